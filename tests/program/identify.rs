//! `contact-dma identify`: what it writes and prints, and what it refuses.

#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;

use crate::program::program;
use predicates::str::contains;
use tempfile::TempDir;

const FILE: &str = "title = \"A measured solid\"\n[identify]\ndata = \"measured.csv\"\n[material]\npoisson_ratio = 0.45\n\
                    [indenter]\nshape = \"sphere\"\nradius = \"2 mm\"\n[drive]\nmean = \"0.2 N\"\namplitude = \"0.1 N\"\n";

/// The measurement of the example.
fn example() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/identify-polymer.csv");
    fs::read_to_string(path).unwrap()
}

/// A folder with a measurement and the file that names it.
fn folder(table: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("measured.csv"), table).unwrap();
    fs::write(folder.path().join("solid.toml"), FILE).unwrap();
    folder
}

fn column(text: &str, name: &str) -> Vec<Option<f64>> {
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    let headers = rows.headers().unwrap();
    let place = headers.iter().position(|header| header == name).unwrap();
    rows.records()
        .map(|row| row.unwrap()[place].parse().ok())
        .collect()
}

#[test]
fn the_solid_of_the_example_is_found_and_its_block_is_one_of_a_sweep() {
    let folder = folder(&example());
    let printed = program()
        .current_dir(folder.path())
        .args(["identify", "solid.toml", "--out", "found"])
        .assert()
        .success();
    let printed = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
    println!("{printed}");
    assert!(
        printed.lines().all(|line| line.chars().count() <= 80),
        "{printed}"
    );
    assert!(printed.contains("Series: 3 branches, chosen among 1 to 6."));
    let read = |name: &str| fs::read_to_string(folder.path().join("found").join(name)).unwrap();
    let prony = read("prony.csv");
    let (moduli, times) = (column(&prony, "modulus_pa"), column(&prony, "time_s"));
    assert_eq!((moduli.len(), times[0]), (4, None));
    // Losses and phases with 1 % of noise: moduli and times to some per cent.
    let truth = [
        (20e6, None),
        (150e6, Some(3e-3)),
        (90e6, Some(0.1)),
        (40e6, Some(4.0)),
    ];
    for ((modulus, time), (modulus_pa, time_s)) in moduli.iter().zip(&times).zip(truth) {
        assert!(
            (modulus.unwrap() / modulus_pa - 1.0_f64).abs() < 0.1,
            "{prony}"
        );
        let off = time
            .zip(time_s)
            .map_or(0.0, |(found, exact): (f64, f64)| found / exact - 1.0);
        assert!(off.abs() < 0.1, "{prony}");
    }
    let summary: serde_json::Value = serde_json::from_str(&read("summary.json")).unwrap();
    assert_eq!(summary["errors"], "given");
    assert_eq!(summary["unknowns"][0]["name"], "g_inf");
    assert_eq!(summary["moduli"].as_array().unwrap().len(), 12);
    for file in [
        "moduli.svg",
        "moduli.png",
        "data-and-model.svg",
        "residuals.svg",
        "index.html",
        "fit.csv",
    ] {
        assert!(folder.path().join("found").join(file).is_file(), "{file}");
    }
    let block = read("material.toml");
    let rest = FILE.split_once("[indenter]").unwrap().1;
    let sweep = format!("title = \"t\"\n{block}\n[indenter]{rest}[sweep]\nfrequency = [1]\n");
    fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
    program()
        .current_dir(folder.path())
        .args(["sweep", "sweep.toml", "--quiet", "--no-figures"])
        .assert()
        .success();
    // The file with every default is the same identification.
    fs::copy(
        folder.path().join("found/resolved.toml"),
        folder.path().join("again.toml"),
    )
    .unwrap();
    program()
        .current_dir(folder.path())
        .args(["identify", "again.toml", "--quiet", "--threads", "1"])
        .assert()
        .success()
        .stdout("");
    let again = fs::read_to_string(folder.path().join("reports/again/prony.csv")).unwrap();
    assert_eq!(again, prony);
}

#[test]
fn a_folder_of_a_sweep_gives_its_material_back() {
    let folder = folder("");
    let sweep = "title = \"t\"\n[material]\npoisson_ratio = 0.45\n[material.relaxation]\nmodulus = \"longitudinal\"\n\
                 equilibrium = \"5 MPa\"\nbranches = [{ modulus = \"60 MPa\", time = \"0.1 s\" }]\n";
    let rest = FILE.split_once("[indenter]").unwrap().1;
    let sweep = format!(
        "{sweep}[indenter]{rest}[sweep]\nangular_frequency = {{ from = 0.1, to = 1000, points = 9 }}\n"
    );
    fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
    let run = |arguments: &[&str]| {
        program()
            .current_dir(folder.path())
            .args(arguments)
            .assert()
            .success()
    };
    run(&["sweep", "sweep.toml", "--quiet", "--out", "swept"]);
    let printed = run(&[
        "identify",
        "solid.toml",
        "--set",
        "identify.data=swept",
        "--format",
        "json",
    ]);
    let found: serde_json::Value = serde_json::from_slice(&printed.get_output().stdout).unwrap();
    assert_eq!(found["branches"], 1, "{found}");
    for (place, exact) in [5e6, 60e6, 0.1].into_iter().enumerate() {
        let unknown = &found["unknowns"][place];
        let value = unknown["value"].as_f64().unwrap();
        // The forward model on 64 springs and steps is within 0.1 % of the sweep's own.
        assert!((value / exact - 1.0).abs() < 3e-3, "{unknown}");
        assert_eq!(unknown["determined"], true);
    }
}

#[test]
fn a_bulk_modulus_stands_in_place_of_the_poisson_ratio_and_goes_into_the_block() {
    let folder = folder("");
    let series = "[material.relaxation]\nmodulus = \"longitudinal\"\nequilibrium = \"5 MPa\"\n\
                  branches = [{ modulus = \"60 MPa\", time = \"0.1 s\" }]\n";
    let bulk = "bulk_modulus = \"80 MPa\"";
    let rest = FILE.split_once("[indenter]").unwrap().1;
    let sweep = format!(
        "title = \"t\"\n[material]\n{bulk}\n{series}[indenter]{rest}[sweep]\n\
         angular_frequency = {{ from = 0.1, to = 1000, points = 9 }}\n"
    );
    fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
    let run = |arguments: &[&str]| {
        let mut command = program();
        command.current_dir(folder.path()).args(arguments).assert()
    };
    run(&["sweep", "sweep.toml", "--quiet", "--out", "swept"]).success();
    let identify = |set: &str| {
        let data = [
            "--set",
            "identify.data=swept",
            "--set",
            "material.poisson_ratio=",
        ];
        run(&[
            &["identify", "solid.toml", "--out", "found"],
            &data[..],
            &["--set", set],
        ]
        .concat())
    };
    identify("material.bulk_modulus=80 MPa").success();
    let read = |name: &str| fs::read_to_string(folder.path().join("found").join(name)).unwrap();
    assert!(
        read("resolved.toml").contains("bulk_modulus = \"80000000 Pa\""),
        "{}",
        read("resolved.toml")
    );
    assert!(read("material.toml").contains("bulk_modulus = "));
    let found: serde_json::Value = serde_json::from_str(&read("summary.json")).unwrap();
    assert_eq!(
        (&found["poisson_ratio"], &found["bulk_modulus_pa"]),
        (&serde_json::Value::Null, &80e6.into())
    );
    for (place, exact) in [5e6, 60e6, 0.1].into_iter().enumerate() {
        let value = found["unknowns"][place]["value"].as_f64().unwrap();
        assert!((value / exact - 1.0).abs() < 3e-3, "{place} {value:e}");
    }
}

/// Second cycles after a rest, as an experiment has them, which are not the stabilised ones.
#[test]
fn cycles_by_their_number_give_the_material_back_and_are_not_taken_for_stabilised_ones() {
    let folder = TempDir::new().unwrap();
    let indenter = "[indenter]\nshape = \"sphere\"\nradius = \"2 mm\"\n";
    let drive = "[drive]\nmean = \"1 N\"\namplitude = \"0.2 N\"\nhold = \"5 s\"\n";
    let cycle = "[cycle]\nmethod = \"march\"\nat_cycle = 2\n";
    let sweep = format!(
        "title = \"t\"\n[material]\npoisson_ratio = 0.45\n[material.relaxation]\nmodulus = \"longitudinal\"\n\
         equilibrium = \"10 MPa\"\nbranches = [{{ modulus = \"40 MPa\", time = \"0.3 s\" }}, {{ modulus = \"20 MPa\", time = \"10 s\" }}]\n\
         {indenter}{drive}{cycle}[sweep]\nangular_frequency = {{ from = \"0.03 rad/s\", to = \"30 rad/s\", points = 8 }}\n\
         [solver]\nsprings = 60\n"
    );
    let file = folder.path().join("cycles.toml");
    fs::write(&file, sweep).unwrap();
    let out = folder.path().join("cycles");
    let mut command = program();
    command
        .args(["sweep", "--quiet", "--no-figures"])
        .arg(&file);
    command.arg("--out").arg(&out).assert().success();
    let identify = |cycle: &str| {
        let text = format!(
            "title = \"t\"\n[identify]\ndata = \"cycles\"\nbranches = 2\n[material]\npoisson_ratio = 0.45\n{indenter}{drive}{cycle}"
        );
        let file = folder.path().join("solid.toml");
        fs::write(&file, text).unwrap();
        let mut command = program();
        command.args(["identify", "--quiet"]).arg(&file);
        command.arg("--out").arg(folder.path().join("solid"));
        command.output().unwrap()
    };
    let stabilised = identify("");
    assert_eq!(stabilised.status.code(), Some(2));
    let told = String::from_utf8(stabilised.stderr).unwrap();
    assert!(told.contains("contradict"), "{told}");
    assert_eq!(identify(cycle).status.code(), Some(0));
    let table = fs::read_to_string(folder.path().join("solid/prony.csv")).unwrap();
    let found = |name: &str| -> Vec<f64> { column(&table, name).into_iter().flatten().collect() };
    let exact = [10e6, 40e6, 20e6, 0.3, 10.0];
    for (found, exact) in [found("modulus_pa"), found("time_s")]
        .concat()
        .iter()
        .zip(exact)
    {
        // The errors of the data are some tenths of a per cent.
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
    }
}

/// What `identify` prints of a table, and its summary.
fn found(folder: &TempDir, set: &[&str]) -> (String, serde_json::Value) {
    let printed = program()
        .current_dir(folder.path())
        .args(["identify", "solid.toml", "--out", "found", "--no-figures"])
        .args(set)
        .assert()
        .success();
    let printed = String::from_utf8(printed.get_output().stdout.clone()).unwrap();
    let summary = fs::read_to_string(folder.path().join("found/summary.json")).unwrap();
    (printed, serde_json::from_str(&summary).unwrap())
}

#[test]
fn a_column_that_is_not_understood_is_named_and_common_words_are_understood() {
    let table = example();
    let rows = table.lines().filter(|line| !line.starts_with('#'));
    let head = "Frequency (Hz),Loss (J),Loss error (J),Phase (rad),Phase fault (rad),Max depth error (m),Operator";
    let rows = rows
        .skip(1)
        .enumerate()
        .map(|(k, row)| match (k, row.rsplit_once(',')) {
            // A cell in which nothing was measured, as Python writes it.
            (3, Some((row, _))) => format!("{row},None,1e-6,N.N."),
            _ => format!("{row},1e-6,N.N."),
        });
    let rows: Vec<String> = rows.collect();
    let folder = folder(&format!("{head}\n{}\n", rows.join("\n")));
    let (printed, summary) = found(&folder, &["--set", "identify.branches=3"]);
    let printed = printed.replace("\n  ", " ");
    for expected in [
        "Columns read: Frequency (Hz), Loss (J), Loss error (J) and Phase (rad).",
        "Not taken as data: Max depth error (m): the table has not the quantity",
        "Warning: columns not understood, and not read: Phase fault (rad) and Operator.",
        "g_inf and g_i are Young's moduli: E(t) = g_inf",
    ] {
        assert!(printed.contains(expected), "{expected}\n{printed}");
    }
    assert_eq!(
        summary["columns_not_understood"],
        serde_json::json!(["Phase fault (rad)", "Operator"])
    );
}

/// A loss that is 30 % off, among data of 1 %.
#[test]
fn an_outlier_is_named_gets_no_branch_and_widens_the_intervals() {
    let mut lines: Vec<String> = example().lines().map(str::to_owned).collect();
    let first = lines
        .iter()
        .position(|line| line.starts_with("1.0000"))
        .unwrap();
    let row = &mut lines[first + 4];
    let mut cells: Vec<String> = row.split(',').map(str::to_owned).collect();
    let loss: f64 = cells[1].parse().unwrap();
    cells[1] = format!("{:e}", 1.3 * loss);
    *row = cells.join(",");
    let folder = folder(&(lines.join("\n") + "\n"));
    let (printed, summary) = found(&folder, &[]);
    println!("{printed}");
    assert_eq!(summary["branches"], 3);
    let worst = &summary["worst"];
    assert_eq!(
        (&worst["column"], &worst["row"]),
        (&"energy_loss_j".into(), &5.into())
    );
    let first = printed.lines().find(|line| line.contains(':')).unwrap();
    assert!(
        first.starts_with("Warning: the series misses the data: chi squared"),
        "{first}"
    );
    assert!(
        printed
            .replace("\n  ", " ")
            .contains("energy_loss_j of row 5")
    );
    let truth = [20e6, 150e6, 3e-3, 90e6, 0.1, 40e6, 4.0];
    for (unknown, truth) in summary["unknowns"].as_array().unwrap().iter().zip(truth) {
        let [low, high] = ["low", "high"].map(|end| unknown[end].as_f64().unwrap());
        assert!(low < truth && truth < high, "{unknown} {truth}");
    }
}

#[test]
fn too_few_branches_are_among_the_causes_of_a_misfit() {
    let folder = folder(&example());
    program()
        .current_dir(folder.path())
        .args(["identify", "solid.toml", "--set", "identify.branches=1"])
        .assert()
        .code(2)
        .stderr(contains("may have more branches"));
}

/// A force curve: sphere of 2.5 um on E = 1 kPa (t/1 s)^-0.2, 0.5 um in 0.5 s and back. The contact of one branch ends before that of the
/// data does, and a load of nothing has no place on a logarithmic axis.
#[test]
fn a_force_curve_whose_model_leaves_the_surface_before_the_data_is_drawn() {
    let loads = [
        (0.04, 4.78e-11),
        (0.08, 1.17e-10),
        (0.12, 1.97e-10),
        (0.16, 2.95e-10),
        (0.2, 3.93e-10),
        (0.24, 4.89e-10),
        (0.28, 6.19e-10),
        (0.32, 7.46e-10),
        (0.36, 8.49e-10),
        (0.4, 9.81e-10),
        (0.44, 1.11e-09),
        (0.48, 1.24e-09),
        (0.52, 1.09e-09),
        (0.56, 8.41e-10),
        (0.6, 6.50e-10),
        (0.64, 4.78e-10),
        (0.68, 3.29e-10),
        (0.72, 2.35e-10),
        (0.76, 1.42e-10),
        (0.8, 6.95e-11),
        (0.88, 1.43e-11),
        (0.936, 8.00e-12),
    ];
    let rows = loads
        .map(|(time_s, load_n)| format!("{time_s},{load_n:e},6.5e-12\n"))
        .concat();
    let folder = folder(&format!("time_s,load_n,load_error_n\n{rows}"));
    let drive = "control = \"approach\"\nsegments = [{ kind = \"ramp\", to = \"0.5 um\", duration = \"0.5 s\" }, \
                 { kind = \"ramp\", to = \"0 um\", duration = \"0.5 s\" }]";
    let file = FILE
        .replace("mean = \"0.2 N\"\namplitude = \"0.1 N\"", drive)
        .replace("2 mm", "2.5 um")
        .replace("0.45", "0.5")
        .replace("[material]", "branches = 1\n[material]");
    fs::write(folder.path().join("solid.toml"), file).unwrap();
    program()
        .current_dir(folder.path())
        .args(["identify", "solid.toml", "--out", "found"])
        .assert()
        .success();
    let page = fs::read_to_string(folder.path().join("found/index.html")).unwrap();
    assert!(page.contains("which a logarithmic axis does not show"));
    assert!(folder.path().join("found/data-and-model.svg").is_file());
}

#[test]
fn the_gel_of_the_creep_example_is_found_and_its_tables_go_by_time() {
    let out = TempDir::new().unwrap();
    let printed = program()
        .args([
            "identify",
            "sweeps/identify-creep.toml",
            "--format",
            "json",
            "--out",
        ])
        .arg(out.path().join("gel"))
        .assert()
        .success();
    let json: serde_json::Value = serde_json::from_slice(&printed.get_output().stdout).unwrap();
    assert_eq!(
        (&json["of"], &json["branches"]),
        (&"history".into(), &2.into())
    );
    // examples/measured_cycles.rs; the intervals are of 95 %, those of one solid.
    let truth = [4e6, 3e6, 2.0, 2e6, 60.0];
    for (unknown, truth) in json["unknowns"].as_array().unwrap().iter().zip(truth) {
        let value = unknown["value"].as_f64().unwrap();
        assert!((value / truth - 1.0).abs() < 0.08, "{unknown}");
    }
    let fit = fs::read_to_string(out.path().join("gel/fit.csv")).unwrap();
    let times = column(&fit, "time_s");
    assert!(times.first().unwrap().unwrap() < 0.21 && times.last().unwrap().unwrap() > 599.0);
    // The resolved file holds the segments and gives the same again.
    let resolved = fs::read_to_string(out.path().join("gel/resolved.toml")).unwrap();
    assert!(resolved.contains("segments = ["), "{resolved}");
}

#[test]
fn a_measured_time_outside_the_drive_is_refused_at_its_row() {
    let folder = folder("time_s,approach_m\n1,1e-6\n2,2e-6\n70,3e-6\n");
    let file = FILE.replace(
        "mean = \"0.2 N\"\namplitude = \"0.1 N\"",
        "control = \"load\"\nsegments = [{ kind = \"step\", to = \"0.2 N\", duration = \"60 s\" }]",
    );
    fs::write(folder.path().join("solid.toml"), file).unwrap();
    let assert = program()
        .current_dir(folder.path())
        .args(["identify", "solid.toml", "--out", "found"])
        .assert()
        .code(2);
    assert
        .stderr(contains("measured.csv:4:1"))
        .stderr(contains("not within the drive"));
    assert!(!folder.path().join("found").exists());
}
