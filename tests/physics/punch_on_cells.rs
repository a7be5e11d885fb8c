//! A flat punch on cells, whose rim is a staircase: as stiff as the face on any grid, and its loss inside the bar on every one.

use std::sync::Arc;

use crate::common::{on_cells, pmma_material, run_case, sweep_plan};
use contact_dma::contact::half_space::layer::Base;
use contact_dma::indenter::{FlatPunch, Indenter, Profile, Shifted};
use contact_dma::reference::layer::LayerContact;
use contact_dma::sweep::plan::SweepPlan;
use contact_dma::sweep::plan::layer::LayerPlan;
use contact_dma::sweep::record::CaseResult;
use contact_dma::sweep::record::error_bars::Quantity;
use rayon::prelude::*;

const RADIUS_M: f64 = 1e-3;
const OMEGA: f64 = 0.00844;
/// Fewest steps that leave bars: a punch is linear, and its loss goes as one over its stiffness whatever the steps.
const STEPS: usize = 32;

fn punch() -> Arc<dyn Indenter> {
    Arc::new(FlatPunch::new(RADIUS_M).unwrap())
}

fn plan_of(indenter: Arc<dyn Indenter>) -> SweepPlan {
    sweep_plan(pmma_material(), indenter, 10.0, 5.0)
}

fn on_springs(indenter: Arc<dyn Indenter>) -> CaseResult {
    let mut plan = plan_of(indenter);
    plan.cycle.steps = STEPS;
    run_case(&plan, OMEGA).result.unwrap()
}

fn with_bars(indenter: Arc<dyn Indenter>, layer: Option<LayerPlan>, cells: usize) -> CaseResult {
    let mut plan = on_cells(plan_of(indenter), cells, STEPS);
    plan.base.contact.layer = layer;
    plan.cycle.error_bars = true;
    run_case(&plan, OMEGA).result.unwrap()
}

/// Deviation and bar of the loss and of the largest approach, relative, where the exact ones are those of springs in as many steps
/// over this factor.
fn deviations(found: &CaseResult, springs: &CaseResult, softer: f64) -> [(f64, f64); 2] {
    [Quantity::EnergyLoss, Quantity::ApproachMax].map(|quantity| {
        let exact = quantity.of(springs).unwrap() / softer;
        let bar = found.errors.as_ref().unwrap().bar(quantity).unwrap();
        let off = quantity.of(found).unwrap() / exact - 1.0;
        (off, (bar.nodes + bar.steady) / exact)
    })
}

/// These numbers of cells, or every `GRIDS`-th from 40 to 256 where this is set in the environment.
fn grids(few: &[usize]) -> Vec<usize> {
    match std::env::var("GRIDS")
        .ok()
        .and_then(|every| every.parse().ok())
    {
        Some(every) => (40..=256).step_by(every).collect(),
        None => few.to_vec(),
    }
}

#[test]
fn the_loss_of_a_punch_on_cells_is_inside_its_bar_on_every_grid() {
    let springs = on_springs(punch());
    // Odd ones, even ones, and those furthest off while the cells under the punch were those with their centre there.
    grids(&[40, 44, 47, 56, 72, 88, 101, 112, 124, 144])
        .par_iter()
        .for_each(|&cells| {
            let found = with_bars(punch(), None, cells);
            for (off, bar) in deviations(&found, &springs, 1.0) {
                println!("{cells}: {off:.1e}, bar {bar:.1e}");
                assert!(off.abs() < bar, "{cells}: {off:e}, bar {bar:e}");
            }
            // First order would leave 3.6e-3 at 112 cells on the average.
            let [(off, bar), _] = deviations(&found, &springs, 1.0);
            let second_order = 2.0 / (cells * cells) as f64;
            assert!(off.abs() < 5.0 * second_order.max(4e-5), "{cells}: {off:e}");
            assert!(bar < 40.0 * (cells as f64).powf(-1.5), "{cells}: {bar:e}");
            assert!((found.contact_radius_m.maximum / RADIUS_M - 1.0).abs() < 1e-12);
        });
}

#[test]
fn the_loss_of_a_punch_on_a_layer_is_inside_its_bar_on_every_grid() {
    let springs = on_springs(punch());
    let material = pmma_material();
    for (a_over_h, few) in [(10.0, &[44, 64, 112, 160][..]), (1.0, &[32, 56, 124])] {
        let layer = LayerPlan {
            thickness_m: RADIUS_M / a_over_h,
            base: Base::Bonded,
            base_modulus_ratio: None,
            base_poisson_ratio: None,
        };
        let of_material = layer.made_of(material.poisson_ratio().unwrap());
        let exact = LayerContact::new(of_material, RADIUS_M, 80);
        let stiffer = exact.punch_stiffness().unwrap();
        grids(few).par_iter().for_each(|&cells| {
            let found = with_bars(punch(), Some(layer), cells);
            // What an identification has by default leaves less than the noise of a measurement.
            let [(off, _), _] = deviations(&found, &springs, stiffer);
            assert!(off.abs() < 3e-3, "{a_over_h} {cells}: {off:e}");
            for (off, bar) in deviations(&found, &springs, stiffer) {
                println!("{a_over_h} {cells}: {off:.1e}, bar {bar:.1e}");
                assert!(off.abs() < bar, "{a_over_h} {cells}: {off:e}, bar {bar:e}");
            }
        });
    }
}

#[test]
fn a_punch_beside_the_origin_is_inside_its_bar() {
    let aside = Shifted::new(punch(), 0.31 * RADIUS_M, -0.127 * RADIUS_M).unwrap();
    let aside: Arc<dyn Indenter> = Arc::new(aside);
    let springs = on_springs(Arc::clone(&aside));
    [50, 96].par_iter().for_each(|&cells| {
        let found = with_bars(Arc::clone(&aside), None, cells);
        for (off, bar) in deviations(&found, &springs, 1.0) {
            println!("{cells}: {off:.1e}, bar {bar:.1e}");
            assert!(off.abs() < bar, "{cells}: {off:e}, bar {bar:e}");
        }
    });
}

#[test]
fn an_edge_that_is_no_rim_but_nearly_as_sharp_is_inside_its_bar() {
    // Flat, then steeply up, on which the contact hardly climbs.
    let points = [
        (0.0, 0.0),
        (RADIUS_M, 0.0),
        (3.0 * RADIUS_M, 2.0 * RADIUS_M),
    ];
    let chamfered: Arc<dyn Indenter> = Arc::new(Profile::new(&points).unwrap());
    let springs = on_springs(Arc::clone(&chamfered));
    [56, 101].par_iter().for_each(|&cells| {
        let found = with_bars(Arc::clone(&chamfered), None, cells);
        let [(off, bar), _] = deviations(&found, &springs, 1.0);
        println!("{cells}: {off:.1e}, bar {bar:.1e}");
        assert!(
            off.abs() < bar && bar < 0.05,
            "{cells}: {off:e}, bar {bar:e}"
        );
    });
}
