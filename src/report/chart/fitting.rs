//! How high a chart of a given width must be for its labels and its legend.

use super::arrange::{Arrangement, arrange};
use super::{Chart, ChartError};

/// The height (px) that a chart of this width wants: its own, and as much more as its upright titles are too long for it, or a legend
/// above the frame takes, so that it takes no room from the frame.
///
/// # Errors
/// [`ChartError`] where the chart cannot be laid out, however high.
pub fn fitting_height_px(chart: &Chart) -> Result<u32, ChartError> {
    /// Steps by which a picture grows that has no room at all, and how many of them: more than any legend needs.
    const STEP_PX: u32 = 50;
    const STEPS: u32 = 100;
    let own = chart.size.height_px;
    let mut result = Ok(own);
    for high in (0..STEPS).map(|step| own.saturating_add(step * STEP_PX)) {
        result = match arrange(&chart.clone().size(chart.size.width_px, high)) {
            Err(error @ ChartError::Size { .. }) => Err(error),
            Err(other) => return Err(other),
            Ok(Arrangement { layout, legend, .. }) => {
                let above = legend.filter(|legend| legend.rect.bottom <= layout.frame.top);
                let legend = above.map_or(0.0, |legend| legend.rect.height());
                let more = (legend + layout.missing_height_px).ceil() as u32;
                return Ok(high.max(own.saturating_add(more)));
            }
        };
    }
    result
}

/// Whether a chart of this size has room for its labels and its legend.
///
/// # Errors
/// [`ChartError`] where the chart cannot be laid out whatever its size.
pub fn fits(chart: &Chart) -> Result<bool, ChartError> {
    match arrange(chart) {
        Ok(_) => Ok(true),
        Err(ChartError::Size { .. }) => Ok(false),
        Err(other) => Err(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::look::{LABEL_TEXT, LEGEND_TEXT};
    use crate::report::chart::text::Anchor;
    use crate::report::chart::{Axis, Series};

    /// Five curves with long names, in a picture as narrow as a column.
    fn narrow_family() -> Chart {
        let series = (0..5).map(|k| {
            let points = (0..=20).map(move |i| (f64::from(i), f64::from((i * 7 + k * 3) % 20)));
            Series::line(points).label(format!("ω = {k}.94 × 10⁻³ rad/s"))
        });
        Chart::new(
            Axis::linear("radius r / µm"),
            Axis::linear("work per cycle and area w / J·m⁻²"),
        )
        .all_series(series)
        .size(481, 200)
    }

    #[test]
    fn a_narrow_chart_gets_the_height_that_its_label_and_legend_want() {
        let chart = narrow_family();
        let high = fitting_height_px(&chart).unwrap();
        let arrangement = arrange(&chart.clone().size(481, high)).unwrap();
        // The label of y has two lines, and no text is much smaller than it should be.
        let texts = &arrangement.layout.texts;
        assert!(texts.iter().all(|text| text.size >= 0.85 * LABEL_TEXT));
        let of_y: Vec<_> = texts
            .iter()
            .filter(|text| text.anchor == Anchor::Upwards)
            .collect();
        assert_eq!(of_y.len(), 2);
        let legend = arrangement.legend.unwrap().rect;
        assert!(legend.bottom <= arrangement.layout.frame.top);
        assert!(arrangement.layout.missing_height_px == 0.0);
        assert!(!fits(&chart).unwrap() && fits(&chart.clone().size(481, high)).unwrap());
        // A chart that is high enough keeps its height, but for the legend.
        let tall = fitting_height_px(&chart.size(481, 600)).unwrap();
        assert!((600..=600 + legend.height().ceil() as u32).contains(&tall));
    }

    #[test]
    fn a_long_legend_above_has_two_columns_and_text_little_smaller() {
        let arrangement = arrange(&narrow_family().size(481, 400)).unwrap();
        let legend = arrangement.legend.unwrap();
        let lefts: std::collections::BTreeSet<i64> =
            legend.entries.iter().map(|e| e.at.0 as i64).collect();
        assert_eq!(lefts.len(), 2);
        assert!(legend.text_px >= 0.85 * LEGEND_TEXT && legend.text_px < LEGEND_TEXT);
    }
}
