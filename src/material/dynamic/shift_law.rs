//! Laws of the shift factors over temperature: Williams-Landel-Ferry and Arrhenius.

/// `log10 a_T = -c1 (T - Tr) / (c2 + T - Tr)` (M. L. Williams, R. F. Landel, J. D. Ferry, J. Am. Chem. Soc. 77 (1955) 3701).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wlf {
    pub reference_temperature_k: f64,
    pub c1: f64,
    pub c2_k: f64,
    /// Standard errors of both.
    pub c1_error: f64,
    pub c2_error_k: f64,
}

/// `ln a_T = (Ea / R) (1/T - 1/Tr)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arrhenius {
    pub reference_temperature_k: f64,
    pub activation_energy_j_per_mol: f64,
    pub activation_energy_error_j_per_mol: f64,
}

/// A law that shift factors were fitted with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ShiftLaw {
    Wlf(Wlf),
    Arrhenius(Arrhenius),
}

/// Gas constant (J/(mol K)), exact since 2019.
pub const GAS_CONSTANT: f64 = 8.314_462_618;

impl Wlf {
    /// Shift factor, where the law has one: above `Tr - c2`.
    pub fn log10_a_t(&self, temperature_k: f64) -> Option<f64> {
        let above = temperature_k - self.reference_temperature_k;
        let denominator = self.c2_k + above;
        (denominator > 0.0).then(|| -self.c1 * above / denominator)
    }
}

impl Arrhenius {
    /// Shift factor.
    pub fn log10_a_t(&self, temperature_k: f64) -> f64 {
        let difference = 1.0 / temperature_k - 1.0 / self.reference_temperature_k;
        self.activation_energy_j_per_mol / GAS_CONSTANT * difference / std::f64::consts::LN_10
    }
}
