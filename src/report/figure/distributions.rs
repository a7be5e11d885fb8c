//! How pressures and gaps are distributed over a contact on cells, at the times asked for.

use super::at_times;
use super::plot::Plot;
use super::quantity::{PRESSURE, Quantity, TIME};
use super::trace::Trace;
use super::units::{Measure, Units};
use super::{Drawn, Figure};
use crate::contact::statistics::{gaps_m, shares_above};
use crate::contact::surface::{CellSurface, Surface};
use crate::quantity::Dimension;
use crate::report::caption::Caption;
use crate::report::chart::Color;
use crate::report::number::{largest, plain};
use crate::report::words::listed;
use crate::simulation::SurfaceRecord;

/// Points of a curve.
const POINTS: usize = 201;

const GAP: Quantity = Quantity::new("gap_m", "gap g", Measure::Approach);

/// A field on cells, its time (s) and its gaps (m).
type Field<'a> = (f64, &'a CellSurface, Option<&'a [f64]>);

/// The figures of these fields: shares of the contact above every pressure, and of the surface above every gap. None where no cells are
/// recorded, or nothing touches.
pub fn figures(records: &[SurfaceRecord], units: &Units) -> Vec<Figure> {
    let fields = records.iter().filter_map(|record| match &record.surface {
        Surface::Cells(cells) => Some((record.row.time_s, cells, record.gap_m.as_deref())),
        Surface::Radial(_) => None,
    });
    let fields: Vec<Field<'_>> = fields.collect();
    [pressures(&fields, units), gaps(&fields, units)]
        .into_iter()
        .filter_map(Result::ok)
        .collect()
}

fn pressures(fields: &[Field<'_>], units: &Units) -> Drawn {
    let of = |field: &Field<'_>| -> Option<Vec<f64>> {
        let pressed = field.1.pressure_pa.iter().filter(|p| **p > 0.0);
        Some(pressed.copied().collect())
    };
    let share = Quantity::new("contact_share", "contact area above p", Measure::Percent);
    let (plot, labels, most) = plot(fields, of, (PRESSURE, share), units)?;
    let caption = Caption::new("Share of the contact area under more than the pressure p")
        .say(format!("Curves: {}.", listed(&labels)))
        .say(format!(
            "Largest pressure: {}.",
            plain(most, Dimension::Stress, 4)
        ));
    Ok(Figure::of("pressure-distribution", &[plot], caption, units))
}

fn gaps(fields: &[Field<'_>], units: &Units) -> Drawn {
    let of = |(_, cells, gap_m): &Field<'_>| Some(gaps_m(cells, (*gap_m)?).collect());
    let share = Quantity::new("surface_share", "surface above g", Measure::Percent);
    let (plot, labels, most) = plot(fields, of, (GAP, share), units)?;
    let caption = Caption::new(
        "Share of the surface over which the indenter stands further off than the gap g; the rest of it, at g = 0, is in contact",
    )
    .say(format!("Curves: {}.", listed(&labels)))
    .say(format!("Largest gap: {}.", plain(most, Dimension::Length, 4)));
    Ok(Figure::of("gap-distribution", &[plot], caption, units))
}

/// The curves of the fields that are drawn, what they are called, and the largest value.
fn plot(
    fields: &[Field<'_>],
    values_of: impl Fn(&Field<'_>) -> Option<Vec<f64>>,
    (x, y): (Quantity, Quantity),
    units: &Units,
) -> Result<(Plot, Vec<String>, f64), &'static str> {
    let values = fields
        .iter()
        .filter_map(|field| Some((field.0, values_of(field)?)));
    let values: Vec<(f64, Vec<f64>)> = values.filter(|(_, values)| !values.is_empty()).collect();
    let most = largest(values.iter().flat_map(|(_, values)| values).copied());
    if most <= 0.0 {
        return Err("nothing touches, or everything");
    }
    let curves = at_times::chosen(&values, |(time_s, _)| *time_s);
    let times_s: Vec<f64> = curves.iter().map(|(time_s, _)| *time_s).collect();
    let labels = at_times::labels(&times_s, units);
    let traces = curves.iter().zip(&labels).enumerate();
    let traces = traces.map(|(step, ((time_s, values), label))| {
        Trace::line(shares_above(values.iter().copied(), most, POINTS))
            .label(label)
            .member(*time_s)
            .color(Color::of_family(step, curves.len()))
    });
    let plot = Plot::new(x, y)
        .family(TIME)
        .traces(traces)
        .x_ends(0.0, most);
    Ok((plot, labels, most))
}
