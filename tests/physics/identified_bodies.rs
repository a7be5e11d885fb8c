//! A material found from cycles and histories of contacts with more in them than a rigid indenter on a half-space: an indenter that
//! yields, a layer, adhesion. Exact measurements give the solid back; without what was there another one is found.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use contact_dma::contact::half_space::layer::Base;
use contact_dma::drive::{Control, HarmonicDrive, Segment, SegmentedDrive};
use contact_dma::engine::SolverPlan;
use contact_dma::identify::data::{Datum, Measurements, Number, Reading};
use contact_dma::identify::{CellError, Driven, Identified, IdentifyPlan, identify};
use contact_dma::indenter::{Indenter, Sphere};
use contact_dma::material::{Compressibility, Material, ModulusKind, Relaxation, RelaxationBranch};
use contact_dma::simulation::Simulation;
use contact_dma::simulation::between::values_at;
use contact_dma::simulation::scenario::ScenarioPlan;
use contact_dma::sweep::Sweep;
use contact_dma::sweep::plan::adhesion::AdhesionPlan;
use contact_dma::sweep::plan::layer::LayerPlan;
use contact_dma::sweep::plan::{CyclePlan, SweepPlan};

const POISSON: f64 = 0.35;
const RADIUS_M: f64 = 1e-3;

fn truth() -> Relaxation {
    let branches = [(4e6, 0.05), (8e6, 3.0)];
    let branch = |(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s };
    Relaxation::new(3e6, branches.map(branch).to_vec()).unwrap()
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
        Arc::new(Sphere::new(RADIUS_M).unwrap())
    }

    fn truth(&self) -> Material {
        let kind = ModulusKind::Longitudinal;
        let material = Material::from_relaxation(truth(), kind, self.compressibility()).unwrap();
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
        plan.branches = Some(2);
        plan.cycle = cycle;
        plan
    }
}

/// Losses, phases and largest approaches at six frequencies over four decades, computed as the model computes them.
fn of_cycles(drive: HarmonicDrive, with: &With) -> IdentifyPlan {
    let omegas: Vec<f64> = (0..6)
        .map(|k| 10_f64.powf(0.8 * f64::from(k) - 2.0))
        .collect();
    let mut sweep = SweepPlan::new(with.truth(), with.indenter(), drive);
    (sweep.base.contact.layer, sweep.base.contact.adhesion) = (with.layer, with.adhesion);
    (sweep.cycle, sweep.solver) = (IdentifyPlan::CYCLE, with.solver());
    sweep.solver.cells = with.measured_on_cells.unwrap_or(with.solver().cells);
    let sweep = Sweep::from(sweep).angular_frequencies_rad_per_s(omegas);
    let records = sweep.unwrap().solve().unwrap().records;
    let quantities = [Number::EnergyLoss, Number::PhaseLag, Number::ApproachMax];
    let mut data = Vec::new();
    for (row, record) in (1..).zip(&records) {
        let result = record.result.as_ref().unwrap();
        data.extend(quantities.map(|quantity| Datum {
            place: record.angular_frequency_rad_per_s,
            drive: Some(drive),
            row,
            number: quantity,
            value: quantity.of(result).unwrap(),
            error: None,
        }));
    }
    let measurements = Measurements::new(data).unwrap();
    with.clone()
        .plan(Driven::Cycles(drive), measurements, IdentifyPlan::CYCLE)
}

/// What a ramp and a hold leave, at forty times over three decades.
fn of_history(drive: SegmentedDrive, with: &With) -> IdentifyPlan {
    let mut scenario = ScenarioPlan::new(with.truth(), with.indenter(), drive.clone());
    (scenario.contact.layer, scenario.contact.adhesion) = (with.layer, with.adhesion);
    (scenario.solver, scenario.output.error_bars) = (with.solver(), false);
    let simulation = Simulation::new(scenario).unwrap();
    let outcome = simulation.run(&AtomicBool::new(false), &|_, _| {});
    let times: Vec<f64> = (0..40)
        .map(|k| 0.05 * 10_f64.powf(3.0 * f64::from(k) / 39.0))
        .collect();
    let values = match drive.control() {
        Control::Load => values_at(&drive, &outcome.rows, &times, |row| row.approach_m),
        Control::Approach => values_at(&drive, &outcome.rows, &times, |row| Some(row.load_n)),
    };
    let readings: Vec<Reading> = (times.iter().zip(values).enumerate())
        .map(|(row, (time_s, value))| Reading {
            row: row + 1,
            time_s: *time_s,
            value: value.unwrap(),
            error: None,
        })
        .collect();
    let measurements = Measurements::of_history(&drive, &readings).unwrap();
    with.clone()
        .plan(Driven::History(drive), measurements, CyclePlan::DEFAULT)
}

fn found(plan: &IdentifyPlan) -> Identified {
    identify(plan, &AtomicBool::new(false)).unwrap()
}

/// The largest relative error of E* over the band.
fn off(found: &Identified) -> f64 {
    let omegas = (0..9).map(|k| 10_f64.powf(0.5 * f64::from(k) - 2.0));
    let off = omegas.map(|omega| {
        let exact = truth().complex_modulus(omega);
        (found.relaxation.complex_modulus(omega) - exact).norm() / exact.norm()
    });
    off.fold(0.0, f64::max)
}

fn held(control: Control, to: f64, pull_off_n: f64) -> SegmentedDrive {
    let segment = |duration_s| Segment::Ramp { to, duration_s };
    SegmentedDrive::attracted(control, vec![segment(0.05), segment(60.0)], pull_off_n).unwrap()
}

#[test]
fn an_indenter_that_yields_as_much_as_the_body_is_taken_out() {
    // A solid of its own, whose branch lies between the two that are sought.
    let branch = RelaxationBranch {
        modulus_pa: 5e6,
        time_s: 0.5,
    };
    let rubber = Relaxation::new(8e6, vec![branch]).unwrap();
    let rubber = Material::from_relaxation(rubber, ModulusKind::Longitudinal, 0.45).unwrap();
    let with = With {
        indenter_material: Some(rubber),
        ..With::default()
    };
    let under_load = of_cycles(HarmonicDrive::load(0.2, 0.1).unwrap(), &with);
    let under_approach = of_cycles(HarmonicDrive::approach(2e-5, 5e-6).unwrap(), &with);
    let crept = of_history(held(Control::Load, 0.2, 0.0), &with);
    let relaxed = of_history(held(Control::Approach, 2e-5, 0.0), &with);
    for (name, plan) in [
        ("load", under_load),
        ("approach", under_approach),
        ("creep", crept),
        ("relaxation", relaxed),
    ] {
        let error = off(&found(&plan));
        // The tolerance of the cycles of the model, 1e-6, reaches the moduli a hundredfold; the histories of the model have its steps.
        assert!(error < 2e-3, "{name}: {error:e}");
        let mut rigid = plan;
        rigid.contact.material.indenter_material = None;
        rigid.branches = None;
        let missed = identify(&rigid, &AtomicBool::new(false)).map_or(1.0, |found| off(&found));
        assert!(missed > 0.1, "{name}: {missed:e}");
    }
}

#[test]
fn attraction_is_taken_out() {
    let adhesion = AdhesionPlan {
        work_j_per_m2: 20.0,
        equilibrium_distance_m: AdhesionPlan::EQUILIBRIUM_DISTANCE_M,
    };
    let with = With {
        adhesion: Some(adhesion),
        ..With::default()
    };
    let sphere = Sphere::new(RADIUS_M).unwrap();
    let pull_off_n = adhesion.pull_off_n(&sphere).unwrap();
    let drive = HarmonicDrive::load(0.2, 0.1).unwrap();
    let cycles = of_cycles(drive.attracted_by(pull_off_n).unwrap(), &with);
    let crept = of_history(held(Control::Load, 0.2, pull_off_n), &with);
    for (name, plan) in [("cycles", cycles), ("creep", crept)] {
        let error = off(&found(&plan));
        assert!(error < 2e-3, "{name}: {error:e}");
    }
}

#[test]
fn a_constant_bulk_modulus_is_known_in_place_of_the_poisson_ratio() {
    // The Poisson ratio grows from 0.375 to 0.475 as the body relaxes.
    let with = With {
        bulk_pa: Some(2e7),
        ..With::default()
    };
    for (name, plan) in [
        (
            "load",
            of_cycles(HarmonicDrive::load(0.2, 0.1).unwrap(), &with),
        ),
        (
            "approach",
            of_cycles(HarmonicDrive::approach(2e-5, 5e-6).unwrap(), &with),
        ),
        ("creep", of_history(held(Control::Load, 0.2, 0.0), &with)),
        (
            "relaxation",
            of_history(held(Control::Approach, 2e-5, 0.0), &with),
        ),
    ] {
        let error = off(&found(&plan));
        assert!(error < 2e-3, "{name}: {error:e}");
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
    let error = off(&found(&plan));
    assert!(error < 2e-3, "{error:e}");
}

/// Cycles of a bonded layer, measured on this number of cells.
fn of_layer(cells: usize) -> IdentifyPlan {
    let layer = LayerPlan {
        thickness_m: 2e-4,
        base: Base::Bonded,
        base_modulus_ratio: None,
        base_poisson_ratio: None,
    };
    let with = With {
        layer: Some(layer),
        measured_on_cells: Some(cells),
        ..With::default()
    };
    of_cycles(HarmonicDrive::load(0.2, 0.05).unwrap(), &with)
}

#[test]
fn a_layer_is_taken_out() {
    // As the model is corrected: by twice its 16 cells.
    let found = found(&of_layer(32));
    let error = off(&found);
    assert!(error < 2e-3, "{error:e}");
    assert!(matches!(found.cell_error, Some(CellError::Included(change)) if change > 0.01));
}

#[test]
fn intervals_from_few_cells_include_the_error_of_the_cells() {
    let found = found(&of_layer(80));
    let exact = truth();
    let branches = exact.branches().iter();
    let mut unknowns = vec![exact.equilibrium_modulus()];
    unknowns.extend(branches.flat_map(|branch| [branch.modulus_pa, branch.time_s]));
    for (unknown, exact) in found.unknowns.iter().zip(unknowns) {
        let off = (unknown.value / exact).ln().abs();
        println!("{}: {off:.2e} of {:.2e}", unknown.name, unknown.factor.ln());
        assert!(off < unknown.factor.ln(), "{unknown:?}, exact {exact}");
        // And not by including everything.
        assert!(unknown.factor < 1.1, "{unknown:?}");
    }
    for k in 0..9 {
        let omega = 10_f64.powf(0.5 * f64::from(k) - 2.0);
        let (band, exact) = (found.band(omega), exact.complex_modulus(omega));
        let [storage, loss] = [exact.re / band.storage_pa, exact.im / band.loss_pa];
        assert!(
            storage.ln().abs() < band.storage_factor.ln(),
            "{omega}: {storage}"
        );
        assert!(loss.ln().abs() < band.loss_factor.ln(), "{omega}: {loss}");
    }
}
