//! Shift factors over temperature, with their errors and the laws through them.

use super::caption;
use crate::material::dynamic::master_curve::MasterCurve;
use crate::material::dynamic::shift_law::ShiftLaw;
use crate::quantity::ZERO_CELSIUS_K;
use crate::report::chart::{Axis, Chart, LineStyle, Series};
use crate::report::dynamic::DynamicReport;
use crate::report::dynamic::tables::celsius;
use crate::report::dynamic::{arrhenius, wlf};
use crate::report::figure::Figure;
use crate::report::number::range;

/// Points of the curve of a law.
const POINTS: i32 = 200;

/// The figure; its data are `shift.csv`. `None` where nothing was shifted.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let master = report.made.master.as_ref()?;
    let shifts = &master.shifts;
    let places = shifts
        .iter()
        .map(|s| (celsius(s.temperature_k), s.log10_a_t));
    let errors = shifts.iter().map(|s| s.log10_a_t_error);
    let data = Series::scatter(places).error_bars(errors);
    let mut chart = Chart::new(
        Axis::linear("temperature T / °C"),
        Axis::linear("shift factor log₁₀ a_T"),
    );
    chart.series.extend(laws(master));
    let chart = chart.series(data.label("isotherms"));
    let (of_wlf, of_arrhenius) = (master.wlf.as_ref(), master.arrhenius.as_ref());
    let sentences = of_wlf
        .map(wlf)
        .into_iter()
        .chain(of_arrhenius.map(arrhenius));
    let preferred = master.preferred.map(|law| match law {
        ShiftLaw::Wlf(_) => "The data prefer WLF.".to_owned(),
        ShiftLaw::Arrhenius(_) => "The data prefer Arrhenius.".to_owned(),
    });
    let any = shifts.iter().any(|s| s.log10_a_t_error.is_some());
    let bars = any.then(|| {
        "Error bars: standard errors; those shorter than their symbol are not drawn.".to_owned()
    });
    Some(Figure {
        name: "shift-factors",
        picture: chart.into(),
        caption: caption(report, "Shift factors a_T over temperature T")
            .say_all(sentences.map(|law| format!("{law}.")))
            .say_all(preferred)
            .say_all(bars),
        data: Vec::new(),
    })
}

/// The curves of the laws over the temperatures of the isotherms.
fn laws(master: &MasterCurve) -> Vec<Series> {
    let (coldest, warmest) = range(master.shifts.iter().map(|s| s.temperature_k));
    let curve = |law: &dyn Fn(f64) -> Option<f64>| {
        let points = (0..=POINTS).map(|i| {
            let temperature_k = coldest + (warmest - coldest) * f64::from(i) / f64::from(POINTS);
            Some((temperature_k - ZERO_CELSIUS_K, law(temperature_k)?))
        });
        Series::line(points)
    };
    let wlf = master.wlf.map(|law| {
        curve(&|temperature_k| law.log10_a_t(temperature_k))
            .label("WLF")
            .color(1)
    });
    let arrhenius = master.arrhenius.map(|law| {
        curve(&|temperature_k| Some(law.log10_a_t(temperature_k)))
            .label("Arrhenius")
            .color(2)
            .style(LineStyle::Dashed)
    });
    wlf.into_iter().chain(arrhenius).collect()
}
