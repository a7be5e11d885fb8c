//! Fractional models: the loss under a flat punch against the model's own loss compliance, in closed form, all over the band and at its
//! ends.
//!
//! `MODELS=100 SEED=1 cargo test --release --test physics fractional -- --nocapture` tries and prints as many as asked for.

use crate::common::solids::Random;
use crate::common::{from_environment, run_case, sweep_plan};
use contact_dma::indenter::FlatPunch;
use contact_dma::material::fractional::Fractional;
use contact_dma::material::{Compressibility, ModulusKind};
use contact_dma::sweep::plan::SweepPlan;
use contact_dma::sweep::record::error_bars::Quantity;
use rayon::prelude::*;
use std::sync::Arc;

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
        let material = series
            .material(ModulusKind::Longitudinal, POISSON_RATIO)
            .unwrap();
        let punch = Arc::new(FlatPunch::new(RADIUS_M).unwrap());
        sweep_plan(material, punch, 1.0, AMPLITUDE_N)
    }

    /// pi A^2 C''/(2 R), with C = (1 - nu^2)/E.
    fn exact_loss_j(&self, omega: f64) -> f64 {
        let compliance = -self.model.complex_modulus(omega).inv().im;
        let contact = (1.0 - POISSON_RATIO * POISSON_RATIO) * compliance;
        std::f64::consts::PI * AMPLITUDE_N * AMPLITUDE_N * contact / (2.0 * RADIUS_M)
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
    let found: Vec<(f64, f64, f64)> = models
        .par_iter()
        .flat_map_iter(|given| {
            let mut plan = given.plan();
            plan.cycle.error_bars = true;
            let found = given.frequencies().map(|omega| {
                let result = run_case(&plan, omega).result.unwrap();
                let bar_j = result.errors.unwrap().of(Quantity::EnergyLoss).unwrap();
                let exact_j = given.exact_loss_j(omega);
                let off = (result.analysis.energy_loss_j / exact_j - 1.0).abs();
                (off, bar_j / exact_j, given.accuracy)
            });
            found.into_iter()
        })
        .collect();
    let inside = found.iter().filter(|(off, bar, _)| off <= bar).count();
    println!("{inside} of {} inside their bars", found.len());
    for (off, bar, accuracy) in &found {
        assert!(off <= bar, "off {off:e}, bar {bar:e}, series {accuracy:e}");
        // The bar is that of the series and of the cycle, and not of anything far larger.
        assert!(*bar < accuracy + 1e-3, "bar {bar:e}, series {accuracy:e}");
    }
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
    assert!(
        why.contains("the material alone") && why.contains("[material.fractional]"),
        "{why}"
    );
    let (fine, exact_j) = at_end(1e-5);
    let loss_j = fine.result.unwrap().analysis.energy_loss_j;
    assert!(
        (loss_j / exact_j - 1.0).abs() < 1e-4,
        "{loss_j:e} {exact_j:e}"
    );
}

#[test]
fn a_fractional_indenter_brings_the_error_of_its_series_along() {
    let given = Given {
        model: Fractional::zener(1e9, 2e9, 1.0, 0.9).unwrap(),
        band: (1e-4, 1e4),
        accuracy: 1e-2,
    };
    let mut plan = given.plan();
    plan.cycle.error_bars = true;
    let bar = |plan: &SweepPlan| {
        let result = run_case(plan, 1e4).result.unwrap();
        let bar = result.errors.as_ref().unwrap().bar(Quantity::EnergyLoss);
        bar.unwrap().material / result.analysis.energy_loss_j
    };
    let body = bar(&plan);
    let indenter = plan.base.contact.material.as_ref().clone();
    let relaxation = indenter.relaxation().unwrap().clone();
    let exact = Compressibility::PoissonRatio(POISSON_RATIO);
    let stiff = relaxation.scaled(1.0).unwrap();
    let plain =
        contact_dma::material::Material::from_relaxation(stiff, ModulusKind::Longitudinal, exact);
    plan.base.contact.material = Arc::new(plain.unwrap().against(indenter));
    // Half of the loss is the indenter's, and so is half of what its series misses.
    let pair = bar(&plan);
    assert!(
        (pair / (0.5 * body) - 1.0).abs() < 0.01,
        "{pair:e} {body:e}"
    );
}
