//! CSV: columns `modulus_pa`, `time_s`, the equilibrium modulus first, with an empty time. Moduli are of the material's own kind, and every
//! digit is kept.

use super::{Export, ExportError, Series};

pub(super) fn export(series: &Series<'_>) -> Result<Export, ExportError> {
    let mut text = format!(
        "modulus_pa,time_s\n{:?},\n",
        series.own.equilibrium_modulus()
    );
    for branch in series.own.branches() {
        text.push_str(&format!("{:?},{:?}\n", branch.modulus_pa, branch.time_s));
    }
    let remark = format!(
        "Poisson ratio {:?}, which the table does not hold.",
        series.nu
    );
    // The shortest text that reads as the same double.
    Ok(series.export(&text, &series.longitudinal, vec![remark]))
}
