//! A figure drawn: the rows of its data and the series of its panels, from the same points.

use std::sync::atomic::AtomicBool;

use super::Result;
use super::curve::{Curve, SPRINGS, cells_label, in_turn};
use super::number::significant;
use super::run::{By, ByEngine};
use super::spec::{Content, Drawn, FigureSpec, PanelSpec};
use super::table::{Quantity, Row};
use crate::report::chart::{Chart, Color, LineStyle, Mark, Marker, Series};
use crate::report::table::{Cell, csv};

/// What is shown of a curve.
struct Shown<'a> {
    curve: &'a Curve<'a>,
    rows: ByEngine<Vec<Row>>,
    peak: Option<(f64, f64)>,
}

/// The panels of a figure from top to bottom, and its data as CSV: numbers to five significant digits, what is undefined empty.
pub(super) fn draw(
    spec: &FigureSpec,
    curves: &[Curve<'_>],
    interrupt: &AtomicBool,
) -> Result<(Vec<Chart>, Vec<u8>)> {
    let is_drawn = |curve: &&Curve<'_>| !curve.family.panels.is_empty();
    let drawn = curves.iter().filter(is_drawn);
    let shown = drawn.map(|curve| Shown::new(curve, interrupt));
    let shown: Vec<Shown<'_>> = shown.collect::<Result<_>>()?;
    let mut data: Vec<Vec<Cell>> = Vec::new();
    for curve in &shown {
        let exact = match curve.curve.family.draws_refined {
            true => "refined",
            false => "closed form",
        };
        let sources = [exact, "axisymmetric", "half-space"].into_iter();
        for (rows, source) in curve.rows.iter().zip(sources) {
            for row in rows {
                let columns = spec.columns.iter();
                let cells = columns.map(|(_, content)| curve.cell(*content, source, row));
                data.push(cells.collect());
            }
        }
    }
    let columns: Vec<&String> = spec.columns.iter().map(|(name, _)| name).collect();
    let panels = spec.panels.iter().enumerate();
    let panels = panels.map(|(place, panel)| chart(panel, place, &shown));
    Ok((panels.collect(), csv(&columns, data)))
}

fn chart(panel: &PanelSpec, place: usize, shown: &[Shown<'_>]) -> Chart {
    let mut chart = Chart::new(panel.x.clone(), panel.y.clone()).legend(panel.legend);
    if let Some((width_px, height_px)) = panel.size {
        chart = chart.size(width_px, height_px);
    }
    let shown: Vec<&Shown<'_>> = shown.iter().filter(|shown| shown.is_in(place)).collect();
    let drawn = shown.iter().flat_map(|shown| {
        let drawn = shown.curve.family.draw.iter();
        drawn.map(move |drawn| (shown, drawn))
    });
    let drawn: Vec<(&&Shown<'_>, &Drawn)> = drawn.collect();
    let of = drawn.len().max(2);
    for (step, (shown, what)) in drawn.iter().enumerate() {
        let color = |step: usize| match panel.palette {
            true => Color::Palette(step),
            false => Color::Ramp { step, of },
        };
        // The symbols of a curve alone have a colour of their own.
        let symbols = if drawn.len() == 1 { 1 } else { step };
        let colors = [step, symbols].map(color);
        let is_last = step + 1 == drawn.len();
        chart = chart.all_series(shown.series(what, colors, LineStyle::nth(step), is_last));
    }
    if let Some((x, label)) = &panel.vertical {
        chart = chart.mark(Mark::vertical(*x, label));
    }
    let peak = shown.first().and_then(|shown| shown.peak);
    if let (Some(label), Some((x, y))) = (&panel.peak, peak) {
        let label = label.replace("{peak}", &format!("{x:.3}"));
        chart = chart.mark(Mark::point(x, y, label));
    }
    chart
}

impl<'a> Shown<'a> {
    fn new(curve: &'a Curve<'a>, interrupt: &AtomicBool) -> Result<Self> {
        let family = curve.family;
        let peak = family.peak.map(|_| curve.peak(interrupt)).transpose()?;
        let peak = peak.map(|[exact, ..]| exact);
        let [springs, cells] = [By::Springs, By::Cells].map(|by| curve.rows(family.of, by));
        let mut rows = [curve.exact_rows(), springs, cells];
        for (place, rows) in rows.iter_mut().enumerate() {
            let mut all = curve.shown(std::mem::take(rows));
            if let (Some(beyond), Some(engine)) = (family.beyond, place.checked_sub(1)) {
                let is_loaded = |row: &&Row| row.get(&family.y).is_some_and(|y| *y > 0.0);
                all.truncate(all.iter().take_while(is_loaded).count() + beyond[engine]);
            }
            if let (2, Some(every)) = (place, family.every_cell) {
                all = all.into_iter().step_by(every).collect();
            }
            *rows = spread(all, family.thin.map(|counts| counts[place]));
            for row in rows {
                let energy = row.get(&family.y).zip(peak);
                let share = energy.map(|(energy, (_, largest))| energy / largest);
                row.extend(share.map(|share| (Quantity::Share, share)));
            }
        }
        Ok(Self { curve, rows, peak })
    }

    fn cell(&self, content: Content, source: &str, row: &Row) -> Cell {
        let (family, at) = (self.curve.family, self.curve.at);
        let of = |quantity: &Quantity| row.get(quantity).copied();
        let value = match content {
            Content::Quantity(quantity) => of(&quantity),
            Content::X => of(&family.x),
            Content::Y => of(&family.y),
            Content::At => at.or(of(&family.x)),
            Content::Source => return source.into(),
            Content::Name => return family.name[..].into(),
            Content::Label => return self.curve.label.into(),
            Content::State => {
                return in_turn(&family.states, self.curve.index).into();
            }
        };
        value.map(|value| significant(value, 5)).into()
    }

    fn is_in(&self, panel: usize) -> bool {
        let Curve { family, at, .. } = self.curve;
        let is_here = |wanted: f64| at.is_some_and(|at| (at - wanted).abs() < 1e-9);
        family.panels.contains(&panel) && family.drawn_at.is_none_or(is_here)
    }

    /// A line for what is exact, or else for springs; crosses for springs beside it, rings or another marker for cells.
    fn series(
        &self,
        drawn: &Drawn,
        [line_color, symbols]: [Color; 2],
        style: LineStyle,
        is_last: bool,
    ) -> Vec<Series> {
        let family = self.curve.family;
        let points = |engine: usize| -> Vec<Option<(f64, f64)>> {
            let unit = family.x_unit.unwrap_or(1.0);
            let point = |row: &Row| Some((row.get(&family.x)? / unit, *row.get(&drawn.y)?));
            let count = family.drawn.map(|counts| counts[engine]);
            let rows = spread(self.rows[engine].clone(), count);
            rows.iter().map(point).collect()
        };
        let scatter = |engine: usize, marker: Marker, name: &str| {
            let series = Series::scatter(points(engine)).color(symbols);
            let series = series.marker(marker);
            match &drawn.symbols {
                Some(label) if !label.is_empty() => series.label(label.replace("{engine}", name)),
                None if is_last => series.label(name),
                _ => series,
            }
        };
        let has_exact = drawn.y == family.y && !self.rows[0].is_empty();
        let line = Series::line(points(usize::from(!has_exact)));
        let line = line.label(self.curve.filled(&drawn.label));
        let mut series = vec![line.color(line_color).style(style)];
        series.extend(has_exact.then(|| scatter(1, Marker::Cross, SPRINGS)));
        let marker = drawn.marker.unwrap_or(Marker::Ring);
        series.push(scatter(2, marker, &cells_label(self.curve.side())));
        series
    }
}

/// At most this many of the rows, evenly spread, the first and the last among them.
fn spread(rows: Vec<Row>, count: Option<usize>) -> Vec<Row> {
    match count {
        Some(count) if count < rows.len() => {
            let parts = count.max(2) - 1;
            let places = (0..=parts).map(|k| k * (rows.len() - 1) / parts);
            places.map(|place| rows[place].clone()).collect()
        }
        _ => rows,
    }
}
