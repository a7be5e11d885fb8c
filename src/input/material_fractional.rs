//! `[material.fractional]`: a fractional model as the series that represents it over a band.

use super::document::block;
use super::document::reader::TableReader;
use super::keys::fractional::{FRACTIONAL_MODEL, FractionalKeys, FractionalModel, SECOND_EXPONENT};
use super::keys::material::EQUILIBRIUM;
use crate::material::fractional::{Fractional, FractionalError, Represented};
use crate::material::{Compressibility, Material, MaterialError};

/// Reads the table: the material but for its Poisson ratio. `None` where a problem was reported.
pub(super) fn read(
    table: &mut TableReader<'_>,
) -> Option<impl FnOnce(Compressibility) -> Result<Material, MaterialError> + use<>> {
    let model = table.value(&FRACTIONAL_MODEL);
    let keys: Option<FractionalKeys> = block::read_from(table, None);
    let model = model?;
    let (mut equilibrium_pa, mut second_exponent) = (Some(0.0), Some(0.0));
    match model {
        FractionalModel::Springpot => {}
        FractionalModel::Zener => equilibrium_pa = table.value(&EQUILIBRIUM),
        FractionalModel::Maxwell => second_exponent = table.value(&SECOND_EXPONENT),
    }
    let keys = keys?;
    let (stiffness_pa, time_s, exponent) = (keys.stiffness_pa, keys.time_s, keys.exponent);
    let made = match model {
        FractionalModel::Springpot => Fractional::springpot(stiffness_pa, time_s, exponent),
        FractionalModel::Zener => {
            Fractional::zener(equilibrium_pa?, stiffness_pa, time_s, exponent)
        }
        FractionalModel::Maxwell => {
            Fractional::maxwell(stiffness_pa, time_s, exponent, second_exponent?)
        }
    };
    let place = table.value_place("exponent")?;
    let made = table.problems().accept(&place, made)?;
    let represented = represent(table, &made, &keys)?;
    Some(move |nu| represented.material(keys.kind, nu))
}

fn represent(
    table: &mut TableReader<'_>,
    model: &Fractional,
    keys: &FractionalKeys,
) -> Option<Represented> {
    let [low, high] = keys.band_rad_per_s[..] else {
        return None;
    };
    match model.represent((low, high), keys.accuracy) {
        Ok(represented) => Some(represented),
        Err(error) => {
            let help = match error {
                FractionalError::TooManyBranches { .. } => {
                    "narrow the band to the frequencies that you compute at, or allow a larger error with `accuracy`; for an exponent \
                     that is nearly 1 write 1"
                }
                _ => "write the lowest frequency first: band = [\"1e-3 rad/s\", \"1e5 rad/s\"]",
            };
            let place = table.value_place("band")?;
            table.problems().at(&place, error.to_string()).help(help);
            None
        }
    }
}
