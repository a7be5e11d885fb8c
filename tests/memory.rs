//! Memory counted by the allocator: what a march takes, against what is predicted of it, and what a record takes.

mod common;

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use common::engines::{cells_on, grid};
use common::{pmma, pmma_material, pmma_plan, solid, sphere, step, sweep_plan, with, with_bars};
use contact_dma::contact::Prescribed;
use contact_dma::contact::half_space::CellField;
use contact_dma::drive::{Control, HarmonicDrive, SegmentedDrive};
use contact_dma::engine::EngineKind;
use contact_dma::history::{March, TimeRule};
use contact_dma::indenter::{Indenter, MapEdge, Roughness, Shifted, Sphere};
use contact_dma::material::Material;
use contact_dma::simulation::checkpoint::HistoryCheckpoint;
use contact_dma::simulation::scenario::ScenarioPlan;
use contact_dma::simulation::{Simulation, SimulationEnd};
use contact_dma::sweep::Sweep;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::case::checkpoint::Checkpoints;
use contact_dma::sweep::plan::{Method, SweepPlan};
use contact_dma::sweep::store::Store;
use contact_dma::sweep::store::entry::Purpose;

/// Counts the bytes held, the most of them, and those ever taken.
struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static TAKEN: AtomicUsize = AtomicUsize::new(0);
static ALLOCATIONS: AtomicUsize = AtomicUsize::new(0);

// SAFETY: every call is handed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        let held = HELD.fetch_add(layout.size(), Ordering::Relaxed) + layout.size();
        PEAK.fetch_max(held, Ordering::Relaxed);
        TAKEN.fetch_add(layout.size(), Ordering::Relaxed);
        ALLOCATIONS.fetch_add(1, Ordering::Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Ordering::Relaxed);
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Held by one test at a time, since what other threads take would be counted too.
fn alone() -> MutexGuard<'static, ()> {
    static ONE: Mutex<()> = Mutex::new(());
    ONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The most bytes held at a time during some work, beyond those before it.
fn peak(work: impl FnOnce()) -> usize {
    let before = HELD.load(Ordering::Relaxed);
    PEAK.store(before, Ordering::Relaxed);
    work();
    PEAK.load(Ordering::Relaxed) - before
}

/// Twelve branches over five decades.
fn twelve_branches() -> Material {
    let branch = |k| (1e8, 10_f64.powf(0.5 * f64::from(k)));
    solid(1e9, &(0..12).map(branch).collect::<Vec<_>>(), 0.4)
}

#[test]
fn a_case_holds_the_memory_predicted_whatever_material_and_engine() {
    let _alone = alone();
    let few_steps = |plan: SweepPlan| {
        with(plan, |plan| {
            plan.angular_frequencies_rad_per_s = vec![0.1];
            plan.cycle.steps = 16;
        })
    };
    let on_cells = |cells: usize, plan: SweepPlan| {
        with(few_steps(plan), |plan| {
            (plan.solver.engine, plan.solver.cells) = (EngineKind::HalfSpace, cells);
        })
    };
    // Off the origin there is no quarter to take.
    let offset = || Arc::new(Shifted::new(sphere(0.01), 1.37e-5, 7.1e-6).unwrap());
    let pmma_on = |cells| on_cells(cells, pmma_plan(sphere(0.01), 5.0));
    let twelve_on = |cells| {
        let plan = sweep_plan(twelve_branches(), sphere(0.01), 10.0, 5.0);
        on_cells(cells, plan)
    };
    let marched = with(twelve_on(256), |plan| {
        (plan.cycle.method, plan.cycle.at_cycle) = (Method::March, Some(2));
    });
    let springs = few_steps(pmma_plan(sphere(0.01), 5.0));
    let plans = [
        pmma_on(256),
        on_cells(128, pmma_plan(offset(), 5.0)),
        on_cells(128, sweep_plan(twelve_branches(), offset(), 10.0, 5.0)),
        twelve_on(192),
        marched,
        with_bars(pmma_on(256)),
        with(springs, |plan| plan.solver.springs = 2000),
    ];
    let mut failed = Vec::new();
    for (k, plan) in plans.into_iter().enumerate() {
        let setup = Setup::new(plan).unwrap();
        let predicted = setup.predicted_case_bytes();
        let case = setup.plan().cases().remove(0);
        let mut cycles = 0;
        // With a checkpoint after every cycle, which takes no copy of what it holds.
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", false).unwrap();
        let checkpoints = Checkpoints::of(&store, Purpose::Sweep, &case, Duration::ZERO);
        let counted = peak(|| {
            let record = setup.run_from(&checkpoints, &case, &AtomicBool::new(false));
            let record = record.unwrap();
            assert!(record.result.is_some(), "{record:?}");
            cycles = record.cycles;
        });
        let ratio = predicted as f64 / counted as f64;
        println!("{k}: {counted} bytes, {cycles} cycles, predicted {ratio:.3} times that");
        // Of springs it is a guess on the safe side: how many rows of their table are asked for depends on the cycle.
        let highest = match setup.plan().solver.engine {
            EngineKind::Axisymmetric => f64::INFINITY,
            EngineKind::HalfSpace => 1.2,
        };
        if !(0.8..highest).contains(&ratio) {
            failed.push((k, ratio));
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
fn a_history_holds_the_memory_predicted_with_checkpoints_and_fields() {
    let _alone = alone();
    let rough = |edge, sphere_radius_m| {
        let roughness = Roughness {
            cells: 256,
            spacing_m: 1e-6,
            hurst_exponent: 0.8,
            rms_height_m: 2e-8,
            roll_off_wavelength_m: Some(64e-6),
            cut_off_wavelength_m: 8e-6,
            seed: 1,
            sphere_radius_m,
            edge,
        };
        Arc::new(roughness.map().unwrap()) as Arc<dyn Indenter>
    };
    let periodic = || rough(MapEdge::Periodic, None);
    let three = || solid(1e9, &[(1e8, 0.1), (1e8, 1.0), (1e8, 10.0)], 0.4);
    let offset = || Arc::new(Shifted::new(sphere(0.01), 1.37e-5, 7.1e-6).unwrap());
    let area_m2 = (256e-6_f64).powi(2);
    // Half and all of a period, a sphere that fills its domain, a quarter of it, a rough punch.
    let histories: [(Arc<dyn Indenter>, f64, usize); 7] = [
        (offset(), 10.0, 0),
        (periodic(), 2e6 * area_m2, 0),
        (periodic(), 1e9 * area_m2, 0),
        (periodic(), 2e6 * area_m2, 3),
        (offset(), 10.0, 2),
        (sphere(0.01), 10.0, 0),
        (rough(MapEdge::Rim, None), 10.0, 0),
    ];
    let mut failed = Vec::new();
    for (k, (indenter, load_n, fields)) in histories.into_iter().enumerate() {
        let drive = SegmentedDrive::new(Control::Load, vec![step(load_n, 1.0)]).unwrap();
        let plan = with(ScenarioPlan::new(three(), indenter, drive), |plan| {
            (plan.solver.engine, plan.solver.cells) = (EngineKind::HalfSpace, 256);
            plan.step_s = Some(0.1);
            plan.output.error_bars = false;
            plan.output.fields_at_s = (1..=fields).map(|at| 0.1 * at as f64).collect();
        });
        let before = HELD.load(Ordering::Relaxed);
        let simulation = Simulation::new(plan).unwrap();
        let surface = HELD.load(Ordering::Relaxed).saturating_sub(before);
        let predicted = simulation.predicted_memory_bytes() - 15_000_000;
        let folder = tempfile::TempDir::new().unwrap();
        let store = Store::open(folder.path(), "", false).unwrap();
        let checkpoint = HistoryCheckpoint::of(&store, Duration::ZERO);
        let counted = peak(|| {
            let flag = AtomicBool::new(false);
            let outcome = simulation.run_from(None, Some(&checkpoint), &flag, &|_, _| {});
            assert_eq!(outcome.ended, SimulationEnd::Done);
        });
        // The map was there before.
        let counted = counted + surface;
        let ratio = predicted as f64 / counted as f64;
        println!("{k}: {counted} bytes, predicted {ratio:.3} times that");
        if !(0.8..1.2).contains(&ratio) {
            failed.push((k, ratio));
        }
    }
    assert!(failed.is_empty(), "{failed:?}");
}

#[test]
#[cfg(feature = "report")]
fn large_pictures_are_drawn_one_after_another_in_the_memory_predicted() {
    use contact_dma::figures::paper::drawing_bytes;
    use contact_dma::report::chart::{Axis, Chart, Series};
    use contact_dma::sweep::plan::figures::{FigurePlan, Format};

    let _alone = alone();
    let plan = FigurePlan {
        formats: vec![Format::Png].into(),
        dpi: Some(600),
        ..FigurePlan::default()
    };
    let chart = Chart::new(Axis::linear("x"), Axis::linear("y"));
    let drawing = chart.series(Series::line([(0.0, 0.0), (1.0, 1.0)]));
    let drawing = drawing.draw().unwrap();
    let counted = peak(|| {
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| drawing.to_png_at(600).unwrap());
            }
        });
    });
    let ratio = drawing_bytes(&plan, 3) as f64 / counted as f64;
    println!("{counted} bytes, predicted {ratio:.3} times that");
    assert!((ratio - 1.0).abs() < 0.2, "{ratio}");
}

#[test]
fn a_record_takes_its_own_bytes_however_long_the_plan_and_however_many_there_are() {
    let _alone = alone();
    let drive = HarmonicDrive::load(5.0, 2.0).unwrap();
    let sweep = Sweep::new(pmma_material(), Sphere::new(0.01).unwrap(), drive);
    let sweep = sweep.steps(16).unwrap().springs(16).unwrap();
    let sweep = sweep.frequencies_hz([1e-3]).unwrap();
    let setup = Setup::new(sweep.into_plan()).unwrap();
    let mut case = setup.plan().cases().remove(0);
    let record = setup.run(&case, &AtomicBool::new(false)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    // As of a sweep of some ten thousand frequencies.
    let plan = format!("title = {:?}\n", "long".repeat(100_000));
    let store = Store::open(folder.path(), &plan, false).unwrap();
    let mut save = || {
        store
            .records()
            .insert(Purpose::Sweep, &case, &record)
            .unwrap();
        case.angular_frequency_rad_per_s *= 1.1;
    };
    // The first takes what all share.
    save();
    let taken = TAKEN.load(Ordering::Relaxed);
    let count = 20;
    (0..count).for_each(|_| save());
    let each = (TAKEN.load(Ordering::Relaxed) - taken) / count;
    assert!(each < 100_000, "{each} bytes for a record");
}

#[test]
fn another_amplitude_takes_no_operator_of_its_own() {
    let _alone = alone();
    let drive = HarmonicDrive::load(5.0, 1.0).unwrap();
    let sweep = Sweep::new(pmma_material(), Sphere::new(0.01).unwrap(), drive).cells(128);
    let sweep = sweep.unwrap().frequencies_hz([1e-3]).unwrap();
    let amplitudes = (0..9).map(|k| 1.0 + 0.4 * f64::from(k));
    let plan = sweep.amplitudes(amplitudes).unwrap().into_plan();
    let setup = Setup::new(plan).unwrap();
    let mut held = Vec::new();
    for condition in setup.plan().conditions().iter() {
        let engines = setup.engines(condition, 128).unwrap();
        let mut engine = engines.engine(0).unwrap();
        let compliance = pmma();
        let mut march = March::new(engine.as_mut(), compliance, TimeRule::Linear);
        march.relax(Prescribed::LoadN(5.0)).unwrap();
        drop(march);
        drop(engine);
        held.push(HELD.load(Ordering::Relaxed));
    }
    // A spectrum of 128 x 128 cells alone takes 130 kB; a contact of another size may ask for a window of its own.
    let more = held[8].saturating_sub(held[0]) / 8;
    assert!(more < 40_000, "{more} bytes for an amplitude");
}

#[test]
fn a_march_holds_the_memory_predicted_and_takes_no_more_while_it_steps() {
    let _alone = alone();
    let (radius_m, load_n) = (0.01, 10.0);
    let sphere = Sphere::new(radius_m).unwrap();
    let compliance = pmma();
    let relaxed = compliance.equilibrium_compliance().unwrap();
    let half_width_m = 1.1 * common::hertz_radius_m(radius_m, load_n, relaxed);
    let whole = [64, 100, 128, 256].map(|cells| (cells, false));
    for (cells, quarter) in whole
        .into_iter()
        .chain([(128, true), (256, true), (512, true)])
    {
        let grid = grid(half_width_m, cells);
        let grid = grid.quarter().filter(|_| quarter).unwrap_or(grid);
        let before = HELD.load(Ordering::Relaxed);
        let mut engine = cells_on(&sphere, grid);
        let mut march = March::new(&mut engine, compliance.clone(), TimeRule::Linear);
        march.jump(Prescribed::LoadN(load_n)).unwrap();
        let weights = march.weights(50.0);
        for _ in 0..3 {
            march.step(&weights, Prescribed::LoadN(load_n)).unwrap();
        }
        let held = HELD.load(Ordering::Relaxed) - before;
        let field = CellField {
            grid,
            is_periodic: false,
            is_map: false,
        };
        let predicted = field.memory_bytes(compliance.branches().len());
        let ratio = predicted as f64 / held as f64;
        println!("{cells} cells: {held} bytes held, predicted {ratio:.3} times that");
        assert!((ratio - 1.0).abs() < 0.2, "{cells} cells: {ratio}");
        let allocations = ALLOCATIONS.load(Ordering::Relaxed);
        for _ in 0..20 {
            march.step(&weights, Prescribed::LoadN(load_n)).unwrap();
        }
        // Nothing is allocated in a step, but that a contact may grow into a new window once.
        let new = ALLOCATIONS.load(Ordering::Relaxed) - allocations;
        assert!(new < 200, "{cells} cells: {new} allocations in 20 steps");
    }
}
