//! What other programs read: JSON on standard output and nothing else, and no colours where no person looks.

use crate::prelude::*;
use contact_dma::material::Relaxation;

const THREE: &str = include_str!("../inputs/three-at-defaults.toml");

#[test]
fn json_holds_the_summary_and_every_column_of_every_case() {
    let place = Place::with("small.toml", THREE);
    for quiet in ["", "--quiet"] {
        let run = format!("sweep small.toml --format json --out out {quiet}");
        let printed = place.done(&run).json();
        assert_eq!(printed["summary"], place.json("out/summary.json"));
        let table = place.table("out/sweep.csv");
        let cases = printed["cases"].as_array().unwrap();
        assert_eq!(cases.len(), table.len());
        for (case, row) in cases.iter().zip(&table.rows) {
            assert_eq!(case.as_object().unwrap().len(), row.len());
            for (column, cell) in table.columns.iter().zip(row) {
                match &case[column] {
                    Value::Null => assert_eq!(cell, ""),
                    Value::String(text) => assert_eq!(text, cell),
                    // Bit for bit.
                    number => assert_eq!(number.as_f64().unwrap(), cell.parse::<f64>().unwrap()),
                }
            }
        }
    }
}

/// What a command prints as JSON.
fn json(place: &Place, line: &str) -> Value {
    let line = format!("{line} --format json");
    let value = place.run_in(&line, &[("COLUMNS", "40")]).ended(0).json();
    assert!(value.is_object());
    value
}

#[test]
fn every_command_that_finds_something_prints_it_as_one_object() {
    let place = Place::with("small.toml", THREE);
    let plan = json(&place, "plan small.toml");
    assert_eq!(plan["cases"].as_array().unwrap().len(), 3);
    assert_eq!(plan["cases"][1]["angular_frequency_rad_per_s"], 0.008);
    assert!(plan["cases"][1]["cycles"].is_u64());
    assert!(plan["time_on_one_thread_s"].as_f64().unwrap() > 0.0 && plan["cells"].is_null());
    let dry = json(&place, "sweep small.toml --dry-run");
    assert_eq!(dry["springs"], plan["springs"]);
    let sweep = json(&place, "sweep small.toml --no-figures --out a");
    assert_eq!(json(&place, "report a"), sweep);
    for (shard, out) in [("1/2", "b"), ("2/2", "c")] {
        let line = format!("sweep small.toml --shard {shard} --out {out}");
        let part = json(&place, &line);
        assert_eq!(part["shard"], shard);
        assert_eq!(part["cases_done"], part["cases_of_shard"]);
    }
    assert_eq!(json(&place, "merge b c --out d"), sweep);
    let comparison = json(&place, "compare a d");
    assert_eq!(comparison["differs"], false);
    assert_eq!(comparison["compared"], 3);
    let mut columns = comparison["columns"].as_array().unwrap().iter();
    let loss = columns.find(|c| c["name"] == "energy_loss_j").unwrap();
    assert!(loss["largest"].is_null());
    let ramp = pmma_sweep("[solver]\nsprings = 50\n").replace(
        "mean = \"10 N\"\namplitude = \"5 N\"",
        "segments = [{ kind = \"ramp\", to = 1, duration = 1 }]",
    );
    place.put("ramp.toml", ramp);
    let dry = json(&place, "simulate ramp.toml --dry-run");
    let history = json(&place, "simulate ramp.toml --no-figures");
    let rows = history["history"].as_array().unwrap();
    assert_eq!(dry["time_steps"], rows.len());
    assert_eq!(rows.last().unwrap()["load_n"], 1.0);
    assert_eq!(history["summary"]["title"], "PMMA under a sphere");
    assert!(!place.has("reports/ramp/index.html"));
}

#[test]
fn materials_are_printed_as_objects_too() {
    let place = Place::new();
    let list = json(&place, "material list");
    let names = list["materials"].as_array().unwrap();
    assert!(names.iter().any(|material| material["name"] == "pmma"));
    let shown = json(&place, "material show pmma");
    assert_eq!(shown["relaxation"]["equilibrium_pa"], 1.973e9);
    assert!(shown["peaks"]["loss_modulus"][0]["value"].as_f64().unwrap() > 1e7);
    assert!(shown["fit"].is_null());
    let number = |value: &Value, key: &str| value[key].as_f64().unwrap();
    let branches = shown["creep"]["branches"].as_array().unwrap().iter();
    let branches = branches.map(|b| (number(b, "compliance_per_pa"), number(b, "time_s")));
    let branches: Vec<_> = branches.collect();
    let at_once_per_pa = number(&shown["creep"], "instantaneous_per_pa");
    let creep = creep(at_once_per_pa, &branches, None);
    let row = |k| {
        let time_s = 10_f64.powf(f64::from(k) / 10.0 - 1.0);
        format!("{time_s},{}\n", creep.compliance(time_s))
    };
    let rows: String = (0..40).map(row).collect();
    place.put(
        "creep.csv",
        format!("time_s,creep_compliance_per_pa\n{rows}"),
    );
    let fit = "material fit creep.csv --quantity creep --modulus longitudinal";
    let fit = json(&place, &format!("{fit} --poisson-ratio 0.38"));
    assert_eq!(fit["fit"]["samples"], 40);
    assert!(fit["fit"]["relative_misfit"]["rms"].as_f64().unwrap() < 1e-3);
    let block = fit["material_toml"].as_str().unwrap();
    assert!(block.contains("[material.creep]"), "{block}");
}

/// From an instantaneous modulus, and ratios to it with times.
fn of_ratios(instantaneous: f64, ratios: &[(f64, f64)]) -> Relaxation {
    let sum: f64 = ratios.iter().map(|(ratio, _)| ratio).sum();
    let branches = ratios
        .iter()
        .map(|(ratio, tau)| (ratio * instantaneous, *tau));
    series(instantaneous * (1.0 - sum), &branches.collect::<Vec<_>>())
}

/// Largest relative difference of the two complex moduli over ten decades.
fn difference(one: &Relaxation, other: &Relaxation) -> f64 {
    let omegas = (0..=100).map(|k| 10_f64.powf(f64::from(k) / 10.0 - 5.0));
    largest(omegas.map(|omega| {
        let [one, other] = [one, other].map(|series| series.complex_modulus(omega));
        (other / one - 1.0).norm()
    }))
}
fn numbers(line: &str) -> Vec<f64> {
    let cells = line.split([',', ' ']).filter(|cell| !cell.is_empty());
    cells.map(|cell| cell.parse().unwrap()).collect()
}

/// Shear modulus and bulk over shear modulus, for a Young's modulus of one.
fn shear_and_bulk(nu: f64) -> (f64, f64) {
    let shear = 1.0 / (2.0 * (1.0 + nu));
    (shear, 1.0 / (3.0 * (1.0 - 2.0 * nu)) / shear)
}

/// Longitudinal series of Abaqus keywords.
fn read_abaqus(text: &str) -> Relaxation {
    let lines = text.lines().filter(|line| !line.starts_with("**"));
    let lines: Vec<&str> = lines.collect();
    let below = |keyword: &str| {
        let at = lines.iter().position(|line| line.starts_with(keyword));
        let below = lines[at.unwrap() + 1..].iter();
        let below = below.take_while(|line| !line.starts_with('*'));
        below.map(|line| numbers(line)).collect::<Vec<_>>()
    };
    let elastic = below("*ELASTIC, MODULI=INSTANTANEOUS");
    let ratios = below("*VISCOELASTIC, TIME=PRONY").into_iter().map(|line| {
        assert_eq!(line[0], line[1], "shear and bulk relax alike");
        (line[0], line[2])
    });
    of_ratios(elastic[0][0], &ratios.collect::<Vec<_>>())
}

/// Longitudinal series of APDL commands.
fn read_ansys(text: &str) -> Relaxation {
    let (mut young, mut tables) = (0.0, Vec::<Vec<f64>>::new());
    for line in text.lines().filter(|line| !line.starts_with('!')) {
        let fields: Vec<&str> = line.split(',').collect();
        match fields[..] {
            ["MP", "EX", "1", value] => young = value.parse().unwrap(),
            ["TB", "PRONY", "1", "1", pairs, "SHEAR" | "BULK"] => {
                tables.push(vec![0.0; 2 * pairs.parse::<usize>().unwrap()]);
            }
            ["TBDATA", first, ..] => {
                let table = tables.last_mut().unwrap();
                assert!(fields.len() <= 8, "six constants a command: {line}");
                for (k, value) in fields[2..].iter().enumerate() {
                    table[first.parse::<usize>().unwrap() - 1 + k] = value.parse().unwrap();
                }
            }
            _ => assert!(line.starts_with("MP,PRXY,1,"), "{line}"),
        }
    }
    assert_eq!(tables[0], tables[1], "shear and bulk relax alike");
    let pairs: Vec<(f64, f64)> = tables[0].chunks(2).map(|pair| (pair[0], pair[1])).collect();
    of_ratios(young, &pairs)
}

/// Longitudinal series of the terms of `*MAT_076`.
fn read_ls_dyna(text: &str, nu: f64) -> Relaxation {
    let (_, cards) = text.split_once("betaki\n").unwrap();
    let (shear, bulk_over_shear) = shear_and_bulk(nu);
    let (mut equilibrium, mut branches) = (0.0, Vec::new());
    for card in cards.lines() {
        let fields = (0..4).map(|k| card[10 * k..10 * (k + 1)].trim());
        let fields: Vec<f64> = fields.map(|field| field.parse().unwrap()).collect();
        let [g, beta, k, beta_k] = fields[..] else {
            panic!("{card}")
        };
        // Five digits each.
        near!(k / g, bulk_over_shear, 1e-4);
        assert_eq!(beta, beta_k);
        match beta {
            0.0 => equilibrium = g / shear,
            _ => branches.push((g / shear, beta.recip())),
        }
    }
    series(equilibrium, &branches)
}

/// Longitudinal series of a table of branches, beside E and nu of the parent node.
fn read_comsol(text: &str, nu: f64) -> Relaxation {
    let comments = text.lines().filter_map(|line| line.strip_prefix("% "));
    let comments = comments.collect::<Vec<_>>().join(" ");
    let (_, rest) = comments.split_once("E = ").unwrap();
    let young = rest.split(' ').next().unwrap().parse().unwrap();
    let rows = text.lines().filter(|line| !line.starts_with('%'));
    let rows = rows.map(numbers);
    let branches = rows.map(|row| (row[1] / shear_and_bulk(nu).0, row[2]));
    series(young, &branches.collect::<Vec<_>>())
}

#[test]
fn what_is_exported_has_the_same_complex_modulus_when_it_is_read_back() {
    let place = Place::new();
    let branch = |k| {
        let modulus_pa = 2e7 * (1.0 + (2.3 * f64::from(k)).sin().abs());
        (modulus_pa, 10_f64.powf(0.5 * f64::from(k) - 5.0) * 1.7)
    };
    let branches: Vec<_> = (0..17).map(branch).collect();
    let own = series(1.3e6, &branches);
    let rows = branches.iter();
    let rows: String = rows
        .map(|(g, tau)| format!("{{ modulus = \"{g:?} Pa\", time = \"{tau:?} s\" }},"))
        .collect();
    for (kind, nu, to_longitudinal) in [("shear", 0.45, 2.9), ("longitudinal", 0.3, 1.0)] {
        let block = format!(
            "[material]\npoisson_ratio = {nu}\n[material.relaxation]\nmodulus = \"{kind}\"\n\
             equilibrium = \"1.3 MPa\"\nbranches = [{rows}]\n"
        );
        place.put("material.toml", block);
        let exact = own.scaled(to_longitudinal).unwrap();
        let export = |name: &str| {
            let line = format!("material export material.toml --to {name}");
            let printed = json(&place, &line);
            let text = printed["text"].as_str().unwrap().to_owned();
            (text, printed["conversion_error"].as_f64().unwrap())
        };
        // Thirteen digits of ratios that add up to all but 1/300 of one; of moduli, thirteen digits; of ten columns, five.
        for (name, digits) in [
            ("abaqus", 1e-9),
            ("ansys", 1e-9),
            ("comsol", 1e-12),
            ("ls-dyna", 5e-5),
        ] {
            let (text, error) = export(name);
            let read = match name {
                "abaqus" => read_abaqus(&text),
                "ansys" => read_ansys(&text),
                "comsol" => read_comsol(&text, nu),
                _ => read_ls_dyna(&text, nu),
            };
            assert_eq!(read.branches().len(), 17);
            let difference = difference(&exact, &read);
            below!(difference, digits, "{name}");
            // The program looks at more frequencies, at bulk moduli as well, and rounds in another order.
            below!(difference, 2.0 * error + 1e-14, "{name}");
        }
        let (text, error) = export("csv");
        assert_eq!(error, 0.0);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("modulus_pa,time_s"));
        assert_eq!(lines.next(), Some("1300000.0,"));
        let read = lines.map(|line| (numbers(line)[0], numbers(line)[1]));
        assert_eq!(read.collect::<Vec<_>>(), branches);
    }
}

#[test]
fn a_material_from_dynamic_data_is_exported_with_its_shift() {
    let place = Place::new();
    let branches: Vec<_> = (0..7).map(|k| (2e7, 10_f64.powi(k - 4))).collect();
    let solid = series(1e6, &branches);
    let (c1, c2) = (8.86, 101.6);
    let shift = |celsius: f64| -c1 * (celsius - 25.0) / (c2 + celsius - 25.0);
    let temperatures = [5.0, 15.0, 25.0, 35.0, 45.0, 55.0];
    let hertz = log_spaced(0.1, 10.0, 11);
    let table = dynamic_csv(&solid, (&temperatures, &hertz), shift, |modulus| modulus);
    place.put("dma.csv", table);
    let block = "[material]\npoisson_ratio = 0.45\n[material.dynamic]\nfile = \"dma.csv\"\nmodulus = \"shear\"\n\
                 reference_temperature = \"25 °C\"\n";
    place.put("material.toml", block);
    let at_40 = "temperature = \"40 °C\"\n[material.dynamic]";
    place.put("at_40.toml", block.replace("[material.dynamic]", at_40));
    // What `fit` writes knows the law as well.
    let fit = "material fit dma.csv --quantity dynamic --modulus shear --poisson-ratio 0.45 --reference-temperature '25 °C' --out fit";
    let fitted = json(&place, fit);
    place.put("fitted.toml", fitted["shifting_toml"].as_str().unwrap());
    for (file, reference) in [
        ("material.toml", 25.0),
        ("at_40.toml", 40.0),
        ("fitted.toml", 25.0),
    ] {
        let export = format!("material export {file} --to");
        let printed = json(&place, &format!("{export} abaqus"));
        let text = printed["text"].as_str().unwrap();
        let (_, law) = text.split_once("*TRS, DEFINITION=WLF\n").unwrap();
        let [reference_k, c1, c2] = numbers(law.trim())[..] else {
            panic!("{law}")
        };
        assert_eq!(reference_k, reference + 273.15);
        // What shift factors are held to, in decades.
        for celsius in [5.0, 30.0, 55.0] {
            let above = celsius - reference;
            let read = -c1 * above / (c2 + above);
            let exact = shift(celsius) - shift(reference);
            below!((read - exact).abs(), 0.03, "{celsius}");
        }
        let ansys = json(&place, &format!("{export} ansys"));
        assert_eq!(ansys["program"], "ansys");
    }
}

#[test]
fn an_export_goes_into_a_file_or_alone_to_standard_output() {
    let place = Place::new();
    let export = |rest: &str| place.run(&format!("material export pmma --to {rest}"));
    let printed = export("csv").ended(0);
    let csv = "modulus_pa,time_s\n1973000000.0,\n254776000.0,8.93\n263662800.0,117.96\n";
    assert_eq!(printed.stdout, csv);
    let parts = ["Error of the conversion", "Poisson ratio 0.38"];
    says(&printed.stderr, &parts);
    export("abaqus --out inp/pmma.inp").ended(0);
    let text = place.text("inp/pmma.inp");
    // What the comments of the file say is not printed too, but how exact its digits are.
    let printed = export("abaqus --out inp/pmma.inp").ended(0).stdout;
    says(&text, &["** Units: Pa, s, K.", "*MATERIAL, NAME=PMMA\n"]);
    assert!(!printed.contains("Units"), "{printed}");
    says(&printed, &["Error of the conversion"]);
    for wrong in ["nastran --out x", "csv --out ."] {
        assert_ne!(export(wrong).code, 0);
    }
}

#[test]
fn the_unit_of_the_frequencies_asked_for_comes_first_in_every_output() {
    let hz = "[sweep]\nfrequency = [\"0.001 Hz\", \"0.0013 Hz\", \"0.003 Hz\"]\n";
    let place = Place::with("hz.toml", &pmma_sweep(hz));
    place.done(&format!("sweep hz.toml --quiet --out out {SVG}"));
    let read = |name: &str| place.text(&format!("out/{name}"));
    let table = read("sweep.csv");
    let mut rows = table.lines();
    let columns = rows.next().unwrap();
    assert!(columns.starts_with("frequency_hz,angular_frequency_rad_per_s,drive_mean,"));
    assert!(rows.next().unwrap().starts_with("1e-3,6.283"), "{table}");
    for name in ["energy-loss", "loops", "dissipation", "moduli", "cole-cole"] {
        let columns = place
            .table(&format!("out/figures/{name}.csv"))
            .columns
            .join(",");
        says(&columns, &["frequency_hz,angular_frequency_rad_per_s"]);
    }
    let caption = read("figures/energy-loss.caption.txt");
    let parts = ["over frequency f: ", "at f = (1.3", " × 10⁻³ Hz"];
    says(&caption, &parts);
    assert!(!caption.contains("rad/s"), "{caption}");
    let page = read("index.html");
    assert!(page.contains("<th scope=\"col\" data-column=\"frequency_hz\">f / Hz</th>"));
    assert!(!page.contains("rad/s</strong>") && page.contains("Hz</strong>"));
    // The file with every default keeps the unit, and is the same sweep as in rad/s.
    let resolved = read("resolved.toml");
    assert!(resolved.contains("frequency_unit = \"Hz\""), "{resolved}");
    let angular = resolved.replace("frequency_unit = \"Hz\"", "");
    place.put("angular.toml", angular);
    place.done("sweep angular.toml --quiet --out out");
    assert!(read("sweep.csv").starts_with("angular_frequency_rad_per_s,frequency_hz,"));
    place.done("report --quiet out --set figures.frequency_unit=Hz");
    assert!(read("sweep.csv").starts_with("frequency_hz,"));
}

#[test]
fn nothing_that_is_piped_or_asked_to_be_plain_is_coloured() {
    let place = Place::with("good.toml", THREE);
    place.put("bad.toml", THREE.replace("radius", "raduis"));
    for file in ["good.toml", "bad.toml"] {
        for no_color in [None, Some(("NO_COLOR", "1"))] {
            let mut command = program();
            command.current_dir(place.path(""));
            command.args(["sweep", file, "--no-figures", "--out", "out"]);
            command.env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
            let output = command.envs(no_color).output().unwrap();
            assert!(!output.stdout.contains(&0x1b) && !output.stderr.contains(&0x1b));
        }
    }
}

#[test]
fn a_plan_counts_what_an_accuracy_takes() {
    let place = Place::with("small.toml", THREE);
    let time_s = |accuracy: &str| {
        let plan = json(&place, &format!("plan small.toml --accuracy {accuracy}"));
        let cases = plan["cases"].as_array().unwrap().iter();
        let times = cases.map(|case| case["time_s"].as_f64().unwrap());
        times.sum::<f64>()
    };
    // An error of second order: some five times as many steps, and springs.
    let (coarse, fine) = (time_s("1e-2"), time_s("1e-5"));
    assert!(fine > 5.0 * coarse, "{coarse} s, {fine} s");
}
