//! Files named in a sweep or scenario file start from its folder, those named in a flag from the working folder: the same for
//! every key.

#![cfg(feature = "cli")]

use std::fs;
use std::path::Path;

use crate::program::{program, write};
use tempfile::TempDir;

/// The keys that name files: the flag, and what the file says.
const KEYS: [(&str, &str); 3] = [
    ("material.table.file=flag/creep.csv", "data/creep.csv"),
    ("indenter.file=flag/tip.csv", "data/tip.csv"),
    (
        "drive.segments=[{ kind = \"table\", file = \"flag/load.csv\" }]",
        "data/load.csv",
    ),
];

const SCENARIO: &str = r#"title = "three files"

[material]
poisson_ratio = 0.4

[material.table]
file = "data/creep.csv"
quantity = "creep"
modulus = "shear"

[indenter]
shape = "profile"
file = "data/tip.csv"

[drive]
segments = [{ kind = "table", file = "data/load.csv" }]

[time]
step = "1 s"

[solver]
springs = 50
"#;

fn write_data(folder: &Path) {
    fs::create_dir_all(folder).unwrap();
    let creep = "time_s,creep_compliance_per_pa\n0.1,1.0e-6\n1,1.1e-6\n10,1.5e-6\n100,1.6e-6\n";
    fs::write(folder.join("creep.csv"), creep).unwrap();
    let tip = "r_m,gap_m\n0,0\n1e-3,5e-5\n2e-3,2e-4\n4e-3,8e-4\n";
    fs::write(folder.join("tip.csv"), tip).unwrap();
    fs::write(folder.join("load.csv"), "time_s,load_n\n0,0\n5,1\n").unwrap();
}

/// project/scenario.toml, its data in project/data, and other copies in flag/; the working folder is above both.
fn project() -> TempDir {
    let folder = TempDir::new().unwrap();
    write_data(&folder.path().join("project/data"));
    write_data(&folder.path().join("flag"));
    write(&folder, "project/scenario.toml", SCENARIO);
    folder
}

/// What a refusal says, on one line.
fn refusal(assert: assert_cmd::assert::Assert) -> String {
    let stderr = assert.code(2).get_output().stderr.clone();
    let words = String::from_utf8(stderr).unwrap();
    words.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn simulate(folder: &TempDir, flags: &[&str]) -> assert_cmd::assert::Assert {
    let mut command = program();
    command
        .current_dir(folder.path())
        .args(["simulate", "project/scenario.toml", "--quiet", "--force"])
        .args(["--no-figures", "--out", "out"]);
    for flag in flags {
        command.args(["--set", flag]);
    }
    command.assert()
}

#[test]
fn names_in_a_file_start_from_its_folder_and_names_in_a_flag_from_the_working_folder() {
    let folder = project();
    simulate(&folder, &[]).success();
    for (flag, in_file) in KEYS {
        simulate(&folder, &[flag]).success();
        // It is the flag's file that is read: the other one is gone.
        let (there, away) = (
            folder.path().join("project").join(in_file),
            folder.path().join("away.csv"),
        );
        fs::rename(&there, &away).unwrap();
        simulate(&folder, &[flag]).success();
        let refused = refusal(simulate(&folder, &[]));
        assert!(refused.contains(&format!("project/{in_file}")), "{refused}");
        assert!(refused.contains("the folder of the file it is written in"));
        fs::rename(&away, &there).unwrap();
    }
    let flags = KEYS.map(|(flag, _)| flag);
    fs::remove_dir_all(folder.path().join("project/data")).unwrap();
    simulate(&folder, &flags).success();
}

#[test]
fn a_missing_file_named_in_a_flag_is_told_with_the_folder_it_was_looked_for_in() {
    let folder = project();
    fs::remove_dir_all(folder.path().join("flag")).unwrap();
    // Beside the scenario there is one of that name, which a flag does not mean.
    write_data(&folder.path().join("project/flag"));
    for (flag, _) in KEYS {
        let name = flag
            .split(['=', '"'])
            .find(|part| part.starts_with("flag/"));
        let refused = refusal(simulate(&folder, &[flag]));
        assert!(refused.contains("a path in a flag starts from the working folder"));
        assert!(
            refused.contains(&format!("`{}`", name.unwrap())),
            "{refused}"
        );
        assert!(!refused.contains("project/flag"), "{refused}");
    }
}

#[test]
fn sweeps_and_the_material_command_have_the_same_rule() {
    let folder = project();
    let start = SCENARIO.split("[drive]").next().unwrap();
    let sweep = "[drive]\nmean = 1\namplitude = 0.5\n[sweep]\nangular_frequency = [0.1]\n[solver]\nsprings = 50\n";
    write(&folder, "project/sweep.toml", &format!("{start}{sweep}"));
    let run = |arguments: &[&str]| {
        let mut command = program();
        command.current_dir(folder.path()).args(arguments).assert()
    };
    let sweep = [
        "sweep",
        "project/sweep.toml",
        "--quiet",
        "--no-figures",
        "--force",
        "--out",
        "out",
    ];
    run(&sweep).success();
    for (flag, _) in &KEYS[..2] {
        run(&[&sweep[..], &["--set", flag]].concat()).success();
    }
    run(&["material", "show", "project/sweep.toml"]).success();
    fs::remove_dir_all(folder.path().join("project/data")).unwrap();
    run(&sweep).code(2);
    let flags: Vec<&str> = KEYS[..2].iter().flat_map(|(f, _)| ["--set", f]).collect();
    run(&[&sweep[..], &flags].concat()).success();
}

#[cfg(unix)]
#[test]
fn data_lie_beside_a_link_to_a_file_or_beside_the_file() {
    let folder = project();
    fs::create_dir(folder.path().join("links")).unwrap();
    let link = folder.path().join("links/scenario.toml");
    std::os::unix::fs::symlink("../project/scenario.toml", &link).unwrap();
    let run = |force: &str| {
        let mut command = program();
        command.current_dir(folder.path());
        command.args([
            "simulate",
            "links/scenario.toml",
            "--quiet",
            "--no-figures",
            "--out",
            "out",
        ]);
        command.args(force.split_whitespace()).assert()
    };
    run("").success();
    // What is beside the link comes first.
    write_data(&folder.path().join("links/data"));
    fs::write(
        folder.path().join("links/data/load.csv"),
        "time_s,load_n\n0,two\n",
    )
    .unwrap();
    let refused = refusal(run("--force"));
    assert!(refused.contains("links/data/load.csv:2:3"), "{refused}");
}
