//! The figures of sweeps: what their data say, which there are, and what is left out.

use crate::prelude::*;
use contact_dma::drive::{Control, HarmonicDrive};
use contact_dma::engine::EngineKind;
use contact_dma::indenter::{HeightMap, MapEdge, MapQuantity};
use contact_dma::quantity::Dimension;
use contact_dma::report;
use contact_dma::sweep::plan::{Axes, AxisValue, AxisValues, Block, Condition, Varied};
use contact_dma::sweep::record::Status;
use contact_dma::sweep::search::run::{self, Mode, Outcome};
use contact_dma::sweep::store::Store;

/// A sweep with what it left in its folder.
struct Swept {
    folder: TempDir,
    outcome: Outcome,
    left_out: Vec<String>,
}

fn swept(plan: SweepPlan) -> Swept {
    let folder = TempDir::new().unwrap();
    let setup = Setup::new(plan).unwrap();
    let store = Store::open(folder.path(), "a sweep", false).unwrap();
    let (threads, never) = (Mode::on_threads(2), AtomicBool::new(false));
    let outcome = run::run(&setup, &store, threads, &never, &()).unwrap();
    let left_out = report::write_sweep(&store, setup.plan(), &outcome).unwrap();
    Swept {
        folder,
        outcome,
        left_out,
    }
}

impl Swept {
    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.folder.path().join(name)).unwrap()
    }

    fn table(&self, name: &str) -> Table {
        Table::of(&self.text(name))
    }

    fn says_left_out(&self, why: &str) {
        let mut left_out = self.left_out.iter();
        assert!(left_out.any(|reason| reason.contains(why)), "{why}");
    }

    fn column(&self, table: &str, column: &str) -> Vec<f64> {
        self.table(table).numbers(column)
    }

    fn figures(&self) -> BTreeSet<String> {
        let names = names_in(&self.folder.path().join("figures")).into_iter();
        names
            .filter_map(|name| Some(name.strip_suffix("@2x.png")?.to_owned()))
            .collect()
    }
}

fn names_in(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    let files = entries.filter(|entry| entry.path().is_file());
    files
        .map(|entry| entry.file_name().into_string().unwrap())
        .collect()
}

/// PMMA under the sphere of the main job, coarse.
pub fn pmma(angular_frequencies_rad_per_s: &[f64]) -> SweepPlan {
    let mut plan = pmma_plan(sphere(10e-3), 5.0);
    plan.angular_frequencies_rad_per_s = angular_frequencies_rad_per_s.to_vec();
    (plan.cycle.steps, plan.solver.springs) = (60, 120);
    plan
}

pub fn with_amplitudes(mut plan: SweepPlan, amplitudes: &[f64]) -> SweepPlan {
    let varied = Varied::amplitude(plan.base.drive.control());
    let axis = Axes::of_drive(&plan, varied, amplitudes.iter().copied());
    plan.axes = Some(axis.unwrap());
    plan
}

/// Two amplitudes, each under two means, phases and rests: 16 conditions.
fn over_four_axes(mut plan: SweepPlan) -> SweepPlan {
    let control = plan.base.drive.control();
    let keys = [
        ("amplitude", Some(Dimension::Force), [1.0, 4.0]),
        ("mean", Some(Dimension::Force), [8.0, 10.0]),
        ("phase", Some(Dimension::Angle), [0.0, 1.0]),
        ("hold", Some(Dimension::Time), [0.0, 5.0]),
    ];
    let over = keys.map(|(key, dimension, _)| Varied::number(Block::Drive, key, dimension));
    let condition = |k: usize| {
        let values = [3, 2, 1, 0].map(|bit| k >> bit & 1);
        let values = [0, 1, 2, 3].map(|axis| keys[axis].2[values[axis]]);
        let [amplitude, mean, phase_rad, hold_s] = values;
        let drive = HarmonicDrive::new(control, mean, amplitude, phase_rad, hold_s);
        Condition {
            values: AxisValues::new(&values.map(AxisValue::Number)).unwrap(),
            drive: drive.unwrap(),
            ..plan.base.clone()
        }
    };
    plan.axes = Some(Axes {
        over: over.to_vec(),
        pairs: false,
        given_blocks: Default::default(),
        conditions: (0..16).map(condition).collect(),
    });
    plan
}

#[test]
fn the_slow_branch_of_pmma_makes_its_peak_and_the_fast_one_the_shoulder() {
    let swept = swept(pmma(&[0.00844, 0.0757]));
    let branches = |case: usize| {
        let result = swept.outcome.records[case].result.as_ref().unwrap();
        let branches = result.branches.iter();
        let loss_j = result.analysis.energy_loss_j;
        let of = branches.map(|b| (b.retardation_time_s, b.energy_loss_j / loss_j));
        of.collect::<Vec<_>>()
    };
    let [(fast_s, fast), (slow_s, slow)] = branches(0)[..] else {
        panic!("PMMA has two branches");
    };
    // The paper's equation (10) has the reciprocals 0.1006 and 0.00747 to fewer digits.
    assert!((fast_s - 9.9363).abs() < 1e-3 && (slow_s - 133.870).abs() < 1e-2);
    assert!(slow > 0.85 && fast < 0.15, "{slow} {fast}");
    let [(_, fast), (_, slow)] = branches(1)[..] else {
        panic!("PMMA has two branches");
    };
    assert!(fast > 0.75 && slow < 0.25, "{fast} {slow}");
    // The figure's data are these numbers.
    let losses = swept.column("figures/dissipation.csv", "energy_loss_j");
    // Both frequencies of the fast branch, of the slow one, and of the loop.
    let [fast, _, slow, _, total, _] = losses[..] else {
        panic!("{losses:?}");
    };
    // Loop area and dissipation agree to the discretisation: 60 steps, of second order.
    near!(fast + slow, total, 2e-3);
    assert!((slow / total - 0.88).abs() < 0.02);
}

/// The integral of the mapped density over the surface.
fn integral(swept: &Swept) -> f64 {
    let name = "figures/dissipation-map.csv";
    let density = swept.column(name, "work_j_per_m2");
    let columns = swept.table(name).columns;
    if columns.contains(&"radius_m".to_owned()) {
        let r = swept.column(name, "radius_m");
        let ring = |k: usize| {
            let at = |k: usize| std::f64::consts::TAU * r[k] * density[k];
            0.5 * (at(k) + at(k + 1)) * (r[k + 1] - r[k])
        };
        return (0..r.len() - 1).map(ring).sum();
    }
    let x = swept.column(name, "x_m");
    let spacing = x[1] - x[0];
    spacing * spacing * density.iter().sum::<f64>()
}

#[test]
fn the_work_over_the_surface_adds_up_to_the_energy_loss_with_both_engines() {
    let springs = swept(pmma(&[0.00844]));
    let mut plan = pmma(&[0.00844]);
    (plan.solver.engine, plan.solver.cells) = (EngineKind::HalfSpace, 64);
    let cells = swept(plan);
    for (swept, tolerance) in [
        // Trapezia over 120 springs, with steps of the contact's edge across them.
        (&springs, 5e-3),
        // A sum over cells is the load itself; what remains is the closing of the loop by 60 steps: (2 pi/60)^2/6.
        (&cells, 3e-3),
    ] {
        let loss_j = swept.outcome.records[0].energy_loss_j().unwrap();
        near!(integral(swept), loss_j, tolerance);
    }
    // In the middle, away from the edge that cells resolve to one in thirty, both engines have the same density.
    let middle = |swept: &Swept, place: &str| {
        let r = swept.column("figures/dissipation-profile.csv", place);
        let w = swept.column("figures/dissipation-profile.csv", "work_j_per_m2");
        let inside = r.iter().zip(w).filter(|(r, _)| r.abs() < 100e-6);
        let (sum, count) = inside.fold((0.0, 0.0), |(s, n), (_, w)| (s + w, n + 1.0));
        sum / count
    };
    let (a, b) = (middle(&springs, "radius_m"), middle(&cells, "radius_m"));
    near!(a, b, 0.02);
}

/// Of the folder, and of who computes in it.
const LOCKS: [&str; 2] = [".contact-dma.compute.lock", ".contact-dma.lock"];

/// Figures of a sweep over frequency alone.
const FIGURES: &str = "energy-loss loops dissipation dissipation-profile dissipation-map moduli cole-cole van-gurp-palmen loss-tangent";
/// And those that an axis of four amplitudes adds.
const OF_AMPLITUDES: &str =
    "loss-map harmonic-2-map peaks moduli-error energy-loss-over-amplitude moduli-over-amplitude";

fn set(names: &str) -> BTreeSet<String> {
    names.split_whitespace().map(str::to_owned).collect()
}

#[test]
fn which_figures_there_are_follows_from_the_axes_and_another_sweep_clears_them() {
    let omegas = [0.002, 0.004, 0.008, 0.02];
    let one = swept(pmma(&omegas));
    let two = swept(with_amplitudes(pmma(&omegas), &[1.0, 2.0, 5.0, 10.0]));
    assert!(one.left_out.is_empty() && two.left_out.is_empty());
    let four = swept(over_four_axes(pmma(&omegas)));
    let top = names_in(four.folder.path()).into_iter();
    let top: Vec<String> = top.filter(|name| !LOCKS.contains(&&**name)).collect();
    assert_eq!(
        top,
        ["index.html", "resolved.toml", "summary.json", "sweep.csv"]
    );
    // One curve has no maps, no peaks along an axis, and no figure over one.
    assert_eq!(one.figures(), set(FIGURES));
    let of_two = set(&format!("{FIGURES} {OF_AMPLITUDES}"));
    assert_eq!(two.figures(), of_two);
    // Two values of an axis make no map.
    four.says_left_out("no map");
    let mut of_four = of_two;
    of_four.retain(|name| !name.ends_with("map") || name == "dissipation-map");
    for (axis, name) in [(2, "mean"), (3, "phase"), (4, "hold")] {
        of_four.extend(["energy-loss", "peaks"].map(|figure| format!("{figure}-{axis}")));
        let over = ["energy-loss", "moduli", "moduli-error"];
        of_four.extend(over.map(|figure| format!("{figure}-over-{name}")));
    }
    assert_eq!(four.figures(), of_four);
    Store::open(four.folder.path(), "another sweep", true).unwrap();
    let left: Vec<String> = names_in(four.folder.path()).into_iter().collect();
    assert_eq!(left, [LOCKS[0], LOCKS[1], "resolved.toml"]);
    assert!(!four.folder.path().join("figures").exists());
}

#[test]
fn the_indentation_formula_is_exact_for_a_punch_and_the_worse_the_larger_the_amplitude_for_a_sphere()
 {
    let omegas = [0.004, 0.008, 0.02];
    let mut plan = pmma(&omegas);
    plan.base.contact.indenter = punch(1e-3);
    let punch = swept(plan);
    let material = &pmma(&omegas).base.contact.material;
    for record in &punch.outcome.records {
        let result = record.result.as_ref().unwrap();
        let own = material.longitudinal_complex_modulus(record.angular_frequency_rad_per_s);
        // The correspondence principle, but for 60 steps of second order.
        near!(result.storage_modulus_pa.unwrap(), own.re, 3e-3);
        near!(result.loss_modulus_pa.unwrap(), own.im, 3e-3);
    }
    let sphere = swept(with_amplitudes(pmma(&omegas), &[0.5, 2.0, 10.0]));
    let error = sphere.column("figures/moduli-error.csv", "loss_relative_difference");
    // One curve for each frequency: that in the middle over the amplitudes.
    let [small, middle, large] = [3, 4, 5].map(|k| -error[k]);
    assert!(small < middle && middle < large, "{error:?}");
    assert!(small < 0.01 && large > 0.05, "{error:?}");
}

#[test]
fn figures_that_do_not_apply_are_left_out_and_said() {
    let single = swept(pmma(&[0.008]));
    assert!(!single.left_out.is_empty());
    assert!(single.figures().contains("dissipation-map"));
    assert!(!single.figures().contains("cole-cole") && !single.figures().contains("dissipation"));

    let mut elastic = pmma(&[0.004, 0.008, 0.02]);
    elastic.base.contact.material = Arc::new(solid(2e9, &[], 0.3));
    let elastic = swept(elastic);
    elastic.says_left_out("branches");
    assert!(!elastic.figures().contains("dissipation"));

    // An approach that is prescribed has no harmonics to be mapped.
    let mut approach = pmma(&[0.004, 0.008, 0.02]);
    approach.base.drive = HarmonicDrive::new(Control::Approach, 1e-6, 0.5e-6, 0.0, 0.0).unwrap();
    approach.angular_frequencies_rad_per_s = vec![0.002, 0.004, 0.008, 0.02];
    let approach = swept(with_amplitudes(approach, &[0.2e-6, 0.5e-6, 1e-6, 2e-6]));
    approach.says_left_out("harmonic-2");
    assert!(!approach.figures().contains("harmonic-2-map"));
    assert!(approach.figures().contains("loss-map"));
}

#[test]
fn the_terminal_has_the_loss_of_every_case_at_one_frequency_and_the_largest() {
    let axis = "[sweep]\nangular_frequency = [\"0.01 rad/s\"]\ndrive.amplitude = [\"1 N\", \"2 N\", \"8 N\"]\n";
    let place = Place::with("one.toml", &pmma_sweep(axis));
    let run = place.done("sweep one.toml --no-figures --out out --set cycle.steps=32");
    let table = Table::of(&place.text("out/sweep.csv"));
    let losses = table.numbers("energy_loss_j");
    assert!(losses.is_sorted(), "{losses:?}");
    let said = run.stdout.clone() + &run.stderr;
    for (amplitude, loss_j) in ["1 N", "2 N", "8 N"].iter().zip(&losses) {
        let row = said.lines().find(|line| line.trim().starts_with(amplitude));
        // A number of a few digits, in a prefix that suits it: 116.0 nJ, 8.37 µJ.
        let told = row.unwrap().split_whitespace().nth(2).unwrap();
        let told: f64 = told.parse().unwrap();
        let digits = (loss_j / told).log10();
        assert!((digits - digits.round()).abs() < 1e-3, "{told} {loss_j}");
    }
    let most = said.lines().find(|line| line.starts_with("Largest loss: "));
    assert!(
        most.unwrap().ends_with(" at ω = 10⁻² rad/s, amplitude 8 N"),
        "{most:?}"
    );
}

#[test]
fn one_frequency_is_drawn_over_the_axis_and_its_table_has_every_case() {
    let amplitudes = [1.0, 2.0, 4.0, 6.0, 8.0];
    let swept = swept(with_amplitudes(pmma(&[0.008]), &amplitudes));
    let table = "figures/energy-loss.csv";
    assert_eq!(swept.column(table, "drive_amplitude"), amplitudes);
    let losses = swept.column("sweep.csv", "energy_loss_j");
    assert_eq!(swept.column(table, "energy_loss_j"), losses);
    let caption = swept.text("figures/energy-loss.caption.txt");
    assert!(
        caption.starts_with("Energy loss per cycle over load amplitude: "),
        "{caption}"
    );
    // What every case has in common is told too, in every caption.
    for name in swept.figures() {
        let caption = swept.text(&format!("figures/{name}.caption.txt"));
        assert!(caption.contains(", ω = 8 × 10⁻³ rad/s"), "{caption}");
    }
    // The material is the same at every amplitude: a diagram of its moduli would be a point.
    assert!(swept.figures().contains("moduli") && !swept.figures().contains("cole-cole"));
    let own = swept.column("figures/moduli.csv", "modulus_pa");
    assert!(own[..5].iter().all(|modulus| *modulus == own[0]), "{own:?}");
}

#[test]
fn a_case_without_a_result_in_the_middle_of_a_map_is_a_hole_in_it() {
    let omegas = [0.002, 0.004, 0.008, 0.016, 0.03];
    let plan = with_amplitudes(pmma(&omegas), &[0.5, 1.0, 2.0, 4.0, 8.0]);
    let swept = swept(plan.clone());
    let whole = swept.text("figures/loss-map.svg");
    let mut holed = swept.outcome.clone();
    let case = &mut holed.records[12];
    (case.status, case.result) = (Status::NotConverged, None);
    let store = Store::open(swept.folder.path(), "a sweep", false).unwrap();
    report::write_sweep(&store, &plan, &holed).unwrap();
    let losses = swept.table("figures/loss-map.csv").found("energy_loss_j");
    let holes = losses.iter().enumerate().filter(|(_, loss)| loss.is_none());
    assert_eq!(holes.map(|(row, _)| row).collect::<Vec<_>>(), [12]);
    // The four fields about the case, of sixteen, are not coloured.
    let holed = swept.text("figures/loss-map.svg").len();
    assert!(holed < whole.len() && holed > whole.len() / 2, "{holed}");
}

#[test]
fn an_earlier_run_that_came_further_leaves_no_figures_beside_new_tables() {
    let swept = swept(pmma(&[0.004, 0.008, 0.02]));
    let mut interrupted = swept.outcome.clone();
    interrupted.records.truncate(1);
    interrupted.peaks.clear();
    let store = Store::open(swept.folder.path(), "a sweep", false).unwrap();
    report::write_sweep(&store, &pmma(&[0.004, 0.008, 0.02]), &interrupted).unwrap();
    assert!(!swept.figures().contains("cole-cole"));
    assert!(swept.figures().contains("loops"));
}

#[test]
fn a_map_is_told_by_its_own_cells_whatever_the_plan_asks_for() {
    let place = |i: usize, n: usize| 40e-6 * (i as f64 - 0.5 * (n as f64 - 1.0));
    let gap = |k: usize| {
        let (x, y) = (place(k % 20, 20), place(k / 20, 15));
        (x * x + y * y) / (2.0 * 10e-3)
    };
    let gaps = (0..20 * 15).map(gap).collect();
    let spacing_m = (40e-6, 40e-6);
    let (quantity, edge) = (MapQuantity::Gap, MapEdge::Unknown);
    let map = HeightMap::new((20, 15), spacing_m, gaps, quantity, edge);
    let mut plan = sweep_plan(pmma_material(), Arc::new(map.unwrap()), 1.0, 0.5);
    (plan.angular_frequencies_rad_per_s, plan.cycle.steps) = (vec![0.008], 32);
    plan.solver.engine = EngineKind::HalfSpace;
    assert_eq!(plan.solver.cells, 128);
    let swept = swept(plan);
    assert_eq!(swept.outcome.records[0].nodes, 20);
    let caption = swept.text("figures/loops.caption.txt");
    assert!(caption.contains("20 × 15 cells of the map"), "{caption}");
    assert!(!caption.contains("128"), "{caption}");
}

#[test]
fn an_elastic_body_loses_nothing_and_is_not_asked_for_a_wider_sweep() {
    for engine in [EngineKind::Axisymmetric, EngineKind::HalfSpace] {
        let mut plan = pmma(&[0.01, 0.1, 1.0]);
        (plan.base.contact.material, plan.cycle.steps) = (Arc::new(solid(1e9, &[], 0.3)), 32);
        (plan.solver.engine, plan.solver.cells) = (engine, 32);
        let told = report::terminal::peaks(&plan, &swept(plan.clone()).outcome).to_string();
        assert!(told.contains("an elastic body loses nothing"), "{told}");
        for record in &swept(plan).outcome.records {
            // Not -0 either, which a table would show.
            let loss_j = record.energy_loss_j().unwrap();
            assert_eq!(loss_j.to_bits(), 0.0_f64.to_bits(), "{engine:?}: {loss_j}");
        }
    }
}
