//! COMSOL Multiphysics: the table of branches of the Viscoelasticity node (generalized Maxwell).
//!
//! COMSOL Structural Mechanics Module User's Guide, "Viscoelasticity" (5.3 and later): "Load from file" reads a text file of three columns
//! apart by blanks, the number of the branch, its shear modulus, its relaxation time. The branches act in parallel to the elastic material
//! of the parent node, whose stiffness is the equilibrium (long-term) one ("Linear Viscoelasticity" of the theory chapter). Shift function
//! Williams-Landel-Ferry: Tref, C1WLF, C2WLF.

use super::number::{digits, rounded};
use super::{Export, ExportError, Relaxation, RelaxationBranch, Series};

pub(super) fn export(series: &Series<'_>) -> Result<Export, ExportError> {
    if series.own.is_fluid() {
        let program = series.program.title();
        return Err(ExportError::Fluid { program });
    }
    let nu = series.nu;
    let equilibrium_pa = rounded(series.longitudinal.equilibrium_modulus());
    let young = digits(equilibrium_pa);
    let mut text = String::new();
    let mut branches = Vec::new();
    for (index, branch) in series.shear.branches().iter().enumerate() {
        let (shear_pa, time_s) = (rounded(branch.modulus_pa), rounded(branch.time_s));
        let number = index + 1;
        text.push_str(&format!(
            "{number} {} {}\n",
            digits(shear_pa),
            digits(time_s)
        ));
        branches.push(RelaxationBranch {
            modulus_pa: shear_pa * (2.0 * (1.0 + nu)),
            time_s,
        });
    }
    let mut remarks = vec![
        format!(
            "For \"Load from file\" of the Viscoelasticity node: branch, shear modulus, relaxation time. Delete these lines if your version \
             does not pass over lines that begin with %. Parent node: linear elastic material with E = {young} Pa, which is the long-term \
             stiffness, and nu = {nu:?}."
        ),
        match series.is_incompressible() {
            true => "Poisson ratio 0.5: the parent node needs the mixed formulation for incompressible materials.".to_owned(),
            false => "Constant Poisson ratio: choose viscoelastic strains \"Volumetric and deviatoric\", with bulk moduli in the ratio \
                      K/G = 2(1 + nu)/(3(1 - 2 nu)); with deviatoric strains alone the bulk modulus does not relax, and E* is another."
                .to_owned(),
        },
    ];
    if let Some([reference, c1, c2]) = series.wlf() {
        remarks.push(format!(
            "Shift function Williams-Landel-Ferry: Tref = {reference} K, C1WLF = {c1}, C2WLF = {c2} K."
        ));
    }
    let made = Relaxation::new(equilibrium_pa, branches)?;
    Ok(series.export(&text, &made, remarks))
}
