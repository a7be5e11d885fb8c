//! Decides where everything of a chart goes: frame, ticks and texts, curves, legend, labels.

use super::check::check;
use super::contour_labels::Contours;
use super::curves::{Curve, Obstacles, curves};
use super::layout::{Layout, Ranges, Reserve, Widths, lay_out, ranges};
use super::legend::{Legend, Outside};
use super::look::MARGIN;
use super::place::{self, PlacedLabel};
use super::{Chart, ChartError, LegendPlace};

/// Everything in its place.
pub(super) struct Arrangement {
    pub(super) layout: Layout,
    pub(super) curves: Vec<Curve>,
    pub(super) legend: Option<Legend>,
    pub(super) labels: Vec<PlacedLabel>,
    pub(super) contours: Contours,
}

impl Arrangement {
    /// Labels of the chart that stand nowhere in full.
    fn short_labels(&self, chart: &Chart) -> usize {
        let wanted = chart.marks.iter().filter(|mark| !mark.label.is_empty());
        let full = self.labels.iter().filter(|label| label.number.is_none());
        wanted.count() - full.count()
    }
}

/// What is left free above labelled peaks, in parts of the height of the data: the first that gives every label a place.
const HEAD_ROOMS: [f64; 4] = [0.12, 0.25, 0.45, 0.8];
/// More peaks than this do not all get a label by making room above them.
const MOST_FULL_LABELS: usize = 3;

/// Decides where everything goes.
pub(super) fn arrange(chart: &Chart) -> Result<Arrangement, ChartError> {
    arrange_beside(chart, 0.0, 1)
}

/// As [`arrange`], with a frame that begins no further left than `left`, and marks numbered from `first_number`.
pub(super) fn arrange_beside(
    chart: &Chart,
    left: f64,
    first_number: usize,
) -> Result<Arrangement, ChartError> {
    check(chart)?;
    let widths = Widths::measure(chart);
    let arranged = |head_room: f64| {
        let ranges = ranges(chart, head_room)?;
        arranged(chart, &widths, &ranges, left, first_number)
    };
    let first = arranged(HEAD_ROOMS[0])?;
    let peaks = chart.marks.iter().filter(|mark| mark.is_labelled_point());
    let is_free = chart.y.range.is_none() && (1..=MOST_FULL_LABELS).contains(&peaks.count());
    if is_free && first.short_labels(chart) > 0 {
        for head_room in HEAD_ROOMS.into_iter().skip(1) {
            let higher = arranged(head_room)?;
            if higher.short_labels(chart) == 0 {
                return Ok(higher);
            }
        }
    }
    Ok(first)
}

fn arranged(
    chart: &Chart,
    widths: &Widths,
    ranges: &Ranges,
    left: f64,
    first_number: usize,
) -> Result<Arrangement, ChartError> {
    let laid_out = |reserve: Reserve| lay_out(chart, ranges, widths, Reserve { left, ..reserve });
    let plain = laid_out(Reserve::default());
    let width = f64::from(chart.size.width_px) - 2.0 * MARGIN;
    let outside = |legend: Legend, side: Outside| {
        let layout = laid_out(legend.reserve(side))?;
        let legend = legend.outside(&layout, side);
        Ok::<_, ChartError>((layout, Some(legend)))
    };
    let above = |plain: Layout| match Legend::rows(chart, widths, width) {
        Some(rows) => outside(rows, Outside::Above),
        None => Ok((plain, None)),
    };
    let plain = plain?;
    let column = match chart.legend {
        None => None,
        Some(_) => Legend::column(chart, widths, plain.frame.width()),
    };
    let (layout, legend) = match (chart.legend, column) {
        (Some(LegendPlace::Right), Some(column)) if column.fits_beside(&plain) => {
            outside(column, Outside::Right)?
        }
        (Some(LegendPlace::Right | LegendPlace::Above), Some(_)) => above(plain)?,
        (Some(LegendPlace::Auto), Some(column)) => {
            let obstacles = Obstacles::of(chart, &plain, &curves(chart, &plain));
            match column.where_free(&plain, &obstacles) {
                Ok(legend) => (plain, Some(legend)),
                Err(column) if column.suits_right(&plain) => outside(column, Outside::Right)?,
                Err(_) => above(plain)?,
            }
        }
        (Some(corner), Some(column)) => {
            let legend = column.in_corner(&plain, corner);
            (plain, Some(legend))
        }
        (_, None) | (None, _) => (plain, None),
    };
    let curves = curves(chart, &layout);
    let mut obstacles = Obstacles::of(chart, &layout, &curves);
    obstacles
        .boxes
        .extend(legend.as_ref().map(|legend| legend.rect));
    let labels = place::labels(chart, &layout, widths, &obstacles, first_number);
    obstacles
        .boxes
        .extend(labels.iter().map(|label| label.rect));
    let contours = Contours::of(chart, &layout, &obstacles);
    Ok(Arrangement {
        layout,
        curves,
        legend,
        labels,
        contours,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::geometry::{Rect, distance};
    use crate::report::chart::look::MARK_RING;
    use crate::report::chart::{Axis, Mark, Marker, Series};

    fn rising() -> Chart {
        let points = (0..=50).map(|k| (f64::from(k), f64::from(k).powi(2)));
        Chart::new(Axis::linear("x"), Axis::linear("y"))
            .series(Series::line(points).marker(Marker::Disc).label("rising"))
    }

    fn wild() -> Chart {
        let points = (0..=400).map(|k| (f64::from(k), (f64::from(k) * 0.9).sin()));
        Chart::new(Axis::linear("x"), Axis::linear("y")).series(Series::line(points).label("wild"))
    }

    fn peak(x_peak: f64, label: &str) -> Chart {
        let points = (0..=60).map(|k| {
            (
                f64::from(k),
                1.0 / (1.0 + (f64::from(k) - x_peak).powi(2) / 40.0),
            )
        });
        Chart::new(Axis::linear("x"), Axis::linear("y"))
            .series(Series::line(points).marker(Marker::Disc))
            .mark(Mark::point(x_peak, 1.0, label))
    }

    fn inside(outer: &Rect, inner: &Rect) -> bool {
        outer.contains((inner.left, inner.top)) && outer.contains((inner.right, inner.bottom))
    }

    #[test]
    fn a_legend_goes_where_no_data_are() {
        let Arrangement {
            layout,
            curves,
            legend,
            ..
        } = arrange(&rising()).unwrap();
        let legend = legend.unwrap();
        assert!(inside(&layout.frame, &legend.rect));
        assert!(
            curves[0]
                .points
                .iter()
                .all(|&point| !legend.rect.contains(point))
        );
        // The upper right corner, tried first, is taken by the curve.
        assert!(legend.rect.right < (layout.frame.left + layout.frame.right) / 2.0);
    }

    #[test]
    fn a_legend_without_a_free_place_goes_outside() {
        let Arrangement { layout, legend, .. } = arrange(&wild()).unwrap();
        assert!(!legend.unwrap().rect.overlaps(&layout.frame));
    }

    #[test]
    fn a_legend_goes_where_it_is_told() {
        let corner = |place: LegendPlace| {
            arrange(&rising().legend(place))
                .unwrap()
                .legend
                .unwrap()
                .rect
        };
        assert!(corner(LegendPlace::TopRight).left > corner(LegendPlace::TopLeft).right);
        assert!(corner(LegendPlace::BottomLeft).top > corner(LegendPlace::TopLeft).bottom);
        assert!(arrange(&rising().legend(None)).unwrap().legend.is_none());
    }

    #[test]
    fn the_label_of_a_peak_stays_in_the_frame_and_clear_of_ring_and_curve() {
        for x_peak in [0.0, 3.0, 30.0, 57.0, 60.0] {
            let chart = peak(x_peak, "ω = 8.44 × 10⁻³ rad/s");
            let Arrangement {
                layout,
                curves,
                labels,
                ..
            } = arrange(&chart).unwrap();
            let rect = labels[0].rect;
            assert!(inside(&layout.frame, &rect), "{x_peak}: {rect:?}");
            let ring = layout.px((x_peak, 1.0));
            assert!(distance(rect.nearest(ring), ring) > MARK_RING, "{x_peak}");
            let obstacles = Obstacles::of(&chart, &layout, &curves);
            assert!(obstacles.spare(&rect), "{x_peak}: covers the curve");
        }
    }

    #[test]
    fn labels_of_neighbouring_peaks_do_not_overlap() {
        let chart = peak(30.0, "the first of two peaks").mark(Mark::point(
            31.0,
            0.97,
            "the second of two peaks",
        ));
        let labels = arrange(&chart).unwrap().labels;
        assert!(!labels[0].rect.overlaps(&labels[1].rect));
    }

    #[test]
    fn the_label_of_a_line_stays_in_the_frame_even_at_its_edge() {
        for x in [0.0, 1.0, 49.0, 50.0] {
            let chart = rising()
                .mark(Mark::vertical(x, "x at the edge"))
                .mark(Mark::horizontal(50.0 * x, "y at the edge"));
            let Arrangement { layout, labels, .. } = arrange(&chart).unwrap();
            assert_eq!(labels.len(), 2);
            assert!(
                labels
                    .iter()
                    .all(|label| inside(&layout.frame, &label.rect)),
                "{x}"
            );
        }
    }

    #[test]
    fn data_outside_a_given_range_are_cut_at_the_frame() {
        let mut chart = rising();
        chart.y = chart.y.range(100.0, 900.0);
        let Arrangement { layout, curves, .. } = arrange(&chart).unwrap();
        let reach = layout.frame.grown(0.02); // sixteenths of a px are finer still
        assert!(
            curves[0]
                .parts
                .iter()
                .flatten()
                .all(|&point| reach.contains(point))
        );
        assert_eq!(curves[0].points.len(), 21); // 10² ... 30²
    }

    #[test]
    fn an_absent_value_breaks_the_line() {
        let points = [
            Some((0.0, 0.0)),
            Some((1.0, 1.0)),
            None,
            Some((3.0, 2.0)),
            Some((4.0, 3.0)),
        ];
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y")).series(Series::line(points));
        assert_eq!(arrange(&chart).unwrap().curves[0].parts.len(), 2);
    }

    #[test]
    fn an_error_bar_that_reaches_zero_on_a_log_axis_runs_out_of_the_frame() {
        let series = Series::scatter([(1.0, 1.0), (2.0, 10.0)]).error_bars([2.0, 1.0]);
        let chart = Chart::new(Axis::linear("x"), Axis::log("y")).series(series);
        let Arrangement { layout, curves, .. } = arrange(&chart).unwrap();
        let bars = &curves[0].error_bars;
        assert_eq!(
            (bars[0].caps, bars[0].bottom),
            ([true, false], layout.frame.bottom)
        );
        assert_eq!(bars[1].caps, [true, true]);
    }

    #[test]
    fn a_mark_outside_a_given_range_is_refused() {
        let mut chart = rising().mark(Mark::point(60.0, 1.0, "peak"));
        chart.x = chart.x.range(0.0, 50.0);
        let error = arrange(&chart).err().unwrap();
        assert!(
            error.to_string().contains("the mark 'peak': its x 60"),
            "{error}"
        );
    }

    #[test]
    fn data_that_a_given_range_leaves_out_altogether_are_refused() {
        let mut chart = rising();
        chart.x = chart.x.range(100.0, 200.0);
        let error = arrange(&chart).err().unwrap().to_string();
        assert!(error.contains("there is no point to show"), "{error}");
    }

    #[test]
    fn a_picture_too_small_or_too_large_is_refused() {
        for (width, height) in [
            (100, 600),
            (800, 90),
            (0, 0),
            (40_000, 600),
            (u32::MAX, u32::MAX),
        ] {
            let result = arrange(&rising().size(width, height));
            assert!(
                matches!(result, Err(ChartError::Size { .. })),
                "{width} {height}"
            );
        }
    }
}
