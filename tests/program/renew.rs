//! What the repository repeats of the tables of keys and columns and of the commands is what these say.

use crate::prelude::*;
use predicates::prelude::PredicateBooleanExt;
use predicates::str::contains;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

#[test]
fn nothing_generated_is_stale() {
    let mut renew = program();
    renew.args(["renew", "--check"]).arg(root());
    renew.assert().success();
}

/// The files of the repository that are generated, or of which parts are.
const FILES: &str = "README.md src/guide/input_files.md src/guide/own_indenter.md src/guide/own_loading.md \
                     src/guide/own_material.md src/guide/python.md src/guide/results.md sweeps/schema/identify.json \
                     sweeps/schema/scenario.json sweeps/schema/setup.json sweeps/schema/sweep.json tests/fuzz/words.txt";

#[test]
fn what_is_stale_is_named_and_renewed() {
    let folder = TempDir::new().unwrap();
    for name in FILES.split_whitespace() {
        let copy = folder.path().join(name);
        fs::create_dir_all(copy.parent().unwrap()).unwrap();
        fs::copy(root().join(name), copy).unwrap();
    }
    let path = |name: &str| folder.path().join(name);
    let readme = fs::read_to_string(path("README.md")).unwrap();
    fs::write(path("README.md"), readme.replace("`flat-punch`, ", "")).unwrap();
    fs::remove_file(path("sweeps/schema/sweep.json")).unwrap();
    let renew = |check: &[&str]| {
        let mut renew = program();
        renew.arg("renew").args(check).current_dir(&folder).assert()
    };
    let named = contains("stale: README.md, sweeps/schema/sweep.json; `cargo run -- renew`");
    renew(&["--check"]).code(1).stderr(named);
    let renewed = contains("Renewed: README.md, sweeps/schema/sweep.json.");
    renew(&[])
        .success()
        .stdout(renewed.and(contains("python/stubs.sh")));
    for name in FILES.split_whitespace() {
        let expected = fs::read_to_string(root().join(name)).unwrap();
        assert_eq!(fs::read_to_string(path(name)).unwrap(), expected, "{name}");
    }
    renew(&["--check"]).success();
    fs::write(path("README.md"), "No marks.").unwrap();
    let lacks = contains("README.md has no `<!-- commands: begin -->`");
    renew(&[]).code(1).stderr(lacks);
    fs::remove_file(path("README.md")).unwrap();
    renew(&[])
        .code(1)
        .stderr(contains("give the folder of the repository"));
}

#[test]
fn it_is_in_neither_help_nor_completions() {
    for arguments in [
        ["help", "--"],
        ["completions", "bash"],
        ["completions", "fish"],
    ] {
        let arguments = arguments.iter().filter(|word| **word != "--");
        let shown = program().args(arguments).assert().success();
        shown.stdout(contains("completions").and(contains("renew").not()));
    }
}
