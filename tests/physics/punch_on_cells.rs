//! A flat punch on cells, whose rim is a staircase: as stiff as the face on any grid, and its loss inside the bar on every one.

use crate::prelude::*;
use contact_dma::contact::axisymmetric::layer::LayerContact;

const RADIUS_M: f64 = 1e-3;
const OMEGA: f64 = 0.00844;
/// Fewest steps that leave bars: a punch is linear, and its loss goes as one over its stiffness whatever the steps.
const STEPS: usize = 32;

fn on_springs(indenter: Arc<dyn Indenter>) -> CaseResult {
    let plan = with(pmma_plan(indenter, 5.0), |plan| plan.cycle.steps = STEPS);
    result(&plan, OMEGA)
}

fn on(cells: usize, indenter: Arc<dyn Indenter>, layer: Option<LayerPlan>) -> CaseResult {
    let mut plan = with_bars(on_cells(pmma_plan(indenter, 5.0), cells, STEPS));
    plan.base.contact.layer = layer;
    result(&plan, OMEGA)
}

/// Loss and largest approach lie inside their bars.
fn assert_inside(cells: usize, deviations: [(f64, f64); 2]) {
    for (off, bar) in deviations {
        below!(off.abs(), bar, "{cells} cells");
    }
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
    match from_environment("GRIDS", 0) {
        0 => few.to_vec(),
        every => (40..=256).step_by(every as usize).collect(),
    }
}

#[test]
fn the_loss_of_a_punch_on_cells_is_inside_its_bar_on_every_grid() {
    let springs = on_springs(punch(RADIUS_M));
    // Odd ones, even ones, and those furthest off while the cells under the punch were those with their centre there.
    grids(&[40, 44, 47, 56, 72, 88, 101, 112, 124, 144])
        .par_iter()
        .for_each(|&cells| {
            let found = on(cells, punch(RADIUS_M), None);
            let deviations = deviations(&found, &springs, 1.0);
            assert_inside(cells, deviations);
            // First order would leave 3.6e-3 at 112 cells on the average.
            let [(off, bar), _] = deviations;
            let second_order = 2.0 / (cells * cells) as f64;
            below!(off.abs(), 5.0 * second_order.max(4e-5), "{cells}");
            below!(bar, 40.0 * (cells as f64).powf(-1.5), "{cells}");
            near!(found.contact_radius_m.maximum, RADIUS_M, 1e-12);
        });
}

#[test]
fn the_loss_of_a_punch_on_a_layer_is_inside_its_bar_on_every_grid() {
    let springs = on_springs(punch(RADIUS_M));
    let material = pmma_material();
    for (a_over_h, few) in [(10.0, &[44, 64, 112, 160][..]), (1.0, &[32, 56, 124])] {
        let layer = bonded(RADIUS_M / a_over_h);
        let of_material = layer.made_of(material.poisson_ratio().unwrap());
        let exact = LayerContact::new(of_material, RADIUS_M, 80);
        let stiffer = exact.punch_stiffness().unwrap();
        grids(few).par_iter().for_each(|&cells| {
            let found = on(cells, punch(RADIUS_M), Some(layer));
            let deviations = deviations(&found, &springs, stiffer);
            // What an identification has by default leaves less than the noise of a measurement.
            below!(deviations[0].0.abs(), 3e-3, "{a_over_h} {cells}");
            assert_inside(cells, deviations);
        });
    }
}

#[test]
fn a_punch_beside_the_origin_is_inside_its_bar() {
    let aside = Shifted::new(punch(RADIUS_M), 0.31 * RADIUS_M, -0.127 * RADIUS_M).unwrap();
    let aside: Arc<dyn Indenter> = Arc::new(aside);
    let springs = on_springs(Arc::clone(&aside));
    [50, 96].par_iter().for_each(|&cells| {
        let found = on(cells, Arc::clone(&aside), None);
        assert_inside(cells, deviations(&found, &springs, 1.0));
    });
}

#[test]
fn an_edge_that_is_no_rim_but_nearly_as_sharp_is_inside_its_bar() {
    // Flat, then steeply up, on which the contact hardly climbs.
    let r_m = RADIUS_M;
    let points = [(0.0, 0.0), (r_m, 0.0), (3.0 * r_m, 2.0 * r_m)];
    let chamfered: Arc<dyn Indenter> = Arc::new(Profile::new(&points).unwrap());
    let springs = on_springs(Arc::clone(&chamfered));
    [56, 101].par_iter().for_each(|&cells| {
        let found = on(cells, Arc::clone(&chamfered), None);
        let [(off, bar), _] = deviations(&found, &springs, 1.0);
        assert!(off.abs() < bar && bar < 0.05, "{cells}: {off:e}, {bar:e}");
    });
}
