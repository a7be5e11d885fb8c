//! Measured data as a material: from a CSV file to the contact, with a fit and without one.

use crate::common::engines;
use crate::common::pmma_material as pmma;
use crate::prelude::*;
use std::f64::consts::TAU;
use std::time::Instant;

use contact_dma::contact::Prescribed;
use contact_dma::history::{DirectMemory, Hereditary, March, Memory, TimeRule};
use contact_dma::material::MaterialFunction;
use contact_dma::material::fit::fit as fit_of;
use contact_dma::material::law::{Form, Law};
use contact_dma::material::tabulated::Tabulated;
use contact_dma::prelude::*;
use contact_dma::reference::transient::step_load_contact_radius_m;
use contact_dma::sweep::plan::resolved;
use contact_dma::sweep::record::material_error;

/// Ten samples per decade, from 0.1 s to 1000 s.
fn times_s() -> Vec<f64> {
    (0..=40)
        .map(|i| 0.1 * 10_f64.powf(f64::from(i) / 10.0))
        .collect()
}

/// What is measured of PMMA at a time.
fn measured(function: MaterialFunction) -> impl Fn(f64) -> f64 {
    let material = pmma();
    move |time_s| match function {
        MaterialFunction::Creep => material.creep().compliance(time_s),
        MaterialFunction::Relaxation => material.relaxation().unwrap().modulus(time_s),
    }
}

fn csv(function: MaterialFunction) -> String {
    let column = match function {
        MaterialFunction::Creep => "creep_compliance_per_pa",
        MaterialFunction::Relaxation => "relaxation_modulus_pa",
    };
    let value = measured(function);
    let rows = times_s().into_iter().map(|t| format!("{t},{}\n", value(t)));
    format!("time_s,{column}\n{}", rows.collect::<String>())
}

/// Those times and what is measured, changed.
fn tabulated(function: MaterialFunction, mut change: impl FnMut(f64) -> f64) -> Tabulated {
    let value = measured(function);
    let values = times_s().into_iter().map(|t| change(value(t))).collect();
    Tabulated::new(function, pmma().kind(), times_s(), values).unwrap()
}

const REST: &str = include_str!("../inputs/under-a-sphere.toml");

const TABLE: &str = include_str!("../inputs/table.toml");

#[test]
fn the_printed_block_is_a_material_block_with_exact_numbers() {
    let place = Place::new();
    for (function, quantity) in [
        (MaterialFunction::Creep, "creep"),
        (MaterialFunction::Relaxation, "relaxation"),
    ] {
        place.put("data.csv", csv(function));
        let fit = format!(
            "material fit data.csv --quantity {quantity} --modulus longitudinal --poisson-ratio 0.38"
        );
        let written = place.done(&format!("{fit} --out {quantity}"));
        // What goes into a file is printed only where there is none.
        assert!(!written.stdout.contains("[material"), "{written:?}");
        written.says(&[
            "Fit of 2 branches",
            "Misfit relative to the data",
            "the data begin at 0.1 s",
        ]);
        let printed = place.done(&fit).stdout;
        let block = &printed[printed.find("# From data.csv").unwrap()..];
        assert_eq!(block, place.text(&format!("{quantity}/material.toml")));

        let plan = sweep_of(block).unwrap();
        let table = Table::of(&csv(function));
        let [times, values] = [0, 1].map(|column| table.numbers(&table.columns[column]));
        let table = Tabulated::new(function, pmma().kind(), times, values).unwrap();
        let expected = fit_of(&table, None).unwrap().material(0.38).unwrap();
        let material = &plan.base.contact.material;
        assert_eq!(material.creep(), expected.creep());
        assert_eq!(material.relaxation(), expected.relaxation());
        assert_eq!(material.poisson_ratio(), Some(0.38));
        place.has_all(
            quantity,
            "figures/fit.svg figures/fit.png figures/fit@2x.png figures/fit-residual.svg",
        );
        let prony = place.table(&format!("{quantity}/prony.csv"));
        assert_eq!(prony.columns, ["modulus_pa", "time_s"]);
        assert!(prony.len() > 1 && prony.found("time_s")[0].is_none());
        let rows = place.table(&format!("{quantity}/figures/fit.csv")).len();
        assert_eq!(rows, times_s().len());
    }
}

#[test]
fn a_sweep_takes_its_material_from_a_table_beside_its_file_and_shows_the_misfit() {
    let place = Place::new();
    place.put("project/data/creep.csv", csv(MaterialFunction::Creep));
    place.put(
        "project/sweep.toml",
        format!("title = \"tabulated\"\n{TABLE}{REST}"),
    );
    let library = "title = \"library\"\n[material]\nlibrary = \"pmma\"\n";
    place.put("project/pmma.toml", format!("{library}{REST}"));
    // From another folder: the path counts from the sweep file.
    place.done("sweep project/pmma.toml --no-figures --out pmma");
    let run = place.done("sweep project/sweep.toml --no-figures --out sweep");
    run.says(&["Fit of 2 branches", "the data begin at 0.1 s"]);
    let loss = |name: &str| {
        let summary = place.json(&format!("{name}/summary.json"));
        summary["peaks"][0]["energy_loss_j"].as_f64().unwrap()
    };
    // The table holds seventeen digits: its fit is the library's material to 1e-12, and marching amplifies nothing.
    near!(loss("sweep"), loss("pmma"), 1e-9);
    // What is resolved needs no table.
    let resolved = place.text("sweep/resolved.toml");
    assert!(resolved.contains("[material.creep]") && !resolved.contains("creep.csv"));
    let shown = place.done("material show project/sweep.toml");
    shown.says(&["Misfit relative to the data", "E(0) = 2491.44 MPa"]);
    // In a flag, the path counts from the working folder.
    place.done("sweep project/sweep.toml --no-figures --out flag --set material.table.file=project/data/creep.csv");
}

/// A sweep of this material under a sphere, or why there is none.
fn sweep_of(material: &str) -> Result<SweepPlan, String> {
    plans::try_sweep(&format!("title = \"x\"\n{material}{REST}"), &[])
}

#[test]
fn a_fluid_among_tables_is_a_solid_where_the_file_says_so() {
    let values: Vec<String> = times_s()
        .iter()
        .map(|t| format!("{:.3e}", 1e-9 * (1.0 + t / 30.0)))
        .collect();
    let table = format!("times = {:?}\nvalues = [{}]", times_s(), values.join(", "));
    let fluid = TABLE.replace("file = \"data/creep.csv\"", &table);
    assert!(sweep_of(&fluid).unwrap_err().contains("flow = false"));
    assert!(sweep_of(&format!("{fluid}flow = false\n")).is_ok());
}

#[test]
fn the_window_and_the_alternatives_of_a_series_are_read() {
    let series = "[material.relaxation]\nmodulus = \"shear\"\nequilibrium = 1e6\nbranches = []\n";
    let other = "[[material.alternative]]\nequilibrium = 9e5\nbranches = []\n";
    let window = "[material]\npoisson_ratio = 0.3\nmeasured = [\"0.1 s\", \"1000 s\"]\n";
    let plan = sweep_of(&format!("{window}{series}{other}")).unwrap();
    let origin = &plan.base.contact.material.origin;
    assert_eq!(origin.measured_window_s, Some((0.1, 1000.0)));
    assert_eq!(origin.alternatives.len(), 1);
}

/// A relaxation modulus that has not levelled off when the test ends, with five digits.
fn unfinished() -> String {
    let modulus = measured(MaterialFunction::Relaxation);
    let rows = times_s().into_iter().filter(|t| *t < 101.0);
    let rows: String = rows.map(|t| format!("{t},{:.4e}\n", modulus(t))).collect();
    format!("time_s,relaxation_modulus_pa\n{rows}")
}

#[test]
fn the_window_and_the_alternatives_of_a_fit_survive_the_resolved_file() {
    let table = TABLE.replace("\"creep\"", "\"relaxation\"");
    let place = Place::with("sweep.toml", &format!("title = \"x\"\n{table}{REST}"));
    place.put("data/creep.csv", unfinished());
    let plan = plans::of(&Document::read(&place.path("sweep.toml")).unwrap()).unwrap();
    let material = &plan.base.contact.material;
    let (first_s, last_s) = material.origin.measured_window_s.unwrap();
    assert!((first_s - 0.1).abs() < 1e-12 && (last_s - 100.0).abs() < 1e-9);
    assert!(material.origin.alternatives.len() >= 2);
    let parts = ["measured = [", "[[material.alternative]]"];
    says(&resolved_text(&plan), &parts);
    let again = plans::again(&plan).base.contact.material;
    assert_eq!(again.origin.alternatives, material.origin.alternatives);
    assert_eq!(again.origin.measured_window_s, Some((first_s, last_s)));
    assert_eq!(again.relaxation(), material.relaxation());
}

#[test]
fn under_a_pressure_the_surface_of_noisy_samples_is_never_displaced_outwards() {
    let mut random = Random(1);
    for function in [MaterialFunction::Creep, MaterialFunction::Relaxation] {
        let table = tabulated(function, |value| {
            value * (1.0 + random.between(-0.03, 0.03))
        });
        let contact = table.contact_compliance(0.38).unwrap();
        for rule in [TimeRule::Linear, TimeRule::Constant] {
            // Pressures that come and go, all of them within the steps of the noise.
            let mut memory = DirectMemory::new(contact.clone(), 20);
            let mut pressure = vec![0.0; 20];
            for step in 0..60 {
                let weights = memory.weights(0.05 * 1.15_f64.powi(step), rule);
                let mut history = vec![0.0; 20];
                memory.predict(&weights, &pressure, &mut history);
                for p in &mut pressure {
                    *p = (1e6 * (random.unit() - 0.6)).max(0.0);
                }
                memory.commit(&weights, &pressure);
                let scale = contact.value(0.0) * 1e6;
                for (p, h) in pressure.iter().zip(&history) {
                    let displacement = weights.compliance_per_pa * p + h;
                    // Sums of sixty terms.
                    assert!(displacement >= -1e-13 * scale, "{rule:?} {step}");
                }
            }
        }
    }
}

/// Instants of the march: most of them between samples, some before the first.
fn instants() -> Vec<f64> {
    (0..=97)
        .map(|i| 0.05 * 10_f64.powf(f64::from(i) / 23.0))
        .collect()
}

/// Contact radii of a sphere under a step load.
fn step_load<M: Hereditary>(memory: impl Fn(usize) -> M) -> Vec<f64> {
    let sphere = Sphere::new(RADIUS_M).unwrap();
    let mut engine = engines::springs(&sphere, 5e-4, 400);
    let mut march = March::with_memory(&mut engine, memory(400), TimeRule::Linear);
    march.jump(Prescribed::LoadN(LOAD_N)).unwrap();
    let mut before = 0.0;
    let radius = |time| {
        let weights = march.weights(time - before);
        before = time;
        let found = march.step(&weights, Prescribed::LoadN(LOAD_N));
        found.unwrap().contact_radius_m
    };
    instants().into_iter().map(radius).collect()
}

/// The largest relative difference.
fn apart(left: &[f64], right: &[f64]) -> f64 {
    let pairs = left.iter().zip(right);
    largest(pairs.map(|(a, b)| (a / b - 1.0).abs()))
}

const RADIUS_M: f64 = 10e-3;
const LOAD_N: f64 = 10.0;

#[test]
fn a_step_load_on_tabulated_pmma_is_the_same_direct_and_fitted_and_both_are_right() {
    let compliance = pmma().contact_compliance().unwrap();
    // Six digits, as data come.
    let rounded = |value: f64| format!("{value:.5e}").parse::<f64>().unwrap();
    let table = tabulated(MaterialFunction::Creep, rounded);
    let contact = table.contact_compliance(0.38).unwrap();
    let times = (1..=3000).map(|i| 0.1 * 10_f64.powf(4.0 * f64::from(i) / 3000.0));
    let times: Vec<f64> = [0.0].into_iter().chain(times).collect();
    let of = |value: &dyn Fn(f64) -> f64| times.iter().map(|t| value(*t)).collect::<Vec<_>>();
    let exact = of(&|t| compliance.compliance(t));
    let interpolation_error = apart(&of(&|t| contact.value(t)), &exact);
    let fit = fit_of(&table, None).unwrap();
    let misfit = fit.report().misfit.largest;
    let fitted = fit.material(0.38).unwrap().contact_compliance().unwrap();

    let exact = instants().into_iter();
    let exact = exact.map(|t| step_load_contact_radius_m(RADIUS_M, LOAD_N, &compliance, t));
    let exact: Vec<f64> = exact.collect();
    let recursive = step_load(|nodes| Memory::new(compliance.clone(), nodes));
    let direct = step_load(|nodes| DirectMemory::new(contact.clone(), nodes));
    let by_fit = step_load(|nodes| Memory::new(fitted.clone(), nodes));
    println!("interpolation {interpolation_error:.2e}, misfit {misfit:.2e}");
    // The radius goes with the cube root of the compliance; linear steps of the pressure are the same for all three, and so
    // are the springs. What the table does to the recursion's result is at most what it does to the compliance.
    below!(apart(&direct, &recursive), interpolation_error);
    below!(apart(&by_fit, &recursive), 3.0 * misfit);
    below!(apart(&direct, &by_fit), interpolation_error + misfit);
    // Springs and steps against the closed form.
    below!(apart(&recursive, &exact), 2e-3);
}

#[test]
fn a_tabulated_relaxation_modulus_goes_into_contact_without_a_fit() {
    let compliance = pmma().contact_compliance().unwrap();
    let table = tabulated(MaterialFunction::Relaxation, |value| value);
    let contact = table.contact_compliance(0.38).unwrap();
    let direct = step_load(|nodes| DirectMemory::new(contact.clone(), nodes));
    let recursive = step_load(|nodes| Memory::new(compliance.clone(), nodes));
    // Ten samples per decade miss the compliance by 2.2e-4, before 0.1 s by 1.2e-3; a third of it in the radius.
    below!(apart(&direct, &recursive), 5e-4);
}

/// A rubber of ten branches over eight decades, its moduli off by a standard deviation of `noise`, drawn from `seed`.
fn rubber(noise: f64, seed: u64) -> Material {
    let mut random = Random(seed);
    let mut off = |value: f64| value * (1.0 + noise * random.normal());
    let equilibrium = off(2e6);
    let branches: Vec<_> = (0..9)
        .map(|k| (off(1e6 * 3_f64.powi(k)), 10_f64.powi(3 - k)))
        .collect();
    let relaxation = series(equilibrium, &branches);
    Material::from_relaxation(relaxation, ModulusKind::Longitudinal, 0.49).unwrap()
}

fn rubber_with_replicas(noise: f64, replicas: u64) -> Material {
    let mut material = rubber(0.0, 0);
    material.origin.replicas = (1..=replicas).map(|seed| rubber(noise, seed)).collect();
    material
}

#[test]
fn the_uncertainty_of_a_flat_punch_is_that_of_the_loss_compliance() {
    let (radius_m, amplitude_n) = (1e-3, 0.2);
    let material = rubber_with_replicas(0.05, 20);
    let drive = HarmonicDrive::load(1.0, amplitude_n).unwrap();
    let sweep = Sweep::new(material.clone(), FlatPunch::new(radius_m).unwrap(), drive);
    let omegas = [1e-2, 1.0, 30.0, 1e3];
    let sweep = sweep.angular_frequencies_rad_per_s(omegas).unwrap();
    let loss_j = |material: &Material, omega: f64| {
        let compliance = material.contact_compliance().unwrap();
        let exact = harmonic((1.0, amplitude_n), omega, &compliance);
        exact.flat_punch(radius_m).1
    };
    for record in sweep.solve().unwrap().records {
        let omega = record.angular_frequency_rad_per_s;
        let own_j = loss_j(&material, omega);
        near!(record.energy_loss_j().unwrap(), own_j, 1e-3);
        let replicas = material.origin.replicas.iter();
        let replicas = replicas.map(|replica| Some(loss_j(replica, omega)));
        let replicas: Vec<_> = replicas.collect();
        let expected_j = material_error::from_replicas(own_j, &replicas).unwrap();
        let error_j = record.energy_loss_material_error_j().unwrap();
        // The error of the coarse steps, which the ratio leaves a small part of.
        near!(error_j, expected_j, 2e-3, "{omega}");
        // Of another kind, and so in a place of its own.
        assert!(record.energy_loss_error_j().unwrap() < 0.1 * error_j);
    }
}

#[test]
fn the_loss_with_a_replica_is_found_on_few_steps_and_springs() {
    let drive = HarmonicDrive::load(1.0, 0.6).unwrap();
    let material = rubber_with_replicas(0.1, 8);
    let solve = |material: Material| {
        let sweep = Sweep::new(material, Sphere::new(0.01).unwrap(), drive);
        let sweep = sweep.angular_frequencies_rad_per_s([1e-2, 1.0, 1e2]);
        sweep.unwrap().without_error_bars().solve().unwrap().records
    };
    let coarse = solve(material.clone());
    for (k, replica) in material.origin.replicas.iter().enumerate() {
        for (with, alone) in coarse.iter().zip(solve(replica.clone())) {
            let result = with.result.as_ref().unwrap();
            let found_j = result.replica_losses_j[k].unwrap();
            let full_j = alone.energy_loss_j().unwrap();
            // Moved by up to 12 %, and found to within 0.07 %: as good as the error of a spread needs.
            near!(found_j, full_j, 1e-3, "{k}");
        }
    }
}

/// Dynamic data of the rubber at -20, 0, 20 and 40 °C with 1 % of noise, shifted by 8 (T - 20 °C)/(100 K + T - 20 °C) decades.
fn noisy_csv() -> String {
    let material = rubber(0.0, 0);
    let mut random = Random(7);
    let hertz = log_spaced(0.1 / TAU, 100.0 / TAU, 13);
    let shift = |celsius: f64| -8.0 * (celsius - 20.0) / (80.0 + celsius);
    // Uniform, of a standard deviation of 1 %.
    let noisy = |value: f64| value * (1.0 + random.between(-0.0173, 0.0173));
    let places = (&[-20.0, 0.0, 20.0, 40.0][..], &*hertz);
    dynamic_csv(material.relaxation().unwrap(), places, shift, noisy)
}

const DYNAMIC: &str = "[material]\npoisson_ratio = 0.49\n[material.dynamic]\nfile = \"dma.csv\"\nmodulus = \"longitudinal\"\n\
                       reference_temperature = \"20 °C\"\nreplicas = 10\n";

/// A folder with the data, and the plan of a sweep of them with flags.
struct Dynamic(Place);

impl Dynamic {
    fn new() -> Self {
        Self(Place::with("dma.csv", &noisy_csv()))
    }

    fn plan(&self, sets: &[&str]) -> SweepPlan {
        let text = format!("title = \"x\"\n{DYNAMIC}{REST}");
        let document = Document::parse("sweep.toml", &text).unwrap();
        let mut document = document.in_folder(&self.0.path(""));
        for set in sets {
            document.set(set).unwrap();
        }
        plans::of(&document).unwrap()
    }
}

#[test]
fn a_file_of_dynamic_data_becomes_a_material_at_a_temperature_with_replicas() {
    let data = Dynamic::new();
    let identity = |sets: &[&str]| resolved::hash(&resolved_text(&data.plan(sets)));
    let plan = data.plan(&[]);
    let own = &plan.base.contact.material;
    assert_eq!(own.origin.temperature_k, Some(293.15));
    assert_eq!(own.origin.replicas.len(), 10);
    // The law of the shift alone, which exports take along, is no part of a sweep.
    let again = plans::again(&plan).base.contact.material;
    assert_eq!(again.relaxation(), own.relaxation());
    assert_eq!(again.origin.replicas, own.origin.replicas);
    // Colder by 40 K, two decades and two thirds: by so much slower, and measured at lower frequencies.
    let cold = data.plan(&["material.temperature=-20 °C"]);
    let [warm_s, cold_s] =
        [&plan, &cold].map(|plan| plan.base.contact.material.origin.measured_window_s);
    let decades = (cold_s.unwrap().0 / warm_s.unwrap().0).log10();
    below!((decades - 8.0 * 40.0 / 60.0).abs(), 0.1);
    let hash = identity(&[]);
    for change in
        "dynamic.replicas=11|dynamic.seed=2|temperature=21 °C|dynamic.branches=5".split('|')
    {
        let flag = format!("material.{change}");
        assert_ne!(identity(&[&flag]), hash, "{change}");
    }
    data.0.put("moved.csv", noisy_csv());
    let moved = data.0.path("moved.csv");
    let moved = format!("material.dynamic.file={}", moved.display());
    assert_eq!(identity(&[&moved]), hash);
    assert_eq!(identity(&["material.dynamic.branches=auto"]), hash);
}

#[test]
fn a_temperature_beyond_the_isotherms_is_warned_of_in_a_resolved_file_too() {
    let data = Dynamic::new();
    let codes = |plan: &SweepPlan| {
        let mut plan = plan.clone();
        plan.angular_frequencies_rad_per_s.truncate(1);
        let warnings = plans::records(plan).remove(0).warnings.into_iter();
        let ours = warnings.filter(|warning| warning.code() == "outside-isotherms");
        ours.map(|warning| warning.to_string()).collect::<Vec<_>>()
    };
    let at = |celsius: &str| {
        let temperature = format!("material.temperature={celsius} °C");
        let fast = ["material.dynamic.replicas=0", "cycle.error_bars=false"];
        data.plan(&[fast[0], fast[1], &temperature])
    };
    for inside in ["-20", "40.4", "10"] {
        assert!(codes(&at(inside)).is_empty(), "{inside}");
    }
    let outside = at("60");
    let said = codes(&outside);
    says(&said[0], &["-20 °C to 40 °C: at 60 °C"]);
    assert_eq!(codes(&plans::again(&outside)), said);
}

#[test]
fn a_time_of_nothing_is_shown() {
    for time in ["1e-307", "5e-324", "1e307"] {
        let series = format!(
            "[material]\npoisson_ratio = 0.3\n[material.relaxation]\nmodulus = \"shear\"\nequilibrium = 1e6\n\
             branches = [{{ modulus = 1e6, time = {time} }}, {{ modulus = 1e6, time = 1 }}]\n"
        );
        let place = Place::with("series.toml", &series);
        let since = Instant::now();
        let shown = place.run("material show series.toml");
        // Shown, or refused for what is beyond the range of a double.
        assert!(matches!(shown.code, 0..=2), "{shown:?}");
        assert!(since.elapsed().as_secs() < 20, "{time}");
    }
}

/// Isotherms of a solid of two branches from 5 to 45 °C under a WLF law, as a table; and the law's log10 a_T
/// at these temperatures, 25 °C being the reference.
fn isotherms() -> (String, Vec<(f64, f64)>) {
    let solid = series(5e6, &[(8e8, 1e-3), (6e7, 1.0)]);
    let log10_a_t = |celsius: f64| -12.0 * (celsius - 25.0) / (60.0 + celsius - 25.0);
    let temperatures = [5.0, 15.0, 25.0, 35.0, 45.0];
    let hertz = log_spaced(0.01, 100.0, 13);
    let table = dynamic_csv(&solid, (&temperatures, &hertz), log10_a_t, |modulus| {
        modulus
    });
    let law = temperatures.map(|celsius| (celsius, log10_a_t(celsius)));
    (table, law.to_vec())
}

const FIT_DYNAMIC: &str = "material fit dma.csv --quantity dynamic --modulus longitudinal";

#[test]
fn dynamic_data_become_a_block_tables_figures_and_a_page() {
    let (table, law) = isotherms();
    let place = Place::with("dma.csv", &table);
    let fit = "--poisson-ratio 0.35 --reference-temperature '25 °C' --replicas 3 --out out";
    let run = place.run_in(&format!("{FIT_DYNAMIC} {fit}"), &[("COLUMNS", "80")]);
    run.ended(0)
        .says(&["found from the content", "Master curve at 25 °C"]);
    let prony = place.table("out/prony.csv");
    assert_eq!(prony.columns, ["modulus_pa", "time_s"]);
    let times = prony.found("time_s");
    assert_eq!(times[0], None);
    assert!(times[1..].iter().all(|time| *time > Some(0.0)));
    let moduli = prony.numbers("modulus_pa");
    assert!(moduli[1..].iter().all(|modulus| *modulus > 0.0));
    let shifts = place.table("out/shift.csv");
    let columns = ["temperature_c", "log10_a_t", "log10_a_t_error"];
    assert_eq!(shifts.columns, columns);
    assert_eq!(shifts.len(), law.len());
    for (row, (celsius, log10_a_t)) in law.iter().enumerate() {
        let [at, found] = shifts.row(row, ["temperature_c", "log10_a_t"]);
        assert_eq!(at, *celsius);
        // The demand on data with noise of 1 %; these have none.
        below!((found - log10_a_t).abs(), 0.03);
    }
    let points = place.table("out/master.csv");
    let expected = "angular_frequency_rad_per_s,storage_modulus_pa,loss_modulus_pa,temperature_c,storage_fit_pa,loss_fit_pa";
    assert_eq!(points.columns.join(","), expected);
    assert_eq!(points.len(), 13 * law.len());
    for row in 0..points.len() {
        // Two branches fit two branches; what is left is what the shifts leave.
        let [of_fit, own] = points.row(row, ["storage_fit_pa", "storage_modulus_pa"]);
        near!(of_fit, own, 0.03, "{row}");
    }
    let summary = place.json("out/summary.json");
    assert_eq!(summary["points"], points.len());
    assert_eq!(summary["isotherms"], law.len());
    assert_eq!(summary["reference_temperature_c"], 25.0);
    assert_eq!(summary["branches"], prony.len() - 1);
    for name in
        "fit fit-residual master-curve isotherms shift-factors spectrum van-gurp-palmen".split(' ')
    {
        assert!(
            place
                .text(&format!("out/figures/{name}.svg"))
                .starts_with("<svg")
        );
        assert!(place.has(&format!("out/figures/{name}.png")));
    }
    assert!(place.text("out/index.html").contains("<figcaption"));
    // The block is that of a sweep file.
    let parts = [
        "poisson_ratio = 0.35\nmeasured = [",
        "[material.relaxation]",
    ];
    says(&place.text("out/material.toml"), &parts);
    place.done("material show out/material.toml");
}

#[test]
fn shift_factors_that_were_given_have_no_errors_and_without_a_poisson_ratio_the_block_says_so() {
    let (table, law) = isotherms();
    let place = Place::with("dma.csv", &table);
    let factor = |(celsius, log): &(f64, f64)| format!("{celsius},{log}\n");
    let factors: String = law.iter().map(factor).collect();
    place.put("a.csv", format!("temperature_c,log10_a_t\n{factors}"));
    let given = "--shift a.csv --out out --format json --data-format table";
    let json = place.done(&format!("{FIT_DYNAMIC} {given}")).json();
    assert!(json["shift_factors"][0]["log10_a_t_error"].is_null());
    assert_eq!(json["format"], "table");
    assert_eq!(json["format_found_by"], "as named");
    let block = json["material_toml"].as_str().unwrap();
    assert!(block.contains("# poisson_ratio = "), "{block}");
    assert!(!block.contains("\npoisson_ratio"), "{block}");
    let errors = place.table("out/shift.csv").found("log10_a_t_error");
    assert!(errors.iter().all(Option::is_none));
}

/// A sweep of a material under a sphere at frequencies that its data cover, under an approach, since the contact under a load depends on
/// what the body is at rest: its losses (J).
fn losses_j(place: &Place, name: &str, block: &str) -> Vec<f64> {
    let sweep = "[indenter]\nshape = \"sphere\"\nradius = \"5 mm\"\n[drive]\ncontrol = \"approach\"\nmean = \"20 um\"\n\
                 amplitude = \"0.2 um\"\n[sweep]\nangular_frequency = { from = \"0.05 rad/s\", to = \"50 rad/s\", points = 9 }\n";
    place.put(
        &format!("{name}.toml"),
        format!("title = \"{name}\"\n{block}{sweep}"),
    );
    place.done(&format!(
        "sweep {name}.toml --quiet --no-figures --force --out {name}"
    ));
    place
        .table(&format!("{name}/sweep.csv"))
        .numbers("energy_loss_j")
}

#[test]
fn the_spectrum_and_the_law_of_a_broad_body_lose_as_it_does() {
    let truth = "[material]\npoisson_ratio = 0.4\n[material.fractional]\nmodel = \"zener\"\nmodulus = \"longitudinal\"\n\
                 equilibrium = \"5 MPa\"\nstiffness = \"100 MPa\"\ntime = \"0.5 s\"\nexponent = 0.4\nband = [\"1e-4 rad/s\", \"1e5 rad/s\"]\n";
    let form = Form {
        law: Law::FractionalZener,
        branches: 1,
    };
    let mut random = Random(8);
    let rows = log_spaced(1e-2, 1e2, 33).into_iter().map(|omega| {
        let modulus = form
            .complex_modulus_pa(&[5e6, 1e8, 0.5, 0.4], omega)
            .unwrap();
        let noisy = |value: f64, random: &mut Random| value * (1.0 + 0.01 * random.normal());
        let storage = noisy(modulus.re, &mut random);
        format!(
            "{omega:e},{storage:e},{:e}\n",
            noisy(modulus.im, &mut random)
        )
    });
    let place = Place::new();
    let head = "angular_frequency [rad/s],E' [Pa],E'' [Pa]\n";
    place.put("dma.csv", head.to_owned() + &rows.collect::<String>());
    let exact = losses_j(&place, "truth", truth);
    for (asked, told) in [
        ("--spectrum", "Continuous spectrum"),
        ("--law auto", "Law: fractional-zener"),
    ] {
        let run = place.done(&format!(
            "{FIT_DYNAMIC} --poisson-ratio 0.4 {asked} --out fitted --force"
        ));
        says(&run.stdout, &[told]);
        let found = losses_j(&place, "found", &place.text("fitted/material.toml"));
        for (found, exact) in found.iter().zip(&exact) {
            near!(*found, *exact, 0.03, "{asked}");
        }
    }
    assert_eq!(place.json("fitted/summary.json")["law"], "fractional-zener");
    place.done(&format!(
        "{FIT_DYNAMIC} --poisson-ratio 0.4 --spectrum --out fitted --force"
    ));
    let spectrum = place.table("fitted/spectrum.csv");
    let inside = (0..spectrum.len()).filter(|row| {
        let [low, high] = spectrum.row(*row, ["spectrum_low_pa", "spectrum_high_pa"]);
        // H of the law at its time, in closed form.
        let x = (spectrum.number(*row, "time_s") / 0.5).powf(0.4);
        let angle = 0.4 * std::f64::consts::PI;
        let exact =
            1e8 / std::f64::consts::PI * x * angle.sin() / (1.0 + x * x + 2.0 * x * angle.cos());
        (low..=high).contains(&exact)
    });
    let inside = inside.count();
    assert!(
        10 * inside >= 9 * spectrum.len(),
        "{inside} of {}",
        spectrum.len()
    );
}
