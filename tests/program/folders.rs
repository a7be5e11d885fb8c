//! Files of a user survive, whatever the folder: the program replaces and removes what it has written itself, and nothing else.

use crate::analyse;
use crate::prelude::*;

/// A folder with the inputs of every command, and a finished sweep in `swept`.
pub fn inputs() -> Place {
    let place = Place::lent("small.toml step.toml creep.csv dma.csv identify.toml");
    for (k, one) in analyse::loops().iter().enumerate() {
        place.put(&format!("raw/{k}.csv"), one.text());
    }
    place.done("sweep small.toml --out swept --no-figures");
    place.put("cycles.csv", place.text("swept/sweep.csv"));
    place
}

/// The files that `run.json` says the program has written.
fn listed(place: &Place, folder: &str) -> Vec<String> {
    let run = place.json(&format!("{folder}/run.json"));
    let files = run["files"].as_array().unwrap().iter();
    let names = files.map(|name| name.as_str().unwrap().to_owned());
    names.collect()
}

/// Holds a folder to what its list says.
#[track_caller]
fn is_as_listed(place: &Place, folder: &str) {
    let names: Vec<String> = place.files(folder).into_keys().collect();
    assert_eq!(names, listed(place, folder), "{folder}");
}

/// A command ends with 2, says all of this and leaves a folder as it was.
#[track_caller]
fn refused(place: &Place, line: &str, folder: &str, parts: &[&str]) {
    let before = place.files(folder);
    says(&place.ends(line, 2), parts);
    assert!(place.files(folder) == before, "{line}");
}

const FIT: &str = "--quantity creep --modulus longitudinal --poisson-ratio 0.4";

/// Every command that writes a folder, without the folder.
const COMMANDS: [&str; 9] = [
    "sweep small.toml",
    "simulate step.toml",
    "merge swept",
    "report swept",
    "analyse raw/0.csv raw/1.csv",
    "identify identify.toml",
    "material show pmma",
    "material fit creep.csv --quantity creep --modulus longitudinal --poisson-ratio 0.4",
    "compare swept swept",
];

fn into(command: &str, out: &str, more: &str) -> String {
    format!("{command} --out {out} {more}")
}

/// Files of a user, in every folder that the program uses, under names that it uses and under others.
const FOREIGN: &str = "notes.txt records/checkpoints/deep/model.pt records/mine.sqlite cases/loops/raw.csv cases/work/notes.txt \
                       cases/peaks/everest.txt profiles/me.jpg fields/corn.csv loops/0.csv loops.csv data/table.csv figures/mine.svg";

#[test]
fn a_folder_of_somebody_else_is_refused_and_with_force_added_to_and_left_as_it_was() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        let out = format!("theirs-{k}");
        for name in FOREIGN.split_whitespace() {
            place.put(&format!("{out}/{name}"), name);
        }
        let before = place.files(&out);
        let parts = ["has not written", "--force"];
        refused(&place, &into(command, &out, ""), &out, &parts);
        // Twice: the second finds its own list beside them.
        place.done(&into(command, &out, "--force"));
        place.done(&into(command, &out, ""));
        let after = place.files(&out);
        for (name, bytes) in &before {
            assert_eq!(after.get(name), Some(bytes), "{command:?}: {name}");
        }
        assert!(after.len() > before.len() + 2, "{command:?}");
        // What is new is listed, and nothing else.
        let new = after.into_keys().filter(|name| !before.contains_key(name));
        assert_eq!(listed(&place, &out), new.collect::<Vec<_>>(), "{command:?}");
    }
}

#[test]
fn files_of_somebody_else_with_the_names_of_results_are_refused_even_with_force() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        for name in ["index.html", "run.json"] {
            let out = format!("{k}-{name}");
            place.put(&format!("{out}/{name}"), "{ \"mine\": 1 }");
            refused(&place, &into(command, &out, "--force"), &out, &[name]);
        }
    }
    // Those of which a computation knows only later whether it writes them.
    let later = "cases/work/0.csv resolved.toml records/a.segment";
    for name in later.split(' ') {
        let out = name.replace('/', "-");
        place.put(&format!("{out}/{name}"), "mine");
        refused(&place, &into(COMMANDS[0], &out, "--force"), &out, &[name]);
    }
    // Which figures there are it knows last. What is computed by then is kept.
    place.put("late/figures/loops.svg", "mine");
    let late = into(COMMANDS[0], "late", "--force");
    says(&place.ends(&late, 2), &["figures/loops.svg"]);
    assert_eq!(place.text("late/figures/loops.svg"), "mine");
    fs::remove_file(place.path("late/figures/loops.svg")).unwrap();
    let said = place.done(&into(COMMANDS[0], "late", "")).stderr;
    says(&said, &["3 of 3 cases were already done"]);
}

/// Names that a file manager shows.
fn entries(place: &Place, folder: &str) -> Vec<String> {
    let entries = fs::read_dir(place.path(folder)).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.filter(|name| !name.starts_with('.')).collect();
    names.sort();
    names
}

#[test]
fn the_top_of_a_folder_has_what_is_opened_first_and_little_else() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        let out = format!("out-{k}");
        place.done(&into(command, &out, ""));
        let found = entries(&place, &out);
        assert!(found.len() <= 10, "{command}: {found:?}");
        for name in ["figures", "index.html", "run.json"] {
            assert!(found.iter().any(|own| own == name), "{command}: {name}");
        }
        let pictures = |name: &str| {
            [".svg", ".png", ".caption.txt"]
                .iter()
                .any(|end| name.ends_with(end))
        };
        for name in listed(&place, &out) {
            assert_eq!(
                pictures(&name),
                name.starts_with("figures/") && pictures(&name),
                "{name}"
            );
        }
    }
    let of_sweep = "cases figures index.html records resolved.toml run.json summary.json sweep.csv";
    assert_eq!(entries(&place, "out-0").join(" "), of_sweep);
    let of_history = "cases figures history.csv index.html resolved.toml run.json summary.json";
    assert_eq!(entries(&place, "out-1").join(" "), of_history);
}

#[test]
fn a_folder_belongs_to_one_command_and_another_one_is_refused() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        place.done(&into(command, &format!("own-{k}"), ""));
    }
    for (k, command) in COMMANDS.iter().enumerate() {
        for other in 0..COMMANDS.len() {
            // `sweep`, `merge` and `report` make the same folder of the same sweep.
            let same = |k: usize| matches!(k, 0 | 2 | 3);
            if other == k || same(k) && same(other) {
                continue;
            }
            let out = format!("own-{other}");
            refused(&place, &into(command, &out, ""), &out, &[&out, "--force"]);
        }
    }
    // Forced, one takes the place of the other, of which nothing is left but what is somebody else's.
    for (k, out) in [(5, "own-0"), (0, "own-4"), (6, "own-7"), (8, "own-1")] {
        place.put(&format!("{out}/cases/work/notes.txt"), "mine");
        place.done(&into(COMMANDS[k], out, "--force"));
        assert_eq!(place.text(&format!("{out}/cases/work/notes.txt")), "mine");
        fs::remove_file(place.path(out).join("cases/work/notes.txt")).unwrap();
        is_as_listed(&place, out);
    }
}

#[test]
fn the_default_folder_of_two_files_of_one_name_is_given_to_one_of_them() {
    let place = inputs();
    place.put("a/polymer.toml", place.text("small.toml"));
    place.put("b/polymer.toml", place.text("identify.toml"));
    place.put("b/cycles.csv", place.text("cycles.csv"));
    place.done("sweep a/polymer.toml");
    let parts = ["reports/polymer", "a sweep", "an identification", "--out"];
    refused(&place, "identify b/polymer.toml", parts[0], &parts);
}

#[test]
fn no_command_writes_over_a_file_that_it_reads() {
    let place = inputs();
    let [raw, table, creep, plan] =
        ["raw/0.csv", "cycles.csv", "creep.csv", "small.toml"].map(|name| place.text(name));
    let identify = place.text("identify.toml");
    let identify = identify.replace("cycles.csv", "fit.csv");
    let sweep = plan.replace(
        "library = \"pmma\"",
        "poisson_ratio = 0.3\n[material.table]\nfile = \"cases/loops/1.csv\"\nquantity = \"creep\"\nmodulus = \"longitudinal\"",
    );
    let fit = &format!("material fit prony.csv {FIT}");
    for (name, text) in [
        ("a/cases/loops/0.csv", &raw),
        ("b/prony.csv", &creep),
        ("c/fit.csv", &table),
        ("c/id.toml", &identify),
        ("d/cases/loops/1.csv", &creep),
        ("d/s.toml", &sweep),
        ("e/resolved.toml", &plan),
    ] {
        place.put(name, text);
    }
    // A folder, the file in it that is read, the command.
    for (folder, named, command) in [
        ("a", "cases/loops/0.csv", "analyse cases/loops/0.csv"),
        ("b", "prony.csv", fit),
        ("c", "fit.csv", "identify id.toml"),
        ("d", "cases/loops/1.csv", "sweep s.toml"),
        ("e", "resolved.toml", "sweep resolved.toml"),
    ] {
        let before = place.files(folder);
        for more in ["", "--force"] {
            let run = place.run_at(folder, &into(command, ".", more)).ended(2);
            // Both names: what is read, and what would be written over it.
            let is_named = run.stderr.matches(named).count() == 2 && run.stderr.contains("is read");
            assert!(more.is_empty() || is_named, "{run:?}");
            assert!(place.files(folder) == before, "{command:?} {more:?}");
        }
    }
    // In a folder of its own too: the table that an earlier fit has written.
    place.done(&format!("material fit creep.csv {FIT} --out fitted"));
    place.put("fitted/figures/fit.csv", creep);
    let fit = format!("material fit fitted/figures/fit.csv {FIT} --out fitted");
    refused(&place, &fit, "fitted", &[]);
}

#[test]
fn what_an_earlier_run_showed_and_this_one_does_not_is_removed() {
    let place = inputs();
    let own = |name: &str| place.path("own").join(name);
    place.done("sweep small.toml --out own");
    place.put("own/cases/work/notes.txt", "mine");
    assert!(own("figures/loops.svg").exists());
    place.done("report own --no-figures");
    assert!(!own("figures/loops.svg").exists() && !own("index.html").exists());
    assert!(own("cases/loops/0.csv").exists() && own("cases/work/notes.txt").exists());
    // Of a listed file that no report writes any more, as those of cases that a partial report has chosen.
    let run = fs::read_to_string(own("run.json")).unwrap();
    let run = run.replace(
        "\"cases/loops/0.csv\"",
        "\"cases/loops/0.csv\",\n    \"cases/loops/202.csv\"",
    );
    fs::write(own("run.json"), run).unwrap();
    fs::write(own("cases/loops/202.csv"), "").unwrap();
    fs::write(own("cases/loops/203.csv"), "mine").unwrap();
    place.done("report own");
    assert!(!own("cases/loops/202.csv").exists() && own("cases/loops/203.csv").exists());
    // Another fit in the same folder.
    let fit = "--modulus longitudinal --poisson-ratio 0.4 --out fits";
    let of_dynamic = format!("material fit dma.csv --quantity dynamic {fit}");
    place.done(&of_dynamic);
    assert!(place.has("fits/summary.json"));
    place.done(&format!("material fit creep.csv --quantity creep {fit}"));
    assert!(!place.has("fits/summary.json"));
    is_as_listed(&place, "fits");
}

#[test]
fn names_in_a_list_do_not_reach_out_of_the_folder() {
    let place = inputs();
    place.done("sweep small.toml --out own --no-figures");
    place.put("mine.txt", "mine");
    let run = place.path("own/run.json");
    let outside = place.path("mine.txt").to_str().unwrap().to_owned();
    let text = fs::read_to_string(&run).unwrap();
    let files = format!("\"files\": [\n    \"../mine.txt\",\n    \"{outside}\",");
    fs::write(&run, text.replace("\"files\": [", &files)).unwrap();
    place.done("sweep small.toml --out own --set cycle.steps=32 --force");
    assert!(place.path("mine.txt").exists());
}

/// Folders of versions that listed nothing.
#[test]
fn a_folder_without_a_list_is_known_by_its_records_and_its_summary() {
    let place = inputs();
    place.done("sweep small.toml --out own");
    let whole = place.files("own");
    let unlist = |all: bool| {
        let names = ["run.json", ".contact-dma.lock", "summary.json"];
        for name in names.iter().take(if all { 3 } else { 2 }) {
            let _ = fs::remove_file(place.path("own").join(name));
        }
    };
    for all in [false, true] {
        unlist(all);
        place.put("own/notes.txt", "mine");
        place.done("sweep small.toml --out own");
        unlist(all);
        place.done("report own");
        let mut found = place.files("own");
        assert_eq!(found.remove("notes.txt").unwrap(), b"mine");
        for (name, bytes) in &whole {
            let is_same = name == "run.json" || found.get(name) == Some(bytes);
            assert!(is_same, "{name}");
        }
        assert_eq!(found.len(), whole.len());
        unlist(all);
        place.ends(&into(COMMANDS[5], "own", ""), 2);
    }
    place.done("sweep small.toml --out own --set cycle.steps=32 --force");
    assert!(place.path("own/notes.txt").exists());
}

#[test]
fn a_damaged_plan_is_written_anew_where_its_records_are_there() {
    let place = inputs();
    place.done("sweep small.toml --out own --no-figures");
    let plan = place.path("own/resolved.toml");
    let whole = fs::read(&plan).unwrap();
    let records = || place.files("own/records");
    let before = records();
    for damage in [40, whole.len() / 2, whole.len()] {
        let mut bytes = whole.clone();
        match bytes.get_mut(damage) {
            Some(byte) => *byte ^= 0x84,
            None => bytes.clear(),
        }
        fs::write(&plan, bytes).unwrap();
        for more in ["", "--force"] {
            let said = place.done(&into("sweep small.toml --no-figures", "own", more));
            says(&said.stderr, &["3 of 3 cases were already done"]);
            assert_eq!(fs::read(&plan).unwrap(), whole);
            assert_eq!(records(), before);
        }
    }
    // Of another sweep it stays, and so do its records.
    let other = "sweep small.toml --out own --set cycle.steps=32";
    let parts = ["holds results of a different sweep"];
    refused(&place, other, "own/records", &parts);
}

#[test]
fn half_written_files_of_killed_commands_are_removed_by_the_next_one() {
    let place = inputs();
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let half = format!(".contact-dma-{}~left", host.trim());
    for k in [0, 4, 7] {
        let (command, out) = (COMMANDS[k], format!("own-{k}"));
        let again = match k {
            0 => format!("report {out}"),
            _ => into(command, &out, ""),
        };
        place.done(&into(command, &out, ""));
        place.put(&format!("{out}/{half}"), "half");
        place.ends(&again, 0);
        assert!(!place.path(&out).join(&half).exists(), "{command:?}");
    }
}

#[test]
fn nothing_is_written_into_a_folder_in_which_a_sweep_runs() {
    let place = inputs();
    place.done("sweep small.toml --out own --no-figures");
    // As a running process has it.
    let lock = place.path("own/.contact-dma.lock");
    let lock = fs::File::options().read(true).append(true).open(lock);
    let lock = lock.unwrap();
    lock.lock_shared().unwrap();
    for k in [4, 5, 7, 8] {
        refused(&place, &into(COMMANDS[k], "own", "--force"), "own", &[]);
    }
}

#[cfg(unix)]
#[test]
fn an_export_is_written_to_what_is_there() {
    let place = inputs();
    let export = |rest: &str| place.run(&format!("material export pmma --to abaqus --out {rest}"));
    export("a.inp").ended(0);
    let text = place.text("a.inp");
    // Its own file it replaces, one of somebody else it does not.
    export("a.inp").ended(0);
    place.put("mine.inp", "mine");
    let told = export("mine.inp").ended(2).stderr;
    says(&told, &["mine.inp", "--force"]);
    assert_eq!(place.text("mine.inp"), "mine");
    export("mine.inp --force").ended(0);
    assert_eq!(place.text("mine.inp"), text);
    // A link stays one, and what it names is written.
    for (link, target) in [("to-a.inp", "a.inp"), ("to-new.inp", "new.inp")] {
        std::os::unix::fs::symlink(place.path(target), place.path(link)).unwrap();
        export(link).ended(0);
        assert!(place.path(link).is_symlink());
        assert_eq!(place.text(target), text);
    }
    // A device is written to.
    let printed = export("/dev/stdout --format json").ended(0).stdout;
    assert!(printed.starts_with(&text), "{printed}");
    place.put("pmma.toml", "[material]\nlibrary = \"pmma\"\n");
    let own = "material export pmma.toml --to abaqus --out pmma.toml --force";
    assert!(place.ends(own, 2).contains("is read"));
}

#[test]
fn a_folder_of_another_command_is_told_where_a_sweep_is_needed() {
    let place = inputs();
    let names =
        "a scenario|an identification|the figures of a material|a material fit|a comparison";
    for (k, holds) in [1, 5, 6, 7, 8].into_iter().zip(names.split('|')) {
        let out = format!("out-{k}");
        place.done(&into(COMMANDS[k], &out, ""));
        let holds = format!("{out} holds {holds}");
        for other in [
            format!("compare {out} swept"),
            format!("merge {out} --out whole"),
        ] {
            refused(&place, &other, &out, &[&holds]);
        }
    }
}

#[test]
fn the_data_of_a_fit_that_were_copied_beside_its_results_stay() {
    let place = inputs();
    place.done("material fit dma.csv --quantity dynamic --modulus shear --out out");
    // The summary names the data by their file, which the program has not written.
    place.put("out/dma.csv", place.text("dma.csv"));
    place.done("sweep small.toml --out out --force");
    assert!(place.path("out/dma.csv").exists() && !place.path("out/master.csv").exists());
}

#[test]
fn a_title_that_is_the_name_of_the_folder_is_no_file_that_is_read() {
    let place = Place::lent("small.toml");
    let found = place
        .text("small.toml")
        .replace("PMMA under a sphere", "found");
    place.put("small.toml", found);
    let run = "sweep small.toml --out found --force --quiet --no-figures";
    for loads in ["10 N", "12 N"] {
        place.done(&format!("{run} --set 'drive.mean={loads}'"));
    }
}
