//! The figures of the base paper: made again from the files of `sweeps/spinu-2018/`, compared byte for byte with what is
//! committed in `reports/spinu-2018/`; and every claim held to the accuracy it needs.

use crate::prelude::*;
use std::sync::LazyLock;

use crate::html::{assert_stands_alone, data};

/// All figures, made once for all tests of this file by the command itself.
static MADE: LazyLock<Place> = LazyLock::new(|| {
    let place = Place::new();
    let run = place.done("reproduce --quiet --out .");
    assert_eq!(run.stdout, "");
    place
});

/// Those that are computed.
const FIGURES: [&str; 11] = ["1", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13"];

/// The files that the figures are computed from, without the one that says what they show.
fn behind_figures() -> Vec<PathBuf> {
    let mut files = below(
        &Path::new(env!("CARGO_MANIFEST_DIR")).join("sweeps/spinu-2018"),
        "",
    );
    files.retain(|path| !path.ends_with("figures.toml"));
    files
}

fn committed() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("reports/spinu-2018")
}

/// All but the lock, which is there for commands that run.
fn names(folder: &Path) -> BTreeSet<String> {
    let names = files(folder).into_keys();
    names.filter(|name| name != ".contact-dma.lock").collect()
}

/// The numbers of the paper that are claimed.
fn claims() -> Table {
    MADE.table("claims.csv")
}

#[test]
fn what_is_committed_is_what_the_command_writes() {
    let (made, kept) = (names(&MADE.path("")), names(&committed()));
    assert_eq!(made, kept);
    for name in made.into_iter().filter(|name| name != "run.json") {
        let found = MADE.bytes(&name);
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
    let mut accurate = claims.cells("within_accuracy").into_iter();
    assert!(accurate.all(|cell| cell == "yes"), "{claims:#?}");
    // Every number but the constants of the creep function is computed on the half-space.
    let on_cells = claims.cells("half_space");
    let checked = on_cells.iter().filter(|cell| !cell.is_empty()).count();
    assert!(checked + 6 >= claims.len() && checked > 80, "{checked}");
}

#[test]
fn the_page_holds_every_figure_and_every_claim_and_stands_alone() {
    let page = MADE.text("index.html");
    assert!(page.len() < 1_500_000, "{}", page.len());
    assert_stands_alone(&page);
    let claims = claims();
    assert_eq!(page.matches("<tr data-verdict=").count(), claims.len());
    assert_eq!(data(&page)["csv"], MADE.text("claims.csv"));
    assert_eq!(page.matches("<svg ").count(), FIGURES.len());
    for verdict in claims.cells("verdict") {
        assert!(page.contains(&format!("<tr data-verdict=\"{verdict}\">")));
    }
    // Every file behind the figures can be downloaded.
    let downloads = page.matches(" download=\"figure-").count();
    assert_eq!(downloads, behind_figures().len());
}

#[test]
fn every_computed_figure_has_claims() {
    let claims = claims();
    let figures: BTreeSet<&str> = claims.cells("figure").into_iter().collect();
    assert_eq!(figures, BTreeSet::from(FIGURES));
}

#[test]
fn what_disagrees_with_the_paper_is_known() {
    let claims = claims();
    let mut figures = claims.cells("figure");
    let mut verdicts = claims.cells("verdict").into_iter();
    figures.retain(|_| verdicts.next() == Some("disagrees"));
    // The frequency in the caption of figure 9; the loss that only decays in figure 12; the four numbers of figure 13.
    assert_eq!(figures, ["9", "12", "13", "13", "13", "13"], "{claims:?}");
}

#[test]
fn one_figure_alone_is_the_same_figure() {
    let place = Place::new();
    let run = place.done("reproduce --figure 1 --threads 1 --out .");
    run.says(&["1 figures: 7 numbers of the paper (7 agree)"]);
    let figure =
        ["caption.txt", "csv", "png", "svg"].map(|ending| format!("figures/figure-01.{ending}"));
    let rest = ["README.md", "claims.csv", "index.html", "run.json"].map(str::to_owned);
    let expected = figure.iter().chain(&rest).cloned().collect();
    assert_eq!(names(&place.path("")), expected);
    for name in figure {
        let same = place.bytes(&name) == fs::read(committed().join(&name)).unwrap();
        assert!(same, "{name}");
    }
}

#[test]
fn the_page_shows_its_figures_in_whatever_form_they_are_written() {
    let place = Place::new();
    place.done("reproduce --figure 1 --quiet --out . --set 'figures.formats=[\"pdf\"]'");
    assert!(place.has("figures/figure-01.pdf") && !place.has("figures/figure-01.svg"));
    assert!(place.text("index.html").contains("<svg"));
}

#[test]
fn every_file_behind_a_figure_says_what_it_asks() {
    let files = behind_figures();
    assert!(files.len() > FIGURES.len());
    for path in files {
        let text = fs::read_to_string(&path).unwrap();
        let first = text.lines().next().unwrap();
        let is_question = first.starts_with("# ") && first.ends_with('?');
        assert!(is_question, "{}: {first}", path.display());
    }
}
