//! Figures 10 to 12: radius and pressure over frequency, the contact under half the load, and what each cycle dissipates.

use std::f64::consts::TAU;

use super::by_engine::ByEngine;
use super::curves::{Member, SPRINGS, about, cells_label, curve, peak, spread};
use super::cycles::{Case, Cycles, Numbers};
use super::number::{Data, short};
use super::scale::{ProfilePoint, at};
use super::{Claim, Figure, Measure, Result, Source};
use crate::contact::surface::Surface;
use crate::cycle::Loop;
use crate::report::chart::{Axis, Chart, Color, LegendPlace, LineStyle, Mark, Marker, Series};
use crate::report::table::cells;

/// All three.
pub(super) fn figures(cycles: &Cycles<'_>) -> Result<Vec<Figure>> {
    Ok(vec![
        figure_10(cycles)?,
        figure_11(cycles)?,
        figure_12(cycles)?,
    ])
}

fn figure_10(cycles: &Cycles<'_>) -> Result<Figure> {
    let columns = ["source", "f", "largest_radius_a_h", "largest_pressure_p_h"];
    let mut data = Data::new(&columns);
    let near = |f: f64| move |shown: &f64| (shown / f - 1.0).abs() < 1e-9;
    let swept = cycles.curve.iter().copied();
    let swept: Vec<(f64, Numbers)> = swept
        .filter(|(f, _)| cycles.shown[0].iter().any(near(*f)))
        .collect();
    let cases = cycles.cases_of(2)?.into_iter();
    let on_cells: Vec<(f64, Numbers)> = cases
        .map(|case| (case.f, case.numbers.half_space))
        .collect();
    for (source, points) in [("axisymmetric", &swept), ("half-space", &on_cells)] {
        for (f, numbers) in points {
            data.row(cells![source, *f, numbers.radius, numbers.pressure]);
        }
    }
    let drawn = |points: &[(f64, Numbers)], read: fn(&Numbers) -> Option<f64>| {
        let point = |(f, numbers): &(f64, Numbers)| Some((*f, read(numbers)?));
        points.iter().map(point).collect::<Vec<_>>()
    };
    let closed = curve(0.1, 1.5, 140, |f| cycles.closed_forms(f).radius);
    let closed = closed.into_iter().map(|(f, radius)| Some((f, radius?)));
    let by_springs = Series::scatter(drawn(&swept, |n| n.radius)).marker(Marker::Cross);
    let by_cells = Series::scatter(drawn(&on_cells, |n| n.radius)).marker(Marker::Ring);
    let pressure = Series::line(drawn(&swept, |n| n.pressure)).style(LineStyle::Dashed);
    let pressure_by_cells = Series::scatter(drawn(&on_cells, |n| n.pressure)).marker(Marker::Ring);
    let chart = Chart::new(
        Axis::linear("frequency f = ωτ/2π").range(0.0, 1.5),
        Axis::linear("largest in a cycle, normalised").range(0.6, 1.3),
    )
    .all_series([
        Series::line(closed)
            .color(0)
            .label("a / Hertz radius, closed form"),
        by_springs.color(0).label(SPRINGS),
        by_cells.color(0).label(cells_label(cycles.cells)),
        pressure
            .color(1)
            .label("p / Hertz peak pressure, axisymmetric engine"),
        pressure_by_cells.color(1),
    ])
    .legend(LegendPlace::Above);
    let caption = "Largest contact radius and pressure of a stabilised cycle over frequency, Zener half-space.";
    let claims = claims_10(cycles)?;
    Ok(Figure::new(10, caption, vec![chart], data, claims))
}

fn claims_10(cycles: &Cycles<'_>) -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for case in cycles.cases_of(2)? {
        let of = |read: fn(&Numbers) -> Option<f64>| case.numbers.as_ref().map(read);
        let quantity = |what: &str| format!("{what}, f = {}", short(case.f));
        claims.extend([
            Claim::new(
                quantity("largest contact radius / a_H"),
                Source::ClosedForm,
                ByEngine {
                    exact: case.closed.radius,
                    ..of(|n| n.radius)
                },
                Measure::absolute("of a_H", 1e-3, 0.5 * case.cell),
            ),
            Claim::new(
                quantity("largest pressure / p_H"),
                Source::Refined,
                of(|n| n.pressure),
                Measure::absolute("of p_H", 1e-3, 0.01),
            ),
            Claim::new(
                quantity("largest approach / δ_H"),
                Source::ClosedForm,
                ByEngine {
                    exact: case.closed.approach,
                    ..of(|n| n.approach)
                },
                Measure::absolute("of δ_H", 1e-3, 2e-3),
            ),
        ]);
    }
    Ok(claims)
}

/// Names of the surfaces that a stabilised cycle keeps, and where in the cycle they are.
const QUARTERS: [&str; 3] = ["W = W₀/2, loading", "W = W₀", "W = W₀/2, unloading"];

fn figure_11(cycles: &Cycles<'_>) -> Result<Figure> {
    let columns = ["f", "state", "source", "radius_a_h", "pressure_p_h"];
    let mut data = Data::new(&columns);
    let mut chart = Chart::new(
        Axis::linear("radial coordinate r / Hertz radius").range(0.0, 1.4),
        Axis::linear("pressure p / Hertz peak pressure").range(0.0, 0.8),
    )
    .legend(LegendPlace::TopRight);
    let loaded = |surface: Option<&Surface>, beyond: usize| -> Vec<(f64, f64)> {
        let points = surface.map_or_else(Vec::new, |surface| cycles.scale.profile(surface));
        let contact = points.iter().take_while(|p| is_loaded(p)).count();
        let shown = points.iter().take(contact + beyond);
        shown
            .filter_map(|p| Some((p.radius, p.pressure?)))
            .collect()
    };
    for case in cycles.cases_of(1)? {
        let [on_springs, on_cells] = &case.surfaces;
        for (step, state) in QUARTERS.into_iter().enumerate() {
            let line = spread(&loaded(on_springs.get(step), 1), 120);
            let cells = spread(&loaded(on_cells.get(step), 0), 18);
            data.points(&cells![case.f, state, "axisymmetric"], &line);
            data.points(&cells![case.f, state, "half-space"], &cells);
            // The paper shows f = 0.6 alone.
            if (case.f - 0.6).abs() < 1e-9 {
                let member = Member { step, of: 3 };
                chart = chart
                    .series(member.line(line).label(state))
                    .series(member.cells(cells, cycles.cells));
            }
        }
    }
    let caption = "Pressure under half and under the full load in a stabilised cycle, Zener half-space, f = 0.6. Lines: \
                   axisymmetric engine. Symbols: half-space engine. The data hold f = 0.4 and 0.8 as well.";
    let claims = claims_11(cycles)?;
    Ok(Figure::new(11, caption, vec![chart], data, claims))
}

fn claims_11(cycles: &Cycles<'_>) -> Result<Vec<Claim>> {
    let mut claims = Vec::new();
    for case in cycles.cases_of(1)? {
        let at = |quarter: usize| {
            case.samples.as_ref().map(|samples: &Loop| {
                let radii = &samples.contact_radius_m;
                let radius_m = radii.get(quarter * radii.len().saturating_sub(1) / 4)?;
                Some(radius_m / cycles.scale.contact_radius_m)
            })
        };
        let (loading, unloading) = (at(1), at(3));
        let wider = unloading.zip(loading).map(|(b, a)| Some(b? - a?));
        for (quantity, radii, within_cells) in [
            ("contact radius / a_H under W₀/2, loading", loading, 0.5),
            ("contact radius / a_H under W₀/2, unloading", unloading, 0.5),
            ("wider on unloading by / a_H, under W₀/2", wider, 1.0),
        ] {
            let quantity = format!("{quantity}, f = {}", short(case.f));
            let measure = Measure::absolute("of a_H", 2e-3, within_cells * case.cell);
            claims.push(Claim::new(quantity, Source::Refined, radii, measure));
        }
        let quantity = format!(
            "pressure at the quarters of a cycle, largest difference between the engines, f = {}",
            short(case.f)
        );
        let differences = [None, pressure_difference(case, cycles)];
        let measure = Measure::absolute("of p_H", 0.0, 0.01);
        claims.push(
            Claim::difference(quantity, differences, measure)
                .note("but within two cells of the edge of the contact"),
        );
    }
    Ok(claims)
}

/// Whether there is pressure at a point.
fn is_loaded(point: &ProfilePoint) -> bool {
    point.pressure.is_some_and(|pressure| pressure > 0.0)
}

/// Largest difference of the pressure between the engines over the surfaces kept, away from the edge of the contact; `None`
/// where a pressure is undefined.
fn pressure_difference(case: &Case, cycles: &Cycles<'_>) -> Option<f64> {
    let mut worst = 0.0_f64;
    let [on_springs, on_cells] = &case.surfaces;
    for (springs, cells) in on_springs.iter().zip(on_cells) {
        let [springs, cells] = [springs, cells].map(|surface| cycles.scale.profile(surface));
        let loaded = springs.iter().filter(|p| is_loaded(p));
        let edge = loaded.map(|p| p.radius).fold(0.0, f64::max);
        // Springs stand where there is contact at some instant: beyond them nothing presses.
        let reach = springs.last()?.radius;
        let away = |p: &&ProfilePoint| (p.radius - edge).abs() > 2.0 * case.cell;
        for point in cells.iter().filter(away) {
            let expected = match point.radius > reach {
                true => Some(0.0),
                false => at(&springs, point.radius, |p| p.pressure),
            };
            worst = worst.max((point.pressure? - expected?).abs());
        }
    }
    Some(worst)
}

fn figure_12(cycles: &Cycles<'_>) -> Result<Figure> {
    let mut data = Data::new(&["f", "source", "kind", "x", "y"]);
    let panels = vec![
        loops_panel(cycles, &mut data)?,
        losses_panel(cycles, &mut data)?,
    ];
    let caption = "Zener half-space: hysteresis loops, as in the paper, and below them the energy loss over a wider range of \
                   frequencies.";
    let claims = claims_12(cycles)?;
    Ok(Figure::new(12, caption, panels, data, claims))
}

fn loops_panel(cycles: &Cycles<'_>, data: &mut Data) -> Result<Chart> {
    let scale = &cycles.scale;
    let mut chart = Chart::new(
        Axis::linear("approach δ / Hertz approach").range(0.0, 1.6),
        Axis::linear("load W / W₀").range(0.0, 1.0),
    )
    .legend(LegendPlace::TopLeft)
    .size(800, 560);
    let cases = cycles.cases_of(2)?;
    for (step, case) in cases.iter().enumerate() {
        let points = |samples: &Loop, count: usize| -> Vec<(f64, f64)> {
            let pairs = samples.approach_m.iter().zip(&samples.load_n);
            let pairs = pairs.map(|(d, w)| (d / scale.approach_m, w / scale.load_n));
            spread(&pairs.collect::<Vec<_>>(), count)
        };
        let line = points(&case.samples.axisymmetric, 101);
        let cells = points(&case.samples.half_space, 17);
        data.points(&cells![case.f, "axisymmetric", "loop"], &line);
        data.points(&cells![case.f, "half-space", "loop"], &cells);
        let of = cases.len();
        let member = Member { step, of };
        chart = chart
            .series(member.line(line).label(format!("f = {}", short(case.f))))
            .series(member.cells(cells, cycles.cells));
    }
    Ok(chart)
}

fn losses_panel(cycles: &Cycles<'_>, data: &mut Data) -> Result<Chart> {
    let line: Vec<(f64, f64)> = cycles.curve.iter().map(|(f, n)| (*f, n.loss)).collect();
    let losses = losses(cycles);
    for (source, points) in [("axisymmetric", &line), ("half-space", &losses.half_space)] {
        for (f, loss) in points {
            data.row(cells![*f, source, "loss", *f, *loss]);
        }
    }
    let (f, largest) = peak(about(&losses.exact, TAU.recip())?)?;
    let symbols = Series::scatter(losses.half_space).marker(Marker::Ring);
    Ok(Chart::new(
        Axis::log("frequency f = ωτ/2π").range(0.02, 2.0),
        Axis::linear("energy loss / (W₀ · Hertz approach)").range(0.0, 0.3),
    )
    .series(Series::line(line).color(Color::Palette(0)).label(SPRINGS))
    .series(
        symbols
            .color(Color::Palette(1))
            .label(cells_label(cycles.cells)),
    )
    .mark(Mark::point(f, largest, format!("f = {f:.3}, ωτ = 1")))
    .legend(LegendPlace::BottomLeft)
    .size(800, 480))
}

/// The loss over frequency.
fn losses(cycles: &Cycles<'_>) -> ByEngine<Vec<(f64, f64)>> {
    let of = |read: fn(&ByEngine<Numbers>) -> &Numbers| -> Vec<(f64, f64)> {
        let cases = cycles.cases.iter();
        cases
            .map(|case| (case.f, read(&case.numbers).loss))
            .collect()
    };
    ByEngine {
        exact: of(|n| &n.exact),
        axisymmetric: of(|n| &n.axisymmetric),
        half_space: of(|n| &n.half_space),
    }
}

fn claims_12(cycles: &Cycles<'_>) -> Result<Vec<Claim>> {
    let claim = |quantity: String, values: ByEngine<f64>, accuracy: f64| {
        let measure = Measure::relative(accuracy, accuracy);
        Claim::new(quantity, Source::Refined, values.map(Some), measure)
    };
    let mut claims = Vec::new();
    for case in cycles.cases_of(2)? {
        let quantity = format!("energy loss / (W₀ δ_H), f = {}", short(case.f));
        claims.push(claim(quantity, case.numbers.as_ref().map(|n| n.loss), 2e-3));
    }
    let maxima = losses(cycles)
        .map(|losses| peak(about(&losses, TAU.recip())?))
        .all()?;
    let note = "the loss decays over the paper's four frequencies, but rises to this maximum before: it vanishes as f does";
    let place = "f of the largest loss".to_owned();
    claims.push(claim(place, maxima.map(|m| m.0), 5e-3).note(note));
    let value = "largest loss over all frequencies / (W₀ δ_H)".to_owned();
    claims.push(claim(value, maxima.map(|m| m.1), 2e-3));
    Ok(claims)
}
