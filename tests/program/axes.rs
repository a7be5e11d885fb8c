//! Axes over any number of material, indenter or drive: the cases are those of separate sweeps, to the last bit.

use crate::plans::{self, again, sweep, try_sweep};
use crate::prelude::*;
use contact_dma::input::sweep_file;
use contact_dma::quantity::FrequencyUnit;
use contact_dma::report::warnings;
use contact_dma::sweep::plan::Varied;
use contact_dma::sweep::record::warning::Warning;

/// Two isotherms that no shift brings onto one another, and a sphere; `[sweep]` is open at its end.
const FILE: &str = include_str!("../inputs/two-isotherms.toml");

fn read(rest: &str) -> SweepPlan {
    sweep(&format!("{FILE}{rest}"))
}

fn with_flags(flags: &[&str]) -> SweepPlan {
    try_sweep(FILE, flags).unwrap()
}

/// What the axis varies in every case, and something of its record.
fn each<T>(plan: SweepPlan, of: impl Fn(CaseRecord) -> T) -> Vec<(Option<f64>, T)> {
    let records = plans::records(plan).into_iter();
    let both = records.map(|record| (record.varied.first_number(), of(record)));
    both.collect()
}

/// Losses of every case, bit for bit.
fn losses(plan: SweepPlan) -> Vec<u64> {
    let losses = each(plan, |record| record.energy_loss_j().unwrap().to_bits());
    losses.into_iter().map(|(_, loss)| loss).collect()
}

/// All results of every case with their error bars.
fn results(plan: SweepPlan) -> Vec<(Option<f64>, CaseResult)> {
    // Coarser resolutions need so many of both.
    let plan = with(plan, |plan| {
        plan.cycle.error_bars = true;
        (plan.cycle.steps, plan.solver.springs) = (32, 48);
    });
    let results = each(plan, |record| record.result.unwrap());
    assert!(results.iter().all(|(_, result)| result.errors.is_some()));
    results
}

/// The same without what the axis varies.
fn bare(plan: SweepPlan) -> Vec<CaseResult> {
    let results = results(plan).into_iter();
    results.map(|(_, result)| result).collect()
}

#[test]
fn the_cases_over_any_number_are_those_of_separate_sweeps() {
    let quoted = |value: &str| match value.parse::<f64>() {
        Ok(_) => value.to_owned(),
        Err(_) => format!("{value:?}"),
    };
    // By ascending number what stands in the file and what it is.
    for (key, values) in [
        (
            "material.temperature",
            [("20 °C", 293.15), ("60 °C", 333.15)],
        ),
        ("indenter.radius", [("5 mm", 5e-3), ("20 mm", 20e-3)]),
        ("material.poisson_ratio", [("0.3", 0.3), ("0.5", 0.5)]),
        ("drive.mean", [("0.7", 0.7), ("2", 2.0)]),
        (
            "material.isotherm[0].branches[0].time",
            [("0.5 s", 0.5), ("3 s", 3.0)],
        ),
    ] {
        let [low, high] = values.map(|(value, _)| quoted(value));
        let axis = match key {
            "material.poisson_ratio" => {
                format!("{key} = {{ from = {low}, to = {high}, points = 2 }}")
            }
            _ => format!("{key:?} = [{high}, {low}]"),
        };
        let separate = values.into_iter().flat_map(|(value, number)| {
            let results = bare(with_flags(&[&format!("{key}={value}")]));
            results
                .into_iter()
                .map(move |result| (Some(number), result))
        });
        let separate: Vec<_> = separate.collect();
        let plan = read(&axis);
        // What is resolved is the same sweep.
        assert!(results(again(&plan)) == separate, "{axis}");
        assert!(results(plan) == separate, "{axis}");
    }
}

#[test]
fn the_layer_at_the_edge_is_that_of_the_own_radius_of_a_case() {
    // A branch that relaxes within a step makes a layer at the edge of the contact, which the error of the largest pressure counts.
    let stiff = FILE.replace(
        "modulus = \"9 MPa\", time = \"1 s\"",
        "modulus = \"10 GPa\", time = \"1 ms\"",
    );
    let alone = |flags: &[&str]| bare(try_sweep(&stiff, flags).unwrap());
    let over = format!("{stiff}indenter.radius = [\"2 mm\", \"10 mm\"]\n");
    let separate = [alone(&["indenter.radius=2 mm"]), alone(&[])].concat();
    assert!(bare(sweep(&over)) == separate);
}

#[test]
fn the_cases_outside_what_was_measured_at_their_own_temperature_are_warned_of() {
    let warm = "temperature = \"60 °C\"\n";
    let text = FILE.replace(warm, &format!("{warm}measured = [\"0.1 s\", \"1 s\"]\n"));
    let text = format!("{text}material.temperature = [\"20 °C\", \"60 °C\"]\n");
    let mut records = plans::records(sweep(&text));
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
    let isotherm = "[[material.isotherm]]\n";
    let parts: Vec<&str> = FILE.split(isotherm).collect();
    let (_, rest) = parts[2].split_once("[indenter]").unwrap();
    let loss_j = |law: &str, celsius: &str, omega: f64| {
        let head = parts[0].replace("20 °C", celsius);
        let text = format!("{head}{isotherm}{law}{}[indenter]{rest}", parts[1]);
        let text = text.replace("[\"0.3 rad/s\", \"3 rad/s\"]", &format!("[{omega:?}]"));
        let plan = sweep(&text);
        assert_eq!(losses(again(&plan)), losses(plan.clone()));
        f64::from_bits(losses(plan)[0])
    };
    let own_j = loss_j("", "20 °C", 0.7);
    for law in [
        format!("wlf = [{c1}, {c2}]\n"),
        format!("activation_energy = {energy:?}\n"),
    ] {
        // The same body on another clock.
        let shifted_j = loss_j(&law, "32 °C", 0.7 / 10_f64.powf(log10_a_t));
        near!(shifted_j, own_j, 1e-9, "{law}");
    }
}

#[test]
fn of_peaks_that_are_equal_none_is_named_alone() {
    // At other temperatures the same curve lies elsewhere; at another load it is another one.
    let place = Place::lent("one-isotherm-that-shifts.toml");
    let said = |axis: &str| {
        let run = "sweep one-isotherm-that-shifts.toml --no-figures --force --out out";
        words(&place.done(&format!("{run} --set '{axis}'")).stdout)
    };
    let text = said("sweep.material.temperature=[\"20 °C\",\"25 °C\",\"30 °C\"]");
    let expected = "; those of 2 other curves are equal to it within their errors";
    assert!(text.contains(expected), "{text}");
    let text = said("sweep.drive.amplitude=[\"0.4 N\",\"0.5 N\"]");
    assert!(!text.contains("equal to it"), "{text}");
}

/// That one of the library that is known at one temperature is refused at another: tests/refused.
#[test]
fn a_material_of_the_library_that_shifts_is_known_at_other_temperatures() {
    let rest = FILE.split_once("[indenter]").unwrap().1;
    let of = |more: &str, axis: &str| {
        let pvb = format!("[material]\nlibrary = \"pvb\"\n{more}");
        sweep(&format!("title = \"t\"\n{pvb}[indenter]{rest}{axis}"))
    };
    let over = of("", "material.temperature = [\"10 °C\", \"20 °C\"]\n");
    let each = losses(again(&over));
    assert_eq!(losses(over), each);
    let at = |celsius: &str| losses(of(&format!("temperature = \"{celsius} °C\"\n"), ""));
    assert_eq!([at("10"), at("20")].concat(), each);
    // Its own is that of the published series.
    assert_eq!(losses(of("", "")), each[2..]);
}

#[test]
fn a_number_that_an_axis_varies_need_not_stand_in_its_block() {
    let axis = "indenter.radius = [\"5 mm\", \"20 mm\"]\n";
    let text = FILE.replace("radius = \"10 mm\"\n", "");
    let left_out = sweep(&format!("{text}{axis}"));
    assert_eq!(losses(read(axis)), losses(left_out));
}

#[test]
fn a_flag_adds_an_axis_or_takes_the_place_of_its_values() {
    let text = format!("{FILE}drive.amplitude = [0.1, 0.2]\n");
    let axes = |flags: &[&str]| try_sweep(&text, flags).unwrap().axes.unwrap();
    let mean = "sweep.drive.mean=[1, 2, 3]";
    let both = axes(&[mean, "sweep.drive.amplitude=[0.3]"]);
    assert_eq!(both.conditions.len(), 3);
    assert!(both.over.iter().any(Varied::is_mean));
    let alone = axes(&[mean, "sweep.drive.amplitude="]);
    assert!(alone.over.len() == 1 && alone.varied().is_mean());
    assert_eq!(alone.numbers_of(0), [1.0, 2.0, 3.0]);
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
    let alone = |[temperature, radius, mean]: [&str; 3]| {
        losses(with_flags(&[
            &format!("material.temperature={temperature}"),
            &format!("indenter.radius={radius}"),
            &format!("drive.mean={mean}"),
        ]))
    };
    let (temperatures, radii, means) = (["293.15", "333.15"], ["5e-3", "20e-3"], ["1", "2"]);
    let all = (0..8).map(|k| [temperatures[k >> 2], radii[k >> 1 & 1], means[k & 1]]);
    let product: Vec<_> = all.flat_map(alone).collect();
    let pairs = [["293.15", "20e-3", "2"], ["333.15", "5e-3", "1"]].map(alone);
    for (pairs, expected) in [("", product), ("pairs = true\n", pairs.concat())] {
        let plan = read(&format!("{axes}{pairs}"));
        assert_eq!(losses(again(&plan)), expected);
        assert_eq!(losses(plan), expected);
    }
}

#[test]
fn a_sweep_over_several_axes_is_drawn_along_each_and_compared_with_itself() {
    let nine = "[0.03, 0.1, 0.5, 2, 8, 30, 120, 500, 2000]";
    let text = FILE.replace("[\"0.3 rad/s\", \"3 rad/s\"]", nine);
    let axes = "material.temperature = [293.15, 333.15]\ndrive.mean = [1, 2, 3]\n";
    let svg = "[figures]\nformats = [\"svg\"]\n";
    let place = Place::with("axes.toml", &format!("{text}{axes}{svg}"));
    // One line per condition.
    let run = place.done("sweep axes.toml --out out");
    run.says(&["60 °C, 3 N"]);
    let table = place.table("out/sweep.csv");
    let columns = table.columns.join(",");
    let both = "material_temperature_k,drive_mean";
    assert!(columns.contains(both), "{columns}");
    assert_eq!(table.len(), 2 * 3 * 9);
    place.has_all(
        "out",
        "figures/energy-loss-over-temperature.svg figures/energy-loss-over-mean.svg figures/energy-loss-2.svg figures/peaks-2.svg",
    );
    let caption = place.text("out/figures/energy-loss-2.caption.txt");
    let others = "Other axes at temperature of the material";
    assert!(caption.contains(others), "{caption}");
    let summary = place.json("out/summary.json");
    assert_eq!(summary["peaks"][0]["varied"].as_array().unwrap().len(), 2);
    place.done("compare out out").says(&["54 cases"]);
}

/// A solid that was given by two springs and a dashpot, not by the series that it is solved with.
#[test]
fn a_number_within_a_model_varies_where_the_file_has_it() {
    let (head, rest) = FILE.split_once("[material]").unwrap();
    let (_, rest) = rest.split_once("[indenter]").unwrap();
    let of = |time: f64, axis: &str| {
        let zener = "[material.zener]\nspring = \"9 MPa\"\nkelvin_spring = \"1 MPa\"";
        let material = format!("[material]\npoisson_ratio = 0.4\n{zener}\ntime = {time:?}\n");
        sweep(&format!("{head}{material}[indenter]{rest}{axis}\n"))
    };
    let loss = |record: CaseRecord| record.energy_loss_j().unwrap().to_bits();
    let separate = [0.5, 3.0].map(|time| {
        let losses = losses(of(time, "")).into_iter();
        losses.map(|loss| (Some(time), loss)).collect::<Vec<_>>()
    });
    // Quoted, as tables, and as `--set` says it.
    for axis in [
        "\"material.zener.time\" = [\"0.5 s\", \"3 s\"]",
        "material.zener.time = [\"0.5 s\", \"3 s\"]",
        "material = { zener = { time = [0.5, 3.0] } }",
    ] {
        let plan = of(7.0, axis);
        let column = plan.axes.as_ref().unwrap().over[0].column();
        assert_eq!(column, "material_zener_time_s");
        assert_eq!(each(again(&plan), loss), separate.concat(), "{axis}");
        assert_eq!(each(plan, loss), separate.concat(), "{axis}");
    }
}
