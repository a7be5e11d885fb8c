//! Axes over any number of material, indenter or drive: the cases are those of separate sweeps, to the last bit.

#![cfg(feature = "cli")]

use std::sync::atomic::AtomicBool;

use crate::program::{Place, words};
use contact_dma::input::diagnostic::Styling;
use contact_dma::input::document::Document;
use contact_dma::input::sweep_file;
use contact_dma::quantity::FrequencyUnit;
use contact_dma::report::warnings;
use contact_dma::sweep::case::Setup;
use contact_dma::sweep::plan::resolved::resolved_text;
use contact_dma::sweep::plan::{SweepPlan, Varied};
use contact_dma::sweep::record::warning::Warning;
use contact_dma::sweep::record::{CaseRecord, CaseResult};

/// Two isotherms that no shift brings onto one another, and a sphere.
const FILE: &str = r#"
title = "two axes"

[material]
poisson_ratio = 0.4
temperature = "20 °C"

[[material.isotherm]]
temperature = "20 °C"
modulus = "shear"
equilibrium = "1 MPa"
branches = [{ modulus = "9 MPa", time = "1 s" }]

[[material.isotherm]]
temperature = "60 °C"
modulus = "shear"
equilibrium = "0.9 MPa"
branches = [{ modulus = "5 MPa", time = "10 ms" }, { modulus = "1 MPa", time = "0.1 s" }]

[indenter]
shape = "sphere"
radius = "10 mm"

[drive]
mean = "1 N"
amplitude = "0.5 N"

[cycle]
steps = 16
error_bars = false

[solver]
springs = 24

[sweep]
angular_frequency = ["0.3 rad/s", "3 rad/s"]
"#;

fn read(rest: &str) -> Result<SweepPlan, String> {
    let document = Document::parse("axes.toml", &format!("{FILE}{rest}"));
    let plan = document.and_then(|document| sweep_file::plan(&document));
    plan.map_err(|why| why.render(Styling::Plain))
}

fn with_flag(flag: &str) -> SweepPlan {
    let mut document = Document::parse("axes.toml", FILE).unwrap();
    document.set(flag).unwrap();
    sweep_file::plan(&document).unwrap()
}

fn records(plan: SweepPlan) -> Vec<CaseRecord> {
    let setup = Setup::new(plan).unwrap();
    let cases = setup.plan().cases().into_iter();
    let record = |case| setup.run(&case, &AtomicBool::new(false)).unwrap();
    cases.map(record).collect()
}

/// Losses of every case, bit for bit, with what the axis varies.
fn losses(plan: SweepPlan) -> Vec<(Option<f64>, u64)> {
    let loss = |record: CaseRecord| {
        let loss = record.energy_loss_j().unwrap();
        (record.varied.first_number(), loss.to_bits())
    };
    records(plan).into_iter().map(loss).collect()
}

/// All results of every case with their error bars, with what the axis varies.
fn results(mut plan: SweepPlan) -> Vec<(Option<f64>, CaseResult)> {
    plan.cycle.error_bars = true;
    // Coarser resolutions need so many of both.
    (plan.cycle.steps, plan.solver.springs) = (32, 48);
    let result = |record: CaseRecord| {
        let result = record.result.unwrap();
        assert!(result.errors.is_some());
        (record.varied.first_number(), result)
    };
    records(plan).into_iter().map(result).collect()
}

#[test]
fn the_cases_over_any_number_are_those_of_separate_sweeps() {
    for (axis, values, flags) in [
        (
            "material.temperature = [\"60 °C\", \"20 °C\"]",
            [293.15, 333.15],
            ["material.temperature=20 °C", "material.temperature=60 °C"],
        ),
        (
            "\"indenter.radius\" = [\"5 mm\", \"20 mm\"]",
            [5e-3, 20e-3],
            ["indenter.radius=5 mm", "indenter.radius=20 mm"],
        ),
        (
            "material.poisson_ratio = { from = 0.3, to = 0.5, points = 2 }",
            [0.3, 0.5],
            ["material.poisson_ratio=0.3", "material.poisson_ratio=0.5"],
        ),
        (
            "drive.mean = [0.7, 2]",
            [0.7, 2.0],
            ["drive.mean=0.7", "drive.mean=2"],
        ),
        (
            "\"material.isotherm[0].branches[0].time\" = [\"3 s\", \"0.5 s\"]",
            [0.5, 3.0],
            [
                "material.isotherm[0].branches[0].time=0.5 s",
                "material.isotherm[0].branches[0].time=3 s",
            ],
        ),
    ] {
        let plan = read(axis).unwrap();
        let separate = values.iter().zip(flags).flat_map(|(value, flag)| {
            let results = results(with_flag(flag)).into_iter();
            results.map(|(_, result)| (Some(*value), result))
        });
        let separate: Vec<_> = separate.collect();
        let text = resolved_text(&plan);
        assert!(results(plan) == separate, "{axis}");
        // What is resolved is the same sweep.
        let again = Document::parse("resolved.toml", &text).unwrap();
        let again = sweep_file::plan(&again).unwrap();
        assert_eq!(resolved_text(&again), text);
        assert!(results(again) == separate, "{axis}");
    }
}

#[test]
fn the_layer_at_the_edge_is_that_of_the_own_radius_of_a_case() {
    // A branch that relaxes within a step makes a layer at the edge of the contact, which the error of the largest pressure counts.
    let stiff = FILE.replace(
        "modulus = \"9 MPa\", time = \"1 s\"",
        "modulus = \"10 GPa\", time = \"1 ms\"",
    );
    let with = |rest: &str| {
        let document = Document::parse("edge.toml", &format!("{stiff}{rest}"));
        sweep_file::plan(&document.unwrap()).unwrap()
    };
    let over = results(with("indenter.radius = [\"2 mm\", \"10 mm\"]\n"));
    let own = results(with(""));
    assert!(
        over[2..]
            .iter()
            .map(|(_, result)| result)
            .eq(own.iter().map(|(_, result)| result))
    );
    let mut small = Document::parse("edge.toml", &stiff).unwrap();
    small.set("indenter.radius=2 mm").unwrap();
    let small = results(sweep_file::plan(&small).unwrap());
    assert!(
        over[..2]
            .iter()
            .map(|(_, result)| result)
            .eq(small.iter().map(|(_, result)| result))
    );
}

#[test]
fn the_cases_outside_what_was_measured_at_their_own_temperature_are_warned_of() {
    let text = FILE.replace(
        "temperature = \"60 °C\"\n",
        "temperature = \"60 °C\"\nmeasured = [\"0.1 s\", \"1 s\"]\n",
    );
    let text = format!("{text}material.temperature = [\"20 °C\", \"60 °C\"]\n");
    let plan = sweep_file::plan(&Document::parse("axes.toml", &text).unwrap()).unwrap();
    let setup = Setup::new(plan).unwrap();
    let cases = setup.plan().cases().into_iter();
    let run = |case| setup.run(&case, &AtomicBool::new(false)).unwrap();
    let mut records: Vec<_> = cases.map(run).collect();
    let codes = records.iter().map(|record| {
        let codes = record.warnings.iter().map(|warning| warning.code());
        codes.collect::<Vec<_>>().join(" ")
    });
    // 1/ω is longer than the test at 60 °C at the first frequency alone; at 20 °C nothing is said of a test.
    // Sixteen steps without error bars leave that case an imbalance of energy as well.
    let expected = ["", "", "below-measured energy-imbalance", ""];
    assert_eq!(codes.collect::<Vec<_>>(), expected);
    let message = |records: &[CaseRecord]| {
        let warnings = warnings::over_cases(records, FrequencyUnit::RadPerS);
        warnings[0].message.clone()
    };
    let alone = "the material was measured up to 1.00 s: below 1.00 rad/s it is an extrapolation";
    assert_eq!(message(&records), alone);
    // Of several windows the one that is left furthest is told, wherever the frequency lies.
    records[0].warnings = vec![Warning::BelowMeasured {
        angular_frequency_rad_per_s: 0.01,
        last_measured_s: 60.0,
    }];
    let several = format!("{alone} in the case that is furthest outside");
    assert_eq!(message(&records), several);
}

#[test]
fn an_isotherm_with_a_shift_law_is_a_material_at_other_temperatures() {
    let temperature_k = 293.15 + 12.0;
    // About 20 °C; the energy of Arrhenius that shifts as far.
    let (c1, c2) = (8.86, 101.6);
    let log10_a_t = -c1 * 12.0 / (c2 + 12.0);
    let energy = log10_a_t * 10_f64.ln() * 8.314_462_618 / (1.0 / temperature_k - 1.0 / 293.15);
    let one = FILE
        .split("[[material.isotherm]]")
        .next()
        .unwrap()
        .replace("20 °C", "32 °C");
    let (_, second) = FILE.split_once("[[material.isotherm]]").unwrap();
    let (first, rest) = second.split_once("[[material.isotherm]]").unwrap();
    let (_, rest) = rest.split_once("[indenter]").unwrap();
    let losses_of = |law: &str, head: &str, omega: f64| {
        let text = format!("{head}[[material.isotherm]]\n{law}{first}[indenter]{rest}");
        let text = text.replace("[\"0.3 rad/s\", \"3 rad/s\"]", &format!("[{omega:?}]"));
        let plan = sweep_file::plan(&Document::parse("law.toml", &text).unwrap());
        let plan = plan.unwrap_or_else(|why| panic!("{}", why.render(Styling::Plain)));
        let again = Document::parse("resolved.toml", &resolved_text(&plan)).unwrap();
        let again = sweep_file::plan(&again).unwrap();
        assert_eq!(losses(again), losses(plan.clone()));
        f64::from_bits(losses(plan)[0].1)
    };
    let own = losses_of("", &one.replace("32 °C", "20 °C"), 0.7);
    for law in [
        format!("wlf = [{c1}, {c2}]\n"),
        format!("activation_energy = {energy:?}\n"),
    ] {
        // The same body on another clock.
        let shifted = losses_of(&law, &one, 0.7 / 10_f64.powf(log10_a_t));
        assert!((shifted / own - 1.0).abs() < 1e-9, "{law}: {shifted} {own}");
    }
}

#[test]
fn of_peaks_that_are_equal_none_is_named_alone() {
    // At other temperatures the same curve lies elsewhere; at another load it is another one.
    let text = r#"title = "shifted"
[material]
poisson_ratio = 0.4
temperature = "20 °C"
[[material.isotherm]]
temperature = "20 °C"
modulus = "shear"
activation_energy = 80e3
equilibrium = "1 MPa"
branches = [{ modulus = "9 MPa", time = "1 s" }]
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
mean = "1 N"
amplitude = "0.5 N"
[cycle]
steps = 32
[solver]
springs = 48
[sweep]
angular_frequency = { from = "0.01 rad/s", to = "10 rad/s", points = 13 }
"#;
    let place = Place::with("shifted.toml", text);
    let said = |axis: &str| {
        let run = format!("sweep shifted.toml --no-figures --force --out out --set '{axis}'");
        words(&place.done(&run).stdout)
    };
    let text = said("sweep.material.temperature=[\"20 °C\",\"25 °C\",\"30 °C\"]");
    let expected = "; those of 2 other curves are equal to it within their errors";
    assert!(text.contains(expected), "{text}");
    let text = said("sweep.drive.amplitude=[\"0.4 N\",\"0.5 N\"]");
    assert!(!text.contains("equal to it"), "{text}");
}

#[test]
fn a_material_of_the_library_that_shifts_is_known_at_other_temperatures() {
    let rest = FILE.split_once("[indenter]").unwrap().1;
    let of = |material: &str, axis: &str| {
        let text = format!("title = \"t\"\n{material}[indenter]{rest}{axis}");
        let document = Document::parse("library.toml", &text).unwrap();
        sweep_file::plan(&document).map_err(|why| why.render(Styling::Plain))
    };
    let pvb = "[material]\nlibrary = \"pvb\"\n";
    let over = of(pvb, "material.temperature = [\"10 °C\", \"20 °C\"]\n").unwrap();
    let again = Document::parse("resolved.toml", &resolved_text(&over)).unwrap();
    let each = losses(over);
    assert_eq!(losses(sweep_file::plan(&again).unwrap()), each);
    for (temperature, expected) in [("10 °C", &each[..2]), ("20 °C", &each[2..])] {
        let own = of(&format!("{pvb}temperature = \"{temperature}\"\n"), "").unwrap();
        let own = losses(own).into_iter().map(|(_, loss)| loss);
        assert!(
            own.eq(expected.iter().map(|(_, loss)| *loss)),
            "{temperature}"
        );
    }
    // Its own is that of the published series.
    let own: Vec<u64> = losses(of(pvb, "").unwrap())
        .into_iter()
        .map(|(_, loss)| loss)
        .collect();
    assert_eq!(own, [each[2].1, each[3].1]);
    let refused = of(
        "[material]\nlibrary = \"pmma\"\ntemperature = \"20 °C\"\n",
        "",
    );
    assert!(
        refused
            .unwrap_err()
            .contains("this material is known at one temperature alone")
    );
}

#[test]
fn a_number_that_an_axis_varies_need_not_stand_in_its_block() {
    let given = read("indenter.radius = [\"5 mm\", \"20 mm\"]").unwrap();
    let text = FILE.replace("radius = \"10 mm\"\n", "");
    let text = format!("{text}indenter.radius = [\"5 mm\", \"20 mm\"]\n");
    let left_out = Document::parse("axes.toml", &text).unwrap();
    let left_out = sweep_file::plan(&left_out).unwrap();
    assert_eq!(losses(given), losses(left_out));
}

#[test]
fn a_flag_adds_an_axis_or_takes_the_place_of_its_values() {
    let text = format!("{FILE}drive.amplitude = [0.1, 0.2]\n");
    let mut document = Document::parse("axes.toml", &text).unwrap();
    document.set("sweep.drive.mean=[1, 2, 3]").unwrap();
    document.set("sweep.drive.amplitude=[0.3]").unwrap();
    let axes = sweep_file::plan(&document).unwrap().axes.unwrap();
    assert_eq!(axes.conditions.len(), 3);
    assert!(axes.over.iter().any(Varied::is_mean));
    document.set("sweep.drive.amplitude=").unwrap();
    let axes = sweep_file::plan(&document).unwrap().axes.unwrap();
    assert!(axes.over.len() == 1 && axes.varied().is_mean());
    assert_eq!(axes.numbers_of(0), [1.0, 2.0, 3.0]);
}

#[test]
fn a_flag_changes_an_axis_that_is_given_in_quotes() {
    let time = "material.isotherm[0].branches[0].time";
    let keys = |flag: &str| {
        let text = format!("{FILE}\"{time}\" = [1, 2]\ndrive.mean = [1]\n");
        let mut document = Document::parse("axes.toml", &text).unwrap();
        document.set(flag).unwrap();
        let axes = sweep_file::plan(&document).unwrap().axes.unwrap();
        let number = |k| axes.numbers_of(k).iter().sum::<f64>();
        let keys = axes.over.iter().enumerate();
        keys.map(|(k, varied)| format!("{} {}", varied.path(), number(k)))
            .collect::<Vec<_>>()
    };
    let mean = "drive.mean 1".to_owned();
    for (flag, left) in [
        (format!("sweep.{time}=[5, 6]"), Some(format!("{time} 11"))),
        (
            "sweep.material.isotherm.0.branches.0.time=[7]".to_owned(),
            Some(format!("{time} 7")),
        ),
        (
            "sweep.material={ poisson_ratio = [0.25] }".to_owned(),
            Some("material.poisson_ratio 0.25".to_owned()),
        ),
        (format!("sweep.{time}="), None),
        ("sweep.material.isotherm=".to_owned(), None),
        ("sweep.material=".to_owned(), None),
    ] {
        let left: Vec<String> = left.into_iter().chain([mean.clone()]).collect();
        assert_eq!(keys(&flag), left, "{flag}");
    }
}

/// Where the temperature varies, beside what else, the one of the block is asked for nowhere.
#[test]
fn a_temperature_that_varies_takes_the_place_of_one_that_is_not_known() {
    let axes =
        "material.temperature = [\"20 °C\", \"60 °C\"]\nmaterial.poisson_ratio = [0.3, 0.4]\n";
    let unknown = FILE.replacen("temperature = \"20 °C\"", "temperature = \"33 °C\"", 1);
    let read = |text: &str| {
        let document = Document::parse("axes.toml", &format!("{text}{axes}")).unwrap();
        resolved_text(&sweep_file::plan(&document).unwrap())
    };
    assert_eq!(read(&unknown), read(FILE));
}

#[test]
fn the_cases_over_several_axes_are_all_combinations_or_pairs_of_their_values() {
    let axes = "material.temperature = [\"60 °C\", \"20 °C\"]\nindenter.radius = [5e-3, 20e-3]\ndrive.mean = [1, 2]\n";
    let alone = |temperature: f64, radius: f64, mean: f64| {
        let mut document = Document::parse("axes.toml", FILE).unwrap();
        for flag in [
            format!("material.temperature={temperature}"),
            format!("indenter.radius={radius}"),
            format!("drive.mean={mean}"),
        ] {
            document.set(&flag).unwrap();
        }
        let losses = losses(sweep_file::plan(&document).unwrap());
        losses.into_iter().map(|(_, bits)| bits).collect::<Vec<_>>()
    };
    let bits = |plan: SweepPlan| losses(plan).into_iter().map(|(_, bits)| bits);
    let mut product = Vec::new();
    for temperature in [293.15, 333.15] {
        for radius in [5e-3, 20e-3] {
            for mean in [1.0, 2.0] {
                product.extend(alone(temperature, radius, mean));
            }
        }
    }
    let mut pairs = alone(293.15, 20e-3, 2.0);
    pairs.extend(alone(333.15, 5e-3, 1.0));
    for (text, expected) in [
        (axes.to_owned(), &product),
        (format!("{axes}pairs = true\n"), &pairs),
    ] {
        let plan = read(&text).unwrap();
        let resolved = resolved_text(&plan);
        assert_eq!(&bits(plan).collect::<Vec<_>>(), expected);
        let again = Document::parse("resolved.toml", &resolved).unwrap();
        let again = sweep_file::plan(&again).unwrap();
        assert_eq!(resolved_text(&again), resolved);
        assert_eq!(&bits(again).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn a_sweep_over_several_axes_is_drawn_along_each_and_compared_with_itself() {
    let text = FILE.replace(
        "[\"0.3 rad/s\", \"3 rad/s\"]",
        "[0.03, 0.1, 0.5, 2, 8, 30, 120, 500, 2000]",
    );
    let text = format!(
        "{text}material.temperature = [293.15, 333.15]\ndrive.mean = [1, 2, 3]\n[figures]\nformats = [\"svg\"]\n"
    );
    let place = Place::with("axes.toml", &text);
    // One line per condition.
    let run = place.done("sweep axes.toml --out out");
    run.says(&["60 °C, 3 N"]);
    let table = place.table("out/sweep.csv");
    let columns = table.columns.join(",");
    assert!(
        columns.contains("material_temperature_k,drive_mean"),
        "{columns}"
    );
    assert_eq!(table.len(), 2 * 3 * 9);
    for name in ["loss-map", "loss-map-2", "energy-loss-2", "peaks-2"] {
        assert!(place.has(&format!("out/{name}.svg")), "{name}");
    }
    let caption = place.text("out/loss-map-2.caption.txt");
    assert!(
        caption.contains("Other axes at temperature of the material"),
        "{caption}"
    );
    let summary = place.json("out/summary.json");
    assert_eq!(summary["peaks"][0]["varied"].as_array().unwrap().len(), 2);
    place.done("compare out out").says(&["54 cases"]);
}

/// A solid that was given by two springs and a dashpot, not by the series that it is solved with.
#[test]
fn a_number_within_a_model_varies_where_the_file_has_it() {
    let (head, rest) = FILE.split_once("[material]").unwrap();
    let (_, rest) = rest.split_once("[indenter]").unwrap();
    let with = |time: &str, axis: &str| {
        let model = format!(
            "[material]\npoisson_ratio = 0.4\n\n[material.zener]\nspring = \"9 MPa\"\nkelvin_spring = \"1 MPa\"\ntime = {time}\n"
        );
        let text = format!("{head}{model}\n[indenter]{rest}{axis}\n");
        let plan = sweep_file::plan(&Document::parse("zener.toml", &text).unwrap());
        plan.unwrap_or_else(|why| panic!("{}", why.render(Styling::Plain)))
    };
    // Quoted, as tables, and as `--set` says it.
    for axis in [
        "\"material.zener.time\" = [\"0.5 s\", \"3 s\"]",
        "material.zener.time = [\"0.5 s\", \"3 s\"]",
        "material = { zener = { time = [0.5, 3.0] } }",
    ] {
        let plan = with("7.0", axis);
        let separate: Vec<_> = [0.5, 3.0]
            .iter()
            .flat_map(|time| {
                let losses = losses(with(&format!("{time:?}"), ""));
                losses.into_iter().map(|(_, bits)| (Some(*time), bits))
            })
            .collect();
        let text = resolved_text(&plan);
        let column = plan.axes.as_ref().unwrap().over[0].column();
        assert_eq!(column, "material_zener_time_s");
        assert_eq!(losses(plan), separate, "{axis}");
        let again = sweep_file::plan(&Document::parse("resolved.toml", &text).unwrap()).unwrap();
        assert_eq!(resolved_text(&again), text);
        assert_eq!(losses(again), separate, "{axis}");
    }
}
