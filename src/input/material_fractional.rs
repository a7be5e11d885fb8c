//! `[material.fractional]`: a fractional model as the series that represents it over a band.

use super::diagnostic::Problems;
use super::document::Located;
use super::document::reader::TableReader;
use super::keys::fractional::{
    BAND, FRACTIONAL_ACCURACY_KEY, FRACTIONAL_EXPONENT, FRACTIONAL_KIND, FRACTIONAL_MODEL,
    FRACTIONAL_TIME, FractionalModel, SECOND_EXPONENT, STIFFNESS,
};
use super::keys::material::EQUILIBRIUM;
use crate::material::fractional::{Fractional, FractionalError, Represented};
use crate::material::{Compressibility, Material, MaterialError};

/// Reads the table: the material but for its Poisson ratio. `None` where a problem was reported.
pub(super) fn read(
    table: &mut TableReader<'_>,
) -> Option<impl FnOnce(Compressibility) -> Result<Material, MaterialError> + use<>> {
    let model = table.read(&FRACTIONAL_MODEL);
    let kind = table.value(&FRACTIONAL_KIND);
    let (stiffness, time) = (table.value(&STIFFNESS), table.value(&FRACTIONAL_TIME));
    let exponent = table.read(&FRACTIONAL_EXPONENT);
    let (band, accuracy) = (table.read(&BAND), table.value(&FRACTIONAL_ACCURACY_KEY));
    let model = model?.value;
    let mut equilibrium = Some(0.0);
    let mut second_exponent = Some(0.0);
    match model {
        FractionalModel::Springpot => {}
        FractionalModel::Zener => equilibrium = table.value(&EQUILIBRIUM),
        FractionalModel::Maxwell => second_exponent = table.value(&SECOND_EXPONENT),
    }
    let (stiffness, time, exponent) = (stiffness?, time?, exponent?);
    let made = match model {
        FractionalModel::Springpot => Fractional::springpot(stiffness, time, exponent.value),
        FractionalModel::Zener => Fractional::zener(equilibrium?, stiffness, time, exponent.value),
        FractionalModel::Maxwell => {
            Fractional::maxwell(stiffness, time, exponent.value, second_exponent?)
        }
    };
    let problems = table.problems();
    let (made, kind) = (problems.accept(&exponent, made)?, kind?);
    let represented = represent(&made, &band?, accuracy?, problems)?;
    Some(move |nu| represented.material(kind, nu))
}

fn represent(
    model: &Fractional,
    band: &Located<Vec<Located<f64>>>,
    accuracy: f64,
    problems: &Problems,
) -> Option<Represented> {
    let [low, high] = band.value.as_slice() else {
        return None;
    };
    match model.represent((low.value, high.value), accuracy) {
        Ok(represented) => Some(represented),
        Err(error) => {
            let help = match error {
                FractionalError::TooManyBranches { .. } => {
                    "narrow the band to the frequencies that you compute at, or allow a larger error with `accuracy`; for an exponent \
                     that is nearly 1 write 1"
                }
                _ => "write the lowest frequency first: band = [\"1e-3 rad/s\", \"1e5 rad/s\"]",
            };
            problems.at(band, error.to_string()).help(help);
            None
        }
    }
}
