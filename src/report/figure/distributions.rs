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

/// Values over a field, gone through and not copied: a field may have millions.
type Values<'a> = Box<dyn Iterator<Item = f64> + 'a>;

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

fn pressures<'a>(fields: &[Field<'a>], units: &Units) -> Drawn {
    let of = |&(_, cells, _): &Field<'a>| -> Option<Values<'a>> {
        let pressed = cells.pressure_pa.iter().filter(|p| **p > 0.0);
        Some(Box::new(pressed.copied()))
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

fn gaps<'a>(fields: &[Field<'a>], units: &Units) -> Drawn {
    let of = |&(_, cells, gap_m): &Field<'a>| -> Option<Values<'a>> {
        Some(Box::new(gaps_m(cells, gap_m?)))
    };
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
fn plot<'a>(
    fields: &[Field<'a>],
    values_of: impl Fn(&Field<'a>) -> Option<Values<'a>>,
    (x, y): (Quantity, Quantity),
    units: &Units,
) -> Result<(Plot, Vec<String>, f64), &'static str> {
    let most = largest(fields.iter().filter_map(&values_of).flatten());
    if most <= 0.0 {
        return Err("nothing touches, or everything");
    }
    let has_values = |field: &&Field<'a>| values_of(field).is_some_and(|mut v| v.next().is_some());
    let shown: Vec<&Field<'a>> = fields.iter().filter(has_values).collect();
    let curves = at_times::chosen(&shown, |(time_s, ..)| *time_s);
    let times_s: Vec<f64> = curves.iter().map(|(time_s, ..)| *time_s).collect();
    let labels = at_times::labels(&times_s, units);
    let traces = curves.iter().zip(&labels).enumerate();
    let traces = traces.map(|(step, (field, label))| {
        let values = values_of(field).into_iter().flatten();
        Trace::line(shares_above(values, most, POINTS))
            .label(label)
            .member(field.0)
            .color(Color::of_family(step, curves.len()))
    });
    let plot = Plot::new(x, y)
        .family(TIME)
        .traces(traces)
        .x_ends(0.0, most);
    Ok((plot, labels, most))
}
