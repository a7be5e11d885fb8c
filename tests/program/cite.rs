//! What `cite` prints for folders of every command, and the manual pages.

use crate::prelude::*;

#[test]
fn without_a_folder_the_program_and_the_paper_are_cited() {
    let place = Place::new();
    let run = place.done("cite");
    run.says(&[
        "For the program:",
        "contact-dma",
        "version 0.1.0",
        "For the paper that is implemented:",
        "S. Spinu, Viscoelastic Contact Simulation",
        "doi:10.1155/2018/9432894",
    ]);
    let json = place.done("cite --format json").json();
    assert_eq!(json["citations"].as_array().unwrap().len(), 2);
}

#[test]
fn a_sweep_names_its_method_and_the_source_of_its_material() {
    let place = Place::with("small.toml", include_str!("../inputs/three.toml"));
    place.done("sweep small.toml --quiet --no-figures --out springs");
    let springs = place.done("cite springs").stdout;
    says(&springs, &["Popov"]);
    assert!(!springs.contains("Polonsky"), "{springs}");
    let cells = "--set solver.engine=half-space --set solver.springs= --set solver.cells=32";
    place.ends(
        &format!("sweep small.toml --quiet --no-figures --out cells {cells}"),
        0,
    );
    let cells = place.done("cite cells").stdout;
    says(&cells, &["Polonsky", "Love"]);
    assert!(!cells.contains("Popov"), "{cells}");
    // Of a bibliography every entry is closed, and none stands twice.
    let bibtex = place.done("cite cells --bibtex").stdout;
    let keys: Vec<&str> = bibtex
        .lines()
        .filter(|line| line.starts_with('@'))
        .collect();
    let once: BTreeSet<&&str> = keys.iter().collect();
    assert!(keys.len() > 3 && once.len() == keys.len(), "{bibtex}");
    assert_eq!(bibtex.matches('{').count(), bibtex.matches('}').count());
}

#[test]
fn laws_of_temperature_are_cited_where_a_material_has_them() {
    let pvb = include_str!("../inputs/three.toml").replace("pmma", "pvb");
    let place = Place::with("pvb.toml", &pvb);
    place.done("sweep pvb.toml --quiet --no-figures --out pvb");
    let cited = place.done("cite pvb").stdout;
    says(&cited, &["material pvb", "van Duser", "Landel"]);
    // Its series was taken from a table: nobody has shifted isotherms here.
    assert!(!cited.contains("Gergesova"), "{cited}");
}

#[test]
fn what_is_no_result_is_refused() {
    let place = Place::with("notes.txt", "mine");
    says(
        &place.ends("cite .", 2),
        &["holds no result of this program"],
    );
    place.ends("cite nowhere", 2);
}

#[test]
fn every_command_has_a_manual_page_that_man_could_show() {
    let place = Place::new();
    place.done("man pages");
    let pages = place.path("pages");
    let names = fs::read_dir(&pages).unwrap();
    let names: BTreeSet<String> = names
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    for name in ["", "-sweep", "-material-fit", "-compare", "-cite", "-man"] {
        assert!(names.contains(&format!("contact-dma{name}.1")), "{names:?}");
    }
    assert!(
        !names.iter().any(|name| name.contains("renew")),
        "{names:?}"
    );
    for name in &names {
        let page = place.text(&format!("pages/{name}"));
        says(&page, &[".TH contact", ".SH NAME", ".SH SYNOPSIS"]);
    }
    says(&place.text("pages/contact-dma.1"), &["130", "Exit codes"]);
}
