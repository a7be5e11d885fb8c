//! Shift factors over temperature, with their errors and the laws through them.

use super::{caption, units};
use crate::material::dynamic::master_curve::MasterCurve;
use crate::material::dynamic::shift_law::ShiftLaw;
use crate::report::chart::LineStyle;
use crate::report::dynamic::DynamicReport;
use crate::report::dynamic::{arrhenius, wlf};
use crate::report::figure::Figure;
use crate::report::figure::plot::Plot;
use crate::report::figure::quantity::{Quantity, TEMPERATURE};
use crate::report::figure::trace::{Point, Trace};
use crate::report::figure::units::Measure;
use crate::report::number::range;

const SHIFT: Quantity = Quantity::new("log10_a_t", "shift factor log₁₀ a_T", Measure::Number);
/// Points of the curve of a law.
const POINTS: i32 = 200;

/// The figure; its data are `shift.csv`. `None` where nothing was shifted.
pub(super) fn figure(report: &DynamicReport<'_>) -> Option<Figure> {
    let master = report.made.master.as_ref()?;
    let shifts = &master.shifts;
    let points = shifts.iter();
    let points = points.map(|s| Point::new(s.temperature_k, s.log10_a_t).error(s.log10_a_t_error));
    let plot = Plot::new(TEMPERATURE, SHIFT)
        .traces(laws(master))
        .traces([Trace::symbols(points).label("isotherms")]);
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
    let caption = caption(report, "Shift factors a_T over temperature T")
        .say_all(sentences.map(|law| format!("{law}.")))
        .say_all(preferred)
        .say_all(bars);
    Some(Figure::of("shift-factors", &[plot], caption, &units(report)).without_data())
}

/// The curves of the laws over the temperatures of the isotherms.
fn laws(master: &MasterCurve) -> Vec<Trace> {
    let (coldest, warmest) = range(master.shifts.iter().map(|s| s.temperature_k));
    let curve = |law: &dyn Fn(f64) -> Option<f64>| {
        let points = (0..=POINTS).map(|i| {
            let temperature_k = coldest + (warmest - coldest) * f64::from(i) / f64::from(POINTS);
            Point::new(temperature_k, law(temperature_k))
        });
        Trace::line(points)
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
