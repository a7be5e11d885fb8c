//! Figures of measured loops: the loops, over computed ones where there are some; loss and moduli over frequency; the loss from cycle
//! to cycle.

use super::curve::evenly;
use super::units::Units;
use super::{Figure, axis};
use crate::measured::{Estimate, Quantity};
use crate::quantity::{Dimension, FrequencyUnit};
use crate::report::caption::Caption;
use crate::report::chart::{Axis, Chart, Color, LineStyle, Marker, Series};
use crate::report::measured::{Analysis, Computed, MeasuredRow};
use crate::report::number::{largest, range, with_error};
use crate::report::table::{Cell, cells, csv};
use crate::report::words::listed;

/// Loops in one figure; more cannot be told apart.
const LOOPS: usize = 5;
/// Beyond this ratio an axis is logarithmic.
const WIDE: f64 = 8.0;
/// What stands in the legend for what was measured, and for what was computed.
const MEASURED: &str = "measured";
const COMPUTED: &str = "computed";
/// A computed frequency belongs to a measured one within this part of it.
const SAME: f64 = 0.01;

/// The figures that the rows have.
pub fn figures(analysis: &Analysis) -> Vec<Figure> {
    let computed = &analysis.computed;
    let rows: Vec<&MeasuredRow> = analysis.rows.iter().collect();
    let all = [
        loops(&rows, computed),
        energy_loss(&rows, computed),
        moduli(&rows, computed),
        cycles(&rows),
    ];
    all.into_iter().flatten().collect()
}

fn units() -> Units {
    Units::in_si(FrequencyUnit::Hz)
}

/// Some of these rows, spread over them.
fn some<'a>(rows: &[&'a MeasuredRow]) -> Vec<&'a MeasuredRow> {
    let places = evenly(rows.len(), LOOPS).into_iter();
    places
        .filter_map(|place| rows.get(place).copied())
        .collect()
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

fn loops(rows: &[&MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let points = |row: &MeasuredRow| {
        row.measured
            .as_ref()
            .map(|m| m.points.clone())
            .unwrap_or_default()
    };
    let with_loop: Vec<&MeasuredRow> = rows
        .iter()
        .copied()
        .filter(|row| !points(row).is_empty())
        .collect();
    let chosen = some(&with_loop);
    chosen.first()?;
    let all: Vec<(f64, f64)> = chosen.iter().flat_map(|row| points(row)).collect();
    let (to_load, load_unit) = units().load(largest(all.iter().map(|p| p.0.abs())));
    let (to_approach, approach_unit) = units().approach(largest(all.iter().map(|p| p.1.abs())));
    let at = |(w, d): (f64, f64)| (to_approach * d, to_load * w);
    let mut series = Vec::new();
    for (step, row) in chosen.iter().enumerate() {
        let color = Color::Ramp {
            step,
            of: chosen.len(),
        };
        let line = match beside(row, computed) {
            Some(case) => case.cycle.clone(),
            None => {
                let samples = row.samples().unwrap_or_default();
                samples.load_n.into_iter().zip(samples.approach_m).collect()
            }
        };
        series.push(Series::line(line.into_iter().map(at)).color(color));
        let measured = Series::scatter(points(row).into_iter().map(at)).marker(Marker::Ring);
        series.push(measured.color(color).label(label(row)).spaced());
    }
    let has_computed = chosen.iter().any(|row| beside(row, computed).is_some());
    let chart = Chart::new(
        Axis::linear(format!("approach δ / {approach_unit}")),
        Axis::linear(format!("load W / {load_unit}")),
    )
    .all_series(series);
    let losses: Vec<String> = chosen.iter().filter_map(|row| loss(row)).collect();
    let lines = match has_computed {
        true => "lines are the computed loops where there are some, the fitted harmonics elsewhere",
        false => "lines are the fitted harmonics",
    };
    let data = chosen.iter().flat_map(|row| {
        let omega = row.angular_rad_per_s();
        points(row)
            .into_iter()
            .map(move |(w, d)| cells![omega, d, w])
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

impl Over<'_> {
    fn series(&self, factor: f64, logarithmic: bool) -> Vec<Series> {
        let hz = |omega: f64| FrequencyUnit::Hz.of(omega);
        let shown = |value: f64| !logarithmic || value > 0.0;
        let place = |(omega, mean): &(f64, Estimate)| {
            shown(mean.value).then_some((hz(*omega), factor * mean.value))
        };
        let errors = self
            .measured
            .iter()
            .map(|(_, mean)| Some(factor * mean.error?));
        let points = Series::scatter(self.measured.iter().map(place).collect::<Vec<_>>());
        let points = points
            .marker(self.marker)
            .color(self.color)
            .label(self.label);
        let mut all = vec![points.error_bars(errors.collect::<Vec<_>>())];
        if !self.computed.is_empty() {
            let line = self.computed.iter();
            let line =
                line.map(|(omega, value)| shown(*value).then_some((hz(*omega), factor * value)));
            let line = Series::line(line.collect::<Vec<_>>()).color(self.color);
            let label = match self.label {
                MEASURED => COMPUTED.to_owned(),
                label => format!("{label}, {COMPUTED}"),
            };
            all.push(line.label(label).style(LineStyle::Dashed));
        }
        all
    }
}

fn means(
    rows: &[&MeasuredRow],
    mean: impl Fn(&MeasuredRow) -> Option<Estimate>,
) -> Vec<(f64, Estimate)> {
    let known = rows
        .iter()
        .filter_map(|row| Some((row.angular_rad_per_s()?, mean(row)?)));
    known.collect()
}

fn of_computed(computed: &[Computed], value: impl Fn(&Computed) -> Option<f64>) -> Vec<(f64, f64)> {
    let known = computed
        .iter()
        .filter_map(|case| Some((case.angular_rad_per_s, value(case)?)));
    known.collect()
}

/// Axis of frequencies (Hz) and axis of values.
fn axes(all: &[Over<'_>], factor: f64, title: String) -> (Axis, Axis, bool) {
    let omegas = || {
        all.iter()
            .flat_map(|over| over.measured.iter().map(|(omega, _)| *omega))
    };
    let values = || {
        all.iter()
            .flat_map(|over| over.measured.iter().map(|(_, mean)| factor * mean.value))
    };
    let (low, high) = range(omegas().map(|omega| FrequencyUnit::Hz.of(omega)));
    let (least, most) = range(values());
    let x = axis((low, high), WIDE, units().frequency_title());
    let y = axis((least, most), 2.0 * WIDE, title);
    (x, y, least > 0.0 && most > 2.0 * WIDE * least)
}

fn energy_loss(rows: &[&MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let measured = means(rows, |row| row.mean(Quantity::EnergyLoss));
    if measured.len() < 2 {
        return None;
    }
    let (factor, unit) = units().energy(largest(measured.iter().map(|(_, m)| m.value.abs())));
    let over = [Over {
        label: MEASURED,
        marker: Marker::Disc,
        color: 0,
        measured,
        computed: of_computed(computed, |case| case.energy_loss_j),
    }];
    let (x, y, logarithmic) = axes(&over, factor, format!("energy loss per cycle / {unit}"));
    let chart = Chart::new(x, y).all_series(over[0].series(factor, logarithmic));
    Some(Figure {
        name: "energy-loss",
        picture: chart.into(),
        caption: Caption::new("Energy loss per cycle over frequency")
            .say("Bars are intervals of 95 %, from the scatter of the cycles and the noise of the samples."),
        data: Vec::new(),
    })
}

fn moduli(rows: &[&MeasuredRow], computed: &[Computed]) -> Option<Figure> {
    let unbiased = |row: &MeasuredRow, is_loss: bool| {
        let unbiased = row.measured.as_ref()?.unbiased?;
        Some(if is_loss {
            unbiased.loss_modulus_pa
        } else {
            unbiased.storage_modulus_pa
        })
    };
    let over = |label, marker, color, measured, computed| Over {
        label,
        marker,
        color,
        measured,
        computed,
    };
    let mut all = vec![
        over(
            "E′ of the formula",
            Marker::Ring,
            0,
            means(rows, |row| row.mean(Quantity::StorageModulus)),
            of_computed(computed, |case| case.storage_modulus_pa),
        ),
        over(
            "E″ of the formula",
            Marker::Diamond,
            1,
            means(rows, |row| row.mean(Quantity::LossModulus)),
            of_computed(computed, |case| case.loss_modulus_pa),
        ),
        over(
            "E′ without bias",
            Marker::Disc,
            0,
            means(rows, |row| unbiased(row, false)),
            Vec::new(),
        ),
        over(
            "E″ without bias",
            Marker::Square,
            1,
            means(rows, |row| unbiased(row, true)),
            Vec::new(),
        ),
    ];
    all.retain(|over| !over.measured.is_empty());
    let highest = largest(
        all.iter()
            .flat_map(|o| o.measured.iter().map(|(_, m)| m.value)),
    );
    if rows.len() < 2 || highest <= 0.0 {
        return None;
    }
    let (factor, unit) = units().modulus(highest);
    let (x, y, logarithmic) = axes(&all, factor, format!("modulus / {unit}"));
    let series = all.iter().flat_map(|over| over.series(factor, logarithmic));
    Some(Figure {
        name: "moduli",
        picture: Chart::new(x, y).all_series(series).into(),
        caption: Caption::new("Storage modulus E′ and loss modulus E″ read from the loops")
            .say("Open symbols: the formula of small amplitudes; filled ones: the same without its bias, which the exact model gives.")
            .say("Bars are intervals of 95 %."),
        data: Vec::new(),
    })
}

fn cycles(rows: &[&MeasuredRow]) -> Option<Figure> {
    let relative = |row: &MeasuredRow| -> Option<Vec<(usize, f64)>> {
        let measured = row.measured.as_ref()?;
        let place = Quantity::EnergyLoss.place();
        let values = measured.cycles.iter().zip(&measured.values);
        let values: Option<Vec<(usize, f64)>> = values
            .map(|(cycle, values)| Some((cycle.number, values[place]?)))
            .collect();
        let values = values.filter(|values| values.len() > 3)?;
        let last = values.last()?.1;
        let center = row
            .mean(Quantity::EnergyLoss)
            .map_or(last, |mean| mean.value);
        Some(
            values
                .into_iter()
                .map(|(number, j)| (number, 100.0 * (j / center - 1.0)))
                .collect(),
        )
    };
    let with_cycles: Vec<&MeasuredRow> = rows
        .iter()
        .copied()
        .filter(|row| relative(row).is_some())
        .collect();
    let chosen = some(&with_cycles);
    chosen.first()?;
    let series = chosen.iter().enumerate().map(|(step, row)| {
        let points = relative(row).unwrap_or_default().into_iter();
        Series::line(points.map(|(number, percent)| (number as f64, percent)))
            .marker(Marker::nth(step))
            .label(label(row))
            .color(Color::Ramp {
                step,
                of: chosen.len(),
            })
    });
    let chart = Chart::new(
        Axis::linear("number of the cycle"),
        Axis::linear("loss of the cycle over the mean, less 1 / %"),
    )
    .all_series(series);
    let data = chosen.iter().flat_map(|row| {
        let omega = row.angular_rad_per_s();
        let values = relative(row).unwrap_or_default().into_iter();
        values.map(move |(number, percent)| cells![omega, number, percent])
    });
    let first = |row: &&MeasuredRow| {
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
        data: csv::<_, [Cell; 3]>(
            &["angular_frequency_rad_per_s", "cycle", "relative_percent"],
            data,
        ),
    })
}
