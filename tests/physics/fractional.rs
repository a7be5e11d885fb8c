//! Fractional models: the loss under a flat punch against the model's own loss compliance, in closed form, all over the band and at its
//! ends.
//!
//! `MODELS=100 SEED=1 cargo test --release --test physics fractional -- --nocapture` tries and prints as many as asked for.

use crate::prelude::*;
use contact_dma::material::fractional::Fractional;

const RADIUS_M: f64 = 1e-3;
const AMPLITUDE_N: f64 = 0.5;
const POISSON_RATIO: f64 = 0.38;

/// A model that is a solid, its band and the accuracy of its series.
struct Given {
    model: Fractional,
    band: (f64, f64),
    accuracy: f64,
}

impl Given {
    fn random(random: &mut Random) -> Self {
        let exponent = random.between(0.05, 0.95);
        let ratio = random.power_of_ten(-1.0, 4.0);
        let model = Fractional::zener(1e9 / ratio, 1e9, 1.0, exponent).unwrap();
        let decades = random.between(2.0, 10.0);
        let low = 10_f64.powf(-decades * random.unit());
        Self {
            model,
            band: (low, low * 10_f64.powf(decades)),
            accuracy: random.power_of_ten(-6.0, -2.0),
        }
    }

    fn plan(&self) -> SweepPlan {
        let series = self.model.represent(self.band, self.accuracy).unwrap();
        let material = series.material(ModulusKind::Longitudinal, POISSON_RATIO);
        sweep_plan(material.unwrap(), punch(RADIUS_M), 1.0, AMPLITUDE_N)
    }

    /// pi A^2 C''/(2 R), with C = (1 - nu^2)/E.
    fn exact_loss_j(&self, omega: f64) -> f64 {
        let compliance = -self.model.complex_modulus(omega).inv().im;
        let contact = (1.0 - POISSON_RATIO * POISSON_RATIO) * compliance;
        PI * AMPLITUDE_N * AMPLITUDE_N * contact / (2.0 * RADIUS_M)
    }

    /// Both ends of the band, and three frequencies inside.
    fn frequencies(&self) -> [f64; 5] {
        let (low, high) = self.band;
        [0.0, 0.11, 0.5, 0.93, 1.0].map(|share| low * (high / low).powf(share))
    }
}

#[test]
fn the_loss_of_a_fractional_model_is_in_its_bar_all_over_the_band() {
    let mut random = Random(from_environment("SEED", 8));
    let models = (0..from_environment("MODELS", 10)).map(|_| Given::random(&mut random));
    let models: Vec<Given> = models.collect();
    models.par_iter().for_each(|given| {
        let plan = with_bars(given.plan());
        for omega in given.frequencies() {
            let result = result(&plan, omega);
            let (bar_j, exact_j) = (result.bar_j(), given.exact_loss_j(omega));
            let off_j = (result.loss_j() - exact_j).abs();
            assert!(off_j <= bar_j, "{omega}: {off_j:e}, bar {bar_j:e}");
            // The bar is that of the series and of the cycle, and not of anything far larger.
            below!(bar_j / exact_j, given.accuracy + 1e-3, "{omega}");
        }
    });
}

#[test]
fn an_accuracy_counts_what_the_series_misses() {
    let given = |accuracy: f64| Given {
        model: Fractional::zener(1e9, 2e9, 1.0, 0.9).unwrap(),
        band: (1e-4, 1e4),
        accuracy,
    };
    let at_end = |of_series: f64| {
        let given = given(of_series);
        let mut plan = given.plan();
        plan.cycle.accuracy = Some(1e-4);
        (run_case(&plan, 1e4), given.exact_loss_j(1e4))
    };
    let (coarse, _) = at_end(1e-2);
    assert!(coarse.result.is_none());
    let why = coarse.message.unwrap();
    for part in ["the material alone", "[material.fractional]"] {
        assert!(why.contains(part), "{why}");
    }
    let (fine, exact_j) = at_end(1e-5);
    near!(fine.energy_loss_j().unwrap(), exact_j, 1e-4);
}

#[test]
fn a_fractional_indenter_brings_the_error_of_its_series_along() {
    let given = Given {
        model: Fractional::zener(1e9, 2e9, 1.0, 0.9).unwrap(),
        band: (1e-4, 1e4),
        accuracy: 1e-2,
    };
    let mut plan = with_bars(given.plan());
    let bar = |plan: &SweepPlan| {
        let result = result(plan, 1e4);
        let bar = result.errors.as_ref().unwrap().bar(Quantity::EnergyLoss);
        bar.unwrap().material / result.loss_j()
    };
    let body = bar(&plan);
    let indenter = plan.base.contact.material.as_ref().clone();
    // The same series as if it were exact.
    let plain = material_of(indenter.relaxation().unwrap().clone(), POISSON_RATIO);
    plan.base.contact.material = Arc::new(plain.against(indenter));
    // Half of the loss is the indenter's, and so is half of what its series misses.
    near!(bar(&plan), 0.5 * body, 0.01);
}
