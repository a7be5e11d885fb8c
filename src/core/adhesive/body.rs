//! The memory of a body in two forms: as the branches of its creep compliance, driven by the force of a spring, and as those of its
//! relaxation modulus, driven by the displacement.
//!
//! Both are the state of the same body, and either follows from the other by a matrix. With the force q = 0 of a branch of creep
//! m_j' = (q - m_j) / lambda_j and the displacement of a branch of relaxation e_k' = (u - e_k) / tau_k,
//!
//! ```text
//! e_k = sum of C_j lambda_j / (lambda_j - tau_k) m_j        m_j = sum of E_k tau_k / (lambda_j - tau_k) e_k
//! ```

use nalgebra::DMatrix;

use crate::material::{Creep, MaterialError};

/// A body in both forms.
#[derive(Debug, Clone)]
pub struct Body {
    pub instantaneous_compliance_per_pa: f64,
    pub compliances_per_pa: Vec<f64>,
    pub retardation_times_s: Vec<f64>,
    pub equilibrium_modulus_pa: f64,
    pub moduli_pa: Vec<f64>,
    pub relaxation_times_s: Vec<f64>,
    /// Row by row.
    displacements_of_forces: Vec<f64>,
    forces_of_displacements: Vec<f64>,
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
            branches.push(crate::material::CreepBranch {
                compliance_per_pa: time_s / viscosity_pa_s,
                time_s,
            });
        }
        let creep = Creep::new(instantaneous, branches, None)?;
        let relaxation = creep.to_relaxation()?;
        let (retarded, relaxed) = (creep.branches(), relaxation.branches());
        let to_displacements = relaxed.iter().flat_map(|r| {
            let of = |c: &crate::material::CreepBranch| {
                c.compliance_per_pa * c.time_s / (c.time_s - r.time_s)
            };
            retarded.iter().map(of)
        });
        let to_forces = retarded.iter().flat_map(|c| {
            let of = |r: &crate::material::RelaxationBranch| {
                r.modulus_pa * r.time_s / (c.time_s - r.time_s)
            };
            relaxed.iter().map(of)
        });
        Ok(Self {
            instantaneous_compliance_per_pa: instantaneous,
            compliances_per_pa: retarded.iter().map(|b| b.compliance_per_pa).collect(),
            retardation_times_s: retarded.iter().map(|b| b.time_s).collect(),
            equilibrium_modulus_pa: relaxation.equilibrium_modulus(),
            moduli_pa: relaxed.iter().map(|b| b.modulus_pa).collect(),
            relaxation_times_s: relaxed.iter().map(|b| b.time_s).collect(),
            displacements_of_forces: to_displacements.collect(),
            forces_of_displacements: to_forces.collect(),
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
            displacements_of_forces: Vec::new(),
            forces_of_displacements: Vec::new(),
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

    /// Both maps, to displacements and to forces.
    pub(super) fn maps(&self) -> (DMatrix<f64>, DMatrix<f64>) {
        let of = |rows: &[f64]| DMatrix::from_row_slice(self.branches(), self.branches(), rows);
        (
            of(&self.displacements_of_forces),
            of(&self.forces_of_displacements),
        )
    }

    /// What the past adds to the displacement (m) of a spring with these forces (N/m) of its branches.
    pub fn retarded_m(&self, forces: &[f64]) -> f64 {
        dot(&self.compliances_per_pa, forces)
    }

    /// Force (N/m) of a spring that is displaced by `displacement_m` from where it is free, and its branches of relaxation by these.
    pub fn force(&self, displacement_m: f64, displacements_m: &[f64]) -> f64 {
        let branches = self.moduli_pa.iter().zip(displacements_m);
        let relaxing = branches.map(|(modulus, e)| modulus * (displacement_m - e));
        self.equilibrium_modulus_pa * displacement_m + relaxing.sum::<f64>()
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn multiply(matrix: &[f64], vector: &[f64], product: &mut [f64]) {
    let rows = matrix.chunks_exact(vector.len().max(1));
    for (entry, row) in product.iter_mut().zip(rows) {
        *entry = dot(row, vector);
    }
}
