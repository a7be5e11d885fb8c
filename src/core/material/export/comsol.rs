//! COMSOL Multiphysics: the table of branches of the Viscoelasticity node (generalized Maxwell).
//!
//! COMSOL Structural Mechanics Module User's Guide, "Viscoelasticity" (5.3 and later): "Load from file" reads a text file of three columns
//! apart by blanks, the number of the branch, its shear modulus, its relaxation time. The branches act in parallel to the elastic material
//! of the parent node, whose stiffness is the equilibrium (long-term) one ("Linear Viscoelasticity" of the theory chapter). Shift function
//! Williams-Landel-Ferry: Tref, C1WLF, C2WLF.

use super::number::Printed;
use super::{Draft, ExportError, Relaxation, RelaxationBranch, Series};

pub(super) fn draft(series: &Series<'_>) -> Result<Draft, ExportError> {
    if series.own.is_fluid() {
        let program = series.program.title();
        return Err(ExportError::Fluid { program });
    }
    let young = Printed::free(series.longitudinal.equilibrium_modulus());
    let nu = series.nu;
    let longitudinal_over_shear = 2.0 * (1.0 + nu);
    let mut text = String::new();
    let mut written = Vec::new();
    for (index, branch) in series.shear.branches().iter().enumerate() {
        let (shear, time) = (
            Printed::free(branch.modulus_pa),
            Printed::free(branch.time_s),
        );
        text.push_str(&format!("{} {shear} {time}\n", index + 1));
        written.push(RelaxationBranch {
            modulus_pa: shear.value * longitudinal_over_shear,
            time_s: time.value,
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
    Ok(Draft {
        text,
        written: Relaxation::new(young.value, written)?,
        remarks,
        comment: Some("%"),
    })
}
