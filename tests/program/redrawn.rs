//! `report` draws the folder of every command again, of what stands in it alone: the same to the byte, or in another size and form.

use crate::prelude::*;
use contact_dma::report::profile_lines::Profile;
use contact_dma::report::scenario_folder;

use crate::folders;
use crate::input_keys::assert_current;

/// Histories on springs and on cells with everything that one can have: an unloaded moment, a jump, cycles, errors, profiles and fields.
const HISTORIES: &str = "springs.toml cells.toml";

/// Every command that draws figures into a folder, and one of its pictures.
const COMMANDS: [(&str, &str); 9] = [
    ("sweep small.toml", "energy-loss"),
    ("simulate springs.toml", "profiles"),
    ("simulate cells.toml", "history"),
    ("analyse raw/0.csv", "loops"),
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
fn files(place: &Place, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let mut found = place.files(folder);
    found.remove("run.json");
    found
}

fn is_picture(name: &str) -> bool {
    let endings = [".svg", ".png", ".pdf", ".caption.txt", ".html"];
    endings.iter().any(|ending| name.ends_with(ending))
}

#[test]
fn a_folder_with_a_key_of_a_newer_program_is_refused_at_its_place_and_left_as_it_is() {
    let place = folders::inputs();
    place.done("sweep small.toml --out out");
    let newer = place
        .text("out/resolved.toml")
        .replace("[cycle]\n", "[cycle]\nfuture = 1\n");
    place.put("out/resolved.toml", newer);
    let before = place.files("out");
    says(
        &place.refused("report out"),
        &["unknown key `cycle.future`", "out/resolved.toml:"],
    );
    assert_eq!(place.files("out"), before);
}

#[test]
fn what_is_drawn_again_is_the_same_to_the_byte_and_another_size_is_another_picture() {
    let place = folders::inputs();
    place.lend(HISTORIES);
    for (k, (command, picture)) in COMMANDS.iter().enumerate() {
        let out = format!("out-{k}");
        place.done(&format!("{command} --out {out}"));
        let before = files(&place, &out);
        let drawn: Vec<&String> = before.keys().filter(|name| is_picture(name)).collect();
        assert!(drawn.len() > 2, "{command}: {drawn:?}");
        for name in &drawn {
            fs::remove_file(place.path(&format!("{out}/{name}"))).unwrap();
        }
        place.put(&format!("{out}/figures/mine.svg"), "mine");
        place.done(&format!("report {out}"));
        let mut after = files(&place, &out);
        assert_eq!(
            after.remove("figures/mine.svg").unwrap(),
            b"mine",
            "{command}"
        );
        assert!(after.keys().eq(before.keys()), "{command}");
        for (name, bytes) in &before {
            assert!(after[name] == *bytes, "{command}: {name}");
        }
        // Into another folder too, of one that stays as it is.
        place.done(&format!("report {out} --out other-{k} --quiet"));
        let other = files(&place, &format!("other-{k}"));
        let mut drawn = drawn.into_iter();
        assert!(drawn.all(|name| other[name] == before[name]), "{command}");
        // In another size and form, which is kept.
        let look = "--set figures.column=one --set 'figures.formats=[\"svg\", \"pdf\"]'";
        place.done(&format!("report {out} {look} --quiet"));
        place.done(&format!("report {out} --quiet"));
        let svg = place.text(&format!("{out}/figures/{picture}.svg"));
        assert!(svg.contains("width=\"85mm\""), "{command}: {}", &svg[..200]);
        assert!(
            place.has(&format!("{out}/figures/{picture}.pdf")),
            "{command}"
        );
        assert!(
            !place.has(&format!("{out}/figures/{picture}.png")),
            "{command}"
        );
        // Tables stay without figures, and from tables alone there are figures again.
        place.done(&format!("report {out} --no-figures --quiet"));
        let left = files(&place, &out).into_keys();
        let left: Vec<_> = left.filter(|name| is_picture(name)).collect();
        assert_eq!(left, ["figures/mine.svg"], "{command}");
        place.done(&format!("report {out} --quiet"));
        let again = place.text(&format!("{out}/figures/{picture}.svg"));
        assert_eq!(again, svg, "{command}");
        assert_eq!(
            place.text(&format!("{out}/figures/mine.svg")),
            "mine",
            "{command}"
        );
    }
}

#[test]
fn what_is_read_of_a_history_is_what_was_computed() {
    let place = Place::lent(HISTORIES);
    for (kind, fields) in [("springs", 0), ("cells", 2)] {
        place.done(&format!("simulate {kind}.toml --no-figures --out {kind}"));
        let simulation = plans::history(&place.text(&format!("{kind}.toml")));
        let mut computed = followed(&simulation);
        let mut read = scenario_folder::read(&place.path(kind), &simulation).unwrap();
        let records = std::mem::take(&mut computed.profiles);
        let profiles: Vec<Profile> = records.iter().map(Profile::of).collect();
        assert_eq!(profiles.len(), 3);
        // The index of surfaces has neither peak pressure nor work.
        for (read, computed) in read.profiles.iter_mut().zip(&profiles) {
            read.row.peak_pressure_pa = computed.row.peak_pressure_pa;
            read.row.work_j = computed.row.work_j;
        }
        for (read, computed) in read.outcome.fields.iter_mut().zip(&computed.fields) {
            read.row.peak_pressure_pa = computed.row.peak_pressure_pa;
            read.row.work_j = computed.row.work_j;
        }
        assert_eq!(read.profiles, profiles);
        assert_eq!(read.outcome, computed);
        assert_eq!(computed.cycles.len(), 2);
        assert_eq!(computed.fields.len(), fields);
    }
}

/// `report out` refuses a folder and says all of this.
#[track_caller]
fn refused(place: &Place, more: &str, parts: &[&str]) {
    says(&place.refused(&format!("report out {more}")), parts);
}

/// Damages, one a line: a file, words of it and what stands in their place, or a file that is taken away; in damaged-history.stderr what
/// is said of each.
const DAMAGES: &str = "tests/refused/damaged-history";

#[test]
fn a_damaged_table_is_named_with_its_line_and_nothing_is_written() {
    let place = Place::lent(HISTORIES);
    place.done("simulate cells.toml --out out");
    let mut told = String::new();
    for line in fs::read_to_string(format!("{DAMAGES}.txt"))
        .unwrap()
        .lines()
    {
        let mut parts = line.split(" | ").map(|part| part.replace('⏎', "\n"));
        let file = format!("out/{}", parts.next().unwrap());
        let whole = place.bytes(&file);
        match parts.next().zip(parts.next()) {
            Some((words, others)) => {
                let text = String::from_utf8_lossy(&whole);
                assert!(text.contains(&words), "{line}");
                place.put(&file, text.replacen(&words, &others, 1));
            }
            None => fs::remove_file(place.path(&file)).unwrap(),
        }
        let before = files(&place, "out");
        // The row itself, with its digits, stands below some messages.
        let said = place.ends("report out", 2);
        let said: Vec<&str> = said.lines().filter(|line| !line.contains('|')).collect();
        told += &format!("{line}\n{}\n\n", said.join("\n"));
        assert!(files(&place, "out") == before, "{line}");
        place.put(&file, whole);
    }
    assert_current(format!("{DAMAGES}.stderr"), &told);
    // A row for every instant, and then as many again.
    let history = place.text("out/history.csv");
    let rows = history.split_once('\n').unwrap().1;
    place.put("out/history.csv", format!("{history}{rows}"));
    refused(&place, "", &["history.csv:", "more than"]);
    place.put("out/history.csv", history);
    place.done("report out");
    // What would be another history is none of this folder.
    refused(&place, "--set 'drive.control=approach'", &["error: "]);
    let parts = ["another scenario", "contact-dma simulate"];
    refused(&place, "--set 'time.step=2 s'", &parts);
}

#[test]
fn a_damaged_file_of_figures_is_refused_and_no_file_of_others_is_written_over() {
    let place = Place::new();
    place.done("material show pmma --out out");
    let whole = place.text("out/records/figures.json");
    let no_json = "line 1 column";
    for (words, others, part) in [
        (&whole[whole.len() / 2..], "", no_json),
        (&whole, "", no_json),
        ("\"name\":\"moduli\"", "\"name\":\"../moduli\"", "name"),
        (
            "\"width_px\":800",
            "\"width_px\":4000000000",
            "larger than any",
        ),
        ("\"width_px\":800", "\"width_px\":-1", no_json),
        ("\"points\":[[", "\"points\":[[NaN,", no_json),
        ("\"points\":[[", "\"points\":[[1e999,1],[", no_json),
        (
            "\"asked\":\"\"",
            "\"asked\":\"[figures]\\nwidth = 3\"",
            "width",
        ),
    ] {
        let damaged = whole.replacen(words, others, 1);
        assert_ne!(damaged, whole, "{part}");
        place.put("out/records/figures.json", &damaged);
        refused(&place, "", &["figures.json", part]);
    }
    // What cannot be drawn is left out with the reason, and stays in the file.
    let points = "\"points\":[[";
    let hostile = format!("{points}1e308,-1e308],[-1e308,1e308],[");
    place.put(
        "out/records/figures.json",
        whole.replacen(points, &hostile, 1),
    );
    let said = place.ends("report out", 0);
    says(&said, &["warning: no figure moduli"]);
    assert!(!place.has("out/figures/moduli.svg") && place.has("out/figures/relaxation.svg"));
    // A figure that has the name of somebody's file.
    let mine = whole.replacen("\"name\":\"moduli\"", "\"name\":\"mine\"", 1);
    place.put("out/records/figures.json", mine);
    place.put("out/figures/mine.svg", "mine");
    refused(&place, "", &["mine.svg"]);
    assert_eq!(place.text("out/figures/mine.svg"), "mine");
    // Without the file it is said how figures are made.
    fs::remove_file(place.path("out/records/figures.json")).unwrap();
    let made = "material show MATERIAL --out out";
    refused(&place, "", &["figures.json", made]);
    refused(&place, "--set figures.axes=normalised", &["figures.json"]);
}

#[test]
fn an_unfinished_or_foreign_folder_is_told() {
    let place = Place::lent(HISTORIES);
    place.put("theirs/notes.txt", "mine");
    says(&place.refused("report theirs"), &["resolved.toml"]);
    // A history that was killed before its first table.
    place.done("simulate springs.toml --no-figures --out out");
    for name in ["history.csv", "cycles.csv", "summary.json"] {
        fs::remove_file(place.path(&format!("out/{name}"))).unwrap();
    }
    refused(&place, "", &["summary.json", "contact-dma simulate"]);
}
