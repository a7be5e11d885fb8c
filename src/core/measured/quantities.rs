//! What is read from a cycle: loss, phase, amplitudes, means, harmonics, extrema, moduli; one list for single cycles, means and
//! uncertainties.

use num_complex::Complex;

use crate::cycle::{Extrema, Harmonics};
use crate::sweep::record::error_bars::Quantity as OfCase;

macro_rules! quantities {
    ($($quantity:ident: $column:expr, $name:literal;)*) => {
        /// A number of a cycle.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Quantity {
            $($quantity,)*
        }

        impl Quantity {
            /// In the order of their columns, each with its column in SI units and its name in sentences.
            pub const ALL: [(Self, &'static str, &'static str); [$($name),*].len()] =
                [$((Self::$quantity, $column, $name)),*];
        }
    };
}

quantities! {
    EnergyLoss: OfCase::EnergyLoss.column(), "energy loss";
    PhaseLag: OfCase::PhaseLag.column(), "phase lag";
    LoadMean: "load_mean_n", "mean load";
    LoadAmplitude: "load_amplitude_n", "amplitude of the load";
    ApproachMean: "approach_mean_m", "mean approach";
    ApproachAmplitude: "approach_amplitude_m", "amplitude of the approach";
    Harmonic2: OfCase::Harmonic2.column(), "second harmonic";
    Harmonic3: OfCase::Harmonic3.column(), "third harmonic";
    Harmonic4: "harmonic_4", "fourth harmonic";
    Harmonic5: "harmonic_5", "fifth harmonic";
    HarmonicPhase2: "harmonic_2_phase_rad", "phase of the second harmonic";
    HarmonicPhase3: "harmonic_3_phase_rad", "phase of the third harmonic";
    HarmonicPhase4: "harmonic_4_phase_rad", "phase of the fourth harmonic";
    HarmonicPhase5: "harmonic_5_phase_rad", "phase of the fifth harmonic";
    ApproachMin: OfCase::ApproachMin.column(), "smallest approach";
    ApproachMax: OfCase::ApproachMax.column(), "largest approach";
    ContactRadius: "contact_radius_m", "contact radius";
    StorageModulus: OfCase::StorageModulus.column(), "storage modulus";
    LossModulus: OfCase::LossModulus.column(), "loss modulus";
}

use Quantity::*;

impl Quantity {
    /// Its column in SI units.
    pub const fn column(self) -> &'static str {
        Self::ALL[self as usize].1
    }

    /// Its place among the values of a cycle.
    pub fn place(self) -> usize {
        self as usize
    }

    /// Whether it is an angle, which is the same after a turn.
    pub(super) fn is_angle(self) -> bool {
        matches!(
            self,
            PhaseLag | HarmonicPhase2 | HarmonicPhase3 | HarmonicPhase4 | HarmonicPhase5
        )
    }
}

/// Size and phase of the harmonics of the approach, from the second on.
pub(super) const HARMONICS_OF_APPROACH: [(Quantity, Quantity); 4] = [
    (Harmonic2, HarmonicPhase2),
    (Harmonic3, HarmonicPhase3),
    (Harmonic4, HarmonicPhase4),
    (Harmonic5, HarmonicPhase5),
];

/// The value of every quantity; `None` where there is none.
pub type Values = [Option<f64>; Quantity::ALL.len()];

/// Samples of a cycle by which its extrema are found.
const SAMPLES: usize = 128;

impl Harmonics {
    /// Everything that is read from the cycle, with this contact radius (m) and modulus (Pa).
    pub(super) fn values(&self, contact: Option<(f64, Complex<f64>)>) -> Values {
        let mut values = [None; Quantity::ALL.len()];
        let (Some(load), Some(approach)) = (self.load_n.first(), self.approach_m.first()) else {
            return values;
        };
        let (_, samples) = self.sampled(SAMPLES);
        let extrema = Extrema::of(&samples);
        let mut set = |quantity: Quantity, value: Option<f64>| {
            values[quantity.place()] = value.filter(|value| value.is_finite());
        };
        set(EnergyLoss, Some(self.energy_loss_j()));
        set(PhaseLag, Some(self.phase_lag_rad()));
        set(LoadMean, Some(self.load_mean_n));
        set(LoadAmplitude, Some(load.norm()));
        set(ApproachMean, Some(self.approach_mean_m));
        set(ApproachAmplitude, Some(approach.norm()));
        set(ApproachMin, extrema.map(|e| e.minimum));
        set(ApproachMax, extrema.map(|e| e.maximum));
        for (n, (ratio, phase)) in (2..).zip(HARMONICS_OF_APPROACH) {
            let harmonic = self.approach_m.get(n - 1);
            set(ratio, harmonic.map(|a| a.norm() / approach.norm()));
            // From the instant at which the first harmonic of the load passes its mean upwards.
            let turned = |a: &Complex<f64>| (a * Complex::cis(-(n as f64) * load.arg())).arg();
            set(phase, harmonic.map(turned));
        }
        if let Some((radius_m, modulus_pa)) = contact {
            set(ContactRadius, Some(radius_m));
            set(StorageModulus, Some(modulus_pa.re));
            set(LossModulus, Some(modulus_pa.im));
        }
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cycle;
    use crate::measured::moduli::{Contact, Radius};

    fn cycle_of_harmonics() -> Harmonics {
        let polar = Complex::from_polar;
        Harmonics {
            load_mean_n: 3.0,
            approach_mean_m: 2e-6,
            load_n: vec![polar(1.0, 0.4), polar(0.1, 1.0), polar(0.02, 0.0)],
            approach_m: vec![polar(5e-7, 0.2), polar(6e-8, -1.0), polar(1e-8, 2.0)],
        }
    }

    #[test]
    fn the_numbers_are_those_of_the_analysis_of_samples() {
        let harmonics = cycle_of_harmonics();
        let (load, approach) = harmonics.sampled(64);
        let analysis = cycle::analyse(&load, &approach).unwrap();
        let contact = Contact {
            poisson_ratio: 0.3,
            radius: Radius::Column,
            indenter: None,
            indenter_material: None,
            bias: false,
        };
        let modulus_pa = contact.modulus_pa(&harmonics, 1e-4, 1.0).unwrap();
        let values = harmonics.values(Some((1e-4, modulus_pa)));
        let near = |quantity: Quantity, expected: f64| {
            let value = values[quantity.place()].unwrap();
            assert!((value / expected - 1.0).abs() < 1e-11, "{quantity:?}");
        };
        near(EnergyLoss, analysis.energy_loss_j);
        near(PhaseLag, analysis.phase_lag_rad);
        near(ApproachMean, analysis.approach_mean_m);
        near(Harmonic2, analysis.approach_harmonic(2).unwrap());
        near(Harmonic3, analysis.approach_harmonic(3).unwrap());
        let moduli = analysis.equivalent_moduli_pa(1e-4, 0.3).unwrap();
        near(StorageModulus, moduli.0);
        near(LossModulus, moduli.1);
        near(HarmonicPhase2, -1.0 - 2.0 * 0.4);
        assert_eq!(values[Harmonic4.place()], None);
        assert_eq!(harmonics.values(None)[LossModulus.place()], None);
    }

    #[test]
    fn every_quantity_stands_at_its_place() {
        for (place, (quantity, ..)) in Quantity::ALL.iter().enumerate() {
            assert_eq!(quantity.place(), place);
        }
    }
}
