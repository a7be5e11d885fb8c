//! Moduli of a material, and beside them what the loops of a sweep give: over frequency or another axis of the sweep, and in the
//! diagrams of Cole and Cole and of van Gurp and Palmen.

use num_complex::Complex;

use super::curve::{Abscissa, Curve, SweepCurves};
use super::equivalent::{LoopModulus, largest_differences, line};
use super::plot::Plot;
use super::quantity::{
    COMPLEX_MODULUS, LOSS_MODULUS, LOSS_TANGENT, MODULUS, PHASE_ANGLE, Quantity, STORAGE_MODULUS,
};
use super::trace::{Point, Trace};
use super::units::Units;
use super::{Drawn, Figure};
use crate::report::caption::{self, Caption};
use crate::report::chart::{Color, LineStyle, Marker};
use crate::report::number::{range, scientific};
use crate::report::table::{cells, csv};

/// A figure of complex moduli.
pub struct Diagram {
    name: &'static str,
    shows: &'static str,
    /// Over what; `None`: over frequency or the axis of the sweep.
    x: Option<(Quantity, Number)>,
    y: Quantity,
    parts: &'static [Part],
}

/// A real number that a complex one has.
type Number = fn(Complex<f64>) -> f64;

/// One of the numbers that stand in a diagram.
struct Part {
    /// What it is called beside another.
    label: &'static str,
    number: Number,
    /// Which of both errors is its own.
    error: Option<usize>,
    style: LineStyle,
    marker: Marker,
}

const STORAGE: Part = Part {
    label: "E′",
    number: |modulus| modulus.re,
    error: Some(0),
    style: LineStyle::Solid,
    marker: Marker::Disc,
};
const LOSS: Part = Part {
    label: "E″",
    number: |modulus| modulus.im,
    error: Some(1),
    style: LineStyle::Dashed,
    marker: Marker::Square,
};
const fn alone(number: Number) -> Part {
    Part {
        label: "",
        number,
        error: None,
        ..STORAGE
    }
}

/// Each relaxation is an arc in the second (K. S. Cole and R. H. Cole, J. Chem. Phys. 9 (1941) 341, for permittivities). The third is
/// free of the frequency, so that errors of a time scale do not show and others do (M. van Gurp and J. Palmen, Rheol. Bull. 67
/// (1998) 5). From a ratio the contact radius of the indentation formula drops out.
static DIAGRAMS: [Diagram; 4] = [
    Diagram {
        name: "moduli",
        shows: "Storage modulus E′ and loss modulus E″",
        x: None,
        y: MODULUS,
        parts: &[STORAGE, LOSS],
    },
    Diagram {
        name: "loss-tangent",
        shows: "Loss tangent E″/E′",
        x: None,
        y: LOSS_TANGENT,
        parts: &[alone(|modulus| modulus.im / modulus.re)],
    },
    Diagram {
        name: "cole-cole",
        shows: "Loss modulus E″ over storage modulus E′ (Cole–Cole diagram)",
        x: Some((STORAGE_MODULUS, |modulus| modulus.re)),
        y: LOSS_MODULUS,
        parts: &[alone(|modulus| modulus.im)],
    },
    Diagram {
        name: "van-gurp-palmen",
        shows: "Phase angle φ over magnitude of the complex modulus |E*| (van Gurp–Palmen diagram)",
        x: Some((COMPLEX_MODULUS, |modulus| modulus.norm())),
        y: PHASE_ANGLE,
        parts: &[alone(|modulus| modulus.arg())],
    },
];

/// Curves in one figure, each with a line and symbols; more cannot be told apart.
const CURVES: usize = 4;
const NONE: &str = "no figures of the moduli: fewer than two loops have equivalent moduli";

/// The diagrams of a sweep: of its curve of the largest loss, or of every material or indenter of a list.
pub fn of_sweep(sweep: &SweepCurves<'_>) -> Vec<Drawn> {
    let curves = with_loops(sweep);
    if curves.is_empty() {
        return vec![Err(NONE)];
    }
    // Where the modulus of the material does not vary, a diagram of moduli over moduli is a point.
    let own = curves.iter().flat_map(|(_, loops)| loops);
    let (least, largest) = range(own.map(|at| at.own_pa.norm()));
    let varies = largest > 1.01 * least;
    let all = DIAGRAMS.iter();
    let all = all.filter(|diagram| varies || diagram.x.is_none());
    all.map(|diagram| Ok(diagram.of_sweep(sweep, &curves)))
        .collect()
}

/// The moduli over an axis of a sweep.
pub fn over_axis(sweep: &SweepCurves<'_>) -> Option<Figure> {
    let curves = with_loops(sweep);
    (!curves.is_empty()).then(|| DIAGRAMS[0].of_sweep(sweep, &curves))
}

/// A curve, and its loops that have moduli: two or more.
type WithLoops<'b, 'a> = (&'b Curve<'a>, Vec<LoopModulus<'a>>);

fn with_loops<'b, 'a>(sweep: &'b SweepCurves<'a>) -> Vec<WithLoops<'b, 'a>> {
    let curves = match (sweep.over, sweep.is_of_one_curve()) {
        (Abscissa::Frequency, true) => super::curve::largest(&sweep.curves).into_iter().collect(),
        _ => sweep.shown(CURVES),
    };
    let loops = |curve: &'b Curve<'a>| {
        let records = curve.records.iter();
        let loops = records.filter_map(|record| LoopModulus::of(sweep, record));
        (curve, loops.collect::<Vec<_>>())
    };
    let all = curves.into_iter().map(loops);
    all.filter(|(_, loops)| loops.len() > 1).collect()
}

impl Diagram {
    fn of_sweep(&self, sweep: &SweepCurves<'_>, curves: &[WithLoops<'_, '_>]) -> Figure {
        let places = curves.iter().flat_map(|(_, loops)| loops);
        let (first, last) = range(places.map(|at| at.record.angular_frequency_rad_per_s));
        // A diagram without frequencies shows the material beyond those of the loops.
        let beyond = if self.x.is_some() { 1e2 } else { 1.0 };
        let place = |x: f64, modulus: Complex<f64>| match &self.x {
            Some((_, number)) => number(modulus),
            None => x,
        };
        let mut traces = Vec::new();
        for (step, (curve, loops)) in curves.iter().enumerate() {
            let own: Vec<(f64, Complex<f64>)> = match sweep.over {
                Abscissa::Frequency => {
                    let material = &curve.condition.contact.material;
                    line(material, first / beyond, last * beyond)
                }
                Abscissa::Axis(_) => {
                    let own = loops.iter();
                    own.map(|at| (sweep.place(at.record), at.own_pa)).collect()
                }
            };
            for (k, part) in self.parts.iter().enumerate() {
                let look = Look {
                    // Colours tell curves apart, and where there is one curve the numbers.
                    color: if curves.len() > 1 { step } else { k },
                    is_only: self.parts.len() == 1,
                    curve: curve.label.as_deref().filter(|_| curves.len() > 1),
                };
                let drawn = own.iter().map(|(x, modulus)| {
                    Point::new(place(*x, *modulus), (part.number)(*modulus)).along(*x)
                });
                traces.push(look.line(part, drawn));
                let symbols = loops.iter().map(|at| {
                    let x = place(sweep.place(at.record), at.modulus_pa);
                    let error = part.error.and_then(|error| at.errors_pa()[error]);
                    Point::new(x, (part.number)(at.modulus_pa))
                        .error(error)
                        .along(sweep.place(at.record))
                });
                traces.push(look.symbols(part, symbols));
            }
        }
        let y = self.y.clone();
        let plot = match &self.x {
            Some((quantity, _)) => Plot {
                along: Some(sweep.x.clone()),
                ..Plot::new(quantity.clone(), y)
            },
            None => sweep.plot(y).family(None),
        };
        let title = curves.first().and_then(|(curve, _)| curve.label.clone());
        let plot = plot
            .title(title.filter(|_| curves.len() == 1))
            .traces(traces);
        Figure::of(
            self.name,
            &[plot],
            self.caption(sweep, curves),
            &sweep.units,
        )
    }

    /// How the symbols come about, and how far they are off.
    fn caption(&self, sweep: &SweepCurves<'_>, curves: &[WithLoops<'_, '_>]) -> Caption {
        let loops = || curves.iter().flat_map(|(_, loops)| loops);
        let [storage, loss] = largest_differences(loops);
        let shows = match self.x {
            Some(_) => self.shows.to_owned(),
            None => format!("{} over {}", self.shows, sweep.x.words),
        };
        let only = curves.first().filter(|_| curves.len() == 1);
        let bars = self.parts.iter().any(|part| part.error.is_some());
        let are_told = self.parts.len() > 1 && curves.len() > 1;
        let told =
            are_told.then(|| "Solid lines and discs: E′; dashed lines and squares: E″.".to_owned());
        Caption::new(shows)
            .say_all(only.and_then(|(curve, _)| curve.sentence.clone()))
            .say_all(told)
            .say(
                "Lines: the material's longitudinal modulus. Symbols: what indentation reads from the hysteresis loops, \
                 E′ = (1 − ν²)W₁cosφ/(2aδ₁) and E″ with sinφ, W₁ and δ₁ being the first harmonics of load and approach, φ the \
                 phase between them and a the mean contact radius. Symbols that would crowd over the lines are left out; the data have \
                 all.",
            )
            .say(format!(
                "They differ from the material's by at most {storage} % in E′ and {loss} % in E″."
            ))
            .say_all(caption::error_bars(sweep.plan, sweep.outcome).filter(|_| bars))
    }
}

/// How one curve of a diagram is drawn.
struct Look<'a> {
    color: usize,
    is_only: bool,
    /// What it is called beside others.
    curve: Option<&'a str>,
}

impl Look<'_> {
    /// What it is, and of which curve. Of several curves the legend has their names alone: what lines and symbols are is in the caption.
    fn labelled(&self, trace: Trace, part: &Part, what: &str, stands_for_curve: bool) -> Trace {
        let what = match self.is_only {
            true => what.to_owned(),
            false => format!("{} {what}", part.label),
        };
        match self.curve {
            None => trace.label(what),
            Some(curve) if stands_for_curve => Trace {
                legend: Some(curve.to_owned()),
                ..trace.label(format!("{curve}, {what}"))
            },
            Some(curve) => Trace {
                in_legend: false,
                ..trace.label(format!("{curve}, {what}"))
            },
        }
    }

    fn line(&self, part: &Part, points: impl Iterator<Item = Point>) -> Trace {
        let trace = Trace::line(points).style(part.style).color(self.color);
        self.labelled(trace, part, "of the material", part.label != LOSS.label)
    }

    fn symbols(&self, part: &Part, points: impl Iterator<Item = Point>) -> Trace {
        // A lone number has the second colour where the line has the first.
        let color = self.color + usize::from(self.is_only && self.curve.is_none());
        let trace = Trace::symbols(points).spaced().marker(part.marker);
        self.labelled(
            trace.color(Color::Palette(color)),
            part,
            "from the loops",
            false,
        )
    }
}

/// One frequency of a material: rad/s, then Pa, then 1/Pa.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct ModulusPoint {
    pub angular_frequency_rad_per_s: f64,
    pub storage_modulus_pa: f64,
    pub loss_modulus_pa: f64,
    pub storage_compliance_per_pa: f64,
    pub loss_compliance_per_pa: f64,
}

impl ModulusPoint {
    fn loss_tangent(&self) -> f64 {
        self.loss_modulus_pa / self.storage_modulus_pa
    }
}

/// The figure of a material. `symbol` is E for longitudinal and G for shear moduli.
pub fn figure(points: &[ModulusPoint], symbol: char) -> Figure {
    let units = Units::default();
    let trace = |number: fn(&ModulusPoint) -> f64| {
        let points = points.iter();
        Trace::line(points.map(|p| Point::new(p.angular_frequency_rad_per_s, number(p))))
    };
    let traces = [
        trace(|p| p.storage_modulus_pa).label(format!("storage modulus {symbol}′")),
        trace(|p| p.loss_modulus_pa)
            .label(format!("loss modulus {symbol}″"))
            .style(LineStyle::Dashed)
            .color(1),
    ];
    let plot = Plot::new(Quantity::frequency(&units), MODULUS).traces(traces);
    let caption = Caption::new(format!(
        "Storage modulus {symbol}′ and loss modulus {symbol}″ over angular frequency ω"
    ))
    .say_all(largest_tangent(points));
    Figure::of("moduli", &[plot], caption, &units).with_data(table(points))
}

/// The points with what follows from them.
fn table(points: &[ModulusPoint]) -> Vec<u8> {
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "loss_modulus_pa",
        "loss_tangent",
        "storage_compliance_per_pa",
        "loss_compliance_per_pa",
    ];
    let rows = points.iter().map(|p| {
        cells![
            p.angular_frequency_rad_per_s,
            p.storage_modulus_pa,
            p.loss_modulus_pa,
            p.loss_tangent(),
            p.storage_compliance_per_pa,
            p.loss_compliance_per_pa,
        ]
    });
    csv(&columns, rows)
}

/// Where the material dissipates most of what it stores.
fn largest_tangent(points: &[ModulusPoint]) -> Option<String> {
    let points = points.iter();
    let largest = points.max_by(|a, b| a.loss_tangent().total_cmp(&b.loss_tangent()))?;
    let at = Units::default().frequency_label(largest.angular_frequency_rad_per_s);
    (largest.loss_tangent() > 0.0).then(|| {
        let tangent = scientific(largest.loss_tangent(), 4);
        format!("Largest loss tangent of the points drawn: {tangent} at {at}.")
    })
}
