//! Which relaxation branch dissipates: the energy loss over frequency as a stack of the losses of the branches.

use super::curve::{Curve, SweepCurves};
use super::quantity::{ENERGY_LOSS, Spread};
use super::trace::{Point, Trace};
use super::{Drawn, Figure};
use crate::quantity::{Dimension, format_human};
use crate::report::caption::Caption;
use crate::report::chart::Color;
use crate::report::number::{largest, scientific};
use crate::report::words::listed;
use crate::sweep::record::{BranchLoss, CaseRecord, CaseResult, Status};

/// Bands in one figure; more cannot be told apart.
const BANDS: usize = 8;
const OTHERS: Color = Color::Rgb(0xC4, 0xC4, 0xC4);

/// The figure, of one curve: bands by retardation time, the longest at the bottom, the area of the loop as a line.
pub fn figure(sweep: &SweepCurves<'_>, curve: &Curve<'_>) -> Drawn {
    let results = curve.results();
    if results.len() < 2 {
        return Err("no dissipation figure: it takes two cases with a result on one curve");
    }
    let bands = bands(&results);
    if bands.is_empty() {
        return Err(match results[0].0.status {
            Status::Transient => {
                "no dissipation figure: what the branches dissipate is not the area of a transient loop"
            }
            _ => "no dissipation figure: the material has no relaxation branches",
        });
    }
    let peaks = sweep.peaks_of(curve);
    let located = peaks.map(|peak| (peak.angular_frequency_rad_per_s, peak.energy_loss_j));
    let located: Vec<(f64, f64)> = located.collect();
    let of = bands.iter().filter(|band| !band.is_rest).count();
    let areas = bands.iter().enumerate().map(|(k, band)| {
        let color = match band.is_rest {
            true => OTHERS,
            // What is left of the stack from here down.
            false => Color::Ramp {
                step: bands.len() - 1 - k,
                of,
            },
        };
        let points = curve.records.iter().map(|record| {
            let place = results.iter().position(|(r, _)| r.index == record.index);
            let loss = place.and_then(|place| band.losses_j.get(place).copied());
            Point::new(sweep.place(record), loss)
        });
        let area = Trace::line(points).label(&band.label).color(color);
        Trace {
            area_to: Some(0.0),
            // Through the located peak as the total is, which it is under.
            ..area.smooth(if k == 0 { located.clone() } else { Vec::new() })
        }
    });
    let records = curve.records.iter();
    let total = records.map(|r| Point::new(sweep.place(r), r.energy_loss_j()));
    let total = Trace::line(total)
        .smooth(located.clone())
        .label("area of the loop")
        .color(Color::Rgb(0, 0, 0));
    let plot = sweep
        .plot(ENERGY_LOSS.spread(Spread::Linear))
        .family(None)
        .title(curve.label.clone())
        .traces(areas)
        .traces([total]);
    let caption = caption(sweep, curve, &results, &bands);
    Ok(Figure::of("dissipation", &[plot], caption, &sweep.units))
}

fn caption(
    sweep: &SweepCurves<'_>,
    curve: &Curve<'_>,
    results: &[(&CaseRecord, &CaseResult)],
    bands: &[Band],
) -> Caption {
    let loss = |place: &usize| results[*place].1.analysis.energy_loss_j;
    let largest = (0..results.len()).max_by(|a, b| loss(a).total_cmp(&loss(b)));
    let shares = largest.filter(|place| loss(place) > 0.0).map(|place| {
        let share = |band: &Band| {
            let part = band.losses_j.get(place).copied().unwrap_or_default() / loss(&place);
            format!("{} % ({})", scientific(100.0 * part, 3), band.label)
        };
        format!(
            "At {}, where the computed loss is largest, they dissipate {} of it.",
            sweep.label_of(results[place].0),
            listed(&bands.iter().map(share).collect::<Vec<_>>())
        )
    });
    Caption::new(format!(
        "Energy loss per cycle over {}, by retardation time λ of the branches that dissipate it",
        sweep.x.words
    ))
        .say("Areas: dissipated by the branches, from their memory alone; line: area of the hysteresis loop.")
        .say_all(curve.sentence.clone().into_iter().chain(shares))
}

/// One band of the stack.
#[derive(Debug, PartialEq)]
struct Band {
    label: String,
    /// One per result.
    losses_j: Vec<f64>,
    /// Whether it stands for what is too small to be shown by itself.
    is_rest: bool,
}

/// The branches, shortest retardation time first; of many, by decades, and of many decades the largest and the rest.
fn bands(results: &[(&CaseRecord, &CaseResult)]) -> Vec<Band> {
    let Some((_, first)) = results.first() else {
        return Vec::new();
    };
    let times = || first.branches.iter().map(|b| b.retardation_time_s);
    let loss =
        |result: &CaseResult, k: usize| result.branches.get(k).map_or(0.0, |b| b.energy_loss_j);
    let band = |label: String, members: &[usize]| Band {
        label,
        losses_j: results
            .iter()
            .map(|(_, result)| members.iter().map(|&k| loss(result, k)).sum())
            .collect(),
        is_rest: false,
    };
    if first.branches.len() <= BANDS {
        let bands = first.branches.iter().enumerate().map(|(k, branch)| {
            let time = format_human(branch.retardation_time_s, Dimension::Time, 4);
            band(format!("λ = {time}{}", body_of(branch)), &[k])
        });
        return bands.collect();
    }
    let mut decades: Vec<(i32, Vec<usize>)> = Vec::new();
    for (k, time_s) in times().enumerate() {
        let decade = time_s.log10().floor() as i32;
        match decades.iter_mut().find(|(d, _)| *d == decade) {
            Some((_, members)) => members.push(k),
            None => decades.push((decade, vec![k])),
        }
    }
    let power = |exponent: i32| scientific(10_f64.powi(exponent), 1);
    let bands = decades.iter().map(|(decade, members)| {
        let label = format!("λ = {} to {} s", power(*decade), power(decade + 1));
        band(label, members)
    });
    with_rest(bands.collect())
}

/// The body that a branch belongs to, where there are two, as it is added to a label.
fn body_of(branch: &BranchLoss) -> &'static str {
    match branch.indenter_share {
        None => "",
        Some(0.0) => ", half-space",
        Some(1.0) => ", indenter",
        Some(_) => ", both bodies",
    }
}

/// At most [`BANDS`]: those with the largest losses, and the sum of the others at the top.
fn with_rest(bands: Vec<Band>) -> Vec<Band> {
    if bands.len() <= BANDS {
        return bands;
    }
    let largest = |band: &Band| largest(band.losses_j.iter().copied());
    let mut heights: Vec<f64> = bands.iter().map(largest).collect();
    heights.sort_by(|a, b| b.total_cmp(a));
    let least = heights[BANDS - 2];
    let (kept, rest): (Vec<Band>, Vec<Band>) =
        bands.into_iter().partition(|band| largest(band) >= least);
    let places = rest.first().map_or(0, |band| band.losses_j.len());
    let others = Band {
        label: "others".to_owned(),
        losses_j: (0..places)
            .map(|i| rest.iter().filter_map(|band| band.losses_j.get(i)).sum())
            .collect(),
        is_rest: true,
    };
    std::iter::once(others).chain(kept).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(label: &str, loss_j: f64) -> Band {
        Band {
            label: label.to_owned(),
            losses_j: vec![loss_j, 0.0],
            is_rest: false,
        }
    }

    #[test]
    fn of_many_bands_the_smallest_are_added_up_at_the_top() {
        let few: Vec<Band> = (0..8).map(|k| band("", f64::from(k))).collect();
        assert_eq!(with_rest(few).len(), 8);
        let many: Vec<Band> = (0..20)
            .map(|k| band(&k.to_string(), f64::from(k)))
            .collect();
        let merged = with_rest(many);
        assert_eq!(merged.len(), BANDS);
        assert!(merged[0].is_rest);
        // 0 + 1 + ... + 12, exact in doubles.
        assert_eq!(merged[0].losses_j, [78.0, 0.0]);
        assert_eq!(merged[1].label, "13");
        assert_eq!(merged[7].label, "19");
    }
}
