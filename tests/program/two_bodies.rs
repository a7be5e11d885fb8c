//! An indenter that is not rigid: two bodies, and what each of them dissipates.

#![cfg(feature = "cli")]

use std::collections::HashMap;
use std::fs;

use crate::program::{pmma_sweep, program, write};
use tempfile::TempDir;

const COARSE: &str = r#"[sweep]
angular_frequency = ["3e-3 rad/s", "0.03 rad/s"]
[cycle]
steps = 32
error_bars = false
[solver]
springs = 60
"#;

/// A Zener solid as a creep series, of these compliances (1/Pa).
fn zener(header: &str, instantaneous: f64, branch: f64, time: f64) -> String {
    format!(
        "[{header}]\npoisson_ratio = 0.5\n[{header}.creep]\ncompliance = \"shear\"\ninstantaneous = {instantaneous:e}\n\
         branches = [{{ compliance = {branch:e}, time = {time:?} }}]\n"
    )
}

fn sweep_of(material: &str, indenter: &str) -> String {
    format!(
        "title = \"Two bodies\"\n{material}[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n{indenter}[drive]\n\
         mean = \"10 N\"\namplitude = \"5 N\"\n{COARSE}"
    )
}

/// The rows of a sweep's table, and the resolved file.
fn run(text: &str) -> (Vec<HashMap<String, String>>, String) {
    let folder = TempDir::new().unwrap();
    let file = write(&folder, "two.toml", text);
    let mut command = program();
    command.args(["sweep", &file, "--quiet", "--no-figures", "--out"]);
    command.arg(folder.path().join("out")).assert().success();
    let mut table = csv::Reader::from_path(folder.path().join("out/sweep.csv")).unwrap();
    let rows = table.deserialize().map(|row| row.unwrap()).collect();
    let resolved = fs::read_to_string(folder.path().join("out/resolved.toml")).unwrap();
    (rows, resolved)
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap()
}

#[test]
fn two_equal_bodies_are_one_of_twice_the_compliance() {
    let equal = zener("indenter.material", 1e-9, 2e-9, 40.0);
    let (pair, _) = run(&sweep_of(&zener("material", 1e-9, 2e-9, 40.0), &equal));
    let (twice, _) = run(&sweep_of(&zener("material", 2e-9, 4e-9, 40.0), ""));
    for (pair, twice) in pair.iter().zip(&twice) {
        // Every compliance is doubled exactly, by an addition or by the file.
        for column in ["energy_loss_j", "approach_max_m", "dissipated_j"] {
            assert_eq!(pair[column], twice[column], "{column}");
        }
        let share = number(pair, "dissipated_in_indenter_j") / number(pair, "dissipated_j");
        assert!((share - 0.5).abs() < 1e-12, "{share}"); // as written, to 15 digits or more
        assert_eq!(twice["dissipated_in_indenter_j"], "");
    }
}

#[test]
fn a_rigid_indenter_is_told_where_it_costs_more_than_the_error_bars() {
    let told = |indenter: &str, bars: bool| {
        let folder = TempDir::new().unwrap();
        let text = sweep_of("[material]\nlibrary = \"pmma\"\n", indenter);
        let text = text.replace("error_bars = false", &format!("error_bars = {bars}"));
        let file = write(&folder, "two.toml", &text);
        let mut command = program();
        command
            .args(["sweep", &file, "--out"])
            .arg(folder.path().join("out"));
        let output = command.output().unwrap();
        assert!(output.status.success());
        let page = fs::read_to_string(folder.path().join("out/index.html")).unwrap();
        let said = String::from_utf8(output.stdout).unwrap();
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        let note = "note: the indenter is taken as rigid: a steel one would add up to ";
        assert_eq!(said.contains(note), page.contains("a steel one would add"));
        said.split_once(note).map(|(_, rest)| rest.to_owned())
    };
    // (1 - 0.3^2)/210 GPa beside (1 - 0.38^2)/2.4 GPa.
    let note = told("", true).unwrap();
    assert!(
        note.starts_with(
            "1.1 % to the compliance, which is more than the error bars of 2 of 2 cases"
        ),
        "{note}"
    );
    assert_eq!(told("", false), None);
    assert_eq!(
        told("[indenter.material]\nlibrary = \"steel\"\n", true),
        None
    );
}

#[test]
fn each_body_dissipates_what_its_branches_do() {
    let (rows, _) = run(&sweep_of(
        &zener("material", 1e-9, 2e-9, 40.0),
        &zener("indenter.material", 1e-9, 1e-9, 400.0),
    ));
    for row in rows {
        let [base, indenter] = [1, 2].map(|k| number(&row, &format!("branch_{k}_loss_j")));
        assert_eq!(number(&row, "dissipated_in_indenter_j"), indenter);
        let loss = number(&row, "energy_loss_j");
        // Of 32 steps a cycle: the discretisation error of the loop.
        assert!(((base + indenter) / loss - 1.0).abs() < 0.01);
    }
}

#[test]
fn a_steel_ball_loses_nothing_itself_and_its_file_is_resolved_to_the_same_sweep() {
    let ball = "[indenter.material]\nelastic = { modulus = \"210 GPa\", poisson_ratio = 0.3 }\n";
    let text = format!("{}{ball}", pmma_sweep(COARSE));
    let (rows, resolved) = run(&text);
    let (rigid, _) = run(&pmma_sweep(COARSE));
    assert!(
        resolved.contains("[indenter.material.relaxation]"),
        "{resolved}"
    );
    let (again, resolved_again) = run(&resolved);
    assert_eq!(resolved, resolved_again);
    for ((steel, rigid), again) in rows.iter().zip(&rigid).zip(&again) {
        assert_eq!(steel["energy_loss_j"], again["energy_loss_j"]);
        assert_eq!(number(steel, "dissipated_in_indenter_j"), 0.0);
        // By Hertz the approach goes with C^(2/3). C of PMMA lies between 0.34 and 0.44 per GPa over the cycle, that of steel is
        // 0.00433: 1.0 to 1.3 % more, of which two thirds.
        let more = number(steel, "approach_max_m") / number(rigid, "approach_max_m") - 1.0;
        assert!((0.0060..0.0090).contains(&more), "{more}");
    }
}

#[test]
fn what_the_indenter_is_made_of_is_an_axis_like_any_number() {
    let pmma = "[material]\nlibrary = \"pmma\"\n";
    let elastic = |modulus: &str| {
        format!(
            "[indenter.material]\nelastic = {{ modulus = \"{modulus}\", poisson_ratio = 0.3 }}\n"
        )
    };
    let over = |axis: &str, indenter: &str| {
        let text = sweep_of(pmma, indenter);
        text.replace("[sweep]\n", &format!("[sweep]\n{axis}\n"))
    };
    let moduli = ["3 GPa", "70 GPa"];
    let axis = "indenter.material.elastic.modulus = [\"3 GPa\", \"70 GPa\"]";
    let swept = over(axis, &elastic("210 GPa"));
    let (rows, resolved) = run(&swept);
    assert_eq!(rows.len(), 4);
    for (rows, modulus) in rows.chunks(2).zip(moduli) {
        let (alone, _) = run(&sweep_of(pmma, &elastic(modulus)));
        for (row, alone) in rows.iter().zip(&alone) {
            for column in ["energy_loss_j", "phase_lag_rad", "storage_modulus_pa"] {
                assert_eq!(row[column], alone[column], "{modulus} {column}");
            }
        }
    }
    let column = "indenter_material_elastic_modulus_pa";
    assert_eq!(
        [number(&rows[0], column), number(&rows[2], column)],
        [3e9, 70e9]
    );
    let (again, resolved_again) = run(&resolved);
    assert_eq!(again, rows);
    assert_eq!(resolved_again, resolved);
    // Beside an axis of the body: every pair.
    let both = format!(
        "{axis}\ndrive.amplitude = [\"2 N\", \"5 N\"]\nmaterial.poisson_ratio = [0.3, 0.4]"
    );
    let (rows, _) = run(&over(&both, &elastic("210 GPa")).replace(
        pmma,
        "[material]\nlibrary = \"pmma\"\npoisson_ratio = 0.38\n",
    ));
    assert_eq!(rows.len(), 16);
    let losses: std::collections::HashSet<_> =
        rows.iter().map(|row| &row["energy_loss_j"]).collect();
    assert_eq!(losses.len(), 16);
}
