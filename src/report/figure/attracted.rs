//! What figures show besides of contacts whose edge an attraction moves: the parts of the loss, the stiffness between that of a moving and
//! that of a pinned edge, and the pull-off load.

use super::curve::{Curve, SweepCurves};
use super::equivalent::LoopModulus;
use super::quantity::{ENERGY_LOSS, Quantity as Along, Spread};
use super::trace::{Point, Trace};
use super::units::Measure;
use super::{Drawn, Figure};
use crate::report::caption::Caption;
use crate::report::chart::{Color, LineStyle, Mark, Marker};
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::record::{CaseRecord, CaseResult};

const STIFFNESS: Along = Along::new("stiffness_ratio", "stiffness K/(2aE*)", Measure::Number);
const PULL: Along =
    Along::new("pull_max_n", "largest pull", Measure::Load).spread(Spread::OfValues);

/// The figures of a curve.
pub fn figures(sweep: &SweepCurves<'_>, curve: &Curve<'_>) -> Vec<Drawn> {
    vec![
        parts(sweep, curve),
        stiffness(sweep, curve),
        pull(sweep, curve),
    ]
}

/// A quantity of a case with its error.
fn point(sweep: &SweepCurves<'_>, record: &CaseRecord, quantity: Quantity) -> Point {
    let result = record.result.as_ref();
    let errors = result.and_then(|result| result.errors.as_ref());
    let value = result.and_then(|result| quantity.of(result));
    Point::new(sweep.place(record), value).error(errors.and_then(|errors| errors.of(quantity)))
}

/// The loss and what it is made of, the largest loss of the edge marked.
fn parts(sweep: &SweepCurves<'_>, curve: &Curve<'_>) -> Drawn {
    if curve.results().len() < 2 {
        return Err(
            "no figure of the parts of the loss: it takes two cases with a result on one curve",
        );
    }
    let of = |quantity: Quantity| {
        let points = curve
            .records
            .iter()
            .map(|record| point(sweep, record, quantity));
        Trace::line(points).smooth([])
    };
    let has_jumps = curve.results().iter().any(|(_, result)| {
        result
            .attracted()
            .is_some_and(|cycle| !cycle.jumps.is_empty())
    });
    let traces = [
        of(Quantity::EnergyLoss)
            .label("all")
            .color(Color::Rgb(0, 0, 0)),
        of(Quantity::BulkLoss)
            .label("bulk")
            .style(LineStyle::Dashed),
        of(Quantity::EdgeLoss).label("edge").marker(Marker::Disc),
    ];
    let jumps = has_jumps.then(|| of(Quantity::JumpLoss).label("jumps").marker(Marker::Square));
    let edge =
        |record: &&CaseRecord| Some((sweep.place(record), record.result.as_ref()?.edge_loss_j()?));
    let edges: Vec<(f64, f64)> = curve
        .records
        .iter()
        .copied()
        .filter_map(|r| edge(&r))
        .collect();
    let is_peak = |k: &usize| {
        let lower = |other: usize| edges.get(other).is_some_and(|other| other.1 < edges[*k].1);
        *k > 0 && lower(k - 1) && lower(k + 1)
    };
    let largest = (0..edges.len())
        .filter(is_peak)
        .max_by(|a, b| edges[*a].1.total_cmp(&edges[*b].1));
    let mark = largest.map(|k| Mark::point(edges[k].0, edges[k].1, String::new()));
    let plot = sweep
        .plot(ENERGY_LOSS.spread(Spread::Linear))
        .family(None)
        .title(curve.label.clone())
        .traces(traces)
        .traces(jumps)
        .marks(mark);
    let caption = Caption::new(format!(
        "Energy loss per cycle over {}, and where it goes",
        sweep.x.words
    ))
    .say(
        "Bulk: under the part of the surface that is in contact all the time; edge: where the contact comes and goes; jumps: what drive and \
         body have less after the contact has passed states that are not stable.",
    )
    .say_all(mark_words(sweep, curve, largest))
    .say_all(curve.sentence.clone());
    Ok(Figure::of("loss-parts", &[plot], caption, &sweep.units))
}

fn mark_words(
    sweep: &SweepCurves<'_>,
    curve: &Curve<'_>,
    largest: Option<usize>,
) -> Option<String> {
    let record = curve.results().get(largest?)?.0;
    Some(format!(
        "Ring: the largest loss of the edge, at {}.",
        sweep.label_of(record)
    ))
}

/// The stiffness of the loop over that of a punch of the mean radius on the same material.
fn stiffness(sweep: &SweepCurves<'_>, curve: &Curve<'_>) -> Drawn {
    let ratio = |record: &CaseRecord| {
        let at = LoopModulus::of(sweep, record)?;
        let errors = at.errors_pa();
        let error_pa = errors[0]
            .zip(errors[1])
            .map(|(storage, loss)| storage.hypot(loss));
        let own_pa = at.own_pa.norm();
        Some((
            at.modulus_pa.norm() / own_pa,
            error_pa.map(|error_pa| error_pa / own_pa),
        ))
    };
    let points: Vec<Point> = curve
        .records
        .iter()
        .map(|record| {
            let ratio = ratio(record);
            Point::new(sweep.place(record), ratio.map(|ratio| ratio.0))
                .error(ratio.and_then(|ratio| ratio.1))
        })
        .collect();
    if points.iter().filter(|point| point.y.is_some()).count() < 2 {
        return Err("no figure of the stiffness: fewer than two loops have moduli");
    }
    let ends = [points.first(), points.last()].into_iter().flatten();
    let punch: Vec<(f64, f64)> = ends.map(|point| (point.x, 1.0)).collect();
    let plot = sweep
        .plot(STIFFNESS)
        .family(None)
        .title(curve.label.clone())
        .traces([Trace::guide(punch).label("flat punch: the edge is pinned")])
        .traces([Trace::line(points).marker(Marker::Disc).smooth([])]);
    let caption = Caption::new(format!(
        "Stiffness K of the contact over {}, relative to that of a flat punch of its mean radius a on the same material",
        sweep.x.words
    ))
    .say("An edge that moves with the load makes a contact softer, one that is pinned leaves it a punch.")
    .say_all(curve.sentence.clone());
    Ok(Figure::of("stiffness", &[plot], caption, &sweep.units))
}

/// The pull-off load of cycles in which the surfaces part.
fn pull(sweep: &SweepCurves<'_>, curve: &Curve<'_>) -> Drawn {
    let parts = |record: &&&CaseRecord| {
        let cycle = record.result.as_ref().and_then(CaseResult::attracted);
        cycle.is_some_and(|cycle| cycle.zone_radius_m.minimum == 0.0)
    };
    let points: Vec<Point> = curve
        .records
        .iter()
        .filter(parts)
        .map(|record| point(sweep, record, Quantity::LargestPull))
        .collect();
    if points.len() < 2 {
        return Err("no figure of the pull-off load: the surfaces part in fewer than two cases");
    }
    let plot = sweep
        .plot(PULL)
        .family(None)
        .title(curve.label.clone())
        .traces([Trace::line(points).marker(Marker::Disc).smooth([])]);
    let caption = Caption::new(format!("Pull-off load over {}", sweep.x.words))
        .say("The largest pull of each cycle in which the surfaces part.")
        .say_all(curve.sentence.clone());
    Ok(Figure::of("pull-off", &[plot], caption, &sweep.units))
}
