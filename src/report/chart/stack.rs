//! Several charts one above another in one picture, their frames in line: quantities of one history, each on its own axis.

use super::check::subject;
use super::draw::{arrange, draw};
use super::render::{Letters, finished};
use super::text::escaped;
use super::{Chart, ChartError, Size};

/// The charts as one SVG, the first at the top. Leave the x label of all but the last empty, and the frames move together.
///
/// # Errors
/// [`ChartError::EmptyStack`] without a chart; otherwise as [`super::to_svg`].
pub fn stack_to_svg(charts: &[Chart], letters: Letters) -> Result<String, ChartError> {
    let mut left = 0.0_f64;
    for chart in charts {
        left = left.max(arrange(chart)?.layout.frame.left);
    }
    let width_px = charts.iter().map(|chart| chart.size.width_px).max();
    let width_px = width_px.ok_or(ChartError::EmptyStack)?;
    let height_px: u32 = charts.iter().map(|chart| chart.size.height_px).sum();
    let titles: Vec<String> = charts.iter().map(subject).collect();
    let mut picture = format!(
        "<svg width=\"{width_px}\" height=\"{height_px}\" xmlns=\"http://www.w3.org/2000/svg\" \
         viewBox=\"0 0 {width_px} {height_px}\" role=\"img\">\n <title>{}</title>\n",
        escaped(&titles.join("; "))
    );
    let mut top_px = 0;
    for (chart, title) in charts.iter().zip(&titles) {
        let svg = finished(&draw(chart, left)?, chart.size, title, letters)?;
        picture.push_str(&format!(" <g transform=\"translate(0 {top_px})\">"));
        picture.push_str(content(&svg, chart.size)?);
        picture.push_str("</g>\n");
        top_px += chart.size.height_px;
    }
    picture.push_str("</svg>\n");
    Ok(picture)
}

/// What stands between the root's tags, without the title.
fn content(svg: &str, size: Size) -> Result<&str, ChartError> {
    let inner = svg
        .split_once("</title>")
        .and_then(|(_, rest)| rest.rsplit_once("</svg>"));
    let (content, _) = inner.ok_or_else(|| ChartError::Draw {
        reason: format!(
            "a chart of {} x {} px has no root element",
            size.width_px, size.height_px
        ),
    })?;
    Ok(content)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Series, to_png};

    fn chart(x_label: &str, largest: f64) -> Chart {
        let points = (0..=10).map(|k| (f64::from(k), largest * f64::from(k)));
        Chart::new(Axis::linear(x_label), Axis::linear("load W / N"))
            .series(Series::line(points))
            .size(800, 260)
    }

    #[test]
    fn the_picture_is_as_high_as_its_charts_and_has_no_text() {
        let svg = stack_to_svg(
            &[chart("", 1.0), chart("", 1e4), chart("time t / s", 0.1)],
            Letters::Outlines,
        )
        .unwrap();
        assert!(svg.starts_with(r#"<svg width="800" height="780""#));
        for unwanted in ["<text", "href", "url("] {
            assert!(!svg.contains(unwanted), "{unwanted}");
        }
        let png = to_png(&svg, 1.0).unwrap();
        let number = |at: usize| u32::from_be_bytes(png[at..at + 4].try_into().unwrap());
        assert_eq!((number(16), number(20)), (800, 780));
    }

    #[test]
    fn the_frames_are_in_line_whatever_their_labels() {
        let (narrow, wide) = (chart("", 1.0), chart("", 123_456.0));
        let left = |chart: &Chart| arrange(chart).unwrap().layout.frame.left;
        assert!(left(&narrow) < left(&wide));
        // What is drawn of one chart of a stack.
        let drawn = |charts: &[Chart], place: usize| {
            let svg = stack_to_svg(charts, Letters::Outlines).unwrap();
            let part = svg.split("<g transform=\"translate").nth(place + 1);
            let content = part.and_then(|part| part.split_once(">")?.1.rsplit_once("</g>"));
            content.unwrap().0.to_owned()
        };
        // The wide chart is the same in company as alone; the narrow one makes room.
        let both = [wide, narrow];
        assert_eq!(drawn(&both[..1], 0), drawn(&both, 0));
        assert_ne!(drawn(&both[1..], 0), drawn(&both, 1));
        assert!(matches!(
            stack_to_svg(&[], Letters::Outlines),
            Err(ChartError::EmptyStack)
        ));
    }
}
