//! A material found from cycles and histories of contacts with more in them than a rigid indenter on a half-space: an indenter that
//! yields, a layer, adhesion. Exact measurements give the solid back; without what was there another one is found.

use crate::identified::{self, EXACT, inside, off_by};
use crate::prelude::*;
use contact_dma::identify::data::{Measurements, Number};
use contact_dma::identify::{CellError, Driven, Identified, IdentifyPlan, identify};

const POISSON: f64 = 0.35;
const RADIUS_M: f64 = 1e-3;

fn truth() -> Relaxation {
    series(3e6, &[(4e6, 0.05), (8e6, 3.0)])
}

/// Nine frequencies over the band.
fn omegas() -> Vec<f64> {
    log_spaced(1e-2, 1e2, 9)
}

/// What makes a contact more than plain.
#[derive(Clone, Default)]
struct With {
    indenter_material: Option<Material>,
    layer: Option<LayerPlan>,
    adhesion: Option<AdhesionPlan>,
    /// In place of the Poisson ratio (Pa).
    bulk_pa: Option<f64>,
    /// Cells of what was measured, in place of those of the model.
    measured_on_cells: Option<usize>,
}

impl With {
    fn compressibility(&self) -> Compressibility {
        let bulk = |bulk_pa| Compressibility::constant_bulk_modulus(bulk_pa).unwrap();
        self.bulk_pa.map_or(POISSON.into(), bulk)
    }

    fn indenter(&self) -> Arc<dyn Indenter> {
        sphere(RADIUS_M)
    }

    fn truth(&self) -> Material {
        let material = material_of(truth(), self.compressibility());
        match &self.indenter_material {
            Some(indenter) => material.against(indenter.clone()),
            None => material,
        }
    }

    /// Few cells, for speed.
    fn solver(&self) -> SolverPlan {
        SolverPlan {
            cells: 16,
            ..IdentifyPlan::solver(self.indenter().as_ref(), self.layer.is_some())
        }
    }

    fn plan(self, drive: Driven, measurements: Measurements, cycle: CyclePlan) -> IdentifyPlan {
        let known = self.compressibility();
        let mut plan = IdentifyPlan::new(known, self.indenter(), drive, measurements);
        plan.solver = self.solver();
        plan.contact.material.indenter_material = self.indenter_material;
        (plan.contact.layer, plan.contact.adhesion) = (self.layer, self.adhesion);
        (plan.branches, plan.cycle) = (Some(2), cycle);
        plan
    }
}

/// Losses, phases and largest approaches at six frequencies over four decades, computed as the model computes them.
fn of_cycles(drive: HarmonicDrive, with: &With) -> IdentifyPlan {
    let mut sweep = SweepPlan::new(with.truth(), with.indenter(), drive);
    (sweep.base.contact.layer, sweep.base.contact.adhesion) = (with.layer, with.adhesion);
    (sweep.cycle, sweep.solver) = (IdentifyPlan::CYCLE, with.solver());
    sweep.solver.cells = with.measured_on_cells.unwrap_or(with.solver().cells);
    let numbers = [Number::EnergyLoss, Number::PhaseLag, Number::ApproachMax];
    let omegas = log_spaced(1e-2, 1e2, 6);
    let measured = identified::of_cycles(sweep, &omegas, &numbers, EXACT, &mut Random(0));
    let cycle = IdentifyPlan::CYCLE;
    with.clone().plan(Driven::Cycles(drive), measured, cycle)
}

/// What a ramp and a hold leave, at forty times over three decades.
fn of_history(drive: SegmentedDrive, with: &With) -> IdentifyPlan {
    let mut scenario = ScenarioPlan::new(with.truth(), with.indenter(), drive.clone());
    (scenario.contact.layer, scenario.contact.adhesion) = (with.layer, with.adhesion);
    scenario.solver = with.solver();
    let times_s = log_spaced(0.05, 50.0, 40);
    let measured = identified::of_history(scenario, &times_s, EXACT, &mut Random(0));
    let cycle = CyclePlan::DEFAULT;
    with.clone().plan(Driven::History(drive), measured, cycle)
}

fn found(plan: &IdentifyPlan) -> Identified {
    identified::found(plan).unwrap()
}

fn off(found: &Identified) -> f64 {
    off_by(&truth(), found, &omegas())
}

fn held(control: Control, to: f64, pull_off_n: f64) -> SegmentedDrive {
    let segment = |duration_s| Segment::Ramp { to, duration_s };
    SegmentedDrive::attracted(control, vec![segment(0.05), segment(60.0)], pull_off_n).unwrap()
}

/// Cycles and histories under either control.
fn four_experiments(with: &With) -> [(&'static str, IdentifyPlan); 4] {
    let cycles = |drive: Result<HarmonicDrive, _>| of_cycles(drive.unwrap(), with);
    let held = |control, to| of_history(held(control, to, 0.0), with);
    [
        ("load", cycles(HarmonicDrive::load(0.2, 0.1))),
        ("approach", cycles(HarmonicDrive::approach(2e-5, 5e-6))),
        ("creep", held(Control::Load, 0.2)),
        ("relaxation", held(Control::Approach, 2e-5)),
    ]
}

#[test]
fn an_indenter_that_yields_as_much_as_the_body_is_taken_out() {
    // A solid of its own, whose branch lies between the two that are sought.
    let with = With {
        indenter_material: Some(solid(8e6, &[(5e6, 0.5)], 0.45)),
        ..With::default()
    };
    for (name, plan) in four_experiments(&with) {
        // The tolerance of the cycles of the model, 1e-6, reaches the moduli a hundredfold; the histories of the model have its steps.
        below!(off(&found(&plan)), 2e-3, "{name}");
        let mut rigid = plan;
        (rigid.contact.material.indenter_material, rigid.branches) = (None, None);
        let missed = identify(&rigid, &AtomicBool::new(false)).map_or(1.0, |found| off(&found));
        assert!(missed > 0.1, "{name}: {missed:e}");
    }
}

#[test]
fn attraction_is_taken_out() {
    let adhesion = AdhesionPlan {
        model: AdhesionModel::Dmt,
        ..AdhesionPlan::of_work(20.0)
    };
    let with = With {
        adhesion: Some(adhesion),
        ..With::default()
    };
    let sphere = ball(RADIUS_M);
    let pull_off_n = adhesion.pull_off_n(&sphere).unwrap();
    let drive = HarmonicDrive::load(0.2, 0.1).unwrap();
    let cycles = of_cycles(drive.attracted_by(pull_off_n).unwrap(), &with);
    let crept = of_history(held(Control::Load, 0.2, pull_off_n), &with);
    for (name, plan) in [("cycles", cycles), ("creep", crept)] {
        below!(off(&found(&plan)), 2e-3, "{name}");
    }
}

#[test]
fn a_constant_bulk_modulus_is_known_in_place_of_the_poisson_ratio() {
    // The Poisson ratio grows from 0.375 to 0.475 as the body relaxes.
    let with = With {
        bulk_pa: Some(2e7),
        ..With::default()
    };
    for (name, plan) in four_experiments(&with) {
        below!(off(&found(&plan)), 2e-3, "{name}");
        let mut constant = plan;
        constant.contact.material.compressibility = 0.375.into();
        // (1 - 0.475^2) / (1 - 0.375^2) at rest.
        let missed = off(&found(&constant));
        assert!(missed > 0.05, "{name}: {missed:e}");
    }
}

#[test]
fn a_bulk_modulus_that_hardly_allows_the_solid_is_no_end_of_the_search() {
    // Nine times it are 18 MPa, and the solid begins with 15 MPa: trials beyond have no cycle.
    let with = With {
        bulk_pa: Some(2e6),
        ..With::default()
    };
    let plan = of_cycles(HarmonicDrive::load(0.2, 0.1).unwrap(), &with);
    below!(off(&found(&plan)), 2e-3);
}

/// Cycles of a bonded layer, measured on this number of cells.
fn of_layer(cells: usize) -> IdentifyPlan {
    let with = With {
        layer: Some(bonded(2e-4)),
        measured_on_cells: Some(cells),
        ..With::default()
    };
    of_cycles(HarmonicDrive::load(0.2, 0.05).unwrap(), &with)
}

#[test]
fn a_layer_is_taken_out() {
    // As the model is corrected: by twice its 16 cells.
    let found = found(&of_layer(32));
    below!(off(&found), 2e-3);
    assert!(matches!(found.cell_error, Some(CellError::Included(change)) if change > 0.01));
}

#[test]
fn intervals_from_few_cells_include_the_error_of_the_cells() {
    let found = found(&of_layer(80));
    let exact = truth();
    for (unknown, exact) in found.unknowns.iter().zip([3e6, 4e6, 0.05, 8e6, 3.0]) {
        let off = (unknown.value / exact).ln().abs();

        assert!(off < unknown.factor.ln(), "{unknown:?}, exact {exact}");
        // And not by including everything.
        assert!(unknown.factor < 1.1, "{unknown:?}");
    }
    let (inside, of) = inside(&exact, &found, &omegas());
    assert_eq!(inside, of);
}
