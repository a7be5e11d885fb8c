//! What a chart must fulfil before it is drawn; nothing that cannot be drawn truly is drawn at all.

use super::text::{plain, printable};
use super::{Chart, ChartError, Mark, Scale, Series};

/// Refuses a chart with no point, with values no axis can show, or with text that XML cannot hold.
pub(super) fn check(chart: &Chart) -> Result<(), ChartError> {
    let texts = [
        chart.title.as_deref(),
        Some(&chart.x.label),
        Some(&chart.y.label),
    ];
    let series = chart.series.iter().map(|series| series.label.as_deref());
    let marks = chart.marks.iter().map(|mark| Some(&*mark.label));
    let mut texts = texts.into_iter().chain(series).chain(marks).flatten();
    if let Some(text) = texts.find(|text| !printable(text)) {
        return Err(ChartError::item(
            format!("the text {text:?}"),
            "it contains a control character; write it on one line of printable characters",
        ));
    }
    for (place, series) in chart.series.iter().enumerate() {
        check_series(chart, series, &series_name(series, place))?;
    }
    for mark in &chart.marks {
        let (x, y) = mark.place.coordinates();
        check_place(chart, (x, y), || mark_name(mark))?;
    }
    let shown = |series: &Series| series.points.iter().any(Option::is_some);
    match chart.map.is_none() && !chart.series.iter().any(shown) {
        true => Err(empty(chart)),
        false => Ok(()),
    }
}

/// The error for a chart that shows nothing.
pub(super) fn empty(chart: &Chart) -> ChartError {
    ChartError::item(
        format!("the chart of {}", subject(chart)),
        "there is no point to show; give at least one series with a point inside the axis ranges",
    )
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
    let refused = |reason: String| Err(ChartError::item(name, reason));
    if series.line.is_none() && series.marker.is_none() && !series.is_filled() {
        return refused(
            "it has neither line nor marker nor filled area; give it one of them".to_owned(),
        );
    }
    for (place, point) in series.points.iter().enumerate() {
        let (x, y) = point.unzip();
        check_place(chart, (x, y), || format!("point {} of {name}", place + 1))?;
    }
    check_place(chart, (None, series.area_to), || {
        format!("the filled area of {name}")
    })?;
    let errors = series.error.as_deref().unwrap_or_default();
    let (bars, points) = (errors.len(), series.points.len());
    if series.error.is_some() && bars != points {
        return refused(format!(
            "there are {bars} error bars for {points} points; give one per point, None where there is none"
        ));
    }
    let is_wrong = |error: &&f64| !(error.is_finite() && **error >= 0.0);
    match errors.iter().flatten().find(is_wrong) {
        Some(bar) => refused(format!(
            "an error bar is {bar} long; give a finite number of at least zero"
        )),
        None => Ok(()),
    }
}

/// Whether the axes can show a place.
fn check_place(
    chart: &Chart,
    (x, y): (Option<f64>, Option<f64>),
    item: impl Fn() -> String,
) -> Result<(), ChartError> {
    for (axis, name, value) in [(&chart.x, "x", x), (&chart.y, "y", y)] {
        let Some(value) = value else { continue };
        let why = match axis.scale {
            _ if !value.is_finite() => "which is not a finite number",
            Scale::Log if value <= 0.0 => "and a logarithmic axis shows only values above zero",
            _ => continue,
        };
        return Err(ChartError::item(
            item(),
            format!("its {name} is {value}, {why}; where a value is absent, leave it out (None)"),
        ));
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

    #[track_caller]
    fn refused(chart: &Chart, why: &str) {
        let error = check(chart).unwrap_err();
        assert!(error.to_string().contains(why), "{error}");
    }

    #[test]
    fn a_point_that_is_not_finite_is_refused_by_name() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let error = check(&chart(&[(1.0, 1.0), (2.0, bad)])).unwrap_err();
            let told =
                format!("point 2 of the series 'loss': its y is {bad}, which is not a finite");
            assert!(error.to_string().contains(&told), "{error}");
        }
    }

    #[test]
    fn a_value_that_is_not_positive_is_refused_on_a_log_axis_only() {
        for bad in [0.0, -1.0] {
            let error = check(&chart(&[(bad, 1.0)])).unwrap_err();
            let told = format!("its x is {bad}, and a logarithmic axis");
            assert!(error.to_string().contains(&told), "{error}");
        }
        assert!(check(&chart(&[(1.0, -1.0)])).is_ok());
    }

    #[test]
    fn a_chart_without_a_point_is_refused() {
        let bare = Chart::new(Axis::linear("t / s"), Axis::linear("W / J"));
        refused(&bare, "there is no point to show");
        let absent = bare.series(Series::line([None::<(f64, f64)>, None]));
        let error = check(&absent).unwrap_err();
        assert!(error.to_string().contains("W / J against t / s"), "{error}");
    }

    #[test]
    fn marks_and_filled_areas_are_held_to_the_same_rules() {
        let good = chart(&[(1.0, 1.0)]);
        let nan = good.clone().mark(Mark::point(1.0, f64::NAN, "peak"));
        refused(&nan, "the mark 'peak': its y is NaN");
        let zero = good.clone().mark(Mark::vertical(0.0, "peak"));
        refused(&zero, "the mark 'peak': its x is 0");
        let fill = good.series(Series::line([(1.0, 1.0)]).area_to(f64::INFINITY));
        refused(&fill, "the filled area of series 2: its y is inf");
    }

    #[test]
    fn error_bars_must_match_the_points() {
        let with = |bars: Vec<f64>| {
            let series = Series::scatter([(1.0, 1.0), (2.0, 2.0)]).error_bars(bars);
            Chart::new(Axis::linear("x"), Axis::linear("y")).series(series)
        };
        assert!(check(&with(vec![0.1, 0.0])).is_ok());
        refused(&with(vec![0.1]), "1 error bars for 2 points");
        refused(&with(vec![0.1, -0.1]), "an error bar is -0.1 long");
        refused(&with(vec![0.1, f64::NAN]), "an error bar is NaN long");
    }

    #[test]
    fn a_series_that_shows_nothing_is_refused() {
        let mut series = Series::line([(1.0, 1.0)]);
        series.line = None;
        let chart = Chart::new(Axis::linear("x"), Axis::linear("y")).series(series);
        refused(&chart, "neither line nor marker nor filled area");
    }

    #[test]
    fn control_characters_are_refused() {
        let chart = chart(&[(1.0, 1.0)]).title("two\nlines");
        refused(&chart, "a control character");
    }
}
