//! LS-DYNA: `*MAT_GENERAL_VISCOELASTIC` (076).
//!
//! LS-DYNA Keyword User's Manual, volume II, `*MAT_076`: `G(t) = sum G_i exp(-BETA_i t)`, `K(t) = sum K_i exp(-BETAK_i t)` with
//! `BETA_i = 1/tau_i`, at most 18 terms, the equilibrium modulus being one with `BETA_i = 0`. Card 1: MID, RO, BULK, PCF, EF, TREF, A,
//! B; card 2, the fit by the program, is blank; then one card a term: GI, BETAI, KI, BETAKI. Fields have ten columns (layout checked
//! against the definition of the keyword in ansys/pydyna, `mat_general_viscoelastic.py`).
//!
//! The manual's shift function of TREF, A and B has a natural exponential and signs of its own, which could not be verified; so they are
//! left out, and the constants stand in a comment. The density is not known to a material of contact mechanics: the field refers to a
//! parameter, which a model without `*PARAMETER` does not run with.

use super::number::{ten_columns, value};
use super::{Export, ExportError, Relaxation, RelaxationBranch, Series};

const MOST_TERMS: usize = 18;

pub(super) fn export(series: &Series<'_>) -> Result<Export, ExportError> {
    let bulk_over_shear = series.bulk_over_shear("its bulk moduli K_i must be finite")?;
    // (modulus, decay constant), slowest first.
    let mut terms = vec![(series.shear.equilibrium_modulus(), 0.0)];
    terms.retain(|(modulus, _)| *modulus > 0.0);
    let branches = series.shear.branches().iter().rev();
    terms.extend(branches.map(|branch| (branch.modulus_pa, branch.time_s.recip())));
    series.at_most(MOST_TERMS, terms.len())?;
    let bulk = ten_columns(series.shear.instantaneous_modulus() * bulk_over_shear);
    let mut text = format!("*MAT_GENERAL_VISCOELASTIC_TITLE\n{:.80}\n", series.title());
    text.push_str(
        "$#     mid        ro      bulk       pcf        ef      tref         a         b\n",
    );
    text.push_str(&format!("{:>10}{:>10}{bulk:>10}\n", 1, "&density"));
    text.push_str(
        "$#    lcid        nt    bstart     tramp     lcidk       ntk   bstartk    trampk\n\n",
    );
    text.push_str("$#      gi     betai        ki    betaki\n");
    let mut equilibrium_pa = 0.0;
    let mut branches = Vec::new();
    for (shear, decay) in terms {
        let terms = [shear, decay, shear * bulk_over_shear].map(ten_columns);
        let [gi, beta, ki] = &terms;
        text.push_str(&format!("{gi:>10}{beta:>10}{ki:>10}{beta:>10}\n"));
        let [shear, decay, bulk] = terms.map(|term| value(&term));
        let young = 9.0 * bulk * shear / (3.0 * bulk + shear);
        match decay == 0.0 {
            true => equilibrium_pa = young,
            false => branches.push(RelaxationBranch {
                modulus_pa: young,
                time_s: decay.recip(),
            }),
        }
    }
    let mut remarks = vec![
        "Constant Poisson ratio: bulk and shear terms in one ratio, with the same decay constants 1/tau_i; the term with decay \
         constant 0 is the equilibrium. BULK is the instantaneous bulk modulus."
            .to_owned(),
        "Define the density, which is not known here: *PARAMETER with `R density` and your value.".to_owned(),
    ];
    if series.shift.is_some() {
        remarks.push(
            "TREF, A and B are left blank, so the card holds at Tr alone: enter the shift as the manual of your version defines A and B."
                .to_owned(),
        );
    }
    let made = Relaxation::new(equilibrium_pa, branches)?;
    Ok(series.export(&text, &made, remarks))
}
