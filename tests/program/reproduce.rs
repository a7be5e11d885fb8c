//! The figures of the base paper: made again from the files of `sweeps/spinu-2018/`, compared byte for byte with what is
//! committed in `reports/spinu-2018/`; and every claim held to the accuracy it needs.

#![cfg(feature = "cli")]

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::html::{assert_stands_alone, data};
use crate::program::program;
use predicates::str::contains;
use tempfile::TempDir;

/// All figures, made once for all tests of this file by the command itself.
static MADE: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = TempDir::new().unwrap();
    program()
        .args(["reproduce", "--quiet", "--out"])
        .arg(folder.path())
        .assert()
        .success()
        .stdout("");
    folder
});

fn committed() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reports/spinu-2018")
}

/// All but the lock, which is there for commands that run.
fn names(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    let name = |entry: fs::DirEntry| entry.file_name().into_string().unwrap();
    let names = entries.map(|entry| name(entry.unwrap()));
    names.filter(|name| name != ".contact-dma.lock").collect()
}

/// The rows of a claim table by the names of its columns.
fn claims() -> Vec<std::collections::BTreeMap<String, String>> {
    let mut table = csv::Reader::from_path(MADE.path().join("claims.csv")).unwrap();
    table.deserialize().map(|row| row.unwrap()).collect()
}

#[test]
fn what_is_committed_is_what_the_command_writes() {
    let (made, kept) = (names(MADE.path()), names(&committed()));
    assert_eq!(made, kept);
    // Eleven figures in four files each, the claims, the text, the page; and their list, which names the build that made them.
    assert_eq!(made.len(), 48);
    for name in made.into_iter().filter(|name| name != "run.json") {
        let found = fs::read(MADE.path().join(&name)).unwrap();
        let expected = fs::read(committed().join(&name)).unwrap();
        if found != expected {
            let [found, expected] =
                [found, expected].map(|b| String::from_utf8_lossy(&b).into_owned());
            let lines = found.lines().zip(expected.lines());
            let different = lines.filter(|(a, b)| a != b).take(3).collect::<Vec<_>>();
            panic!("{name} differs from what is committed: {different:#?}");
        }
    }
}

#[test]
fn every_claim_is_as_accurate_as_it_must_be() {
    let claims = claims();
    let mut checked = 0;
    for claim in &claims {
        assert_eq!(claim["within_accuracy"], "yes", "{claim:#?}");
        checked += usize::from(!claim["half_space"].is_empty());
    }
    // Every number but the constants of the creep function is computed on the half-space.
    assert!(checked + 6 >= claims.len() && checked > 80, "{checked}");
}

#[test]
fn the_page_holds_every_figure_and_every_claim_and_stands_alone() {
    let page = fs::read_to_string(MADE.path().join("index.html")).unwrap();
    assert!(page.len() < 1_500_000, "{}", page.len());
    assert_stands_alone(&page);
    let claims = claims();
    assert_eq!(page.matches("<tr data-verdict=").count(), claims.len());
    let table = fs::read_to_string(MADE.path().join("claims.csv")).unwrap();
    assert_eq!(data(&page)["csv"], table);
    assert_eq!(page.matches("<svg ").count(), 11);
    for claim in &claims {
        let row = format!("<tr data-verdict=\"{}\">", claim["verdict"]);
        assert!(page.contains(&row));
    }
    // Every file behind the figures can be downloaded.
    assert_eq!(page.matches(" download=\"figure-").count(), 17);
}

#[test]
fn every_computed_figure_has_claims() {
    let figures: BTreeSet<String> = claims()
        .iter()
        .map(|claim| claim["figure"].clone())
        .collect();
    let expected = [1, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13].map(|n: u8| n.to_string());
    assert_eq!(figures, BTreeSet::from(expected));
}

#[test]
fn what_disagrees_with_the_paper_is_known() {
    let disagreeing: Vec<(String, String)> = claims()
        .into_iter()
        .filter(|claim| claim["verdict"] == "disagrees")
        .map(|claim| (claim["figure"].clone(), claim["quantity"].clone()))
        .collect();
    let figures: Vec<&str> = disagreeing
        .iter()
        .map(|(figure, _)| figure.as_str())
        .collect();
    // The frequency in the caption of figure 9; the loss that only decays in figure 12; the four numbers of figure 13.
    assert_eq!(
        figures,
        ["9", "12", "13", "13", "13", "13"],
        "{disagreeing:?}"
    );
}

#[test]
fn one_figure_alone_is_the_same_figure() {
    let folder = TempDir::new().unwrap();
    program()
        .args(["reproduce", "--figure", "1", "--threads", "1", "--out"])
        .arg(folder.path())
        .assert()
        .success()
        .stdout(contains("1 figures: 7 numbers of the paper (7 agree)"));
    let expected = [
        "README.md",
        "claims.csv",
        "figure-01.caption.txt",
        "figure-01.csv",
        "figure-01.png",
        "figure-01.svg",
        "index.html",
        "run.json",
    ];
    assert_eq!(
        names(folder.path()),
        BTreeSet::from(expected.map(str::to_owned))
    );
    for name in &expected[2..6] {
        let [found, kept] = [folder.path(), &committed()].map(|f| fs::read(f.join(name)).unwrap());
        assert!(found == kept, "{name}");
    }
}

#[test]
fn the_page_shows_its_figures_in_whatever_form_they_are_written() {
    let folder = TempDir::new().unwrap();
    program()
        .args(["reproduce", "--figure", "1", "--quiet", "--out"])
        .arg(folder.path())
        .args(["--set", "figures.formats=[\"pdf\"]"])
        .assert()
        .success();
    assert!(names(folder.path()).contains("figure-01.pdf"));
    assert!(!names(folder.path()).contains("figure-01.svg"));
    let page = fs::read_to_string(folder.path().join("index.html")).unwrap();
    assert!(page.contains("<svg"));
}

#[test]
fn a_figure_that_is_not_computed_is_refused_with_those_that_are() {
    for (number, why) in [
        ("2", "it is a flowchart"),
        ("14", "figures 1 to 13"),
        ("all", "computed"),
    ] {
        let folder = TempDir::new().unwrap();
        let out = folder.path().join("out");
        program()
            .args(["reproduce", "--figure", number, "--out"])
            .arg(&out)
            .assert()
            .code(2)
            .stdout("")
            .stderr(contains(why))
            .stderr(contains("1, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13"));
        assert!(!out.exists());
    }
}

#[test]
fn every_file_behind_a_figure_says_what_it_asks() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/spinu-2018");
    let mut files = names(&folder);
    assert!(files.remove("claims.toml"), "what the paper states");
    assert_eq!(files.len(), 17);
    for name in files {
        let text = fs::read_to_string(folder.join(&name)).unwrap();
        let first = text.lines().next().unwrap();
        assert!(
            first.starts_with("# ") && first.ends_with('?'),
            "{name}: {first}"
        );
    }
}
