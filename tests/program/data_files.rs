//! Data files that cannot be used, or only with reservations, through the program: drive tables, height maps, profiles and tables
//! of measured compliance. Each message names file and place and says what to do.

#![cfg(feature = "cli")]

use std::fs;

use crate::program::{program, write};
use std::path::Path;

use contact_dma::input::diagnostic::Styling;
use contact_dma::input::dynamic::{self, DynamicFile};
use contact_dma::material::{ModulusKind, library};
use tempfile::TempDir;

/// Runs `simulate` on a scenario that names `data.csv` and expects it to be refused, with these words on standard error.
fn refused(scenario: &str, data: &[u8], expected: &[&str]) {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("data.csv"), data).unwrap();
    write(&folder, "scenario.toml", scenario);
    let assert = program()
        .current_dir(folder.path())
        .args(["simulate", "scenario.toml"])
        .assert()
        .code(2)
        .stdout("");
    let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    let words = stderr.split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["scenario.toml:", "data.csv"].iter().chain(expected) {
        assert!(words.contains(part), "{part:?} is missing in:\n{stderr}");
    }
    assert!(!folder.path().join("reports").exists());
}

const MATERIAL: &str = "title = \"data\"\n[material]\nlibrary = \"pmma\"\n";
const SPHERE: &str = "[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n";
const STEP: &str = "[drive]\nsegments = [{ kind = \"step\", to = 1, duration = 1 }]\n";

#[test]
fn a_drive_table_that_cannot_be_followed_is_refused_with_its_line() {
    let drive = "[drive]\nsegments = [{ kind = \"table\", file = \"data.csv\" }]\n";
    let scenario = format!("{MATERIAL}{SPHERE}{drive}");
    let cases: [(&str, &[&str]); 11] = [
        ("", &["the table is empty", "`time_s,load_n`"]),
        ("time_s,load_n\n", &["at least"]),
        ("time_s,load_n\n0,1\n", &["at least"]),
        (
            "time_s,force\n0,1\n1,2\n",
            &[
                "data.csv:1:1",
                "no column `load_n`",
                "2 columns, separated by commas",
            ],
        ),
        (
            "t,load_n\n0,1\n1,2\n",
            &["data.csv:1:1", "no column `time_s`"],
        ),
        (
            "time_s,load_n\n0,1\n2,2\n1,3\n",
            &["data.csv:4:1", "1 s lies before 2 s", "must ascend"],
        ),
        (
            "time_s,load_n\n0,1\n1,NaN\n",
            &[
                "data.csv:3:3",
                "a cell of the column `load_n` must be a number",
                "not a finite number",
            ],
        ),
        (
            "time_s,load_n\n0,1\nNaN,2\n",
            &["data.csv:3:1", "the column `time_s`", "not a finite number"],
        ),
        (
            "time_s,load_n\n0,1\n1,\n",
            &["data.csv:3:3", "`load_n`", "empty", "leave out"],
        ),
        (
            "time_s,load_n\n0,1\n1,2,3\n",
            &["data.csv:3:1", "a row of 3 cells in a table of 2"],
        ),
        (
            "time_s,load_n\n0,\"1 N\"\n1,2\n",
            &["data.csv:2:4", "not a number"],
        ),
    ];
    for (data, expected) in cases {
        refused(&scenario, data.as_bytes(), expected);
    }
    refused(
        &scenario,
        b"time_s,load_n\n0,\xff\n",
        &["data.csv:2:3", "not UTF-8"],
    );
    // Under approach control the other column is asked for.
    let approach = scenario.replace("[drive]\n", "[drive]\ncontrol = \"approach\"\n");
    refused(
        &approach,
        b"time_s,load_n\n0,1\n1,2\n",
        &["no column `approach_m`"],
    );
    // A load below zero is a pull, at whichever line.
    refused_pull(&scenario);
}

fn refused_pull(scenario: &str) {
    let folder = TempDir::new().unwrap();
    write(&folder, "data.csv", "time_s,load_n\n0,1\n1,-2\n");
    write(&folder, "scenario.toml", scenario);
    let assert = program()
        .current_dir(folder.path())
        .args(["simulate", "scenario.toml"])
        .assert()
        .code(2);
    let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
    assert!(stderr.contains("pull") && stderr.contains("-2"), "{stderr}");
}

#[test]
fn a_height_map_with_holes_or_mistakes_is_refused_with_line_and_column() {
    let map = "[indenter]\nshape = \"height-map\"\nfile = \"data.csv\"\n";
    let matrix = format!("{MATERIAL}{map}spacing = \"1 um\"\n{STEP}");
    let points = format!("{MATERIAL}{map}{STEP}");
    let cases: [(&str, &[&str]); 6] = [
        ("", &["holds no numbers", "one line of numbers per row"]),
        (
            "1,2,3\n4,,6\n7,8,9\n",
            &[
                "data.csv:2:3",
                "a cell of column 2 must be a number",
                "empty",
                "fill holes",
            ],
        ),
        (
            "1,2,3\n4,5,NaN\n7,8,9\n",
            &["data.csv:2:5", "not a finite number", "fill holes"],
        ),
        (
            "1,2,3\n4,5,six\n7,8,9\n",
            &["data.csv:2:5", "column 3", "not a number"],
        ),
        (
            "1,2,3\n4,5\n7,8,9\n",
            &["data.csv:2:1", "a row of 2 cells in a table of 3 columns"],
        ),
        ("1,2,3\n4,5,6\n", &["3 x 2 points"]),
    ];
    for (data, expected) in cases {
        refused(&matrix, data.as_bytes(), expected);
    }
    let grid = |skipped: usize, moved: f64| {
        let row = |k: usize| {
            let x = k as f64 % 3.0 + if k == 4 { moved } else { 0.0 };
            format!("{x},{},0\n", k / 3)
        };
        let rows: String = (0..9).filter(|k| *k != skipped).map(row).collect();
        format!("x_m,y_m,z_m\n{rows}")
    };
    refused(
        &points,
        grid(4, 0.0).as_bytes(),
        &["a hole: no point at x = 1e0 m, y = 1e0 m"],
    );
    refused(
        &points,
        grid(9, 0.1).as_bytes(),
        &["interpolate the points onto a regular grid"],
    );
    let twice = format!("{}0,0,0\n", grid(9, 0.0));
    refused(
        &points,
        twice.as_bytes(),
        &[
            "data.csv:11:1",
            "the same point is given twice",
            "2 | 0,0,0",
        ],
    );
    refused(
        &points,
        grid(9, 0.0).replace("z_m", "h_m").as_bytes(),
        &["data.csv:1:1", "no column `z_m`", "x_m,y_m,h_m"],
    );
    refused(
        &matrix,
        b"\x93NUMPY\x01\x00\x02\x00{}",
        &[".npy", "numpy.save"],
    );
}

#[test]
fn a_profile_that_is_none_is_refused() {
    let profile = "[indenter]\nshape = \"profile\"\nfile = \"data.csv\"\n";
    let scenario = format!("{MATERIAL}{profile}{STEP}");
    let cases: [(&str, &[&str]); 5] = [
        ("", &["the table is empty"]),
        ("r_m,z_m\n0,0\n1,1\n", &["no column `gap_m`"]),
        (
            "r_m,gap_m\n0,0\n2,1\n1,2\n",
            &[
                "data.csv:4:1",
                "does not exceed the one before",
                "sort the points",
            ],
        ),
        (
            "r_m,gap_m\n1,0\n2,1\n",
            &["data.csv:2:1", "not on the axis", "r = 0"],
        ),
        ("r_m,gap_m\n0,0\n1,nan\n", &["data.csv:3:3", "fill holes"]),
    ];
    for (data, expected) in cases {
        refused(&scenario, data.as_bytes(), expected);
    }
}

#[test]
fn a_material_table_is_refused_the_same_way_whether_it_is_fitted_or_taken_directly() {
    let cases: [(&str, &[&str]); 7] = [
        (
            "",
            &["the table is empty", "begin it with a line of column names"],
        ),
        (
            "time_s,creep_compliance_per_pa\n",
            &["the table has no samples; it takes at least 4"],
        ),
        (
            "time_s,J\n1,1e-9\n",
            &[
                "data.csv:1:8",
                "the column of values has no unit",
                "write `J [1/Pa]`",
            ],
        ),
        (
            "time_s,creep_compliance_per_pa\n1,1e-9\n3,2e-9\n2,3e-9\n4,4e-9\n",
            &["data.csv:4:1", "must increase", "sort the rows"],
        ),
        (
            "time_s,creep_compliance_per_pa\n1,1e-9\n2,inf\n3,3e-9\n4,4e-9\n",
            &["data.csv:3:3", "not a finite number"],
        ),
        (
            "time_s,creep_compliance_per_pa\n1,1e-9\n2,?\n3,3e-9\n4,4e-9\n",
            &["data.csv:3:3", "not a number", "leave the cell empty"],
        ),
        (
            "time_s,creep_compliance_per_pa\n1,4e-9\n2,3e-9\n3,2e-9\n4,1e-9\n",
            &[
                "falls",
                "if the values are of the other quantity, say \"relaxation\"",
            ],
        ),
    ];
    for evaluation in ["fit", "direct"] {
        let block = format!(
            "title = \"data\"\n[material]\npoisson_ratio = 0.4\n[material.table]\nfile = \"data.csv\"\nquantity = \
             \"creep\"\nmodulus = \"shear\"\nevaluation = \"{evaluation}\"\n"
        );
        let scenario = format!("{block}{SPHERE}{STEP}");
        for (data, expected) in cases {
            let folder = TempDir::new().unwrap();
            write(&folder, "data.csv", data);
            write(&folder, "scenario.toml", &scenario);
            let assert = program()
                .current_dir(folder.path())
                .args(["simulate", "scenario.toml"])
                .assert()
                .code(2);
            let stderr = String::from_utf8(assert.get_output().stderr.clone()).unwrap();
            let words = stderr.split_whitespace().collect::<Vec<_>>().join(" ");
            for part in expected {
                assert!(words.contains(part), "{part:?} is missing in:\n{stderr}");
            }
        }
    }
}

/// `material fit` of a creep compliance; exit code, and what was printed, on one line.
fn fit(rows: &[(f64, f64)]) -> (Option<i32>, String) {
    let folder = TempDir::new().unwrap();
    let rows: String = rows.iter().map(|(t, v)| format!("{t},{v}\n")).collect();
    write(
        &folder,
        "data.csv",
        &format!("time_s,creep_compliance_per_pa\n{rows}"),
    );
    let output = program()
        .current_dir(folder.path())
        .args(["material", "fit", "data.csv", "--quantity", "creep"])
        .args(["--modulus", "longitudinal", "--poisson-ratio", "0.38"])
        .output()
        .unwrap();
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8(text).unwrap();
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    (output.status.code(), words)
}

#[test]
fn a_fit_to_noisy_gappy_or_short_data_says_what_it_did_and_impossible_data_are_refused() {
    let creep = library::find("pmma").unwrap().material().unwrap();
    let value = |time_s: f64| creep.creep().compliance(time_s);
    let times: Vec<f64> = (0..=40)
        .map(|i| 0.1 * 10_f64.powf(f64::from(i) / 10.0))
        .collect();
    let rows = |change: &dyn Fn(usize, f64) -> f64| -> Vec<(f64, f64)> {
        let rows = times.iter().enumerate();
        rows.map(|(i, &t)| (t, value(t) * change(i, t))).collect()
    };
    let clean = rows(&|_, _| 1.0);
    let (code, text) = fit(&clean);
    assert_eq!(code, Some(0), "{text}");
    assert!(!text.contains("Warning"), "{text}");

    // Every other sample 0.6 % too high or too low: the data fall here and there.
    let (code, text) = fit(&rows(&|i, _| if i % 2 == 0 { 1.006 } else { 0.994 }));
    assert_eq!(code, Some(0), "{text}");
    for part in [
        "wrong side of an earlier one",
        "taken for noise",
        "Misfit relative to the data: 0.6",
    ] {
        assert!(text.contains(part), "{part:?} is missing in:\n{text}");
    }
    // One dropped by a hand's breadth: no noise.
    let (code, text) = fit(&rows(&|i, _| if i >= 30 { 0.6 } else { 1.0 }));
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("falls by") && text.contains("row 31"),
        "{text}"
    );

    let gappy: Vec<_> = clean
        .iter()
        .copied()
        .filter(|(t, _)| *t < 1.0 || *t > 50.0)
        .collect();
    let (code, text) = fit(&gappy);
    assert_eq!(code, Some(0), "{text}");
    for part in ["Warning: no sample between", "decades", "are guessed"] {
        assert!(text.contains(part), "{part:?} is missing in:\n{text}");
    }

    let short: Vec<_> = (0..=10)
        .map(|i| 5.0 + f64::from(i))
        .map(|t| (t, value(t)))
        .collect();
    let (code, text) = fit(&short);
    assert_eq!(code, Some(0), "{text}");
    for part in [
        "Warning: the data cover 0.48 decades of time only",
        "the data begin at 5 s",
    ] {
        assert!(text.contains(part), "{part:?} is missing in:\n{text}");
    }
    let (code, text) = fit(&clean[..3]);
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("too few samples, 3"), "{text}");

    // Falling all the way, negative, twice the same time: no passive material, no table.
    let falling: Vec<_> = times.iter().map(|&t| (t, 1.0 / value(t) * 1e-19)).collect();
    let (code, text) = fit(&falling);
    assert_eq!(code, Some(2), "{text}");
    assert!(
        text.contains("no passive material") || text.contains("falls"),
        "{text}"
    );
    let (code, text) = fit(&rows(&|i, _| if i == 5 { -1.0 } else { 1.0 }));
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("greater than zero"), "{text}");
}

/// Dynamic data of a text, as a file named `data.csv`; a refusal on one line.
fn dynamic(data: &str, kind: ModulusKind) -> Result<DynamicFile, String> {
    let folder = TempDir::new().unwrap();
    write(&folder, "data.csv", data);
    dynamic::read(&[folder.path().join("data.csv")], None, kind).map_err(|refused| {
        let text = refused.render(Styling::Plain);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    })
}

#[test]
fn the_measured_isotherms_of_pyvisco_are_read_from_their_file() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/pyvisco-freq-user-raw.csv");
    let file = dynamic::read(&[path], None, ModulusKind::Longitudinal).unwrap();
    assert_eq!(file.format.name(), "pyvisco");
    let isotherms = file.data.isotherms();
    assert_eq!(isotherms.len(), 21);
    assert!(isotherms.iter().all(|isotherm| isotherm.points.len() == 10));
    let temperatures: Vec<f64> = isotherms
        .iter()
        .filter_map(|isotherm| isotherm.temperature_k)
        .collect();
    assert!(
        (temperatures[0] - 223.24).abs() < 0.01 && (temperatures[20] - 373.1).abs() < 0.2,
        "{temperatures:?}"
    );
    assert!(
        file.notes
            .iter()
            .any(|note| note.contains("210 points in 21 isotherms")),
        "{:?}",
        file.notes
    );
}

#[test]
fn dynamic_data_that_leave_a_question_open_are_refused_with_it() {
    for (data, expected) in [
        (
            "f,E' [MPa],E'' [MPa]\n1,2,3\n",
            "write `f [Hz]` or `f [rad/s]`",
        ),
        ("f [Hz],G' [MPa],G'' [MPa]\n1,2,3\n", "--modulus shear"),
        ("f [Hz],E' [MPa],E'' [MPa]\n1,2,3\n2,-1,3\n", "data.csv:3:3"),
        ("{\"Results\": 1}\n", "JSON and XML are not read"),
        ("\0\0\u{1}\0binary", "is binary"),
    ] {
        let refused = dynamic(data, ModulusKind::Longitudinal).unwrap_err();
        assert!(
            refused.contains("data.csv") && refused.contains(expected),
            "{data}\n{refused}"
        );
    }
    let binary = dynamic::from_bytes("run.tri", b"TRIOS", None, ModulusKind::Shear)
        .unwrap_err()
        .to_string();
    assert!(binary.contains("in TRIOS: File, Export"), "{binary}");
}
