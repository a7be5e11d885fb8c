//! What a chart must fulfil before it is drawn; nothing that cannot be drawn truly is drawn at all.

use super::text::{plain, printable};
use super::{AxisName, Chart, ChartError, Mark, Scale, Series};

/// Refuses a chart with no point, with values no axis can show, or with text that XML cannot hold.
pub(super) fn check(chart: &Chart) -> Result<(), ChartError> {
    let texts = [
        chart.title.as_deref(),
        Some(&chart.x.label),
        Some(&chart.y.label),
    ];
    let series = chart.series.iter().map(|series| series.label.as_deref());
    let marks = chart.marks.iter().map(|mark| Some(&*mark.label));
    for text in texts.into_iter().chain(series).chain(marks).flatten() {
        if !printable(text) {
            return Err(ChartError::Text {
                text: text.to_owned(),
            });
        }
    }
    for (place, series) in chart.series.iter().enumerate() {
        check_series(chart, series, &series_name(series, place))?;
    }
    for mark in &chart.marks {
        check_mark(chart, mark)?;
    }
    let shown = |series: &Series| series.points.iter().any(Option::is_some);
    if chart.map.is_none() && !chart.series.iter().any(shown) {
        return Err(empty(chart));
    }
    Ok(())
}

/// The error for a chart that shows nothing.
pub(super) fn empty(chart: &Chart) -> ChartError {
    ChartError::Empty {
        chart: subject(chart),
    }
}

/// What the chart shows, in words.
pub(super) fn subject(chart: &Chart) -> String {
    plain(&match (&chart.title, &chart.map) {
        (Some(title), _) => title.clone(),
        (None, Some(map)) => format!("{} over the surface", map.value_label),
        (None, None) => format!("{} against {}", chart.y.label, chart.x.label),
    })
}

/// What a mark is called in an error.
pub(super) fn mark_name(mark: &Mark) -> String {
    match mark.label.as_str() {
        "" => "a mark".to_owned(),
        label => format!("the mark '{label}'"),
    }
}

fn series_name(series: &Series, place: usize) -> String {
    match &series.label {
        Some(label) => format!("the series '{label}'"),
        None => format!("series {}", place + 1),
    }
}

fn check_series(chart: &Chart, series: &Series, name: &str) -> Result<(), ChartError> {
    if series.line.is_none() && series.marker.is_none() && !series.is_filled() {
        return Err(ChartError::Invisible {
            series: name.to_owned(),
        });
    }
    for (place, point) in series.points.iter().enumerate() {
        let Some((x, y)) = *point else { continue };
        let item = || format!("point {} of {name}", place + 1);
        check_value(chart, AxisName::X, x, item)?;
        check_value(chart, AxisName::Y, y, item)?;
    }
    if let Some(base) = series.area_to {
        check_value(chart, AxisName::Y, base, || {
            format!("the filled area of {name}")
        })?;
    }
    let Some(errors) = &series.error else {
        return Ok(());
    };
    if errors.len() != series.points.len() {
        let (errors, points) = (errors.len(), series.points.len());
        return Err(ChartError::ErrorBarCount {
            series: name.to_owned(),
            errors,
            points,
        });
    }
    for (place, error) in errors.iter().enumerate() {
        if let Some(value) = error.filter(|value| !(value.is_finite() && *value >= 0.0)) {
            return Err(ChartError::ErrorBar {
                item: format!("point {} of {name}", place + 1),
                value,
            });
        }
    }
    Ok(())
}

fn check_mark(chart: &Chart, mark: &Mark) -> Result<(), ChartError> {
    let (x, y) = mark.place.coordinates();
    for (axis, value) in [(AxisName::X, x), (AxisName::Y, y)] {
        if let Some(value) = value {
            check_value(chart, axis, value, || mark_name(mark))?;
        }
    }
    Ok(())
}

fn check_value(
    chart: &Chart,
    axis: AxisName,
    value: f64,
    item: impl Fn() -> String,
) -> Result<(), ChartError> {
    let (scale, quantity) = match axis {
        AxisName::X => (chart.x.scale, "its x"),
        AxisName::Y => (chart.y.scale, "its y"),
    };
    if !value.is_finite() {
        return Err(ChartError::NotFinite {
            item: item(),
            quantity,
            value,
        });
    }
    if scale == Scale::Log && value <= 0.0 {
        return Err(ChartError::NotPositive {
            item: item(),
            axis,
            value,
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, Mark};

    fn chart(points: &[(f64, f64)]) -> Chart {
        Chart::new(Axis::log("x"), Axis::linear("y"))
            .series(Series::line(points.iter().copied()).label("loss"))
    }

    #[test]
    fn a_point_that_is_not_finite_is_refused_by_name() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = check(&chart(&[(1.0, 1.0), (2.0, bad)])).unwrap_err();
            assert!(matches!(error, ChartError::NotFinite { .. }));
            assert!(
                error.to_string().contains("point 2 of the series 'loss'"),
                "{error}"
            );
        }
    }

    #[test]
    fn a_value_that_is_not_positive_is_refused_on_a_log_axis_only() {
        for bad in [0.0, -1.0] {
            let error = check(&chart(&[(bad, 1.0)])).unwrap_err();
            assert!(
                matches!(
                    error,
                    ChartError::NotPositive {
                        axis: AxisName::X,
                        ..
                    }
                ),
                "{error}"
            );
        }
        assert!(check(&chart(&[(1.0, -1.0)])).is_ok());
    }

    #[test]
    fn a_chart_without_a_point_is_refused() {
        let bare = Chart::new(Axis::linear("t / s"), Axis::linear("W / J"));
        assert!(matches!(check(&bare), Err(ChartError::Empty { .. })));
        let absent = bare.series(Series::line([None::<(f64, f64)>, None]));
        let error = check(&absent).unwrap_err();
        assert!(error.to_string().contains("W / J against t / s"), "{error}");
    }

    #[test]
    fn marks_and_filled_areas_are_held_to_the_same_rules() {
        let good = chart(&[(1.0, 1.0)]);
        let nan = good.clone().mark(Mark::point(1.0, f64::NAN, "peak"));
        assert!(matches!(check(&nan), Err(ChartError::NotFinite { .. })));
        let zero = good.clone().mark(Mark::vertical(0.0, "peak"));
        assert!(matches!(check(&zero), Err(ChartError::NotPositive { .. })));
        let fill = good.series(Series::line([(1.0, 1.0)]).area_to(f64::INFINITY));
        assert!(matches!(check(&fill), Err(ChartError::NotFinite { .. })));
    }

    #[test]
    fn error_bars_must_match_the_points() {
        let with = |bars: Vec<f64>| {
            let series = Series::scatter([(1.0, 1.0), (2.0, 2.0)]).error_bars(bars);
            check(&Chart::new(Axis::linear("x"), Axis::linear("y")).series(series))
        };
        assert!(with(vec![0.1, 0.0]).is_ok());
        assert!(matches!(
            with(vec![0.1]),
            Err(ChartError::ErrorBarCount {
                errors: 1,
                points: 2,
                ..
            })
        ));
        assert!(matches!(
            with(vec![0.1, -0.1]),
            Err(ChartError::ErrorBar { .. })
        ));
        assert!(matches!(
            with(vec![0.1, f64::NAN]),
            Err(ChartError::ErrorBar { .. })
        ));
    }

    #[test]
    fn a_series_that_shows_nothing_is_refused() {
        let mut series = Series::line([(1.0, 1.0)]);
        series.line = None;
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y")).series(series);
        assert!(matches!(check(&chart), Err(ChartError::Invisible { .. })));
    }

    #[test]
    fn control_characters_are_refused() {
        let chart = chart(&[(1.0, 1.0)]).title("two\nlines");
        assert!(matches!(check(&chart), Err(ChartError::Text { .. })));
    }
}
