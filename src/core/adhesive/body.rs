//! The memory of a body in two forms: as the branches of its creep compliance, driven by the force of a spring, and as those of its
//! relaxation modulus, driven by the displacement.
//!
//! Both are the state of the same body, and either follows from the other by a matrix. With the force q = 0 of a branch of creep
//! m_j' = (q - m_j) / lambda_j and the displacement of a branch of relaxation e_k' = (u - e_k) / tau_k,
//!
//! ```text
//! e_k = sum of C_j lambda_j / (lambda_j - tau_k) m_j        m_j = sum of E_k tau_k / (lambda_j - tau_k) e_k
//! ```

use nalgebra::{DMatrix, DVectorView, DVectorViewMut};

use crate::material::{Creep, CreepBranch, MaterialError};

/// A body in both forms.
#[derive(Debug, Clone)]
pub struct Body {
    pub instantaneous_compliance_per_pa: f64,
    pub compliances_per_pa: Vec<f64>,
    pub retardation_times_s: Vec<f64>,
    pub equilibrium_modulus_pa: f64,
    pub moduli_pa: Vec<f64>,
    pub relaxation_times_s: Vec<f64>,
    /// What makes displacements of relaxation of forces of creep, and the inverse.
    pub(super) displacements_of_forces: DMatrix<f64>,
    pub(super) forces_of_displacements: DMatrix<f64>,
}

impl Body {
    /// What a spring is made stiffer or slower by, relative, of a body that answers at once with no displacement, or flows for ever.
    const SPARE: f64 = 1e-6;

    /// A body of this contact compliance, seen at times about `time_s`: one that is rigid at once yields by 1e-6 of what it yields in
    /// this time, and one that flows comes to rest after 1e6 such times.
    ///
    /// # Errors
    /// [`MaterialError`] of a compliance that has no relaxation modulus in doubles.
    pub fn new(creep: &Creep, time_s: f64) -> Result<Self, MaterialError> {
        let mut instantaneous = creep.instantaneous_compliance();
        let mut branches = creep.branches().to_vec();
        if instantaneous == 0.0 {
            instantaneous = Self::SPARE * creep.compliance(time_s);
        }
        if let Some(viscosity_pa_s) = creep.viscosity_pa_s() {
            let longest_s = branches.last().map_or(time_s, |b| b.time_s.max(time_s));
            let time_s = longest_s / Self::SPARE;
            branches.push(CreepBranch {
                compliance_per_pa: time_s / viscosity_pa_s,
                time_s,
            });
        }
        let creep = Creep::new(instantaneous, branches, None)?;
        let relaxation = creep.to_relaxation()?;
        let (retarded, relaxed) = (creep.branches(), relaxation.branches());
        let count = retarded.len();
        let displacements_of_forces = DMatrix::from_fn(count, count, |k, j| {
            let (c, relaxation_s) = (retarded[j], relaxed[k].time_s);
            c.compliance_per_pa * c.time_s / (c.time_s - relaxation_s)
        });
        let forces_of_displacements = DMatrix::from_fn(count, count, |j, k| {
            let (r, retardation_s) = (relaxed[k], retarded[j].time_s);
            r.modulus_pa * r.time_s / (retardation_s - r.time_s)
        });
        Ok(Self {
            instantaneous_compliance_per_pa: instantaneous,
            compliances_per_pa: retarded.iter().map(|b| b.compliance_per_pa).collect(),
            retardation_times_s: retarded.iter().map(|b| b.time_s).collect(),
            equilibrium_modulus_pa: relaxation.equilibrium_modulus(),
            moduli_pa: relaxed.iter().map(|b| b.modulus_pa).collect(),
            relaxation_times_s: relaxed.iter().map(|b| b.time_s).collect(),
            displacements_of_forces,
            forces_of_displacements,
        })
    }

    /// The elastic body that this one is after an infinite time.
    pub fn relaxed(&self) -> Self {
        Self {
            instantaneous_compliance_per_pa: self.equilibrium_modulus_pa.recip(),
            compliances_per_pa: Vec::new(),
            retardation_times_s: Vec::new(),
            equilibrium_modulus_pa: self.equilibrium_modulus_pa,
            moduli_pa: Vec::new(),
            relaxation_times_s: Vec::new(),
            displacements_of_forces: DMatrix::zeros(0, 0),
            forces_of_displacements: DMatrix::zeros(0, 0),
        }
    }

    /// Number of branches, of either form.
    pub fn branches(&self) -> usize {
        self.moduli_pa.len()
    }

    /// Displacements (m) of the branches of relaxation, from the forces (N/m) of those of creep.
    pub fn displacements_m(&self, forces: &[f64], displacements_m: &mut [f64]) {
        multiply(&self.displacements_of_forces, forces, displacements_m);
    }

    /// Forces (N/m) of the branches of creep, from the displacements (m) of those of relaxation.
    pub fn forces(&self, displacements_m: &[f64], forces: &mut [f64]) {
        multiply(&self.forces_of_displacements, displacements_m, forces);
    }

    /// What the past adds to the displacement (m) of a spring with these forces (N/m) of its branches.
    pub fn retarded_m(&self, forces: &[f64]) -> f64 {
        let branches = self.compliances_per_pa.iter().zip(forces);
        branches.map(|(per_pa, force)| per_pa * force).sum()
    }

    /// Force (N/m) of a spring that is displaced by `displacement_m` from where it is free, and its branches of relaxation by these.
    pub fn force(&self, displacement_m: f64, displacements_m: &[f64]) -> f64 {
        let branches = self.moduli_pa.iter().zip(displacements_m);
        let relaxing = branches.map(|(modulus, e)| modulus * (displacement_m - e));
        self.equilibrium_modulus_pa * displacement_m + relaxing.sum::<f64>()
    }
}

fn multiply(matrix: &DMatrix<f64>, vector: &[f64], product: &mut [f64]) {
    let count = vector.len();
    let vector = DVectorView::from_slice(vector, count);
    DVectorViewMut::from_slice(product, count).gemv(1.0, matrix, &vector, 0.0);
}
