//! ANSYS Mechanical APDL: `MP,EX` and `MP,PRXY` as the instantaneous elasticity, `TB,PRONY` twice, `TB,SHIFT` for the shift.
//!
//! ANSYS Mechanical APDL Material Reference, "Viscoelasticity": `TB,PRONY,MAT,NTEMP,NPTS,SHEAR` or `BULK`, with `TBDATA` giving pairs of
//! relative modulus alpha_i and relaxation time tau_i, at most six constants a command and 100 pairs; `G(t) = G_0 (alpha_inf + sum
//! alpha_i exp(-t/tau_i))` with G_0 from EX and PRXY. `TB,SHIFT,MAT,NTEMP,3,WLF` with `TBDATA,1,Tr,C1,C2`, where `log10 A = C1 (T -
//! Tr)/(C2 + T - Tr)` and time is multiplied by A, the reciprocal of a_T: so C1 and C2 are those of WLF as they stand. S. Imaoka,
//! "Viscoelasticity", memo STI0807B (ANSYS 11.0, 2008), has examples.

use super::{Export, ExportError, Ratios, Series};

const MOST_PAIRS: usize = 100;
/// Two constants each, of the six that one `TBDATA` takes.
const PAIRS_PER_COMMAND: usize = 3;

pub(super) fn export(series: &Series<'_>) -> Result<Export, ExportError> {
    series.bulk_over_shear(
        "EX and PRXY of an incompressible material make an infinite bulk modulus",
    )?;
    let Ratios { young, pairs, made } = series.ratios()?;
    series.at_most(MOST_PAIRS, pairs.len())?;
    let mut text = format!("MP,EX,1,{young}\nMP,PRXY,1,{:?}\n", series.nu);
    let kinds = ["SHEAR", "BULK"].into_iter();
    for kind in kinds.filter(|_| !pairs.is_empty()) {
        text.push_str(&format!("TB,PRONY,1,1,{},{kind}\n", pairs.len()));
        for (command, pairs) in pairs.chunks(PAIRS_PER_COMMAND).enumerate() {
            let first = 2 * PAIRS_PER_COMMAND * command + 1;
            text.push_str(&format!("TBDATA,{first},{}\n", pairs.concat().join(",")));
        }
    }
    let mut remarks = vec![
        "Constant Poisson ratio: the same relative moduli in shear and in bulk. EX is the instantaneous modulus. Read in /PREP7; \
         the material has the number 1."
            .to_owned(),
    ];
    if let (Some(wlf), false) = (series.wlf(), pairs.is_empty()) {
        text.push_str(&format!("TB,SHIFT,1,1,3,WLF\nTBDATA,1,{}\n", wlf.join(",")));
        remarks.push("Temperatures of the model must be in K, as that of TB,SHIFT.".to_owned());
    }
    Ok(series.export(&text, &made, remarks))
}
