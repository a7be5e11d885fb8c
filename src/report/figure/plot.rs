//! One frame of a figure: points in SI units over two quantities. From it come the chart, whose prefixes, scales and titles are
//! chosen here, and the table behind the figure, so that both say the same.

use super::quantity::{Quantity, Spread, WIDE_CURVES, scale};
use super::smooth::{self, Line};
use super::trace::Trace;
use super::units::{Shown, Units};
use crate::report::chart::{Axis, Chart, ColorScale, LegendPlace, Mark, MarkPlace, Scale, Series};
use crate::report::number::{largest, range};

/// A frame with its curves.
#[derive(Debug, Clone, PartialEq)]
pub struct Plot {
    pub x: Quantity,
    pub y: Quantity,
    /// What the curves are a family of: a column of the table.
    pub family: Option<Quantity>,
    /// What changes along a curve of which neither axis is it: another column.
    pub along: Option<Quantity>,
    pub traces: Vec<Trace>,
    /// Places in SI units.
    pub marks: Vec<Mark>,
    pub title: Option<String>,
    pub legend: Option<LegendPlace>,
    pub color_scale: Option<ColorScale>,
    /// Where the axes end; `None`: as the points ask for.
    pub x_ends: Option<(f64, f64)>,
    pub y_ends: Option<(f64, f64)>,
    /// Of a picture 800 px wide; `None`: by the number of frames.
    pub height_px: Option<u32>,
}

/// A line as it is drawn, in SI units; `None` breaks it.
type Drawn = Vec<Option<(f64, f64)>>;

impl Plot {
    pub fn new(x: Quantity, y: Quantity) -> Self {
        Self {
            x,
            y,
            family: None,
            along: None,
            traces: Vec::new(),
            marks: Vec::new(),
            title: None,
            legend: Some(LegendPlace::Auto),
            color_scale: None,
            x_ends: None,
            y_ends: None,
            height_px: None,
        }
    }

    #[must_use]
    pub fn family(mut self, family: impl Into<Option<Quantity>>) -> Self {
        self.family = family.into();
        self
    }

    #[must_use]
    pub fn traces(mut self, traces: impl IntoIterator<Item = Trace>) -> Self {
        self.traces.extend(traces);
        self
    }

    #[must_use]
    pub fn marks(mut self, marks: impl IntoIterator<Item = Mark>) -> Self {
        self.marks.extend(marks);
        self
    }

    #[must_use]
    pub fn title(self, title: Option<String>) -> Self {
        Self { title, ..self }
    }

    #[must_use]
    pub fn legend(self, legend: Option<LegendPlace>) -> Self {
        Self { legend, ..self }
    }

    #[must_use]
    pub fn x_ends(self, low: f64, high: f64) -> Self {
        Self {
            x_ends: Some((low, high)).filter(|(low, high)| low < high),
            ..self
        }
    }

    #[must_use]
    pub fn height(self, height_px: u32) -> Self {
        Self {
            height_px: Some(height_px),
            ..self
        }
    }

    /// How many points have no place on the scales of the axes.
    pub fn without_place(&self) -> usize {
        let [x, y] = self.scales();
        let has_place = |scale: Scale, value: f64| scale == Scale::Linear || value > 0.0;
        let points = self.traces.iter().flat_map(|trace| &trace.points);
        let points = points.filter_map(|point| Some((point.x, point.y?)));
        points
            .filter(|(px, py)| !(has_place(x, *px) && has_place(y, *py)))
            .count()
    }

    /// The scales of both axes.
    fn scales(&self) -> [Scale; 2] {
        let xs = || {
            let points = self.traces.iter().flat_map(|trace| &trace.points);
            points
                .map(|point| point.x)
                .chain(self.marked().map(|m| m.0))
        };
        let ys = || {
            let points = self.traces.iter().flat_map(|trace| &trace.points);
            let ys = points.filter_map(|point| point.y);
            ys.chain(self.marked().map(|mark| mark.1))
        };
        let highest = self.traces.iter().map(Trace::highest);
        let highest: Vec<f64> = highest.filter(|height| *height > 0.0).collect();
        let of = |quantity: &Quantity, values: Vec<f64>| match quantity.spread {
            Spread::Linear | Spread::Whole => Scale::Linear,
            Spread::Log => Scale::Log,
            Spread::OfCurves => scale(range(highest.iter().copied()), WIDE_CURVES),
            Spread::OfValues => Spread::of_values(values),
        };
        [of(&self.x, xs().collect()), of(&self.y, ys().collect())]
    }

    /// Places of the marks that are points.
    fn marked(&self) -> impl Iterator<Item = (f64, f64)> {
        self.marks.iter().filter_map(|mark| match mark.place {
            MarkPlace::Point { x, y } => Some((x, y)),
            MarkPlace::Vertical { .. } | MarkPlace::Horizontal { .. } => None,
        })
    }

    /// Whether a mark is within the ends of the axes that are given.
    fn holds(&self, mark: &Mark) -> bool {
        let within = |ends: Option<(f64, f64)>, value: Option<f64>| match (ends, value) {
            (Some((low, high)), Some(value)) => (low..=high).contains(&value),
            _ => true,
        };
        let (x, y) = mark.place.coordinates();
        within(self.x_ends, x) && within(self.y_ends, y)
    }

    /// The largest values (SI) along both axes.
    fn sizes(&self) -> [f64; 2] {
        let points = || self.traces.iter().flat_map(|trace| &trace.points);
        let xs = points().map(|point| point.x);
        let ys = points().flat_map(|p| [p.y, p.band.map(|band| band.1)]);
        let marks = || self.marked();
        [
            largest(xs.chain(marks().map(|m| m.0)).map(f64::abs)),
            largest(ys.flatten().chain(marks().map(|m| m.1)).map(f64::abs)),
        ]
    }

    /// The same among these frames: logarithmic axes of one measure, which hold small values as well, have one unit.
    fn sizes_among(&self, plots: &[Self]) -> [f64; 2] {
        let [x, y] = self.sizes();
        let is_log = |plot: &&Self| plot.scales()[1] == Scale::Log;
        let alike = plots.iter().filter(|p| p.y.measure == self.y.measure);
        match is_log(&self) {
            true => [x, largest(alike.filter(is_log).map(|p| p.sizes()[1]))],
            false => [x, y],
        }
    }

    /// How both axes are shown, with their titles, for values as large as these.
    fn axes(&self, units: &Units, sizes: [f64; 2]) -> [(Axis, Shown); 2] {
        let [x_scale, y_scale] = self.scales();
        let axis = |quantity: &Quantity, scale, ends: Option<(f64, f64)>, size| {
            let shown = units.shown(quantity.measure, size);
            let axis = Axis {
                whole: quantity.spread == Spread::Whole,
                label: shown.title(&quantity.words),
                scale,
                range: ends.map(|(low, high)| (shown.of(low), shown.of(high))),
            };
            (axis, shown)
        };
        [
            axis(&self.x, x_scale, self.x_ends, sizes[0]),
            axis(&self.y, y_scale, self.y_ends, sizes[1]),
        ]
    }

    /// The line through the points of a trace at these heights and through what was located between them, and whether all of it is
    /// smooth; `None` where it is not to be.
    fn line(
        &self,
        trace: &Trace,
        heights: &[Option<f64>],
        [x, y]: [Scale; 2],
    ) -> Option<(Drawn, bool)> {
        let on = |scale: Scale, value: f64| match scale {
            Scale::Log => (value > 0.0).then(|| value.log10()),
            Scale::Linear => Some(value),
        };
        let place = |(px, py): (f64, f64)| Some((on(x, px)?, on(y, py)?));
        let located = trace.smooth.as_ref()?.iter().copied();
        let located: Vec<_> = located.filter_map(place).collect();
        let points = trace.points.iter().zip(heights);
        let points = points.map(|(point, height)| place((point.x, (*height)?)));
        let points: Vec<Option<(f64, f64)>> = points.collect();
        let (mut drawn, mut is_smooth) = (Vec::new(), true);
        for run in points.split(Option::is_none).filter(|run| !run.is_empty()) {
            let run: Vec<(f64, f64)> = run.iter().copied().flatten().collect();
            let points = match smooth::line(&run, &located) {
                Line::Smooth(points) => points,
                Line::Straight(points) => {
                    is_smooth &= run.len() == 1;
                    points
                }
            };
            let points = points.into_iter();
            drawn.extend(points.map(|(px, py)| Some((x.value(px), y.value(py)))));
            drawn.push(None);
        }
        Some((drawn, is_smooth))
    }

    /// Whether all curves that are to be smooth are; `None` where none is to be.
    fn is_smooth(&self) -> Option<bool> {
        let scales = self.scales();
        let traces = self.traces.iter().enumerate();
        let lines = traces.filter_map(|(k, trace)| self.line(trace, &self.heights(k), scales));
        let all: Vec<bool> = lines.map(|(_, is_smooth)| is_smooth).collect();
        (!all.is_empty()).then(|| !all.contains(&false))
    }

    /// The chart, in units for values as large as these.
    fn chart(&self, units: &Units, sizes: [f64; 2]) -> Chart {
        let [(x_axis, x), (y_axis, y)] = self.axes(units, sizes);
        let on = Axes {
            scales: [x_axis.scale, y_axis.scale],
            shown: [x, y],
        };
        let bands = self.traces.iter().filter_map(|trace| on.band(trace));
        let series = self.traces.iter().enumerate().map(|(k, trace)| {
            let heights = self.heights(k);
            let mut series = on.series(trace, &heights);
            let line = self.line(trace, &heights, on.scales);
            let curve =
                line.map(|(points, _)| points.into_iter().map(|at| on.place(at?)).collect());
            match (series.area_to, curve) {
                (Some(_), Some(curve)) => series.points = curve,
                (_, curve) => series.curve = curve,
            }
            series
        });
        let mut chart = Chart::new(x_axis, y_axis)
            .maybe_title(self.title.clone())
            .legend(self.legend)
            .all_series(bands)
            .all_series(series)
            .all_marks(
                self.marks
                    .iter()
                    .filter(|m| self.holds(m))
                    .filter_map(|m| on.mark(m)),
            );
        chart.color_scale = self.color_scale.clone();
        chart
    }

    /// The heights at which the points of a trace are drawn: areas stand on those that come after them.
    fn heights(&self, k: usize) -> Vec<Option<f64>> {
        let own = &self.traces[k];
        let stack = match own.area_to {
            Some(_) => &self.traces[k..],
            None => std::slice::from_ref(own),
        };
        let areas = stack.iter().filter(|trace| trace.area_to == own.area_to);
        let areas: Vec<&Trace> = areas.collect();
        let height = |i: usize| {
            let heights = areas.iter().map(|area| area.points.get(i)?.y);
            heights.sum::<Option<f64>>()
        };
        (0..own.points.len()).map(height).collect()
    }
}

/// How values come to their places on both axes.
struct Axes {
    scales: [Scale; 2],
    shown: [Shown; 2],
}

impl Axes {
    /// One value on one of the axes; `None` where a logarithmic axis has no place for it.
    fn along(&self, axis: usize, value: f64) -> Option<f64> {
        let has_place = self.scales[axis] == Scale::Linear || value > 0.0;
        has_place.then(|| self.shown[axis].of(value))
    }

    fn place(&self, (x, y): (f64, f64)) -> Option<(f64, f64)> {
        Some((self.along(0, x)?, self.along(1, y)?))
    }

    fn band(&self, trace: &Trace) -> Option<Series> {
        let edges = trace.points.iter().filter_map(|point| {
            let (low, high) = point.band?;
            let (at, high) = self.place((point.x, high))?;
            // On a logarithmic axis what reaches to zero reaches to the edge of the frame.
            let low = self.along(1, low).unwrap_or(1e-3 * high);
            Some((at, low, high))
        });
        let edges: Vec<_> = edges.collect();
        (edges.len() > 1).then(|| Series {
            label: trace.band_label.clone(),
            ..Series::band(edges).color(trace.color)
        })
    }

    fn series(&self, trace: &Trace, heights: &[Option<f64>]) -> Series {
        let points = trace.points.iter().zip(heights);
        let label = trace.label.clone().filter(|_| trace.in_legend);
        let series = Series {
            label: trace.legend.clone().or(label),
            line: trace.line.filter(|_| trace.area_to.is_none()),
            marker: trace.marker,
            color: trace.color,
            spaced: trace.spaced,
            area_to: trace.area_to.map(|base| self.shown[1].of(base)),
            ..Series::line(points.map(|(point, height)| self.place((point.x, (*height)?))))
        };
        match trace.points.iter().any(|point| point.error.is_some()) {
            false => series,
            true => {
                let errors = trace.points.iter().map(|point| point.error);
                let errors = errors.map(|error| Some(self.shown[1].of_difference(error?)));
                series.error_bars(errors.collect::<Vec<_>>())
            }
        }
    }

    fn mark(&self, mark: &Mark) -> Option<Mark> {
        let place = match mark.place {
            MarkPlace::Point { x, y } => {
                let (x, y) = self.place((x, y))?;
                MarkPlace::Point { x, y }
            }
            MarkPlace::Vertical { x } => MarkPlace::Vertical {
                x: self.along(0, x)?,
            },
            MarkPlace::Horizontal { y } => MarkPlace::Horizontal {
                y: self.along(1, y)?,
            },
        };
        Some(Mark {
            place,
            ..mark.clone()
        })
    }
}

/// The charts of frames one above another: the last has the title of x, the first the legend.
pub(super) fn charts(plots: &[Plot], units: &Units) -> Vec<Chart> {
    /// Of one frame alone, of one of two, and of one of several; the last is higher by the title of its axis.
    const HEIGHTS_PX: [u32; 3] = [600, 360, 250];
    const TITLE_PX: u32 = 25;
    let last = plots.len().saturating_sub(1);
    let chart = |(k, plot): (usize, &Plot)| {
        let mut chart = plot.chart(units, plot.sizes_among(plots));
        chart.size.height_px = plot.height_px.unwrap_or(HEIGHTS_PX[last.min(2)]);
        if k < last {
            chart.x.label.clear();
        } else if last > 0 && plot.height_px.is_none() {
            chart.size.height_px += TITLE_PX;
        }
        if k > 0 {
            chart.legend = None;
        }
        chart
    };
    plots.iter().enumerate().map(chart).collect()
}

/// What lines through the points of these frames are, in words; nothing where no line is to be smooth.
pub(super) fn lines_in_words(plots: &[Plot]) -> Option<&'static str> {
    let smooth: Vec<bool> = plots.iter().filter_map(Plot::is_smooth).collect();
    match smooth.contains(&false) {
        _ if smooth.is_empty() => None,
        false => Some("Lines: monotone cubic interpolation of the computed points."),
        true => Some(
            "Straight lines join computed points where these are too few to draw a smooth curve.",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::super::quantity::{APPROACH, MODULUS, TIME};
    use super::*;

    #[test]
    fn frames_one_above_another_have_one_unit_of_a_quantity_on_logarithmic_axes() {
        let titles = |quantity: &Quantity| -> Vec<String> {
            let frame = |size: f64| {
                let points = [(1.0, 0.5 * size), (2.0, size)];
                Plot::new(TIME, quantity.clone()).traces([Trace::line(points)])
            };
            let charts = charts(&[frame(5e9), frame(2e8)], &Units::default());
            charts.into_iter().map(|chart| chart.y.label).collect()
        };
        assert_eq!(titles(&MODULUS), ["modulus / GPa", "modulus / GPa"]);
        // On linear ones the smaller would be a row of zeros.
        let linear = titles(&APPROACH.spread(Spread::Linear));
        assert!(
            linear[0].ends_with("/ Gm") && linear[1].ends_with("/ Mm"),
            "{linear:?}"
        );
    }
}
