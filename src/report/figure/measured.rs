//! Figures of measured loops: the loops, over computed ones where there are some; loss and moduli over frequency; the loss from cycle
//! to cycle.

use super::Figure;
use super::curve::evenly;
use super::plot::Plot;
use super::quantity::{APPROACH, CYCLE, ENERGY_LOSS, LOAD, MODULUS, Quantity, Spread};
use super::trace::{Point, Trace};
use super::units::{Measure, Units};
use crate::measured::bias::Unbiased;
use crate::measured::{Estimate, Quantity as Measured};
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::caption::Caption;
use crate::report::chart::{LineStyle, Marker};
use crate::report::measured::{Analysis, Computed, MeasuredRow};
use crate::report::number::{largest, scientific, with_error};
use crate::report::words::listed;

/// Loops in one figure; more cannot be told apart.
const LOOPS: usize = 5;
/// What stands in the legend for what was measured, and for what was computed.
const MEASURED: &str = "measured";
const COMPUTED: &str = "computed";
/// And for storage and loss modulus.
const OF_FORMULA: [&str; 2] = ["E′ of the formula", "E″ of the formula"];
const WITHOUT_BIAS: [&str; 2] = ["E′ without bias", "E″ without bias"];
/// A computed frequency belongs to a measured one within this part of it.
const SAME: f64 = 0.01;
const DEVIATION: Quantity = Quantity::new(
    "relative_deviation",
    "deviation of the loss from the mean",
    Measure::Percent,
);

/// The figures that the rows have.
pub fn figures(analysis: &Analysis) -> Vec<Figure> {
    let (rows, computed) = (&analysis.rows[..], &analysis.computed[..]);
    let all = [
        loops(rows, computed),
        energy_loss(rows, computed),
        moduli(rows, computed),
        cycles(rows),
    ];
    all.into_iter().flatten().collect()
}

fn units() -> Units {
    Units::in_si(FrequencyUnit::Hz)
}

/// Of rows with what is drawn of them some, spread over all.
fn some<'a, T: Clone>(rows: &[(&'a MeasuredRow, T)]) -> Vec<(&'a MeasuredRow, T)> {
    let places = evenly(rows.len(), LOOPS).into_iter();
    places.map(|place| rows[place].clone()).collect()
}

fn label(row: &MeasuredRow) -> String {
    let omega = row.angular_rad_per_s().unwrap_or(0.0);
    units().frequency_label(omega)
}

/// The computed case at the frequency of a row, the nearest in loss where there are several.
fn beside<'a>(row: &MeasuredRow, computed: &'a [Computed]) -> Option<&'a Computed> {
    let omega = row.angular_rad_per_s()?;
    let loss_j = row.mean(Measured::EnergyLoss)?.value;
    let near = |case: &&Computed| (case.angular_rad_per_s / omega - 1.0).abs() < SAME;
    let apart = |case: &Computed| {
        case.energy_loss_j
            .map_or(f64::INFINITY, |j| (j - loss_j).abs())
    };
    let near = computed.iter().filter(near);
    near.min_by(|a, b| apart(a).total_cmp(&apart(b)))
}

fn loops(rows: &[MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let points = rows
        .iter()
        .filter_map(|row| Some((row, &row.measured.as_ref()?.points[..])));
    let chosen = some(
        &points
            .filter(|(_, points)| !points.is_empty())
            .collect::<Vec<_>>(),
    );
    chosen.first()?;
    let mut traces = Vec::new();
    let mut lines = "lines are the fitted harmonics";
    for (step, (row, points)) in chosen.iter().enumerate() {
        let line = match beside(row, computed) {
            Some(case) => {
                lines = "lines are the computed loops where there are some, the fitted harmonics elsewhere";
                case.cycle.clone()
            }
            None => {
                let samples = row.samples().unwrap_or_default();
                samples.load_n.into_iter().zip(samples.approach_m).collect()
            }
        };
        let at = |(load_n, approach_m): (f64, f64)| (approach_m, load_n);
        let of = |trace: Trace| {
            trace
                .of_family(step, chosen.len())
                .member(row.angular_rad_per_s())
        };
        let line = of(Trace::line(line.into_iter().map(at)));
        let rings = of(Trace::symbols(points.iter().copied().map(at)))
            .marker(Marker::Ring)
            .label(label(row))
            .spaced();
        traces.extend([
            Trace {
                in_table: false,
                ..line
            },
            rings,
        ]);
    }
    let plot = Plot::new(APPROACH, LOAD)
        .family(Quantity::frequency(&units()))
        .traces(traces);
    let losses: Vec<String> = chosen.iter().filter_map(|(row, _)| loss(row)).collect();
    let caption = Caption::new("Measured loops: load W over approach δ, averaged over the cycles")
        .say(format!(
            "Rings are averages of samples, drift taken off; {lines}."
        ))
        .say(format!(
            "Their areas are the energy losses per cycle: {}.",
            listed(&losses)
        ));
    Some(Figure::of("loops", &[plot], caption, &units()))
}

/// The loss in words: `3.51 ± 0.02 µJ at f = 1 Hz`.
fn loss(row: &MeasuredRow) -> Option<String> {
    let mean = row.mean(Measured::EnergyLoss)?;
    let value = with_error(mean.value, mean.error, Dimension::Energy);
    Some(format!("{value} at {}", label(row)))
}

/// One of several numbers over the frequency.
struct Over<'a> {
    label: &'a str,
    marker: Marker,
    color: usize,
    measured: Vec<(f64, Estimate)>,
    computed: Vec<(f64, f64)>,
}

/// What is read from which.
type Read<'a, T, V> = (&'a [T], fn(&T) -> Option<V>);

impl<'a> Over<'a> {
    /// What is read from rows and from computed cases.
    fn new(
        (label, marker, color): (&'a str, Marker, usize),
        (rows, mean): Read<'_, MeasuredRow, Estimate>,
        (computed, value): Read<'_, Computed, f64>,
    ) -> Self {
        let measured = rows
            .iter()
            .filter_map(|row| Some((row.angular_rad_per_s()?, mean(row)?)));
        let computed = computed
            .iter()
            .filter_map(|case| Some((case.angular_rad_per_s, value(case)?)));
        Self {
            label,
            marker,
            color,
            measured: measured.collect(),
            computed: computed.collect(),
        }
    }

    fn traces(&self) -> impl Iterator<Item = Trace> {
        let points = self.measured.iter();
        let points = points.map(|(x, mean)| Point::new(*x, mean.value).error(mean.error));
        let symbols = Trace::symbols(points)
            .marker(self.marker)
            .color(self.color)
            .label(self.label);
        let line = (!self.computed.is_empty()).then(|| {
            let label = match self.label {
                MEASURED => COMPUTED.to_owned(),
                label => format!("{label}, {COMPUTED}"),
            };
            Trace::line(self.computed.iter().copied())
                .color(self.color)
                .label(label)
                .style(LineStyle::Dashed)
                .smooth([])
        });
        [symbols].into_iter().chain(line)
    }
}

/// Numbers over frequencies.
fn over_frequency(all: &[Over<'_>], y: Quantity) -> Plot {
    let x = Quantity::frequency(&units()).spread(Spread::OfValues);
    Plot::new(x, y.spread(Spread::OfValues)).traces(all.iter().flat_map(Over::traces))
}

fn energy_loss(rows: &[MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let over = Over::new(
        (MEASURED, Marker::Disc, 0),
        (rows, |row| row.mean(Measured::EnergyLoss)),
        (computed, |case| case.energy_loss_j),
    );
    if over.measured.len() < 2 {
        return None;
    }
    let caption = Caption::new("Energy loss per cycle over frequency").say(
        "Bars are intervals of 95 %, from the scatter of the cycles and the noise of the samples.",
    );
    let plot = over_frequency(&[over], ENERGY_LOSS);
    Some(Figure::of("energy-loss", &[plot], caption, &units()))
}

fn moduli(rows: &[MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let mut all = vec![
        Over::new(
            (OF_FORMULA[0], Marker::Ring, 0),
            (rows, |row| row.mean(Measured::StorageModulus)),
            (computed, |case| case.storage_modulus_pa),
        ),
        Over::new(
            (OF_FORMULA[1], Marker::Diamond, 1),
            (rows, |row| row.mean(Measured::LossModulus)),
            (computed, |case| case.loss_modulus_pa),
        ),
        Over::new(
            (WITHOUT_BIAS[0], Marker::Disc, 0),
            (rows, |row| Some(row.unbiased()?.storage_modulus_pa)),
            (&[], |_| None),
        ),
        Over::new(
            (WITHOUT_BIAS[1], Marker::Square, 1),
            (rows, |row| Some(row.unbiased()?.loss_modulus_pa)),
            (&[], |_| None),
        ),
    ];
    all.retain(|over| !over.measured.is_empty());
    let measured = all.iter().flat_map(|over| &over.measured);
    if rows.len() < 2 || largest(measured.map(|(_, mean)| mean.value)) <= 0.0 {
        return None;
    }
    let plot = over_frequency(&all, MODULUS);
    let caption = caption_of_moduli(rows, &all);
    Some(Figure::of("moduli", &[plot], caption, &units()))
}

fn caption_of_moduli(rows: &[MeasuredRow], all: &[Over<'_>]) -> Caption {
    let shown = |labels: [&str; 2]| -> Vec<String> {
        let shown = all.iter().filter(|over| labels.contains(&over.label));
        shown
            .map(|over| format!("{} ({})", over.label, over.marker.name()))
            .collect()
    };
    let of_formula = shown(OF_FORMULA);
    let correction = |bias: fn(&Unbiased) -> f64| {
        let unbiased = rows.iter().filter_map(MeasuredRow::unbiased);
        largest(unbiased.map(|unbiased| (bias(&unbiased) - 1.0).abs()))
    };
    let percent = |share: f64| format!("{} %", scientific(100.0 * share, 2));
    let (storage, loss) = (correction(|u| u.storage_bias), correction(|u| u.loss_bias));
    let without = match &shown(WITHOUT_BIAS)[..] {
        [] => String::new(),
        shown => format!(
            "; {}: without its bias, which is up to {} of E′ and {} of E″ and may be too small to be seen here",
            listed(shown),
            percent(storage),
            percent(loss)
        ),
    };
    Caption::new("Storage modulus E′ and loss modulus E″ read from the loops")
        .say(format!(
            "{}: the formula of small amplitudes{without}.",
            listed(&of_formula)
        ))
        .say("Bars are intervals of 95 %.")
}

/// The number of every cycle, and the relative deviation of its loss from the mean, where there are enough of them.
fn relative_losses(row: &MeasuredRow) -> Option<Vec<(usize, f64)>> {
    let measured = row.measured.as_ref()?;
    let cycles = measured.cycles.iter().zip(&measured.values);
    let mut losses: Vec<(usize, f64)> = cycles
        .map(|(cycle, values)| Some((cycle.number, values[Measured::EnergyLoss.place()]?)))
        .collect::<Option<_>>()?;
    let last = losses.get(3..)?.last()?.1;
    let mean = row.mean(Measured::EnergyLoss);
    let center = mean.map_or(last, |mean| mean.value);
    for (_, loss) in &mut losses {
        *loss = *loss / center - 1.0;
    }
    Some(losses)
}

fn cycles(rows: &[MeasuredRow]) -> Option<Figure> {
    let losses = rows
        .iter()
        .filter_map(|row| Some((row, relative_losses(row)?)));
    let chosen = some(&losses.collect::<Vec<_>>());
    chosen.first()?;
    let traces = chosen.iter().enumerate().map(|(step, (row, losses))| {
        let points = losses.iter();
        Trace::line(points.map(|(number, deviation)| (*number as f64, *deviation)))
            .marker(Marker::Disc)
            .of_family(step, chosen.len())
            .label(label(row))
            .member(row.angular_rad_per_s())
    });
    let plot = Plot::new(CYCLE, DEVIATION)
        .family(Quantity::frequency(&units()))
        .traces(traces);
    let first = |(row, _): &(&MeasuredRow, _)| {
        let first = row.measured.as_ref()?.first_stabilised?;
        Some(format!("{first} at {}", label(row)))
    };
    let firsts: Vec<String> = chosen.iter().filter_map(first).collect();
    let holds = match firsts.is_empty() {
        true => "None of them is stabilised.".to_owned(),
        false => format!(
            "Nothing changes any more from cycle {} on.",
            listed(&firsts)
        ),
    };
    let caption =
        Caption::new("Energy loss of every cycle, relative to the mean of those that count")
            .say(holds);
    Some(Figure::of("cycles", &[plot], caption, &units()))
}
