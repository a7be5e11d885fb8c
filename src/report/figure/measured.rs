//! Figures of measured loops: the loops, over computed ones where there are some; loss and moduli over frequency; the loss from cycle
//! to cycle.

use super::curve::evenly;
use super::units::Units;
use super::{Figure, axis};
use crate::measured::bias::Unbiased;
use crate::measured::{Estimate, Quantity};
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, LineStyle, Marker, Series};
use crate::report::measured::{Analysis, Computed, MeasuredRow};
use crate::report::number::{largest, range, scientific, with_error};
use crate::report::table::{cells, csv};
use crate::report::words::listed;

/// Loops in one figure; more cannot be told apart.
const LOOPS: usize = 5;
/// Beyond this ratio an axis is logarithmic.
const WIDE: f64 = 8.0;
/// What stands in the legend for what was measured, and for what was computed.
const MEASURED: &str = "measured";
const COMPUTED: &str = "computed";
/// And for storage and loss modulus.
const OF_FORMULA: [&str; 2] = ["E′ of the formula", "E″ of the formula"];
const WITHOUT_BIAS: [&str; 2] = ["E′ without bias", "E″ without bias"];
/// A computed frequency belongs to a measured one within this part of it.
const SAME: f64 = 0.01;

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
    let loss_j = row.mean(Quantity::EnergyLoss)?.value;
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
    let all = || chosen.iter().flat_map(|(_, points)| *points);
    let (to_load, load_unit) = units().load(largest(all().map(|p| p.0.abs())));
    let (to_approach, approach_unit) = units().approach(largest(all().map(|p| p.1.abs())));
    let at = |(w, d): (f64, f64)| (to_approach * d, to_load * w);
    let mut chart = Chart::new(
        Axis::linear(format!("approach δ / {approach_unit}")),
        Axis::linear(format!("load W / {load_unit}")),
    );
    let mut lines = "lines are the fitted harmonics";
    for (step, (row, points)) in chosen.iter().enumerate() {
        let color = ramp(step, &chosen);
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
        let rings = Series::scatter(points.iter().copied().map(at)).marker(Marker::Ring);
        chart = chart
            .series(Series::line(line.into_iter().map(at)).color(color))
            .series(rings.color(color).label(label(row)).spaced());
    }
    let losses: Vec<String> = chosen.iter().filter_map(|(row, _)| loss(row)).collect();
    let data = chosen.iter().flat_map(|(row, points)| {
        let omega = row.angular_rad_per_s();
        points.iter().map(move |(w, d)| cells![omega, *d, *w])
    });
    Some(Figure {
        name: "loops",
        picture: chart.into(),
        caption: Caption::new("Measured loops: load W over approach δ, averaged over the cycles")
            .say(format!(
                "Rings are averages of samples, drift taken off; {lines}."
            ))
            .say(format!(
                "Their areas are the energy losses per cycle: {}.",
                listed(&losses)
            )),
        data: csv(
            &["angular_frequency_rad_per_s", "approach_m", "load_n"],
            data,
        ),
    })
}

fn ramp<T>(step: usize, all: &[T]) -> Color {
    let of = all.len();
    Color::Ramp { step, of }
}

/// The loss in words: `3.51 ± 0.02 µJ at f = 1 Hz`.
fn loss(row: &MeasuredRow) -> Option<String> {
    let mean = row.mean(Quantity::EnergyLoss)?;
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

    fn series(&self, factor: f64, logarithmic: bool) -> Vec<Series> {
        let place = |omega: f64, value: f64| {
            let shown = !logarithmic || value > 0.0;
            shown.then_some((FrequencyUnit::Hz.of(omega), factor * value))
        };
        let points = self.measured.iter();
        let errors = points.clone().map(|(_, mean)| Some(factor * mean.error?));
        let points = Series::scatter(points.map(|(omega, mean)| place(*omega, mean.value)))
            .marker(self.marker)
            .color(self.color)
            .label(self.label)
            .error_bars(errors.collect::<Vec<_>>());
        let line = (!self.computed.is_empty()).then(|| {
            let label = match self.label {
                MEASURED => COMPUTED.to_owned(),
                label => format!("{label}, {COMPUTED}"),
            };
            Series::line(
                self.computed
                    .iter()
                    .map(|(omega, value)| place(*omega, *value)),
            )
            .color(self.color)
            .label(label)
            .style(LineStyle::Dashed)
        });
        [points].into_iter().chain(line).collect()
    }
}

/// Numbers over frequencies (Hz).
fn over_frequency(all: &[Over<'_>], factor: f64, title: String) -> Chart {
    let measured = || all.iter().flat_map(|over| &over.measured);
    let frequencies = range(measured().map(|(omega, _)| FrequencyUnit::Hz.of(*omega)));
    let (least, most) = range(measured().map(|(_, mean)| factor * mean.value));
    let logarithmic = least > 0.0 && most > 2.0 * WIDE * least;
    Chart::new(
        axis(frequencies, WIDE, units().frequency_title()),
        axis((least, most), 2.0 * WIDE, title),
    )
    .all_series(all.iter().flat_map(|over| over.series(factor, logarithmic)))
}

fn energy_loss(rows: &[MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let over = Over::new(
        (MEASURED, Marker::Disc, 0),
        (rows, |row| row.mean(Quantity::EnergyLoss)),
        (computed, |case| case.energy_loss_j),
    );
    if over.measured.len() < 2 {
        return None;
    }
    let (factor, unit) = units().energy(largest(over.measured.iter().map(|(_, m)| m.value.abs())));
    Some(Figure {
        name: "energy-loss",
        picture: over_frequency(&[over], factor, format!("energy loss per cycle / {unit}")).into(),
        caption: Caption::new("Energy loss per cycle over frequency")
            .say("Bars are intervals of 95 %, from the scatter of the cycles and the noise of the samples."),
        data: Vec::new(),
    })
}

fn moduli(rows: &[MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let mut all = vec![
        Over::new(
            (OF_FORMULA[0], Marker::Ring, 0),
            (rows, |row| row.mean(Quantity::StorageModulus)),
            (computed, |case| case.storage_modulus_pa),
        ),
        Over::new(
            (OF_FORMULA[1], Marker::Diamond, 1),
            (rows, |row| row.mean(Quantity::LossModulus)),
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
    let highest = largest(measured.map(|(_, mean)| mean.value));
    if rows.len() < 2 || highest <= 0.0 {
        return None;
    }
    let (factor, unit) = units().modulus(highest);
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
    Some(Figure {
        name: "moduli",
        picture: over_frequency(&all, factor, format!("modulus / {unit}")).into(),
        caption: Caption::new("Storage modulus E′ and loss modulus E″ read from the loops")
            .say(format!(
                "{}: the formula of small amplitudes{without}.",
                listed(&of_formula)
            ))
            .say("Bars are intervals of 95 %."),
        data: Vec::new(),
    })
}

/// The number of every cycle, and its relative deviation of its loss from the mean (%), where there are enough of them.
fn relative_losses(row: &MeasuredRow) -> Option<Vec<(usize, f64)>> {
    let measured = row.measured.as_ref()?;
    let cycles = measured.cycles.iter().zip(&measured.values);
    let mut losses: Vec<(usize, f64)> = cycles
        .map(|(cycle, values)| Some((cycle.number, values[Quantity::EnergyLoss.place()]?)))
        .collect::<Option<_>>()?;
    let last = losses.get(3..)?.last()?.1;
    let mean = row.mean(Quantity::EnergyLoss);
    let center = mean.map_or(last, |mean| mean.value);
    for (_, loss) in &mut losses {
        *loss = 100.0 * (*loss / center - 1.0);
    }
    Some(losses)
}

fn cycles(rows: &[MeasuredRow]) -> Option<Figure> {
    let losses = rows
        .iter()
        .filter_map(|row| Some((row, relative_losses(row)?)));
    let chosen = some(&losses.collect::<Vec<_>>());
    chosen.first()?;
    let series = chosen.iter().enumerate().map(|(step, (row, losses))| {
        let points = losses.iter();
        Series::line(points.map(|(number, percent)| (*number as f64, *percent)))
            .marker(Marker::nth(step))
            .label(label(row))
            .color(ramp(step, &chosen))
    });
    let chart = Chart::new(
        Axis::linear("number of the cycle"),
        Axis::linear("deviation of the loss from the mean / %"),
    )
    .all_series(series);
    let data = chosen.iter().flat_map(|(row, losses)| {
        let omega = row.angular_rad_per_s();
        let losses = losses.iter();
        losses.map(move |(number, percent)| cells![omega, *number, *percent])
    });
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
    Some(Figure {
        name: "cycles",
        picture: chart.into(),
        caption: Caption::new(
            "Energy loss of every cycle, relative to the mean of those that count",
        )
        .say(holds),
        data: csv(
            &["angular_frequency_rad_per_s", "cycle", "relative_percent"],
            data,
        ),
    })
}
