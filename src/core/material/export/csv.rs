//! CSV: columns `modulus_pa`, `time_s`, the equilibrium modulus first, with an empty time. Moduli are of the material's own kind, and every
//! digit is kept.

use super::{Draft, Series};

pub(super) fn draft(series: &Series<'_>) -> Draft {
    let mut text = format!(
        "modulus_pa,time_s\n{:?},\n",
        series.own.equilibrium_modulus()
    );
    for branch in series.own.branches() {
        text.push_str(&format!("{:?},{:?}\n", branch.modulus_pa, branch.time_s));
    }
    Draft {
        text,
        // The shortest text that reads as the same double.
        written: series.longitudinal.clone(),
        remarks: vec![format!(
            "Poisson ratio {:?}, which the table does not hold.",
            series.nu
        )],
        comment: None,
    }
}
