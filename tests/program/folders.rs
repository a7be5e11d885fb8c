//! Files of a user survive, whatever the folder: the program replaces and removes what it has written itself, and nothing else.

#![cfg(feature = "cli")]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use crate::program::{Place, pmma_sweep};

/// Three cases of a few milliseconds, with figures as SVG alone.
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

const SCENARIO: &str = r#"title = "a step"
[material]
library = "pmma"
[indenter]
shape = "sphere"
radius = "10 mm"
[drive]
segments = [{ kind = "step", to = "10 N", duration = "10 s" }]
[time]
step = "1 s"
[output]
error_bars = false
profiles_at = ["0 s", "5 s"]
[solver]
springs = 24
[figures]
formats = ["svg"]
"#;

const CREEP: &str =
    "time_s,creep_compliance_per_pa\n0.1,1.0e-6\n1,1.1e-6\n10,1.4e-6\n100,1.8e-6\n1000,1.95e-6\n";

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

/// A folder with the inputs of every command, and a finished sweep in `swept`.
fn inputs() -> Place {
    let place = Place::with("small.toml", &pmma_sweep(SWEEP));
    place.put("step.toml", SCENARIO);
    place.put("creep.csv", CREEP);
    place.put("identify.toml", IDENTIFY);
    for k in 0..2 {
        let row = |i: usize| {
            let (t, w) = (0.05 * i as f64, 2.0 + k as f64);
            let (load, depth) = ((w * t).sin(), (w * t - 0.1).sin());
            format!("{t},{},{}\n", 10.0 + 5.0 * load, 2e-5 + 4e-6 * depth)
        };
        let rows: String = (0..400).map(row).collect();
        place.put(
            &format!("raw/{k}.csv"),
            format!("time_s,load_n,approach_m\n{rows}"),
        );
    }
    place.done("sweep small.toml --out swept --no-figures");
    place.put("cycles.csv", place.text("swept/sweep.csv"));
    place
}

/// Every file below a folder with its bytes, but for what the program keeps for itself.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let name = path.strip_prefix(folder).unwrap().to_str().unwrap();
            found.insert(name.to_owned(), fs::read(&path).unwrap());
        }
    }
    found
}

/// The files that `run.json` says the program has written.
fn listed(folder: &Path) -> Vec<String> {
    let run = fs::read(folder.join("run.json")).unwrap();
    let run: serde_json::Value = serde_json::from_slice(&run).unwrap();
    let files = run["files"].as_array().unwrap().iter();
    files
        .map(|name| name.as_str().unwrap().to_owned())
        .collect()
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
const FOREIGN: &str = "notes.txt checkpoints/deep/model.pt records/mine.sqlite loops/raw.csv pressures/notes.txt work/notes.txt \
                       peaks/everest.txt profiles/me.jpg fields/corn.csv cycles/tandem.txt data/table.csv figures/mine.svg";

#[test]
fn a_folder_of_somebody_else_is_refused_and_with_force_added_to_and_left_as_it_was() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        let out = format!("theirs-{k}");
        for name in FOREIGN.split_whitespace() {
            place.put(&format!("{out}/{name}"), name);
        }
        let before = files(&place.path(&out));
        let refusal = place.ends(&into(command, &out, ""), 2);
        assert!(
            refusal.contains("has not written") && refusal.contains("--force"),
            "{refusal}"
        );
        assert_eq!(files(&place.path(&out)), before, "{command:?}");
        // Twice: the second finds its own list beside them.
        place.ends(&into(command, &out, "--force"), 0);
        place.ends(&into(command, &out, ""), 0);
        let after = files(&place.path(&out));
        for (name, bytes) in &before {
            assert_eq!(after.get(name), Some(bytes), "{command:?}: {name}");
        }
        assert!(after.len() > before.len() + 2, "{command:?}");
        // What is new is listed, and nothing else.
        let own: Vec<String> = after
            .into_keys()
            .filter(|name| !before.contains_key(name))
            .collect();
        assert_eq!(listed(&place.path(&out)), own, "{command:?}");
    }
}

#[test]
fn files_of_somebody_else_with_the_names_of_results_are_refused_even_with_force() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        for name in ["index.html", "run.json"] {
            let out = format!("{k}-{name}");
            place.put(&format!("{out}/{name}"), "{ \"mine\": 1 }");
            let refusal = place.ends(&into(command, &out, "--force"), 2);
            assert!(refusal.contains(name), "{refusal}");
            let after = files(&place.path(&out));
            assert_eq!(after.len(), 1, "{command:?}: {:?}", after.keys());
        }
    }
    // Those of which a computation knows only later whether it writes them.
    for name in [
        "work/0.csv",
        "loops.csv",
        "peaks.caption.txt",
        "resolved.toml",
        "records/a.segment",
    ] {
        let out = name.replace('/', "-");
        place.put(&format!("{out}/{name}"), "mine");
        let refusal = place.ends(&into(COMMANDS[0], &out, "--force"), 2);
        assert!(refusal.contains(name), "{refusal}");
        assert_eq!(files(&place.path(&out)).len(), 1);
    }
}

#[test]
fn a_folder_belongs_to_one_command_and_another_one_is_refused() {
    let place = inputs();
    for (k, command) in COMMANDS.iter().enumerate() {
        place.ends(&into(command, &format!("own-{k}"), ""), 0);
    }
    for (k, command) in COMMANDS.iter().enumerate() {
        for other in 0..COMMANDS.len() {
            // `sweep`, `merge` and `report` make the same folder of the same sweep.
            let same = |k: usize| matches!(k, 0 | 2 | 3);
            if other == k || same(k) && same(other) {
                continue;
            }
            let out = format!("own-{other}");
            let before = files(&place.path(&out));
            let refusal = place.ends(&into(command, &out, ""), 2);
            assert!(
                refusal.contains(&out) && refusal.contains("--force"),
                "{refusal}"
            );
            assert_eq!(files(&place.path(&out)), before, "{command:?} into {out}");
        }
    }
    // Forced, one takes the place of the other, of which nothing is left but what is somebody else's.
    for (k, out) in [(5, "own-0"), (0, "own-4"), (6, "own-7"), (8, "own-1")] {
        place.put(&format!("{out}/work/notes.txt"), "mine");
        place.ends(&into(COMMANDS[k], out, "--force"), 0);
        let mut left = files(&place.path(out));
        assert_eq!(left.remove("work/notes.txt").unwrap(), b"mine");
        assert_eq!(
            left.into_keys().collect::<Vec<_>>(),
            listed(&place.path(out))
        );
    }
}

#[test]
fn the_default_folder_of_two_files_of_one_name_is_given_to_one_of_them() {
    let place = inputs();
    place.put("a/polymer.toml", pmma_sweep(SWEEP));
    place.put("b/polymer.toml", IDENTIFY);
    place.put("b/cycles.csv", place.text("cycles.csv"));
    place.ends("sweep a/polymer.toml", 0);
    let before = files(&place.path("reports/polymer"));
    let refusal = place.ends("identify b/polymer.toml", 2);
    for part in ["reports/polymer", "a sweep", "an identification", "--out"] {
        assert!(refusal.contains(part), "{refusal}");
    }
    assert_eq!(files(&place.path("reports/polymer")), before);
}

#[test]
fn no_command_writes_over_a_file_that_it_reads() {
    let place = inputs();
    let raw = place.text("raw/0.csv");
    let identify = IDENTIFY.replace("cycles.csv", "fit.csv");
    let table = place.text("cycles.csv");
    let sweep = pmma_sweep(SWEEP).replace(
        "library = \"pmma\"",
        "poisson_ratio = 0.3\n[material.table]\nfile = \"loops.csv\"\nquantity = \"creep\"\nmodulus = \"longitudinal\"",
    );
    let plan = pmma_sweep(SWEEP);
    let fit = &format!("material fit fit.csv {FIT}");
    for (name, text) in [
        ("a/loops/0.csv", raw.as_str()),
        ("b/fit.csv", CREEP),
        ("c/fit.csv", &table),
        ("c/id.toml", &identify),
        ("d/loops.csv", CREEP),
        ("d/s.toml", &sweep),
        ("e/resolved.toml", &plan),
    ] {
        place.put(name, text);
    }
    // A folder, the file in it that is read, the command.
    for (folder, named, command) in [
        ("a", "loops/0.csv", "analyse loops/0.csv"),
        ("b", "fit.csv", fit),
        ("c", "fit.csv", "identify id.toml"),
        ("d", "loops.csv", "sweep s.toml"),
        ("e", "resolved.toml", "sweep resolved.toml"),
    ] {
        let before = files(&place.path(folder));
        for more in ["", "--force"] {
            let run = place.run_at(folder, &into(command, ".", more)).ended(2);
            // Both names: what is read, and what would be written over it.
            let is_named = run.stderr.matches(named).count() == 2 && run.stderr.contains("is read");
            assert!(more.is_empty() || is_named, "{run:?}");
            assert_eq!(files(&place.path(folder)), before, "{command:?} {more:?}");
        }
    }
    // In a folder of its own too: the table that an earlier fit has written.
    place.done(&format!("material fit creep.csv {FIT} --out fitted"));
    place.put("fitted/fit.csv", CREEP);
    let before = files(&place.path("fitted"));
    place.ends(
        &format!("material fit fitted/fit.csv {FIT} --out fitted"),
        2,
    );
    assert_eq!(files(&place.path("fitted")), before);
}

#[test]
fn what_an_earlier_run_showed_and_this_one_does_not_is_removed() {
    let place = inputs();
    let own = |name: &str| place.path("own").join(name);
    place.ends("sweep small.toml --out own", 0);
    place.put("own/work/notes.txt", "mine");
    assert!(own("loops.svg").exists());
    place.ends("report own --no-figures", 0);
    assert!(!own("loops.svg").exists() && !own("index.html").exists());
    assert!(own("loops/0.csv").exists() && own("work/notes.txt").exists());
    // Of a listed file that no report writes any more, as those of cases that a partial report has chosen.
    let run = fs::read_to_string(own("run.json")).unwrap();
    let run = run.replace("\"loops/0.csv\"", "\"loops/0.csv\",\n    \"loops/202.csv\"");
    fs::write(own("run.json"), run).unwrap();
    fs::write(own("loops/202.csv"), "").unwrap();
    fs::write(own("loops/203.csv"), "mine").unwrap();
    place.ends("report own", 0);
    assert!(!own("loops/202.csv").exists() && own("loops/203.csv").exists());
    // Another fit in the same folder.
    let dynamic = "Temperature (°C),Frequency (Hz),E' (MPa),E'' (MPa)\n";
    let rows: String = (0..12)
        .map(|k| {
            let f = 10f64.powf(-1.0 + 0.25 * f64::from(k));
            let x = 6.0 * f;
            format!(
                "25,{f},{},{}\n",
                100.0 + 50.0 * x * x / (1.0 + x * x),
                50.0 * x / (1.0 + x * x)
            )
        })
        .collect();
    place.put("dynamic.csv", format!("{dynamic}{rows}"));
    let fit = "--modulus longitudinal --poisson-ratio 0.4 --out fits";
    place.done(&format!(
        "material fit dynamic.csv --quantity dynamic {fit}"
    ));
    let first = files(&place.path("fits"));
    assert!(first.contains_key("summary.json"));
    place.done(&format!("material fit creep.csv --quantity creep {fit}"));
    let second = files(&place.path("fits"));
    assert!(!second.contains_key("summary.json"));
    assert_eq!(
        second.into_keys().collect::<Vec<_>>(),
        listed(&place.path("fits"))
    );
}

#[test]
fn names_in_a_list_do_not_reach_out_of_the_folder() {
    let place = inputs();
    place.ends("sweep small.toml --out own --no-figures", 0);
    place.put("mine.txt", "mine");
    let run = place.path("own/run.json");
    let outside = place.path("mine.txt").to_str().unwrap().to_owned();
    let text = fs::read_to_string(&run).unwrap();
    let files = format!("\"files\": [\n    \"../mine.txt\",\n    \"{outside}\",");
    fs::write(&run, text.replace("\"files\": [", &files)).unwrap();
    place.ends("sweep small.toml --out own --set cycle.steps=32 --force", 0);
    assert!(place.path("mine.txt").exists());
}

/// Folders of versions that listed nothing.
#[test]
fn a_folder_without_a_list_is_known_by_its_records_and_its_summary() {
    let place = inputs();
    place.ends("sweep small.toml --out own", 0);
    let whole = files(&place.path("own"));
    let unlist = |all: bool| {
        let names: &[&str] = match all {
            true => &["run.json", ".contact-dma.lock", "summary.json"],
            false => &["run.json", ".contact-dma.lock"],
        };
        for name in names {
            let _ = fs::remove_file(place.path("own").join(name));
        }
    };
    for all in [false, true] {
        unlist(all);
        place.put("own/notes.txt", "mine");
        place.ends("sweep small.toml --out own", 0);
        unlist(all);
        place.ends("report own", 0);
        let mut found = files(&place.path("own"));
        assert_eq!(found.remove("notes.txt").unwrap(), b"mine");
        for (name, bytes) in &whole {
            assert!(
                name == "run.json" || found.get(name) == Some(bytes),
                "{name}"
            );
        }
        assert_eq!(found.len(), whole.len());
        unlist(all);
        place.ends(&into(COMMANDS[5], "own", ""), 2);
    }
    place.ends("sweep small.toml --out own --set cycle.steps=32 --force", 0);
    assert!(place.path("own/notes.txt").exists());
}

#[test]
fn a_damaged_plan_is_written_anew_where_its_records_are_there() {
    let place = inputs();
    place.ends("sweep small.toml --out own --no-figures", 0);
    let plan = place.path("own/resolved.toml");
    let whole = fs::read(&plan).unwrap();
    let records = || files(&place.path("own/records"));
    let before = records();
    for damage in [40, whole.len() / 2, whole.len()] {
        let mut bytes = whole.clone();
        match bytes.get_mut(damage) {
            Some(byte) => *byte ^= 0x84,
            None => bytes.clear(),
        }
        fs::write(&plan, bytes).unwrap();
        for more in ["", "--force"] {
            let said = place.ends(&into("sweep small.toml --no-figures", "own", more), 0);
            assert!(said.contains("3 of 3 cases were already done"), "{said}");
            assert_eq!(fs::read(&plan).unwrap(), whole);
            assert_eq!(records(), before);
        }
    }
    // Of another sweep it stays, and so do its records.
    let said = place.ends("sweep small.toml --out own --set cycle.steps=32", 2);
    assert!(
        said.contains("holds results of a different sweep"),
        "{said}"
    );
    assert_eq!(records(), before);
}

#[test]
fn half_written_files_of_killed_commands_are_removed_by_the_next_one() {
    let place = inputs();
    let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap();
    let half = format!(".contact-dma-{}~left", host.trim());
    for (k, command) in COMMANDS
        .iter()
        .enumerate()
        .filter(|(k, _)| [0, 4, 7].contains(k))
    {
        let out = format!("own-{k}");
        let again = match k {
            0 => format!("report {out}"),
            _ => into(command, &out, ""),
        };
        place.ends(&into(command, &out, ""), 0);
        place.put(&format!("{out}/{half}"), "half");
        place.ends(&again, 0);
        assert!(!place.path(&out).join(&half).exists(), "{command:?}");
    }
}

#[test]
fn nothing_is_written_into_a_folder_in_which_a_sweep_runs() {
    let place = inputs();
    place.ends("sweep small.toml --out own --no-figures", 0);
    // As a running process has it.
    let lock = fs::File::options()
        .read(true)
        .append(true)
        .open(place.path("own/.contact-dma.lock"));
    let lock = lock.unwrap();
    lock.lock_shared().unwrap();
    let before = files(&place.path("own"));
    for k in [4, 5, 7, 8] {
        place.ends(&into(COMMANDS[k], "own", "--force"), 2);
        assert_eq!(files(&place.path("own")), before, "{:?}", COMMANDS[k]);
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
    assert!(
        told.contains("mine.inp") && told.contains("--force"),
        "{told}"
    );
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
    for (k, holds) in [
        (1, "a scenario"),
        (5, "an identification"),
        (6, "the figures of a material"),
        (7, "a material fit"),
        (8, "a comparison"),
    ] {
        let out = format!("out-{k}");
        place.ends(&into(COMMANDS[k], &out, ""), 0);
        let before = files(&place.path(&out));
        for other in [
            format!("compare {out} swept"),
            format!("merge {out} --out whole"),
        ] {
            let said = place.ends(&other, 2);
            assert!(said.contains(&format!("{out} holds {holds}")), "{said}");
        }
        assert_eq!(files(&place.path(&out)), before, "{holds}");
    }
}

#[test]
fn the_data_of_a_fit_that_were_copied_beside_its_results_stay() {
    let place = inputs();
    let data = "frequency_hz,storage_modulus_pa,loss_modulus_pa\n0.1,1e6,1e5\n0.3,1.2e6,2e5\n1,1.5e6,3e5\n3,1.8e6,2e5\n10,2e6,1e5\n";
    place.put("dma.csv", data);
    place.done("material fit dma.csv --quantity dynamic --modulus shear --out out");
    // The summary names the data by their file, which the program has not written.
    place.put("out/dma.csv", data);
    place.ends("sweep small.toml --out out --force", 0);
    assert!(place.path("out/dma.csv").exists() && !place.path("out/master.csv").exists());
}

#[test]
fn a_title_that_is_the_name_of_the_folder_is_no_file_that_is_read() {
    let sweep = pmma_sweep(SWEEP).replacen("title = \"", "title = \"found\" # \"", 1);
    assert!(sweep.contains("title = \"found\""), "{sweep}");
    let place = Place::with("small.toml", &sweep);
    for loads in ["10 N", "12 N"] {
        place.done(&format!(
            "sweep small.toml --out found --force --quiet --no-figures --set 'drive.mean={loads}'"
        ));
    }
}
