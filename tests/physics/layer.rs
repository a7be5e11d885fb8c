//! A layer on a base, rigid or not, on cells, against the dual integral equation, closed forms and correspondence.

use crate::prelude::*;
use contact_dma::contact::axisymmetric::layer::{ElasticContact, LayerContact};
use contact_dma::contact::half_space::layer::{Base, Layer, LayerInfluence, YieldingBase};
use contact_dma::engine::{EngineBuilder, LargestContact};

const COMPLIANCE_PER_PA: f64 = 4e-10;
const A_OVER_H: [f64; 7] = [0.01, 0.1, 0.3, 1.0, 2.0, 4.0, 10.0];
const KINDS: [Layer; 8] = [
    rigid(Base::Bonded, 0.0),
    rigid(Base::Bonded, 0.3),
    rigid(Base::Bonded, 0.45),
    rigid(Base::Bonded, 0.5),
    rigid(Base::Frictionless, 0.3),
    PLATE,
    yielding(0.5, 0.5),
    yielding(8.0, 0.5),
];
const PLATE: Layer = yielding(0.05, 0.3);
const RADIUS_M: f64 = 1e-4;

const fn rigid(base: Base, poisson_ratio: f64) -> Layer {
    Layer {
        thickness_m: 1.0,
        base,
        yielding: None,
        poisson_ratio,
    }
}

/// On a base of so many times the shear modulus, and of Poisson ratio 0.2.
const fn yielding(modulus_ratio: f64, poisson_ratio: f64) -> Layer {
    Layer {
        yielding: Some(YieldingBase {
            modulus_ratio,
            poisson_ratio: 0.2,
        }),
        ..rigid(Base::Bonded, poisson_ratio)
    }
}

fn layer(kind: Layer, a_over_h: f64) -> Layer {
    Layer {
        thickness_m: RADIUS_M / a_over_h,
        ..kind
    }
}

fn on_grid(indenter: &dyn Indenter, layer: Layer, grid: Grid) -> HalfSpace {
    cells_on_layer(indenter, Arc::new(LayerInfluence::new(layer)), grid)
}

/// A contact of [`RADIUS_M`] under a sphere.
fn under_ball(layer: Layer) -> ElasticContact {
    let exact = LayerContact::new(layer, RADIUS_M, 60);
    exact.under(|t| t * t / 0.01, COMPLIANCE_PER_PA).unwrap()
}

/// The stiffness of a punch, over that on a half-space.
fn stiffness(load_n: f64) -> f64 {
    0.5 * load_n * COMPLIANCE_PER_PA / (1e-7 * RADIUS_M)
}

/// The load under an approach, found by the fast way.
fn load_n(engine: &mut HalfSpace, approach_m: f64) -> f64 {
    let prescribed = Prescribed::ApproachM(approach_m);
    let (solution, _) = first_touch(engine, COMPLIANCE_PER_PA, prescribed).unwrap();
    assert_eq!(engine.safeguarded_instants(), 0);
    solution.load_n
}

#[test]
fn a_sphere_on_cells_is_as_stiff_as_the_dual_integral_equation_has_it_in_second_order() {
    let sphere = ball(0.01);
    let mut orders = Vec::new();
    for kind in KINDS {
        for a_over_h in A_OVER_H {
            let layer = layer(kind, a_over_h);
            let exact = under_ball(layer);
            let influence = Arc::new(LayerInfluence::new(layer));
            let error = |cells: usize| {
                // The edge of the contact lies in another place of a cell for each width.
                let errors = (0..5).map(|k| {
                    let width_m = (1.2 + 0.0137 * f64::from(k)) * RADIUS_M;
                    let quarter = grid(width_m, cells).quarter().unwrap();
                    let mut engine = cells_on_layer(&sphere, Arc::clone(&influence), quarter);
                    relative(load_n(&mut engine, exact.approach_m), exact.load_n)
                });
                root_mean_square(errors)
            };
            let (coarse, fine) = (error(32), error(128));
            below!(fine, 1.5e-4, "{kind:?} {a_over_h}");
            orders.push(0.5 * (coarse / fine).log2());
        }
    }
    // Where the edge lies leaves a scatter of the error, and of the order over two refinements.
    let mean = orders.iter().sum::<f64>() / orders.len() as f64;
    let least = orders.iter().copied().fold(f64::INFINITY, f64::min);
    assert!(mean > 1.8 && least > 1.5, "{mean} {least} {orders:?}");
}

#[test]
fn a_punch_on_cells_is_as_stiff_as_the_dual_integral_equation_has_it() {
    let punch = FlatPunch::new(RADIUS_M).unwrap();
    // A layer far stiffer than its base bends away from a punch, which the next test is about.
    for kind in KINDS.into_iter().filter(|kind| *kind != PLATE) {
        for a_over_h in A_OVER_H {
            let layer = layer(kind, a_over_h);
            let exact = LayerContact::new(layer, RADIUS_M, 80);
            let exact = exact.punch_stiffness().unwrap();
            let influence = Arc::new(LayerInfluence::new(layer));
            let error = |cells: usize| {
                let quarter = grid(1.1 * RADIUS_M, cells).quarter().unwrap();
                let mut engine = cells_on_layer(&punch, Arc::clone(&influence), quarter);
                relative(stiffness(load_n(&mut engine, 1e-7)), exact).abs()
            };
            let (coarse, fine) = (error(64), error(256));
            // The rim is a staircase, at which the pressure is singular: first order, and four times as much where it grows like the
            // fourth power of the radius.
            below!(fine, 4e-3, "{kind:?} {a_over_h}");
            below!(fine, coarse / 2.5, "{kind:?} {a_over_h}");
        }
    }
}

#[test]
fn a_stiff_layer_on_a_soft_base_leaves_the_middle_of_a_punch() {
    let punch = FlatPunch::new(RADIUS_M).unwrap();
    for (a_over_h, leaves) in [(0.1, false), (1.0, true), (2.0, true)] {
        let layer = layer(PLATE, a_over_h);
        // The equation knows no lift-off: there the middle would have to be pulled.
        let held = LayerContact::new(layer, RADIUS_M, 80);
        let held = held.punch_stiffness().unwrap();
        let quarter = grid(1.1 * RADIUS_M, 128).quarter().unwrap();
        let mut engine = on_grid(&punch, layer, quarter);
        let prescribed = Prescribed::ApproachM(1e-7);
        let (found, pressure_pa) = first_touch(&mut engine, COMPLIANCE_PER_PA, prescribed).unwrap();
        assert_eq!(pressure_pa[0] == 0.0, leaves, "{a_over_h}");
        let part = stiffness(found.load_n) / held;
        assert!(part < 1.0 && part > 0.98, "{a_over_h} {part}");
    }
}

#[test]
fn the_numbers_of_the_guide_are_those_of_the_dual_integral_equation() {
    let guide = include_str!("../../src/guide/validity.md");
    let rows = guide.lines().filter_map(|line| {
        let cells: Option<Vec<f64>> = line
            .trim_matches('|')
            .split('|')
            .map(|cell| cell.trim().parse().ok())
            .collect();
        cells.filter(|cells| cells.len() == 5)
    });
    let rows: Vec<Vec<f64>> = rows.collect();
    assert!(!rows.is_empty());
    for row in rows {
        for (nu, told) in [0.0, 0.3, 0.45, 0.5].into_iter().zip(&row[1..]) {
            let contact = LayerContact::new(layer(rigid(Base::Bonded, nu), row[0]), RADIUS_M, 60);
            let exact = contact.punch_stiffness().unwrap();
            // Three decimals.
            below!((told - exact).abs(), 6e-4, "{} {nu}", row[0]);
        }
    }
}

#[test]
fn windows_quarters_and_the_safe_way_find_the_same_contact_where_the_surface_rises() {
    let sphere = ball(0.01);
    for a_over_h in [0.5, 3.0] {
        let layer = layer(rigid(Base::Bonded, 0.5), a_over_h);
        let load = Prescribed::LoadN(under_ball(layer).load_n);
        let whole = grid(3.0 * RADIUS_M, 128);
        let approach_m = |mut engine: HalfSpace| {
            let (found, _) = first_touch(&mut engine, COMPLIANCE_PER_PA, load).unwrap();
            found.approach_m
        };
        let found_m = approach_m(on_grid(&sphere, layer, whole));
        let quarter_m = approach_m(on_grid(&sphere, layer, whole.quarter().unwrap()));
        let safe_m = approach_m(on_grid(&sphere, layer, whole).by_safeguard_alone());
        // The tolerance of an instant is 1e-8.
        near!(quarter_m, found_m, 1e-7, "{a_over_h}");
        near!(safe_m, found_m, 1e-7, "{a_over_h}");
    }
}

#[test]
fn the_domain_is_as_large_as_the_contact_from_far_below_its_radius_to_far_above() {
    for kind in KINDS {
        for a_over_h in A_OVER_H {
            let layer = layer(kind, a_over_h);
            let exact = under_ball(layer);
            for (control, maximum) in [
                (Control::Load, exact.load_n),
                (Control::Approach, exact.approach_m),
            ] {
                let largest = LargestContact {
                    control,
                    maximum,
                    compliance_per_pa: COMPLIANCE_PER_PA,
                };
                let solver = SolverPlan {
                    engine: EngineKind::HalfSpace,
                    cells: 32,
                    ..SolverPlan::default()
                };
                let engines = EngineBuilder::on(Some(layer), sphere(0.01), solver, largest);
                let width = engines.unwrap().half_width_m() / RADIUS_M;
                // A tenth of room, and what cells of a 24th of the radius make of the edge.
                let what = format!("{kind:?} {a_over_h} {control:?} {width}");
                assert!((1.05..1.2).contains(&width), "{what}");
            }
        }
    }
}

const OMEGA: f64 = 0.00844;

fn on_layer(indenter: Arc<dyn Indenter>, amplitude_n: f64, layer: LayerPlan) -> CaseResult {
    let mut plan = on_cells(pmma_plan(indenter, amplitude_n), 48, 200);
    (plan.base.contact.layer, plan.cycle.tolerance) = (Some(layer), 1e-6);
    result(&plan, OMEGA)
}

fn on_base(thickness_m: f64, yielding: Option<YieldingBase>) -> LayerPlan {
    LayerPlan {
        base_modulus_ratio: yielding.map(|base| base.modulus_ratio),
        base_poisson_ratio: yielding.map(|base| base.poisson_ratio),
        ..bonded(thickness_m)
    }
}

const SOFT: Option<YieldingBase> = yielding(0.4, 0.3).yielding;

#[test]
fn a_punch_on_a_viscoelastic_layer_answers_by_correspondence() {
    let compliance = pmma();
    let relaxed = compliance.equilibrium_compliance().unwrap();
    for (thickness_m, yielding) in [(1e-4, None), (1e-3, None), (1e-4, SOFT), (1e-3, SOFT)] {
        let result = on_layer(punch(5e-4), 5.0, on_base(thickness_m, yielding));
        // The mean of the approach says how compliant layer and cells are: the load's mean at the compliance at rest; which is that of
        // a half-space under a punch of another radius.
        let mean_m = 0.5 * (result.approach_m.minimum + result.approach_m.maximum);
        let radius_m = 10.0 * relaxed / (2.0 * mean_m);
        let (_, exact_j) = harmonic((10.0, 5.0), OMEGA, &compliance).flat_punch(radius_m);
        // The mean of extremes at 200 steps, and the rule of second order: 1e-4 as asked for.
        near!(result.loss_j(), exact_j, 1e-4, "{thickness_m}");
    }
}

#[test]
fn equivalent_moduli_are_those_of_the_material_however_thin_the_layer() {
    let exact = pmma_material().longitudinal_complex_modulus(OMEGA);
    for (thickness_m, yielding) in [(5e-5, None), (3e-4, None), (3e-3, None), (1e-4, SOFT)] {
        let result = on_layer(sphere(0.01), 0.1, on_base(thickness_m, yielding));
        // The contact moves by a part of a cell, or not at all: the tangent radius is that of cells, a percent or two.
        near!(result.storage_modulus_pa.unwrap(), exact.re, 0.03);
        near!(result.loss_modulus_pa.unwrap(), exact.im, 0.03);
    }
}
