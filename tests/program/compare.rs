//! Two results compared: the peak that moved is found, what was not compared is said, and nothing compared is no agreement.

use crate::prelude::*;

/// Sweeps PMMA, with its slower relaxation time as given (s), around its largest peak.
fn swept(place: &Place, name: &str, time_s: f64, more: &str) {
    let text = include_str!("../inputs/peak.toml").replace("117.96", &time_s.to_string());
    place.put(&format!("{name}.toml"), text);
    place.done(&format!(
        "sweep {name}.toml --quiet --no-figures --out {name} {more}"
    ));
}

/// Exit code and what was printed.
fn compared(place: &Place, arguments: &str) -> (i32, String) {
    let run = place.run(&format!("compare {arguments}"));
    let is_told = |part: &str, of: &str| !arguments.contains(part) || run.stderr.contains(of);
    assert!(is_told("nothing=1", "no column nothing") && is_told("/no/such", "/no/such"));
    (run.code, run.stdout)
}

#[test]
fn a_peak_that_moved_is_found_whatever_is_allowed_of_the_columns() {
    let place = Place::new();
    // The slower time alone makes the largest peak: it moves by nearly as much.
    for (name, time_s) in [("a", 117.96), ("moved", 118.5), ("hardly", 117.961)] {
        swept(&place, name, time_s, "");
    }
    let with = |new: &str, more: &str| compared(&place, &format!("a {new} {more}"));
    assert_eq!(with("moved", "--relative 1").0, 0);
    for column in ["angular_frequency_rad_per_s", "frequency_hz"] {
        let tolerance = format!("--relative 1 --tolerance {column}=1e-3");
        let (code, text) = with("moved", &tolerance);
        assert_eq!(code, 4, "{text}");
        says(&text, &["moved by -0.", ": differs"]);
        assert_eq!(with("hardly", &tolerance).0, 0);
    }
    // The columns of the two differ by 1e-5; the peaks alone decide.
    assert_eq!(with("hardly", "").0, 4);
    for (new, peaks, code) in [
        ("hardly", "--peaks 1e-3", 0),
        ("moved", "--peaks 1e-3", 4),
        ("moved", "--peaks 1e-2", 0),
        ("hardly", "--peaks", 0),
        // A column with a tolerance of its own is judged too.
        ("hardly", "--peaks 1e-3 --tolerance energy_loss_j=1e-9", 4),
        ("a", "--relative -1", 2),
        ("a", "--tolerance nothing=1", 2),
        ("/no/such", "", 2),
    ] {
        let (found, text) = with(new, peaks);
        assert_eq!(found, code, "{new} {peaks}: {text}");
    }
}

/// Over one axis the summary has the number itself, where over several it has a list.
#[test]
fn a_peak_that_moved_is_found_over_one_further_axis_and_over_two() {
    let amplitude = "--set 'sweep.drive.amplitude=[2, 5]'";
    let both = format!("{amplitude} --set 'sweep.drive.mean=[10, 11]'");
    for (axes, combinations) in [(amplitude, 2), (&both, 4)] {
        let place = Place::new();
        swept(&place, "one", 117.96, axes);
        swept(&place, "other", 110.0, axes);
        let (code, text) = compared(&place, "one one");
        assert_eq!(code, 0, "{text}");
        let (code, text) = compared(&place, "one other --peaks");
        assert_eq!(code, 4, "{text}");
        // One peak for each combination, every one of which moved.
        let moved = text.lines().filter(|line| line.contains("moved by +8."));
        assert_eq!(moved.count(), combinations, "{text}");
    }
}

#[test]
fn what_was_not_compared_is_said_and_nothing_compared_is_no_agreement() {
    let place = Place::new();
    swept(&place, "a", 117.96, "");
    // Tables without a row, and without a row in common.
    let table = place.text("a/sweep.csv");
    let rows: Vec<&str> = table.lines().collect();
    place.put("head.csv", rows[0]);
    place.put("one.csv", rows[..2].join("\n"));
    place.put("other.csv", [rows[0], rows[3]].join("\n"));
    place.put("missing.csv", [rows[0], rows[1], rows[3]].join("\n"));
    let itself = "3 cases in both results";
    let nothing = "nothing was compared, no case is in both.";
    let alone = "peaks: not compared, a/sweep.csv was given without its summary.json";
    for (arguments, code, part) in [
        ("a/sweep.csv a/sweep.csv", 0, alone),
        (
            "a/sweep.csv a/sweep.csv --peaks 1e-3",
            4,
            "No peak was compared",
        ),
        ("head.csv head.csv", 4, nothing),
        ("one.csv other.csv", 4, nothing),
        ("a missing.csv", 4, "1 cases missing in the new result"),
        ("a missing.csv", 4, "ω = 8.000e-3 rad/s"),
        ("a a", 0, "peak at"),
        ("a a --out drawn", 0, itself),
    ] {
        let (found, text) = compared(&place, arguments);
        assert_eq!(found, code, "{arguments}: {text}");
        says(&text, &[part]);
        assert!(arguments != "a a" || !text.contains("not compared"));
    }
    place.has_all(
        "drawn",
        "figures/comparison.svg figures/comparison.png comparison.csv",
    );
}

#[test]
fn columns_that_other_steps_leave_unjudged_are_counted() {
    let place = Place::new();
    swept(&place, "a", 117.96, "");
    let Table { columns, rows } = place.table("a/sweep.csv");
    let changed = |(name, cell): (&String, String)| match name.as_str() {
        "steps" => "60".to_owned(),
        "branch_1_loss_j" => format!("{:e}", 1.01 * cell.parse::<f64>().unwrap()),
        _ => format!("\"{}\"", cell.replace('"', "\"\"")),
    };
    let mut text = columns.join(",");
    for row in rows {
        let cells = columns.iter().zip(row).map(changed);
        text += &format!("\n{}", cells.collect::<Vec<_>>().join(","));
    }
    place.put("b.csv", text);
    let (code, text) = compared(&place, "a/sweep.csv b.csv");
    assert_eq!(code, 0, "{text}");
    let unjudged = "3 not judged: other steps or nodes, no error bars";
    says(&text, &[unjudged]);
    fs::remove_file(place.path("a/sweep.csv")).unwrap();
    let refused = place.refused("compare a b.csv");
    says(
        &refused,
        &["its sweep.csv is missing", "`contact-dma report a`"],
    );
    place.done("report a");
    assert_eq!(compared(&place, "a a").0, 0);
}
