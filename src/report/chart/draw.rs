//! Draws charts, alone or one above another.

use std::borrow::Cow;

use super::arrange::{Arrangement, arrange, arrange_beside};
use super::canvas::Canvas;
use super::check::subject;
use super::drawing::{Drawing, Shape};
use super::layers::{Counts, Layer, paint};
use super::notes::Notes;
use super::{Chart, ChartError, Size, heat_map};

impl Chart {
    /// The finished picture.
    ///
    /// # Errors
    /// [`ChartError`] where the chart has no point, or a value, text or range that cannot be drawn.
    pub fn draw(&self) -> Result<Drawing, ChartError> {
        stack(std::slice::from_ref(self))
    }
}

/// The charts as one picture, one above another, the first at the top: quantities of one history, each on its own axis. Leave the x
/// label of all but the last empty, and the frames, which are in line, move together.
///
/// # Errors
/// [`ChartError::Item`] without a chart; otherwise as [`Chart::draw`].
pub fn stack(charts: &[Chart]) -> Result<Drawing, ChartError> {
    let charts = charts.iter().map(heat_map::to_scale);
    let charts: Vec<Cow<'_, Chart>> = charts.collect::<Result<_, _>>()?;
    let mut left = 0.0_f64;
    if charts.len() > 1 {
        for chart in &charts {
            left = left.max(arrange(chart)?.layout.frame.left);
        }
    }
    let width_px = charts.iter().map(|chart| chart.size.width_px).max();
    let mut size = Size {
        width_px: width_px.ok_or_else(|| ChartError::item("no charts", "give at least one"))?,
        height_px: 0,
    };
    let (mut drawn, mut layers, mut notes) = (Vec::new(), Vec::new(), Notes::default());
    for chart in &charts {
        let arrangement = arrange_beside(chart, left, notes.numbered.len() + 1)?;
        notes.add(chart, &arrangement);
        let (shapes, of_chart) = painted(chart, &arrangement, f64::from(size.height_px))?;
        drawn.extend(shapes);
        layers.push((size.height_px, of_chart));
        size.height_px += chart.size.height_px;
    }
    let titles: Vec<String> = charts.iter().map(|chart| subject(chart)).collect();
    Ok(Drawing {
        size,
        paper: None,
        title: titles.join("; "),
        description: None,
        sweep_hash: None,
        families: charts
            .first()
            .map_or_else(String::new, |chart| chart.typeface.families()),
        shapes: drawn,
        layers,
        notes,
    })
}

/// The shapes of a chart, and how many of them each layer has, from back to front.
fn painted(
    chart: &Chart,
    arrangement: &Arrangement,
    top_px: f64,
) -> Result<(Vec<Shape>, Counts), ChartError> {
    let (mut shapes, mut layers) = (Vec::new(), Vec::new());
    for layer in Layer::ALL {
        let mut canvas = Canvas::new(chart);
        paint(layer, chart, arrangement, &mut canvas);
        let of_layer = canvas.finish()?.into_iter();
        let of_layer = of_layer.filter_map(|shape| shape.moved_down(top_px));
        let of_layer: Vec<Shape> = of_layer.collect();
        layers.push((layer, of_layer.len()));
        shapes.extend(of_layer);
    }
    Ok((shapes, layers))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Series};

    fn panel(x_label: &str, largest: f64) -> Chart {
        let points = (0..=10).map(|k| (f64::from(k), largest * f64::from(k)));
        Chart::new(Axis::linear(x_label), Axis::linear("load W / N"))
            .series(Series::line(points))
            .size(800, 260)
    }

    #[test]
    fn the_picture_is_as_high_as_its_charts_and_has_no_text() {
        let charts = [panel("", 1.0), panel("", 1e4), panel("time t / s", 0.1)];
        let drawing = stack(&charts).unwrap();
        let svg = drawing.to_svg();
        assert!(svg.starts_with(r#"<svg width="800" height="780""#));
        for unwanted in ["<text", "href", "url("] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        let png = drawing.to_png(1.0).unwrap();
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        assert_eq!((number(16), number(20)), (800, 780));
    }

    #[test]
    fn the_frames_are_in_line_whatever_their_labels() {
        let (narrow, wide) = (panel("", 1.0), panel("", 123_456.0));
        let left = |chart: &Chart| arrange(chart).unwrap().layout.frame.left;
        assert!(left(&narrow) < left(&wide));
        // The wide chart is the same in company as alone; the narrow one makes room.
        let both = [wide, narrow];
        // Where each shape of a stack begins.
        let lefts = |charts: &[Chart]| {
            let shapes = stack(charts).unwrap().shapes.into_iter();
            let lefts = shapes.map(|shape| shape.path.bounds().left());
            lefts.collect::<Vec<_>>()
        };
        let (alone, stacked) = (lefts(&both[..1]), lefts(&both));
        let (first, second) = stacked.split_at(alone.len());
        assert_eq!(alone, first);
        assert_ne!(lefts(&both[1..]), second);
        assert!(matches!(stack(&[]), Err(ChartError::Item { .. })));
    }
}
