//! How high a chart of a given width must be for its labels and its legend.

use super::check::check;
use super::draw::arrange;
use super::layout::Widths;
use super::{Chart, ChartError};

/// The height (px) that a chart of this width wants: its own, or as much as it takes to set the label of y in full size, and that
/// of a legend above the frame, so that it takes no room from the frame.
///
/// # Errors
/// [`ChartError`] where the chart cannot be laid out, however high.
pub fn fitting_height_px(chart: &Chart) -> Result<u32, ChartError> {
    /// More than any legend needs.
    const AMPLE_PX: u32 = 1000;
    check(chart)?;
    let of_label = Widths::measure(chart).height_of_y_label_px().ceil() as u32;
    let high = chart.size.height_px.max(of_label);
    let arranged = |high: u32| arrange(&chart.clone().size(chart.size.width_px, high));
    let arrangement = arranged(high).or_else(|error| match error {
        ChartError::Size { .. } => arranged(high.saturating_add(AMPLE_PX)),
        other => Err(other),
    })?;
    let above = arrangement
        .legend
        .filter(|legend| legend.rect.bottom <= arrangement.layout.frame.top);
    let legend = above.map_or(0, |legend| legend.rect.height().ceil() as u32);
    Ok(high.saturating_add(legend))
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
    use crate::report::chart::look::{LABEL_TEXT, LEGEND_TEXT, MARGIN};
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
        let sizes = arrangement.layout.texts.iter().map(|text| text.size);
        let sizes: Vec<f64> = sizes.collect();
        // Full size but for rounding: nothing is set smaller.
        assert!(
            sizes.iter().all(|size| *size > 0.999 * LABEL_TEXT),
            "{sizes:?}"
        );
        let label = &arrangement.layout.texts[1];
        let legend = arrangement.legend.unwrap().rect;
        assert!(legend.bottom <= arrangement.layout.frame.top);
        // The label of y begins below the legend.
        let length = Widths::measure(&chart).height_of_y_label_px() - 2.0 * MARGIN;
        assert!(
            label.at.1 - length / 2.0 >= legend.bottom,
            "{:?} {legend:?}",
            label.at
        );
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
            legend.entries.iter().map(|(_, at)| at.0 as i64).collect();
        assert_eq!(lefts.len(), 2);
        assert!(legend.text_px >= 0.85 * LEGEND_TEXT && legend.text_px < LEGEND_TEXT);
    }
}
