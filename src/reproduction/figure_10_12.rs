//! Figures 10 to 12: radius and pressure over frequency, the contact under half the load, and what each cycle dissipates.

use std::f64::consts::TAU;

use super::claim::Value;
use super::cycles::{Case, CurvePoint, Cycles, loss, peak, pressure, radius};
use super::look::{Member, SPRINGS, cells_label, evenly, spread};
use super::number::{datum, optional_datum, short};
use super::scale::{ProfilePoint, at};
use super::stabilised::Stabilised;
use super::{Claim, Figure, Measure, ReproductionError, Verdict};
use crate::cycle::Extrema;
use crate::report::chart::{Axis, Chart, Color, LegendPlace, LineStyle, Mark, Marker, Series};
use crate::report::table::Table;

/// All three.
pub(super) fn figures(cycles: &Cycles) -> Result<Vec<Figure>, ReproductionError> {
    Ok(vec![
        figure_10(cycles)?,
        figure_11(cycles)?,
        figure_12(cycles)?,
    ])
}

/// What a cycle on cells came to, normalised: largest radius, approach and pressure. The pressure is `None` where an instant
/// has none.
fn largest_on_cells(case: &Case, cycles: &Cycles) -> [Option<f64>; 3] {
    let scale = &cycles.scale;
    let samples = &case.on_cells.samples;
    let largest = |signal: &[f64]| Extrema::of(signal).map(|e| e.maximum);
    let pressures: Option<Vec<f64>> = samples.peak_pressure_pa.iter().copied().collect();
    // A radius that is counted in cells has no parabola through its maximum.
    let radius_m = samples.contact_radius_m.iter().copied().reduce(f64::max);
    let over = |value: Option<f64>, unit: f64| value.map(|value| value / unit);
    [
        over(radius_m, scale.contact_radius_m),
        over(largest(&samples.approach_m), scale.approach_m),
        over(pressures.and_then(|p| largest(&p)), scale.pressure_pa),
    ]
}

fn figure_10(cycles: &Cycles) -> Result<Figure, ReproductionError> {
    let scale = &cycles.scale;
    let columns = ["source", "f", "largest_radius_a_h", "largest_pressure_p_h"];
    let mut table = Table::new("figure-10.csv", &columns)?;
    let swept = |f: f64| {
        cycles.shown[0]
            .iter()
            .any(|shown| (shown / f - 1.0).abs() < 1e-9)
    };
    let springs: Vec<CurvePoint> = cycles
        .curve
        .iter()
        .filter(|point| swept(point.f))
        .copied()
        .collect();
    for point in &springs {
        let [f, radius] = [point.f, point.largest_radius].map(datum);
        let pressure = optional_datum(point.largest_pressure);
        table.row(&["axisymmetric".to_owned(), f, radius, pressure])?;
    }
    let (mut radii, mut pressures) = (Vec::new(), Vec::new());
    for &f in &cycles.shown[2] {
        let [radius, _, pressure] = largest_on_cells(cycles.case(f)?, cycles);
        radii.push(radius.map(|radius| (f, radius)));
        pressures.push(pressure.map(|pressure| (f, pressure)));
        let [radius, pressure] = [radius, pressure].map(optional_datum);
        table.row(&["half-space".to_owned(), datum(f), radius, pressure])?;
    }
    let equilibrium = scale.contact_compliance.equilibrium_compliance();
    let instantaneous = scale.contact_compliance.instantaneous_compliance();
    let closed = evenly(0.1, 1.5, 140).into_iter().map(|f| {
        let modulus = scale.contact_compliance.complex_compliance(TAU * f).norm();
        Some((f, (0.5 * (equilibrium? + modulus) / instantaneous).cbrt()))
    });
    let chart = Chart::new(
        Axis::linear("frequency f = ωτ/2π").range(0.0, 1.5),
        Axis::linear("largest in a cycle, normalised").range(0.6, 1.3),
    )
    .series(
        Series::line(closed)
            .color(0)
            .label("a / Hertz radius, closed form"),
    )
    .series(
        Series::scatter(springs.iter().map(|p| (p.f, p.largest_radius)))
            .color(0)
            .marker(Marker::Cross)
            .label(SPRINGS),
    )
    .series(
        Series::scatter(radii)
            .color(0)
            .marker(Marker::Ring)
            .label(cells_label(cycles.cells)),
    )
    .series(
        Series::line(springs.iter().map(|p| Some((p.f, p.largest_pressure?))))
            .color(1)
            .style(LineStyle::Dashed)
            .label("p / Hertz peak pressure, axisymmetric engine"),
    )
    .series(Series::scatter(pressures).color(1).marker(Marker::Ring))
    .legend(LegendPlace::Above);
    Ok(Figure {
        number: 10,
        caption: "Largest contact radius and pressure of a stabilised cycle over frequency, Zener half-space.".to_owned(),
        panels: vec![chart],
        data: table.finish()?,
        claims: claims_10(cycles)?,
    })
}

fn claims_10(cycles: &Cycles) -> Result<Vec<Claim>, ReproductionError> {
    let scale = &cycles.scale;
    let cell = |case: &Case| case.on_cells.spacing_m / scale.contact_radius_m;
    let mut claims = Vec::new();
    for &f in &cycles.shown[2] {
        let case = cycles.case(f)?;
        let on_cells = largest_on_cells(case, cycles);
        let claim = |quantity: &str, paper: &str, exact, springs, cells, measure| Claim {
            figure: 10,
            quantity: format!("{quantity}, f = {}", short(f)),
            paper: paper.to_owned(),
            exact,
            axisymmetric: springs,
            half_space: cells,
            measure,
            verdict: Verdict::Agrees,
            note: String::new(),
        };
        claims.push(claim(
            "largest contact radius / a_H",
            "amplitude decays with increasing frequency",
            Value::ClosedForm(case.closed.largest_radius),
            Some(radius(&case.springs, scale)),
            on_cells[0],
            Measure::absolute("of a_H", 1e-3, 0.5 * cell(case)),
        ));
        claims.push(claim(
            "largest pressure / p_H",
            "amplitude increases with increasing frequency",
            Value::Refined(pressure(&case.refined, scale)),
            pressure(&case.springs, scale),
            on_cells[2],
            Measure::absolute("of p_H", 1e-3, 0.01),
        ));
        claims.push(claim(
            "largest approach / δ_H",
            "drawn in figures 8 and 12",
            Value::ClosedForm(case.closed.largest_approach),
            Some(case.springs.approach_m.maximum / scale.approach_m),
            on_cells[1],
            Measure::absolute("of δ_H", 1e-3, 2e-3),
        ));
    }
    Ok(claims)
}

/// Names of the surfaces that a stabilised cycle keeps, and where in the cycle they are.
const QUARTERS: [&str; 3] = ["W = W₀/2, loading", "W = W₀", "W = W₀/2, unloading"];

fn figure_11(cycles: &Cycles) -> Result<Figure, ReproductionError> {
    let scale = &cycles.scale;
    let columns = ["f", "state", "source", "radius_a_h", "pressure_p_h"];
    let mut table = Table::new("figure-11.csv", &columns)?;
    let mut series = Vec::new();
    let loaded = |cycle: &Stabilised, k: usize, beyond: usize| -> Vec<(f64, f64)> {
        let profile = cycle.surfaces.get(k).map(|surface| scale.profile(surface));
        let points = profile.unwrap_or_default();
        let contact = points.iter().take_while(|p| is_loaded(p));
        let shown = contact.count() + beyond;
        let shown = points.iter().take(shown);
        shown
            .filter_map(|p| Some((p.radius, p.pressure?)))
            .collect()
    };
    for &f in &cycles.shown[1] {
        let case = cycles.case(f)?;
        for (k, state) in QUARTERS.into_iter().enumerate() {
            let line = spread(&loaded(&case.on_springs, k, 1), 120);
            let cells = spread(&loaded(&case.on_cells, k, 0), 18);
            for (source, points) in [("axisymmetric", &line), ("half-space", &cells)] {
                for (r, p) in points {
                    let [f, r, p] = [f, *r, *p].map(datum);
                    table.row(&[f, state.to_owned(), source.to_owned(), r, p])?;
                }
            }
            // The paper shows f = 0.6 alone.
            if (f - 0.6).abs() < 1e-9 {
                let member = Member { step: k, of: 3 };
                let symbols = member.cells(cells);
                series.push(member.line(line).label(state));
                series.push(match k {
                    2 => symbols.label(cells_label(cycles.cells)),
                    _ => symbols,
                });
            }
        }
    }
    let chart = Chart::new(
        Axis::linear("radial coordinate r / Hertz radius").range(0.0, 1.4),
        Axis::linear("pressure p / Hertz peak pressure").range(0.0, 0.8),
    )
    .all_series(series)
    .legend(LegendPlace::TopRight);
    Ok(Figure {
        number: 11,
        caption: "Pressure under half and under the full load in a stabilised cycle, Zener half-space, f = 0.6. Lines: \
                  axisymmetric engine. Symbols: half-space engine. The data hold f = 0.4 and 0.8 as well."
            .to_owned(),
        panels: vec![chart],
        data: table.finish()?,
        claims: claims_11(cycles)?,
    })
}

fn claims_11(cycles: &Cycles) -> Result<Vec<Claim>, ReproductionError> {
    let scale = &cycles.scale;
    let mut claims = Vec::new();
    for &f in &cycles.shown[1] {
        let case = cycles.case(f)?;
        for (quarter, branch) in [(1, "loading"), (3, "unloading")] {
            let at = |radii: &[f64]| {
                let place = quarter * radii.len().saturating_sub(1) / 4;
                radii
                    .get(place)
                    .map(|radius_m| radius_m / scale.contact_radius_m)
            };
            let exact = at(&case.refined.samples.contact_radius_m);
            let cell = case.on_cells.spacing_m / scale.contact_radius_m;
            claims.push(Claim {
                figure: 11,
                quantity: format!(
                    "contact radius / a_H under W₀/2, {branch}, f = {}",
                    short(f)
                ),
                paper:
                    "more conformal on the descending branch, the more so the lower the frequency"
                        .to_owned(),
                exact: Value::Refined(exact),
                axisymmetric: at(&case.springs.samples.contact_radius_m),
                half_space: at(&case.on_cells.samples.contact_radius_m),
                measure: Measure::absolute("of a_H", 2e-3, 0.5 * cell),
                verdict: Verdict::Agrees,
                note: String::new(),
            });
        }
        claims.push(Claim {
            figure: 11,
            quantity: format!(
                "pressure at the quarters of a cycle, largest difference between the engines, f = {}",
                short(f)
            ),
            paper: "drawn".to_owned(),
            exact: Value::Difference,
            axisymmetric: None,
            half_space: pressure_difference(case, cycles),
            measure: Measure::absolute("of p_H", 0.0, 0.01),
            verdict: Verdict::Agrees,
            note: "but within two cells of the edge of the contact".to_owned(),
        });
    }
    Ok(claims)
}

/// Whether there is pressure at a point.
fn is_loaded(point: &ProfilePoint) -> bool {
    point.pressure.is_some_and(|pressure| pressure > 0.0)
}

/// Largest difference of the pressure between the engines over the surfaces kept, away from the edge of the contact; `None`
/// where a pressure is undefined.
fn pressure_difference(case: &Case, cycles: &Cycles) -> Option<f64> {
    let scale = &cycles.scale;
    let cell = case.on_cells.spacing_m / scale.contact_radius_m;
    let mut worst = 0.0_f64;
    for (springs, cells) in case.on_springs.surfaces.iter().zip(&case.on_cells.surfaces) {
        let (springs, cells) = (scale.profile(springs), scale.profile(cells));
        let loaded = springs.iter().filter(|p| is_loaded(p));
        let edge = loaded.map(|p| p.radius).fold(0.0, f64::max);
        // Springs stand where there is contact at some instant: beyond them nothing presses.
        let reach = springs.last()?.radius;
        for point in cells
            .iter()
            .filter(|p| (p.radius - edge).abs() > 2.0 * cell)
        {
            let expected = match point.radius > reach {
                true => Some(0.0),
                false => at(&springs, point.radius, |p| p.pressure),
            };
            worst = worst.max((point.pressure? - expected?).abs());
        }
    }
    Some(worst)
}

fn figure_12(cycles: &Cycles) -> Result<Figure, ReproductionError> {
    let columns = ["f", "source", "kind", "x", "y"];
    let mut table = Table::new("figure-12.csv", &columns)?;
    let loops = loops_panel(cycles, &mut table)?;
    let losses = losses_panel(cycles, &mut table)?;
    Ok(Figure {
        number: 12,
        caption: "Zener half-space: hysteresis loops, as in the paper, and below them the energy loss over a wider range of \
                  frequencies."
            .to_owned(),
        panels: vec![loops, losses],
        data: table.finish()?,
        claims: claims_12(cycles)?,
    })
}

fn loops_panel(cycles: &Cycles, table: &mut Table) -> Result<Chart, ReproductionError> {
    let scale = &cycles.scale;
    let mut chart = Chart::new(
        Axis::linear("approach δ / Hertz approach").range(0.0, 1.6),
        Axis::linear("load W / W₀").range(0.0, 1.0),
    )
    .legend(LegendPlace::TopLeft)
    .size(800, 560);
    for (step, &f) in cycles.shown[2].iter().enumerate() {
        let case = cycles.case(f)?;
        let points = |approach_m: &[f64], load_n: &[f64], count: usize| -> Vec<(f64, f64)> {
            let pairs = approach_m.iter().zip(load_n);
            let pairs: Vec<_> = pairs
                .map(|(d, w)| (d / scale.approach_m, w / scale.load_n))
                .collect();
            spread(&pairs, count)
        };
        let samples = &case.springs.samples;
        let line = points(&samples.approach_m, &samples.load_n, 101);
        let samples = &case.on_cells.samples;
        let cells = points(&samples.approach_m, &samples.load_n, 17);
        for (source, points) in [("axisymmetric", &line), ("half-space", &cells)] {
            for (approach, load) in points {
                let [f, x, y] = [f, *approach, *load].map(datum);
                table.row(&[f, source.to_owned(), "loop".to_owned(), x, y])?;
            }
        }
        let member = Member {
            step,
            of: cycles.shown[2].len(),
        };
        let symbols = member.cells(cells);
        chart = chart
            .series(member.line(line).label(format!("f = {}", short(f))))
            .series(match step {
                last if last + 1 == member.of => symbols.label(cells_label(cycles.cells)),
                _ => symbols,
            });
    }
    Ok(chart)
}

fn losses_panel(cycles: &Cycles, table: &mut Table) -> Result<Chart, ReproductionError> {
    let scale = &cycles.scale;
    let line: Vec<(f64, f64)> = cycles.curve.iter().map(|p| (p.f, p.loss)).collect();
    let cells = cycles
        .cases
        .iter()
        .map(|case| Ok((case.f, case.on_cells.energy_loss_j()? / scale.energy_j())))
        .collect::<Result<Vec<_>, ReproductionError>>()?;
    for (source, points) in [("axisymmetric", &line), ("half-space", &cells)] {
        for (f, loss) in points {
            let [f, loss] = [*f, *loss].map(datum);
            table.row(&[f.clone(), source.to_owned(), "loss".to_owned(), f, loss])?;
        }
    }
    let (f, largest) = peak(
        cycles
            .about_the_peak()?
            .map(|c| (c.f, loss(&c.refined, scale))),
    );
    Ok(Chart::new(
        Axis::log("frequency f = ωτ/2π").range(0.02, 2.0),
        Axis::linear("energy loss / (W₀ · Hertz approach)").range(0.0, 0.3),
    )
    .series(Series::line(line).color(Color::Palette(0)).label(SPRINGS))
    .series(
        Series::scatter(cells)
            .color(Color::Palette(1))
            .marker(Marker::Ring)
            .label(cells_label(cycles.cells)),
    )
    .mark(Mark::point(f, largest, format!("f = {f:.3}, ωτ = 1")))
    .legend(LegendPlace::BottomLeft)
    .size(800, 480))
}

fn claims_12(cycles: &Cycles) -> Result<Vec<Claim>, ReproductionError> {
    let scale = &cycles.scale;
    let claim = |quantity: String, exact: f64, springs, cells| Claim {
        figure: 12,
        quantity,
        paper: "energy loss decays with increasing frequency".to_owned(),
        exact: Value::Refined(Some(exact)),
        axisymmetric: Some(springs),
        half_space: Some(cells),
        measure: Measure::relative(Some(exact), 2e-3, 2e-3),
        verdict: Verdict::Agrees,
        note: String::new(),
    };
    let mut claims = Vec::new();
    for &f in &cycles.shown[2] {
        let case = cycles.case(f)?;
        claims.push(claim(
            format!("energy loss / (W₀ δ_H), f = {}", short(f)),
            loss(&case.refined, scale),
            loss(&case.springs, scale),
            case.on_cells.energy_loss_j()? / scale.energy_j(),
        ));
    }
    let about = cycles.about_the_peak()?;
    let refined = peak(about.map(|c| (c.f, loss(&c.refined, scale))));
    let springs = peak(about.map(|c| (c.f, loss(&c.springs, scale))));
    let [low, middle, high] = about.map(|c| c.on_cells.energy_loss_j());
    let on_cells = [low?, middle?, high?].map(|loss_j| loss_j / scale.energy_j());
    let on_cells = [0, 1, 2].map(|k| (about[k].f, on_cells[k]));
    let on_cells = peak(on_cells);
    let note = "the loss decays over the paper's four frequencies, but rises to this maximum before: it vanishes as f does";
    claims.push(Claim {
        measure: Measure::relative(Some(refined.0), 5e-3, 5e-3),
        verdict: Verdict::Disagrees,
        note: note.to_owned(),
        ..claim(
            "f of the largest loss".to_owned(),
            refined.0,
            springs.0,
            on_cells.0,
        )
    });
    claims.push(Claim {
        verdict: Verdict::NotStated,
        paper: String::new(),
        ..claim(
            "largest loss over all frequencies / (W₀ δ_H)".to_owned(),
            refined.1,
            springs.1,
            on_cells.1,
        )
    });
    Ok(claims)
}
