//! `report` draws the folder of every command again, of what stands in it alone: the same to the byte, or in another size and form.

#![cfg(feature = "cli")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use contact_dma::input::document::Document;
use contact_dma::input::scenario_file;
use contact_dma::report::profile_lines::Profile;
use contact_dma::report::scenario_folder;
use contact_dma::simulation::Simulation;
use std::sync::atomic::AtomicBool;

use crate::program::{Place, pmma_sweep};

const SWEEP: &str = r#"[sweep]
angular_frequency = ["0.004 rad/s", "0.01 rad/s", "0.03 rad/s"]
[cycle]
steps = 24
error_bars = false
[solver]
springs = 24
[figures]
formats = ["svg"]
"#;

/// With everything that a history can have: an unloaded moment, a jump, cycles, errors, profiles and fields.
fn history(solver: &str) -> String {
    format!(
        r#"title = "a history"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
segments = [
    {{ kind = "step", to = "0 N", duration = "2 s" }},
    {{ kind = "step", to = "10 N", duration = "10 s" }},
    {{ kind = "sine", mean = "10 N", amplitude = "4 N", frequency = "50 mHz", cycles = 2 }},
]
[time]
step = "1 s"
[output]
profiles_at = ["1 s", "5 s", "20 s"]
{solver}
[figures]
formats = ["svg"]
"#
    )
}

const SPRINGS: &str = "[solver]\nsprings = 24\n";
const CELLS: &str =
    "fields_at = [\"5 s\", \"30 s\"]\n[solver]\nengine = \"half-space\"\ncells = 16\n";

const CREEP: &str =
    "time_s,creep_compliance_per_pa\n0.1,1.0e-6\n1,1.1e-6\n10,1.4e-6\n100,1.8e-6\n1000,1.95e-6\n";
const DYNAMIC: &str = "temperature_c,frequency_hz,storage_modulus_pa,loss_modulus_pa\n20,0.1,1e6,1e5\n20,0.3,1.2e6,2e5\n\
                       20,1,1.5e6,3e5\n20,3,1.8e6,2e5\n20,10,2e6,1e5\n";

const IDENTIFY: &str = r#"title = "a polymer"
[identify]
data = "cycles.csv"
branches = 1
[material]
poisson_ratio = 0.35
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
control = "load"
mean = "10 N"
amplitude = "5 N"
[cycle]
steps = 24
[solver]
springs = 24
"#;

/// What every command reads, and a sweep in `swept`.
fn inputs() -> Place {
    let place = Place::with("small.toml", &pmma_sweep(SWEEP));
    place.put("springs.toml", history(SPRINGS));
    place.put("cells.toml", history(CELLS));
    place.put("creep.csv", CREEP);
    place.put("dma.csv", DYNAMIC);
    place.put("identify.toml", IDENTIFY);
    let rows: String = (0..400)
        .map(|i| {
            let t = 0.05 * f64::from(i);
            let (load, depth) = ((2.0 * t).sin(), (2.0 * t - 0.1).sin());
            format!("{t},{},{}\n", 10.0 + 5.0 * load, 2e-5 + 4e-6 * depth)
        })
        .collect();
    place.put("loop.csv", format!("time_s,load_n,approach_m\n{rows}"));
    place.done("sweep small.toml --out swept --no-figures");
    place.put("cycles.csv", place.text("swept/sweep.csv"));
    place
}

/// Every command that draws figures into a folder, and one of its pictures.
const COMMANDS: [(&str, &str); 9] = [
    ("sweep small.toml", "energy-loss"),
    ("simulate springs.toml", "profiles"),
    ("simulate cells.toml", "history"),
    ("analyse loop.csv", "loops"),
    ("identify identify.toml", "moduli"),
    ("material show pmma", "moduli"),
    (
        "material fit creep.csv --quantity creep --modulus longitudinal --poisson-ratio 0.4",
        "fit",
    ),
    (
        "material fit dma.csv --quantity dynamic --modulus shear --poisson-ratio 0.4",
        "fit",
    ),
    ("compare swept swept", "comparison"),
];

/// The files below a folder, but for those that say when they were made.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(folder).unwrap().to_str().unwrap();
            match path.is_dir() {
                true => folders.push(path),
                false if name == "run.json" => {}
                false => drop(found.insert(name.to_owned(), fs::read(&path).unwrap())),
            }
        }
    }
    found
}

fn is_picture(name: &str) -> bool {
    let endings = [".svg", ".png", ".pdf", ".caption.txt", ".html"];
    endings.iter().any(|ending| name.ends_with(ending))
}

#[test]
fn what_is_drawn_again_is_the_same_to_the_byte_and_another_size_is_another_picture() {
    let place = inputs();
    for (k, (command, picture)) in COMMANDS.iter().enumerate() {
        let out = format!("out-{k}");
        place.done(&format!("{command} --out {out}"));
        let before = files(&place.path(&out));
        let drawn: Vec<&String> = before.keys().filter(|name| is_picture(name)).collect();
        assert!(drawn.len() > 2, "{command}: {drawn:?}");
        for name in &drawn {
            fs::remove_file(place.path(&format!("{out}/{name}"))).unwrap();
        }
        place.put(&format!("{out}/mine.svg"), "mine");
        place.done(&format!("report {out}"));
        let mut after = files(&place.path(&out));
        assert_eq!(after.remove("mine.svg").unwrap(), b"mine", "{command}");
        let names = |of: &BTreeMap<String, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
        assert_eq!(names(&after), names(&before), "{command}");
        for (name, bytes) in &before {
            assert!(after[name] == *bytes, "{command}: {name}");
        }
        // Into another folder too, of one that stays as it is.
        place.done(&format!("report {out} --out other-{k} --quiet"));
        let other = files(&place.path(&format!("other-{k}")));
        assert!(
            drawn.iter().all(|name| other[*name] == before[*name]),
            "{command}"
        );
        // In another size and form, which is kept.
        let look = "--set figures.column=one --set 'figures.formats=[\"svg\", \"pdf\"]'";
        place.done(&format!("report {out} {look} --quiet"));
        place.done(&format!("report {out} --quiet"));
        let svg = place.text(&format!("{out}/{picture}.svg"));
        assert!(svg.contains("width=\"85mm\""), "{command}: {}", &svg[..200]);
        assert!(place.has(&format!("{out}/{picture}.pdf")), "{command}");
        assert!(!place.has(&format!("{out}/{picture}.png")), "{command}");
        // Tables stay without figures, and from tables alone there are figures again.
        place.done(&format!("report {out} --no-figures --quiet"));
        assert!(
            !files(&place.path(&out))
                .keys()
                .any(|name| is_picture(name) && name != "mine.svg")
        );
        place.done(&format!("report {out} --quiet"));
        assert_eq!(
            place.text(&format!("{out}/{picture}.svg")),
            svg,
            "{command}"
        );
        assert_eq!(place.text(&format!("{out}/mine.svg")), "mine", "{command}");
    }
}

#[test]
fn what_is_read_of_a_history_is_what_was_computed() {
    let place = inputs();
    for kind in ["springs", "cells"] {
        let text = place.text(&format!("{kind}.toml"));
        place.done(&format!("simulate {kind}.toml --no-figures --out {kind}"));
        let document = Document::parse("scenario.toml", &text).unwrap();
        let simulation = Simulation::new(scenario_file::plan(&document).unwrap()).unwrap();
        let mut computed = simulation.run(&AtomicBool::new(false), &|_, _| {});
        let mut read = scenario_folder::read(&place.path(kind), &simulation).unwrap();
        let records = std::mem::take(&mut computed.profiles);
        let profiles: Vec<Profile> = records.iter().map(Profile::of).collect();
        assert_eq!(profiles.len(), 3);
        // The index of surfaces has no peak pressure.
        for (read, computed) in read.profiles.iter_mut().zip(&profiles) {
            read.row.peak_pressure_pa = computed.row.peak_pressure_pa;
        }
        for (read, computed) in read.outcome.fields.iter_mut().zip(&computed.fields) {
            read.row.peak_pressure_pa = computed.row.peak_pressure_pa;
        }
        assert_eq!(read.profiles, profiles);
        assert_eq!(read.outcome, computed);
        assert_eq!(computed.cycles.len(), 2);
        assert_eq!(computed.fields.len(), if kind == "cells" { 2 } else { 0 });
    }
}

/// What happens to a file.
type Damage = fn(&str) -> String;

#[test]
fn a_damaged_table_is_named_with_its_line_and_nothing_is_written() {
    let place = inputs();
    place.done("simulate cells.toml --out out");
    let damaged: [(&str, Damage, &[&str]); 12] = [
        (
            "history.csv",
            |t| t.replacen("load_n", "load", 1),
            &["history.csv:1", "no column `load_n`"],
        ),
        (
            "history.csv",
            |t| {
                t.lines()
                    .enumerate()
                    .map(|(k, line)| {
                        if k == 4 {
                            "1,2\n".to_owned()
                        } else {
                            format!("{line}\n")
                        }
                    })
                    .collect()
            },
            &["history.csv:5", "2 cells"],
        ),
        (
            "history.csv",
            |t| {
                t.lines()
                    .enumerate()
                    .map(|(k, line)| {
                        if k == 4 {
                            line.replacen("1e1,", "NaN,", 1) + "\n"
                        } else {
                            format!("{line}\n")
                        }
                    })
                    .collect()
            },
            &[
                "history.csv:5",
                "`NaN` in the column `load_n` is no finite number",
            ],
        ),
        (
            "history.csv",
            |t| format!("{t}{}", t.split_once('\n').unwrap().1),
            &["history.csv:", "more than"],
        ),
        (
            "cycles.csv",
            |t| t.replacen("\n3,1,", "\n3,99999999999999999999,", 1),
            &["cycles.csv:2", "no whole number"],
        ),
        (
            "cycles.csv",
            |t| t.replacen("\n3,1,", "\n3,7,", 1),
            &["cycles.csv", "not those of history.csv"],
        ),
        (
            "profiles/1.csv",
            |t| t.replacen("x,", "x,abc", 1),
            &["profiles/1.csv:2", "no finite number"],
        ),
        (
            "profiles/index.csv",
            |t| t.replacen(",16,16,", ",1e300,16,", 1),
            &["profiles/index.csv", "cells"],
        ),
        (
            "fields/index.csv",
            |t| t.replacen(",16,16,", ",15,16,", 1),
            &[
                "fields/0-pressure_pa.npy",
                "no matrix of 16 rows and 15 columns",
            ],
        ),
        (
            "fields/1-displacement_m.npy",
            |_| "short".to_owned(),
            &["fields/1-displacement_m.npy", "no matrix"],
        ),
        (
            "summary.json",
            |t| t.replacen("\"iterations\": ", "\"iterations\": -", 1),
            &["summary.json", "line"],
        ),
        (
            "summary.json",
            |t| t.replacen("\"scenario_hash\": \"", "\"scenario_hash\": \"0", 1),
            &["summary.json", "another scenario"],
        ),
    ];
    for (name, damage, parts) in damaged {
        let file = format!("out/{name}");
        let whole = place.bytes(&file);
        let text = String::from_utf8_lossy(&whole).into_owned();
        let other = damage(&text);
        assert_ne!(other, text, "{name}: {parts:?}");
        place.put(&file, other);
        let before = files(&place.path("out"));
        let said = place.refused("report out");
        for part in parts {
            assert!(said.contains(part), "{part} is not in: {said}");
        }
        assert!(files(&place.path("out")) == before, "{name}");
        place.put(&file, whole);
    }
    for name in ["history.csv", "summary.json", "fields/0-pressure_pa.npy"] {
        let whole = place.bytes(&format!("out/{name}"));
        fs::remove_file(place.path(&format!("out/{name}"))).unwrap();
        let said = place.refused("report out");
        assert!(
            said.contains(name) && said.contains("contact-dma simulate"),
            "{said}"
        );
        place.put(&format!("out/{name}"), whole);
    }
    place.done("report out");
    // What would be another history is none of this folder.
    let said = place.refused("report out --set 'drive.control=approach'");
    assert!(!said.contains("panicked"), "{said}");
    let said = place.refused("report out --set 'time.step=2 s'");
    assert!(
        said.contains("another scenario") && said.contains("contact-dma simulate"),
        "{said}"
    );
}

#[test]
fn a_damaged_file_of_figures_is_refused_and_no_file_of_others_is_written_over() {
    let place = inputs();
    place.done("material show pmma --out out");
    let whole = place.text("out/figures.json");
    let damaged: [(Damage, &str); 8] = [
        (|t| t[..t.len() / 2].to_owned(), "line 1 column"),
        (|_| String::new(), "line 1 column"),
        (
            |t| t.replacen("\"name\":\"moduli\"", "\"name\":\"../moduli\"", 1),
            "name",
        ),
        (
            |t| t.replacen("\"width_px\":800", "\"width_px\":4000000000", 1),
            "larger than any",
        ),
        (
            |t| t.replacen("\"width_px\":800", "\"width_px\":-1", 1),
            "line 1 column",
        ),
        (
            |t| t.replacen("\"points\":[[", "\"points\":[[NaN,", 1),
            "line 1 column",
        ),
        (
            |t| t.replacen("\"points\":[[", "\"points\":[[1e999,1],[", 1),
            "line 1 column",
        ),
        (
            |t| t.replacen("\"asked\":\"\"", "\"asked\":\"[figures]\\nwidth = 3\"", 1),
            "width",
        ),
    ];
    for (damage, part) in damaged {
        let other = damage(&whole);
        assert_ne!(other, whole, "{part}");
        place.put("out/figures.json", &other);
        let said = place.refused("report out");
        assert!(
            said.contains("figures.json") && said.contains(part),
            "{said}"
        );
    }
    // What cannot be drawn is left out with the reason, and stays in the file.
    let hostile = whole.replacen(
        "\"points\":[[",
        "\"points\":[[1e308,-1e308],[-1e308,1e308],[",
        1,
    );
    place.put("out/figures.json", &hostile);
    let said = place.ends("report out", 0);
    assert!(said.contains("warning: no figure moduli"), "{said}");
    assert!(!place.has("out/moduli.svg") && place.has("out/relaxation.svg"));
    // A figure that has the name of somebody's file.
    place.put(
        "out/figures.json",
        whole.replacen("\"name\":\"moduli\"", "\"name\":\"mine\"", 1),
    );
    place.put("out/mine.svg", "mine");
    let said = place.refused("report out");
    assert!(said.contains("mine.svg"), "{said}");
    assert_eq!(place.text("out/mine.svg"), "mine");
    // Without the file it is said how figures are made.
    fs::remove_file(place.path("out/figures.json")).unwrap();
    let said = place.refused("report out");
    assert!(
        said.contains("figures.json") && said.contains("material show MATERIAL --out out"),
        "{said}"
    );
    let said = place.refused("report out --set figures.axes=normalised");
    assert!(said.contains("figures.json"), "{said}");
}

#[test]
fn an_unfinished_or_foreign_folder_is_told() {
    let place = inputs();
    place.put("theirs/notes.txt", "mine");
    let said = place.refused("report theirs");
    assert!(said.contains("resolved.toml"), "{said}");
    let said = place.refused("report nowhere");
    assert!(said.contains("nowhere"), "{said}");
    // A history that was killed before its first table.
    place.done("simulate springs.toml --no-figures --out begun");
    for name in ["history.csv", "cycles.csv", "summary.json"] {
        fs::remove_file(place.path(&format!("begun/{name}"))).unwrap();
    }
    let said = place.refused("report begun");
    assert!(
        said.contains("summary.json") && said.contains("contact-dma simulate"),
        "{said}"
    );
}
