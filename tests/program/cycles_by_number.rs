//! The n-th cycle of a sweep, and the cycles of a history, as files, tables, pages and messages show them.

use crate::prelude::*;

const THREE: &str =
    "[sweep]\nangular_frequency = [\"0.004 rad/s\", \"0.02 rad/s\", \"0.1 rad/s\"]\n";
const SECOND: &str =
    "[cycle]\nmethod = \"march\"\nat_cycle = 2\nsteps = 64\n[solver]\nsprings = 60\n";

#[test]
fn the_second_cycle_of_every_frequency_is_a_result_and_says_what_it_is() {
    let text = pmma_sweep(&format!("{THREE}{SECOND}"));
    let text = text.replace("amplitude = ", "hold = \"50 s\"\namplitude = ");
    let place = Place::with("second.toml", &text);
    let run = place.done(&format!("sweep second.toml --out out {SVG}"));
    run.says(&["transient"]);
    let table = place.table("out/sweep.csv");
    assert_eq!(table.cells("status"), ["transient"; 3]);
    let summary = place.json("out/summary.json");
    assert_eq!(summary["cases"]["transient"], 3);
    assert_eq!(summary["cases"]["converged"], 0);
    for (file, part) in [
        ("figures/loops.caption.txt", "Cycle 2 from the beginning"),
        // The resolved file gives the same plan again.
        ("resolved.toml", "at_cycle = 2"),
        ("index.html", "number 2 after the hold"),
    ] {
        assert!(place.text(&format!("out/{file}")).contains(part), "{file}");
    }
}

#[test]
fn a_history_has_a_table_of_its_cycles() {
    let segments = r#"
        { kind = "step", to = "10 N", duration = "20 s" },
        { kind = "sine", mean = "10 N", amplitude = "5 N", angular_frequency = "0.5 rad/s", cycles = 3 },
        { kind = "sine", mean = "10 N", amplitude = "2 N", angular_frequency = "2 rad/s", cycles = 2.5 },
        { kind = "sine", mean = "2 N", amplitude = "2 N", angular_frequency = "2 rad/s", cycles = 1 },"#;
    let text = format!(
        "title = \"cycles\"\n[material]\nlibrary = \"pmma\"\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n[drive]\ncontrol = \"load\"\n\
         segments = [{segments}\n]\n[solver]\nsprings = 60\n"
    );
    let place = Place::new();
    let simulate = |text: &str, more: &str| {
        place.put("history.toml", text);
        let run = format!("simulate history.toml --out out {SVG} {more}");
        place.done(&run)
    };
    simulate(&text, "").says(&["Loss in segment 2", " cycle 3: "]);
    let table = place.table("out/cycles.csv");
    let numbers = |column: usize| table.rows.iter().map(move |row| &*row[column]);
    assert!(numbers(0).eq(["2", "2", "2", "3", "3", "4"]));
    assert!(numbers(1).eq(["1", "2", "3", "1", "2", "1"]));
    let errors = table.numbers("energy_loss_error_j");
    for (loss, error) in table.numbers("energy_loss_j").iter().zip(errors) {
        assert!(*loss > 0.0 && error > 0.0);
        below!(error, 0.05 * loss);
    }
    assert!(place.has("out/figures/cycle-losses.svg"));
    assert!(place.text("out/index.html").contains("Cycle by cycle"));
    let json = simulate(&text, "--format json").json();
    assert_eq!(json["cycles"].as_array().unwrap().len(), 6);
    // A history without a sine takes them away again.
    simulate(&without_sines(&text), "--force");
    assert!(!place.has("out/cycles.csv") && !place.has("out/figures/cycle-losses.svg"));
}

/// The same history with its sines as steps.
fn without_sines(text: &str) -> String {
    let text = text.replace("kind = \"sine\", mean", "kind = \"step\", to");
    let line = |line: &str| match line.split_once(", amplitude") {
        Some((head, _)) => format!("{head}, duration = \"5 s\" }},"),
        None => line.to_owned(),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}
