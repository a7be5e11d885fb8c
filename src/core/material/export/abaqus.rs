//! Abaqus: `*ELASTIC, MODULI=INSTANTANEOUS` and `*VISCOELASTIC, TIME=PRONY`, with `*TRS` for the shift.
//!
//! Abaqus Keywords Reference, `*VISCOELASTIC` (data lines of `TIME=PRONY`: modulus ratio g_i of the shear relaxation modulus, modulus
//! ratio k_i of the bulk relaxation modulus, relaxation time tau_i; any number of lines), `*ELASTIC` and `*TRS` (DEFINITION=WLF:
//! reference temperature, C1, C2); Abaqus Analysis User's Guide, "Time domain viscoelasticity": `g(t) = 1 - sum g_i (1 -
//! exp(-t/tau_i))`, the ratios being those to the instantaneous modulus. A number has at most 20 characters.

use super::{Export, ExportError, Ratios, Series};

pub(super) fn export(series: &Series<'_>) -> Result<Export, ExportError> {
    let Ratios { young, pairs, made } = series.ratios()?;
    let mut text = format!(
        "*MATERIAL, NAME={}\n*ELASTIC, MODULI=INSTANTANEOUS\n{young}, {:?}\n",
        series.label(),
        series.nu
    );
    if !pairs.is_empty() {
        text.push_str("*VISCOELASTIC, TIME=PRONY\n");
    }
    for [ratio, time] in &pairs {
        text.push_str(&format!("{ratio}, {ratio}, {time}\n"));
    }
    let mut remarks = vec![
        "Constant Poisson ratio: shear and bulk relax alike, g_i = k_i. Ratios are those to the instantaneous modulus.".to_owned(),
    ];
    if series.is_incompressible() {
        remarks.push(
            "Poisson ratio 0.5: Abaqus/Standard takes it with hybrid elements; Abaqus/Explicit needs a ratio below 0.5, which is yours \
             to choose."
                .to_owned(),
        );
    }
    if let (Some(wlf), false) = (series.wlf(), pairs.is_empty()) {
        text.push_str(&format!("*TRS, DEFINITION=WLF\n{}\n", wlf.join(", ")));
        remarks.push("Temperatures of the model must be in K, as that of *TRS.".to_owned());
    }
    Ok(series.export(&text, &made, remarks))
}
