//! CSV: columns `modulus_pa`, `time_s`, the equilibrium modulus first, with an empty time. Moduli are of the material's own kind, and every
//! digit is kept.

use super::{Draft, ExportError, Series};

pub(super) fn draft(series: &Series<'_>) -> Result<Draft, ExportError> {
    let mut text = format!(
        "modulus_pa,time_s\n{:?},\n",
        series.own.equilibrium_modulus()
    );
    for branch in series.own.branches() {
        text.push_str(&format!("{:?},{:?}\n", branch.modulus_pa, branch.time_s));
    }
    Ok(Draft {
        text,
        // The shortest text that reads as the same double.
        written: series.longitudinal.clone(),
        remarks: vec![format!(
            "Poisson ratio {:?}, which the table does not hold.",
            series.nu()
        )],
        comment: None,
    })
}
