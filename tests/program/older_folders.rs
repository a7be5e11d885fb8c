//! Folders of the layout before `figures/` and `cases/`: read by every command, and drawn anew in the present one.

use crate::folders;
use crate::prelude::*;
use serde_json::json;

/// Where an earlier version had a file.
fn former(name: &str) -> String {
    let at_top = ["records/figures.json", "records/analysis.json"];
    let below = match name.split_once('/') {
        Some(("figures" | "cases", below)) => below,
        Some(("records", below)) if at_top.contains(&name) || below.starts_with("run-") => below,
        _ => name,
    };
    below.to_owned()
}

/// Gives a folder the layout of earlier versions, with its list or without one, and a file of the user in the midst of it.
fn make_older(place: &Place, folder: &str, is_listed: bool) {
    let run = format!("{folder}/run.json");
    let mut list = place.json(&run);
    let names = list["files"].as_array().unwrap().clone();
    let names = names.iter().map(|name| name.as_str().unwrap());
    for name in names.clone().filter(|name| former(name) != *name) {
        let bytes = place.bytes(&format!("{folder}/{name}"));
        place.put(&format!("{folder}/{}", former(name)), bytes);
    }
    for below in [
        "figures",
        "cases",
        "records/figures.json",
        "records/analysis.json",
    ] {
        let path = place.path(folder).join(below);
        let _ = fs::remove_dir_all(&path);
        let _ = fs::remove_file(&path);
    }
    list["files"] = names.map(former).collect();
    fs::remove_file(place.path(&run)).unwrap();
    if is_listed {
        place.put(&run, list.to_string());
    }
    for name in MINE {
        place.put(&format!("{folder}/{name}"), name);
    }
}

/// Files of the user, at the places of earlier versions.
const MINE: [&str; 3] = ["mine.svg", "loops/mine.csv", "fields/notes.txt"];

/// The files of a folder without those of the user, and without those that say when they were made.
fn results(place: &Place, folder: &str) -> BTreeMap<String, Vec<u8>> {
    let mut files = place.files(folder);
    for name in MINE {
        assert_eq!(files.remove(name).unwrap(), name.as_bytes(), "{folder}");
    }
    files.retain(|name, _| name != "run.json" && !name.starts_with(".contact-dma"));
    files
}

/// A folder as it is now, with the files of the user.
fn present(place: &Place, command: &str, folder: &str) -> BTreeMap<String, Vec<u8>> {
    place.done(&format!("{command} --out {folder}"));
    for name in MINE {
        place.put(&format!("{folder}/{name}"), name);
    }
    results(place, folder)
}

#[test]
fn the_folder_of_every_command_is_drawn_anew_in_the_present_layout_and_nothing_of_the_user_is_touched()
 {
    let place = folders::inputs();
    place.lend("springs.toml cells.toml");
    for (k, command) in [
        "sweep small.toml",
        "simulate springs.toml",
        "simulate cells.toml",
        "analyse raw/0.csv raw/1.csv",
        "identify identify.toml",
        "material show pmma",
        "material fit creep.csv --quantity creep --modulus longitudinal --poisson-ratio 0.4",
        "material fit dma.csv --quantity dynamic --modulus shear --poisson-ratio 0.4",
        "compare swept swept",
    ]
    .iter()
    .enumerate()
    {
        let folder = format!("own-{k}");
        let whole = present(&place, command, &folder);
        make_older(&place, &folder, true);
        let older = place.files(&folder);
        // Into another folder the older one stays as it is.
        place.done(&format!("report {folder} --quiet --out other-{k}"));
        assert!(place.files(&folder) == older, "{command}");
        place.done(&format!("report {folder} --quiet"));
        let found = results(&place, &folder);
        assert!(
            found.keys().eq(whole.keys()),
            "{command}: {:?}",
            found.keys()
        );
        for (name, bytes) in &whole {
            assert!(found[name] == *bytes, "{command}: {name}");
        }
        let other = place.files(&format!("other-{k}"));
        for name in whole.keys().filter(|name| name.starts_with("figures/")) {
            assert!(other[name] == whole[name], "{command}: {name}");
        }
    }
}

#[test]
fn an_older_sweep_goes_on_with_its_records_and_is_compared_and_merged() {
    let place = folders::inputs();
    for is_listed in [true, false] {
        let whole = present(&place, "sweep small.toml --force", "own");
        make_older(&place, "own", is_listed);
        place.done("compare own swept --quiet --out compared --force");
        place.done("merge own --quiet --out merged --force");
        assert!(place.text("merged/sweep.csv") == place.text("own/sweep.csv"));
        let said = place.done("sweep small.toml --out own").stderr;
        says(&said, &["3 of 3 cases were already done"]);
        let found = results(&place, "own");
        assert!(found == whole, "{:?}", found.keys());
        for folder in ["own", "merged", "compared"] {
            fs::remove_dir_all(place.path(folder)).unwrap();
        }
    }
}

#[test]
fn loops_of_an_older_sweep_are_read_and_files_of_the_user_in_their_place_are_not() {
    let place = folders::inputs();
    let read = |out: &str| {
        place.done(&format!(
            "analyse raw/0.csv --against swept --quiet --out {out}"
        ));
        place.json(&format!("{out}/records/analysis.json"))["computed"].clone()
    };
    let whole = read("one");
    assert!(whole[0]["cycle"].as_array().unwrap().len() > 8);
    fs::remove_dir_all(place.path("swept/cases/loops")).unwrap();
    // No files of the sweep, whatever their names.
    for k in 0..3 {
        place.put(&format!("swept/loops/{k}.csv"), place.text("raw/1.csv"));
    }
    assert!(read("two")[0]["cycle"] == json!([]));
    fs::remove_dir_all(place.path("swept/loops")).unwrap();
    place.done("report swept --quiet --no-figures");
    make_older(&place, "swept", true);
    assert!(read("three") == whole);
}
