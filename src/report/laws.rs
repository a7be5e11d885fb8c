//! Laws that were fitted to the same numbers, in words and for the summary: which is chosen, from which others it is not told, its parameters.

use serde_json::{Map, Value, json};

use super::number::scientific;
use super::table::{cells, csv};
use super::text::{Column, Table};
use super::words::listed;
use crate::identify::laws::{Estimate, FittedLaw, Laws};
use crate::material::continuous::Spectrum;
use crate::material::law::{Form, Law, Scale};
use crate::material::{Material, MaterialError, MaterialFunction, ModulusKind, Relaxation};
use crate::quantity::{Dimension, format_human};

/// A number that was found.
pub struct Named {
    /// With its unit, as tables call it.
    pub name: String,
    pub(super) words: String,
    pub(super) estimate: Estimate,
    pub(super) dimension: Option<Dimension>,
}

impl Named {
    /// Value, and both ends of its interval, with units.
    pub fn texts(&self) -> [String; 3] {
        let Estimate { value, low, high } = self.estimate;
        [value, low, high].map(|value| match self.dimension {
            Some(dimension) => format_human(value, dimension, 4),
            None => scientific(value, 4),
        })
    }
}

/// The parameters of a law.
pub fn named(law: &FittedLaw) -> Vec<Named> {
    let parameters = law.form.parameters().into_iter().zip(&law.parameters);
    let parameters = parameters.map(|(parameter, estimate)| Named {
        dimension: match parameter.scale {
            Scale::Logarithm(dimension) => Some(dimension),
            Scale::Odds => None,
        },
        words: match parameter.scale {
            Scale::Logarithm(_) => without_unit(&parameter.name),
            Scale::Odds => parameter.name.replace('_', " "),
        },
        name: parameter.name,
        estimate: *estimate,
    });
    parameters.collect()
}

/// Numbers with their intervals.
pub fn table(all: &[Named]) -> Table {
    let columns = [
        Column::left("", 24),
        Column::right("value", 13),
        Column::left("95 % interval", 0),
    ];
    let mut table = Table::new(2, columns);
    for named in all {
        let [value, low, high] = named.texts();
        table.row([named.words.clone(), value, format!("{low} to {high}")]);
    }
    table
}

/// A name without its unit, which stands with the value.
fn without_unit(name: &str) -> String {
    let name = name.rsplit_once('_').map_or(name, |(name, _)| name);
    name.replace('_', " ")
}

/// Which law was found of `what`, and from which others that does not tell it; below it the law itself, of the modulus with this symbol.
pub fn laws_in_words(laws: &Laws, what: &str, symbol: char) -> [String; 2] {
    let law = laws.best();
    let others = laws.others().map(|other| {
        let weight = scientific(other.weight, 2);
        format!("{} ({weight})", other.form.in_words())
    });
    let others: Vec<String> = others.collect();
    let words = law.form.in_words();
    let weight = scientific(law.weight, 2);
    let chosen = match (others.is_empty(), laws.all.len()) {
        (_, 1) => format!("Law: {words}, as asked for."),
        (true, _) => {
            format!(
                "Law: {words} (weight {weight}); {what} tells it from all others that were tried."
            )
        }
        (false, _) => format!(
            "Law: {words} (weight {weight}); {what} does not tell it from {}. The bands of the moduli hold what these say.",
            listed(&others)
        ),
    };
    let modulus = if symbol == 'G' {
        "shear modulus"
    } else {
        "Young's modulus"
    };
    let formula = formula(law.form);
    let formula = formula.strip_prefix('E').unwrap_or(formula);
    [chosen, format!("{symbol}{formula}, {modulus}.")]
}

/// What a fit of a material has beside its series, in whose place it is.
#[derive(Debug, Clone)]
pub enum Beside {
    Laws(Laws),
    Spectrum(Spectrum),
}

impl Beside {
    /// What it is, one fact a line, of a modulus of this kind.
    pub fn lines(&self, kind: ModulusKind) -> Vec<String> {
        let symbol = MaterialFunction::Relaxation.symbol(kind);
        match self {
            Self::Laws(laws) => laws_in_words(laws, "what was measured", symbol).to_vec(),
            Self::Spectrum(spectrum) => {
                let count = spectrum.points.len();
                let mean_square = scientific(spectrum.mean_square, 2);
                let mut lines = vec![format!(
                    "Continuous spectrum: {count} times, five per decade, each a branch of the block; chi squared over the number of data \
                     {mean_square}."
                )];
                let (from, to) = spectrum.window_s;
                let [from, to] = [from, to].map(|t| format_human(t, Dimension::Time, 3));
                lines.push(format!(
                    "The data tell of the spectrum from \u{3c4} = {from} to {to}; outside, it is an extrapolation."
                ));
                lines
            }
        }
    }

    /// The series in place of the one that was fitted before; `None` where that is as good.
    fn series_in_place(&self) -> Option<Relaxation> {
        match self {
            Self::Laws(laws) if laws.best().form.law == Law::Series => None,
            Self::Laws(laws) => laws.series(),
            Self::Spectrum(spectrum) => spectrum.series().ok(),
        }
    }

    /// The material of that series, with where it comes from, in place of one that was fitted before.
    ///
    /// # Errors
    /// As [`Material::from_relaxation`].
    pub fn in_place_of(
        &self,
        own: Material,
        kind: ModulusKind,
        nu: f64,
    ) -> Result<Material, MaterialError> {
        let Some(series) = self.series_in_place() else {
            return Ok(own);
        };
        let mut material = Material::from_relaxation(series, kind, nu)?;
        material.origin = own.origin;
        // What the series that was fitted before left open is none of this one.
        (material.origin.fit, material.origin.alternatives) = (None, Vec::new());
        material.origin.replicas.clear();
        Ok(material)
    }

    /// Parameters with their intervals, where there are any.
    pub fn parameters(&self) -> Option<Table> {
        match self {
            Self::Laws(laws) => Some(table(&named(laws.best()))),
            Self::Spectrum(_) => None,
        }
    }

    /// What the summary says of it.
    pub fn summary(&self) -> Map<String, Value> {
        match self {
            Self::Laws(laws) => summary(laws),
            Self::Spectrum(spectrum) => {
                let value = json!({
                    "points": spectrum.points.len(),
                    "equilibrium_modulus_pa": spectrum.equilibrium_pa,
                    "window_s": spectrum.window_s,
                    "mean_square": spectrum.mean_square,
                });
                [("spectrum".to_owned(), value)].into_iter().collect()
            }
        }
    }

    /// The spectrum, where it is one.
    pub fn spectrum(&self) -> Option<&Spectrum> {
        match self {
            Self::Laws(_) => None,
            Self::Spectrum(spectrum) => Some(spectrum),
        }
    }
}

/// A summary with further keys, where there are any.
pub fn extended(mut summary: Value, more: Option<Map<String, Value>>) -> Value {
    if let (Some(object), Some(more)) = (summary.as_object_mut(), more) {
        object.extend(more);
    }
    summary
}

/// `spectrum.csv`: the continuous spectrum with its band.
pub fn spectrum_csv(spectrum: &Spectrum) -> Vec<u8> {
    let columns = [
        "time_s",
        "spectrum_pa",
        "spectrum_low_pa",
        "spectrum_high_pa",
        "extrapolated",
    ];
    let (first, last) = spectrum.window_s;
    let is_outside = |t: f64| t < first || t > last;
    let rows = spectrum.points.iter().map(|p| {
        cells![
            p.time_s,
            p.spectrum_pa,
            p.low_pa,
            p.high_pa,
            is_outside(p.time_s).to_string()
        ]
    });
    csv(&columns, rows)
}

/// The interval of a number as an object.
pub fn estimate(estimate: &Estimate) -> Value {
    json!({ "value": estimate.value, "low": estimate.low, "high": estimate.high })
}

/// What the summary says of laws.
pub fn summary(laws: &Laws) -> Map<String, Value> {
    let best = laws.best();
    let names = best.form.parameters().into_iter().map(|p| p.name);
    let parameters: Map<String, Value> = names.zip(best.parameters.iter().map(estimate)).collect();
    let all = laws.all.iter().map(|law: &FittedLaw| {
        json!({
            "law": law.form.law.name(),
            "branches": (law.form.law == Law::Series).then_some(law.form.branches),
            "weight": law.weight,
            "schwarz": law.schwarz,
            "chi_squared": law.chi_squared,
        })
    });
    let all: Vec<Value> = all.collect();
    [
        ("law", json!(best.form.law.name())),
        ("laws", json!(all)),
        (
            "law_is_told_from_others",
            json!(laws.others().next().is_none()),
        ),
        ("parameters", json!(parameters)),
    ]
    .map(|(key, value)| (key.to_owned(), value))
    .into_iter()
    .collect()
}

/// What the parameters are of.
fn formula(form: Form) -> &'static str {
    match form.law {
        Law::PowerLaw => "E* = modulus (i\u{3c9} \u{b7} 1 s)^exponent",
        Law::StandardSolid => "E(t) = equilibrium + modulus exp(-t/time)",
        Law::FractionalZener => {
            "E* = equilibrium + modulus (i\u{3c9} time)^exponent / (1 + (i\u{3c9} time)^exponent)"
        }
        Law::FractionalMaxwell => {
            "E* = modulus (i\u{3c9} time)^a / (1 + (i\u{3c9} time)^(a - b)), a = exponent, b = exponent_ratio a"
        }
        Law::KelvinVoigt => "E* = equilibrium + modulus (i\u{3c9} \u{b7} 1 s)^exponent",
        Law::Kww => "E(t) = equilibrium + modulus exp(-(t/time)^exponent)",
        Law::Series => "E(t) = equilibrium + sum of modulus_i exp(-t/time_i)",
    }
}
