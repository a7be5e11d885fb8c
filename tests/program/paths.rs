//! Files named in a sweep or scenario file start from its folder, those named in a flag from the working folder: the same for
//! every key.

use crate::prelude::*;

/// The keys that name files: the flag, and what the file says.
const KEYS: [(&str, &str); 3] = [
    ("material.table.file=flag/creep.csv", "data/creep.csv"),
    ("indenter.file=flag/tip.csv", "data/tip.csv"),
    (
        "drive.segments=[{ kind = \"table\", file = \"flag/load.csv\" }]",
        "data/load.csv",
    ),
];

const SCENARIO: &str = include_str!("../inputs/three-files.toml");

fn write_data(place: &Place, folder: &str) {
    let creep = "time_s,creep_compliance_per_pa\n0.1,1.0e-6\n1,1.1e-6\n10,1.5e-6\n100,1.6e-6\n";
    place.put(&format!("{folder}/creep.csv"), creep);
    let tip = "r_m,gap_m\n0,0\n1e-3,5e-5\n2e-3,2e-4\n4e-3,8e-4\n";
    place.put(&format!("{folder}/tip.csv"), tip);
    place.put(&format!("{folder}/load.csv"), "time_s,load_n\n0,0\n5,1\n");
}

/// project/scenario.toml, its data in project/data, and other copies in flag/; the working folder is above both.
fn project() -> Place {
    let place = Place::with("project/scenario.toml", SCENARIO);
    write_data(&place, "project/data");
    write_data(&place, "flag");
    place
}

/// Runs the scenario with these keys set.
fn simulate(flags: &[&str]) -> String {
    let run = "simulate project/scenario.toml --quiet --force --no-figures --out out".to_owned();
    let flags = flags.iter().map(|flag| format!(" --set '{flag}'"));
    run + &flags.collect::<String>()
}

#[test]
fn names_in_a_file_start_from_its_folder_and_names_in_a_flag_from_the_working_folder() {
    let place = project();
    place.done(&simulate(&[]));
    for (flag, in_file) in KEYS {
        place.done(&simulate(&[flag]));
        // It is the flag's file that is read: the other one is gone.
        let in_file = format!("project/{in_file}");
        let (there, away) = (place.path(&in_file), place.path("away.csv"));
        fs::rename(&there, &away).unwrap();
        place.done(&simulate(&[flag]));
        let refused = place.refused(&simulate(&[]));
        let from = "the folder of the file it is written in";
        says(&refused, &[&in_file, from]);
        fs::rename(&away, &there).unwrap();
    }
    fs::remove_dir_all(place.path("project/data")).unwrap();
    place.done(&simulate(&KEYS.map(|(flag, _)| flag)));
}

#[test]
fn a_missing_file_named_in_a_flag_is_told_with_the_folder_it_was_looked_for_in() {
    let place = project();
    fs::remove_dir_all(place.path("flag")).unwrap();
    // Beside the scenario there is one of that name, which a flag does not mean.
    write_data(&place, "project/flag");
    for (flag, _) in KEYS {
        let mut parts = flag.split(['=', '"']);
        let name = parts.find(|part| part.starts_with("flag/")).unwrap();
        let refused = place.refused(&simulate(&[flag]));
        let where_from = "a path in a flag starts from the working folder";
        says(&refused, &[where_from, &format!("`{name}`")]);
        assert!(!refused.contains("project/flag"), "{refused}");
    }
}

#[test]
fn sweeps_and_the_material_command_have_the_same_rule() {
    let place = project();
    let start = SCENARIO.split("[drive]").next().unwrap();
    let rest = "[drive]\nmean = 1\namplitude = 0.5\n[sweep]\nangular_frequency = [0.1]\n[solver]\nsprings = 50\n";
    place.put("project/sweep.toml", format!("{start}{rest}"));
    let sweep = "sweep project/sweep.toml --quiet --no-figures --force --out out";
    place.done(sweep);
    let [first, second, _] = KEYS.map(|(flag, _)| format!("--set '{flag}'"));
    for flag in [&first, &second] {
        place.done(&format!("{sweep} {flag}"));
    }
    place.done("material show project/sweep.toml");
    fs::remove_dir_all(place.path("project/data")).unwrap();
    place.refused(sweep);
    place.done(&format!("{sweep} {first} {second}"));
}

#[cfg(unix)]
#[test]
fn data_lie_beside_a_link_to_a_file_or_beside_the_file() {
    let place = project();
    fs::create_dir(place.path("links")).unwrap();
    let link = place.path("links/scenario.toml");
    std::os::unix::fs::symlink("../project/scenario.toml", link).unwrap();
    let run = "simulate links/scenario.toml --quiet --no-figures --force --out out";
    place.done(run);
    // What is beside the link comes first.
    write_data(&place, "links/data");
    place.put("links/data/load.csv", "time_s,load_n\n0,two\n");
    let refused = place.refused(run);
    says(&refused, &["links/data/load.csv:2:3"]);
}
