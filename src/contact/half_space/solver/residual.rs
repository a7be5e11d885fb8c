//! How far a pressure is from the solution of an instant: gaps inside the contact, penetration outside.

use super::active_set::STANDING_OFF;

/// Sums over the contact that one iteration needs.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Residual {
    pub(super) cells: usize,
    /// The approach prescribed, or the mean over the contact of free gap + displacement (mean-gap correction).
    pub(super) approach_m: f64,
    /// Sum of the squared gaps inside the contact (m^2).
    pub(super) squared_gap: f64,
    /// Sums over the contact of p |gap|, of p u, of p (free gap + u), and of p.
    misfit: f64,
    work: f64,
    pub(super) lifted: f64,
    pub(super) pressure_sum: f64,
    /// Deepest penetration outside the contact, as a positive number (m).
    pub(super) penetration_m: f64,
    /// Highest gap under pressure, at least 0 (m).
    standing_off_m: f64,
}

/// One value per cell each.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'a> {
    pub(super) pressure: &'a [f64],
    /// g + B H (m).
    pub(super) free_gap_m: &'a [f64],
    /// B p, without the compliance.
    pub(super) displacement: &'a [f64],
}

impl Fields<'_> {
    /// Pressure, free gap, displacement of each cell in turn.
    fn cells(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let fields = self.pressure.iter().zip(self.free_gap_m);
        let fields = fields.zip(self.displacement);
        fields.map(|((&p, &free), &u)| (p, free, u))
    }
}

impl Residual {
    /// Gap sums for these fields; `approach_m` is prescribed or, under load control, found here.
    pub(super) fn of(fields: &Fields<'_>, compliance: f64, approach_m: Option<f64>) -> Self {
        let mut total = Self::default();
        let mut lifted_sum = 0.0;
        for (p, free, u) in fields.cells() {
            if p > 0.0 {
                let elastic = compliance * u;
                total.cells += 1;
                lifted_sum += free + elastic;
                total.work += p * elastic;
                total.lifted += p * (free + elastic);
                total.pressure_sum += p;
            }
        }
        total.approach_m = approach_m.unwrap_or(lifted_sum / total.cells.max(1) as f64);
        let mut lowest = 0.0_f64;
        for (p, free, u) in fields.cells() {
            let gap = free + compliance * u - total.approach_m;
            if p > 0.0 {
                total.squared_gap += gap * gap;
                total.misfit += p * gap.abs();
                total.standing_off_m = total.standing_off_m.max(gap);
            } else {
                lowest = lowest.min(gap);
            }
        }
        total.penetration_m = -lowest;
        total
    }

    /// What the tolerance bounds, gaps below `noise_m` counting as none; 0 out of contact, infinite where nothing is in
    /// contact yet but something penetrates.
    pub(super) fn relative(&self, tolerance: f64, noise_m: f64) -> f64 {
        if self.penetration_m <= 0.0 && self.misfit == 0.0 {
            return 0.0;
        }
        if self.work <= 0.0 {
            return f64::INFINITY;
        }
        let reference_m = self.work / self.pressure_sum + noise_m / tolerance;
        let standing_off_m = self.standing_off_m / STANDING_OFF;
        (self.misfit / self.pressure_sum)
            .max(standing_off_m)
            .max(self.penetration_m)
            / reference_m
    }
}
