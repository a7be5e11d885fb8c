//! `contact-dma identify`: what it writes and prints, and what it refuses.

use crate::prelude::*;

const FILE: &str = include_str!("../inputs/measured-solid.toml");

/// The measurement of the example.
fn example() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/identify-polymer.csv");
    fs::read_to_string(path).unwrap()
}

/// A folder with a measurement and the file that names it.
fn place(table: &str) -> Place {
    let place = Place::with("measured.csv", table);
    place.put("solid.toml", FILE);
    place
}

/// A sweep of the solid that is sought, of this Poisson ratio or bulk modulus, in `swept`.
fn swept(known: &str) -> Place {
    let rest = FILE.split_once("[indenter]").unwrap().1;
    let sweep = format!(
        "title = \"t\"\n[material]\n{known}\n[material.relaxation]\nmodulus = \"longitudinal\"\nequilibrium = \"5 MPa\"\n\
         branches = [{{ modulus = \"60 MPa\", time = \"0.1 s\" }}]\n[indenter]{rest}[sweep]\n\
         angular_frequency = {{ from = 0.1, to = 1000, points = 9 }}\n"
    );
    let place = place("");
    place.put("sweep.toml", sweep);
    place.done("sweep sweep.toml --quiet --out swept");
    place
}

/// The solid of [`swept`] is found: the forward model on 64 springs and steps is within 0.1 % of the sweep's own.
fn is_that_of_the_sweep(found: &Value) {
    assert_eq!(found["branches"], 1, "{found}");
    for (place, exact) in [5e6, 60e6, 0.1].into_iter().enumerate() {
        let unknown = &found["unknowns"][place];
        let value = unknown["value"].as_f64().unwrap();
        near!(value, exact, 3e-3, "{unknown}");
        assert_eq!(unknown["determined"], true);
    }
}

#[test]
fn the_solid_of_the_example_is_found_and_its_block_is_one_of_a_sweep() {
    let place = place(&example());
    let run = place.done("identify solid.toml --out found").fits_eighty();
    run.says(&["Series: 3 branches, chosen among 1 to 6."]);
    let prony = place.table("found/prony.csv");
    assert_eq!(prony.found("time_s")[0], None);
    // Losses and phases with 1 % of noise: moduli and times to some per cent.
    let close = |found: &[Option<f64>], exact: &[f64]| {
        assert_eq!(found.len(), exact.len());
        for (found, exact) in found.iter().zip(exact) {
            near!(found.unwrap(), *exact, 0.1);
        }
    };
    close(&prony.found("modulus_pa"), &[20e6, 150e6, 90e6, 40e6]);
    close(&prony.found("time_s")[1..], &[3e-3, 0.1, 4.0]);
    let summary = place.json("found/summary.json");
    assert_eq!(summary["errors"], "given");
    assert_eq!(summary["unknowns"][0]["name"], "g_inf");
    assert_eq!(summary["moduli"].as_array().unwrap().len(), 12);
    let files = "figures/moduli.svg figures/moduli.png figures/data-and-model.svg figures/residuals.svg index.html fit.csv";
    place.has_all("found", files);
    let block = place.text("found/material.toml");
    let rest = FILE.split_once("[indenter]").unwrap().1;
    place.swept(&format!(
        "title = \"t\"\n{block}\n[indenter]{rest}[sweep]\nfrequency = [1]\n"
    ));
    // The file with every default is the same identification.
    place.put("again.toml", place.text("found/resolved.toml"));
    let again = place.done("identify again.toml --quiet --threads 1");
    assert_eq!(again.stdout, "");
    assert_eq!(place.table("reports/again/prony.csv"), prony);
}

#[test]
fn a_folder_of_a_sweep_gives_its_material_back() {
    let place = swept("poisson_ratio = 0.45");
    let found = place.done("identify solid.toml --set identify.data=swept --format json");
    is_that_of_the_sweep(&found.json());
}

#[test]
fn a_bulk_modulus_stands_in_place_of_the_poisson_ratio_and_goes_into_the_block() {
    let place = swept("bulk_modulus = \"80 MPa\"");
    place.done("identify solid.toml --out found --set identify.data=swept --set material.poisson_ratio= --set 'material.bulk_modulus=80 MPa'");
    let bulk = "bulk_modulus = \"80000000 Pa\"";
    says(&place.text("found/resolved.toml"), &[bulk]);
    says(&place.text("found/material.toml"), &["bulk_modulus = "]);
    let found = place.json("found/summary.json");
    assert!(found["poisson_ratio"].is_null() && found["bulk_modulus_pa"] == 80e6);
    is_that_of_the_sweep(&found);
}

/// Second cycles after a rest, as an experiment has them, which are not the stabilised ones.
#[test]
fn cycles_by_their_number_give_the_material_back_and_are_not_taken_for_stabilised_ones() {
    let cycle = "[cycle]\nmethod = \"march\"\nat_cycle = 2\n";
    let place = Place::lent("cycles.toml");
    place.done("sweep cycles.toml --quiet --no-figures --out cycles");
    let identify = |cycle: &str| {
        let head = FILE.replace("measured.csv\"", "cycles\"\nbranches = 2");
        let drive = head.replace("0.2 N", "1 N").replace("0.1 N", "0.2 N");
        place.put("solid.toml", format!("{drive}hold = \"5 s\"\n{cycle}"));
        place.run("identify solid.toml --quiet --out solid")
    };
    let stabilised = identify("").ended(2);
    assert!(stabilised.stderr.contains("contradict"), "{stabilised:?}");
    identify(cycle).ended(0);
    let table = place.table("solid/prony.csv");
    let found = [table.found("modulus_pa"), table.found("time_s")].concat();
    let exact = [10e6, 40e6, 20e6, 0.3, 10.0];
    for (found, exact) in found.into_iter().flatten().zip(exact) {
        // The errors of the data are some tenths of a per cent.
        near!(found, exact, 5e-3);
    }
}

/// What `identify` prints of a table, and its summary.
fn found(place: &Place, set: &str) -> (String, Value) {
    let run = format!("identify solid.toml --out found --no-figures {set}");
    (place.done(&run).stdout, place.json("found/summary.json"))
}

#[test]
fn a_column_that_is_not_understood_is_named_and_common_words_are_understood() {
    let table = example();
    let rows = table.lines().filter(|line| !line.starts_with('#')).skip(1);
    let head = "Frequency (Hz),Loss (J),Loss error (J),Phase (rad),Phase fault (rad),Max depth error (m),Operator";
    let row = |(k, row): (usize, &str)| match (k, row.rsplit_once(',')) {
        // A cell in which nothing was measured, as Python writes it.
        (3, Some((row, _))) => format!("{row},None,1e-6,N.N."),
        _ => format!("{row},1e-6,N.N."),
    };
    let rows: Vec<String> = rows.enumerate().map(row).collect();
    let place = place(&format!("{head}\n{}\n", rows.join("\n")));
    let (printed, summary) = found(&place, "--set identify.branches=3");
    let parts = [
        "Columns read: Frequency (Hz), Loss (J), Loss error (J) and Phase (rad).",
        "Not taken as data: Max depth error (m): the table has not the quantity",
        "Warning: columns not understood, and not read: Phase fault (rad) and Operator.",
        "g_inf and g_i are Young's moduli: E(t) = g_inf",
    ];
    says(&printed.replace("\n  ", " "), &parts);
    let expected = serde_json::json!(["Phase fault (rad)", "Operator"]);
    assert_eq!(summary["columns_not_understood"], expected);
}

/// A loss that is 30 % off, among data of 1 %.
#[test]
fn an_outlier_is_named_gets_no_branch_and_widens_the_intervals() {
    let mut lines: Vec<String> = example().lines().map(str::to_owned).collect();
    let first = lines.iter().position(|line| line.starts_with("1.0000"));
    let row = &mut lines[first.unwrap() + 4];
    let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
    let loss: f64 = cells[1].parse().unwrap();
    cells[1] = format!("{:e}", 1.3 * loss);
    *row = cells.join(",");
    let place = place(&(lines.join("\n") + "\n"));
    let (printed, summary) = found(&place, "");
    assert_eq!(summary["branches"], 3);
    let worst = &summary["worst"];
    assert_eq!(worst["column"], "energy_loss_j");
    assert_eq!(worst["row"], 5);
    let first = printed.lines().find(|line| line.contains(':')).unwrap();
    let warning = "Warning: the series misses the data: chi squared";
    assert!(first.starts_with(warning), "{first}");
    says(&printed.replace("\n  ", " "), &["energy_loss_j of row 5"]);
    let truth = [20e6, 150e6, 3e-3, 90e6, 0.1, 40e6, 4.0];
    for (unknown, truth) in summary["unknowns"].as_array().unwrap().iter().zip(truth) {
        let [low, high] = ["low", "high"].map(|end| unknown[end].as_f64().unwrap());
        assert!(low < truth && truth < high, "{unknown} {truth}");
    }
}

/// A force curve: sphere of 2.5 um on E = 1 kPa (t/1 s)^-0.2, 0.5 um in 0.5 s and back. The contact of one branch ends before that of the
/// data does, and a load of nothing has no place on a logarithmic axis.
#[test]
fn a_force_curve_whose_model_leaves_the_surface_before_the_data_is_drawn() {
    // Times in hundredths of a second, loads in pN.
    let loads = "4 47.8  8 117  12 197  16 295  20 393  24 489  28 619  32 746  36 849  40 981  44 1110  48 1240  52 1090  56 841  \
                 60 650  64 478  68 329  72 235  76 142  80 69.5  88 14.3  93.6 8";
    let cells = loads.split_whitespace();
    let loads: Vec<f64> = cells.map(|cell| cell.parse().unwrap()).collect();
    let row = |row: &[f64]| format!("{:.3},{:e},6.5e-12\n", 0.01 * row[0], 1e-12 * row[1]);
    let rows: String = loads.chunks(2).map(row).collect();
    let place = place(&format!("time_s,load_n,load_error_n\n{rows}"));
    let drive = "control = \"approach\"\nsegments = [{ kind = \"ramp\", to = \"0.5 um\", duration = \"0.5 s\" }, \
                 { kind = \"ramp\", to = \"0 um\", duration = \"0.5 s\" }]";
    let file = FILE
        .replace("mean = \"0.2 N\"\namplitude = \"0.1 N\"", drive)
        .replace("2 mm", "2.5 um")
        .replace("0.45", "0.5")
        .replace("[material]", "branches = 1\n[material]");
    place.put("solid.toml", file);
    place.done("identify solid.toml --out found");
    let note = "which a logarithmic axis does not show";
    says(&place.text("found/index.html"), &[note]);
    assert!(place.has("found/figures/data-and-model.svg"));
}

#[test]
fn the_gel_of_the_creep_example_is_found_and_its_tables_go_by_time() {
    let place = Place::new();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/identify-creep.toml");
    let run = format!("identify '{}' --format json --out gel", file.display());
    let json = place.done(&run).json();
    assert_eq!(json["of"], "history");
    assert_eq!(json["branches"], 2);
    // examples/measured_cycles.rs; the intervals are of 95 %, those of one solid.
    let truth = [4e6, 3e6, 2.0, 2e6, 60.0];
    for (unknown, truth) in json["unknowns"].as_array().unwrap().iter().zip(truth) {
        near!(unknown["value"].as_f64().unwrap(), truth, 0.08, "{unknown}");
    }
    let times = place.table("gel/fit.csv").numbers("time_s");
    assert!(times[0] < 0.21 && times[times.len() - 1] > 599.0);
    // The resolved file holds the segments and gives the same again.
    says(&place.text("gel/resolved.toml"), &["segments = ["]);
}

#[test]
fn the_law_of_a_gel_is_found_from_its_relaxation_and_its_block_relaxes_alike() {
    let place = Place::new();
    let rest = "[material]\npoisson_ratio = 0.49\n[indenter]\nshape = \"sphere\"\nradius = \"5 um\"\n[drive]\ncontrol = \"approach\"\n\
                segments = [ { kind = \"ramp\", to = \"0.5 um\", duration = \"0.1 s\" }, \
                { kind = \"step\", to = \"0.5 um\", duration = \"100 s\" } ]\n";
    let law = "[material.fractional]\nmodel = \"springpot\"\nmodulus = \"longitudinal\"\nstiffness = \"1 kPa\"\ntime = \"1 s\"\n\
               exponent = 0.2\nband = [\"0.001 rad/s\", \"1000 rad/s\"]\n";
    place.put("gel.toml", format!("title = \"gel\"\n{law}{rest}"));
    place.done("simulate gel.toml --quiet --no-figures --out gel");
    let history = place.table("gel/history.csv");
    let columns = ["time_s", "load_n"].map(|name| history.numbers(name));
    let rows = columns[0]
        .iter()
        .zip(&columns[1])
        .filter(|(t, _)| **t >= 0.1);
    let mut random = Random(3);
    let rows =
        rows.map(|(t, load_n)| format!("{t:e},{:e}\n", load_n * (1.0 + 0.01 * random.normal())));
    let table = format!("time_s,load_n\n{}", rows.collect::<String>());
    place.put("gel.csv", table);
    place.put(
        "find.toml",
        format!("title = \"find\"\n[identify]\ndata = \"gel.csv\"\nlaw = \"auto\"\n{rest}"),
    );
    place.done("identify find.toml --quiet --out found");
    let found = place.json("found/summary.json");
    assert_eq!(found["law"], "power-law", "{}", found["laws"]);
    for (name, exact) in [("modulus_pa", 1e3), ("exponent", 0.2)] {
        let value = found["parameters"][name]["value"].as_f64().unwrap();
        near!(value, exact, 0.02, "{name}");
    }
    // What lies outside the times measured is marked.
    let moduli = place.table("found/figures/moduli.csv");
    let marked = moduli.cells("extrapolated");
    assert_eq!((marked[0], marked[marked.len() / 2]), ("true", "false"));
    // The same gel relaxes as measured.
    place.put(
        "again.toml",
        "title = \"again\"\n".to_owned()
            + &place.text("found/material.toml")
            + &rest.replace("[material]\npoisson_ratio = 0.49\n", ""),
    );
    place.done("simulate again.toml --quiet --no-figures --out again");
    let last = |folder: &str| {
        let loads = place
            .table(&format!("{folder}/history.csv"))
            .numbers("load_n");
        loads[loads.len() - 1]
    };
    near!(last("again"), last("gel"), 0.01);
}

#[test]
fn solids_of_data_with_their_noise_drawn_anew_spread_as_the_bands_say_and_a_sweep_has_their_band() {
    let place = Place::new();
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/identify-polymer.toml");
    let samples = "--set identify.samples=40 --quiet --out found";
    place.done(&format!("identify '{}' {samples}", file.display()));
    let ensemble = place.table("found/ensemble.csv");
    assert_eq!(ensemble.len(), 3 * 40);
    let middle: Vec<f64> = (0..40)
        .map(|k| ensemble.number(3 * k + 1, "storage_modulus_pa").ln())
        .collect();
    let mean = middle.iter().sum::<f64>() / 40.0;
    let squares = middle.iter().map(|ln| (ln - mean).powi(2));
    let spread = (squares.sum::<f64>() / 39.0).sqrt();
    let moduli = place.table("found/figures/moduli.csv");
    let [low, high] = moduli.row(
        moduli.len() / 2,
        ["storage_modulus_low_pa", "storage_modulus_high_pa"],
    );
    let deviation = (high / low).ln() / 2.0 / 1.96;
    assert!(
        (0.6..1.6).contains(&(spread / deviation)),
        "{spread} {deviation}"
    );
    let sweep = "[indenter]\nshape = \"sphere\"\nradius = \"2 mm\"\n[drive]\nmean = \"0.2 N\"\namplitude = \"0.1 N\"\n[sweep]\n\
                 angular_frequency = [\"1 rad/s\"]\n";
    let block = place.text("found/material.toml");
    place.put("swept.toml", format!("title = \"swept\"\n{block}{sweep}"));
    place.done("sweep swept.toml --quiet --no-figures --out swept");
    let swept = place.table("swept/sweep.csv");
    let relative =
        swept.number(0, "energy_loss_material_error_j") / swept.number(0, "energy_loss_j");
    assert!((1e-3..0.1).contains(&relative), "{relative}");
}
