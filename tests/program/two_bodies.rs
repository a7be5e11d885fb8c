//! An indenter that is not rigid: two bodies, and what each of them dissipates.

use crate::prelude::*;
use std::collections::HashSet;

/// A Zener solid as a creep series, of these compliances (1/Pa).
fn zener(header: &str, instantaneous: f64, branch: f64, time: f64) -> String {
    format!(
        "[{header}]\npoisson_ratio = 0.5\n[{header}.creep]\ncompliance = \"shear\"\ninstantaneous = {instantaneous:e}\n\
         branches = [{{ compliance = {branch:e}, time = {time:?} }}]\n"
    )
}

fn sweep_of(material: &str, indenter: &str) -> String {
    let text = include_str!("../inputs/two-bodies.toml").replace("# The body.\n", material);
    text.replace("# The indenter.\n", indenter)
}

/// The table of a sweep, and the resolved file.
fn run(text: &str) -> (Table, String) {
    let place = Place::new();
    (place.swept(text), place.text("out/resolved.toml"))
}

#[test]
fn two_equal_bodies_are_one_of_twice_the_compliance() {
    let equal = zener("indenter.material", 1e-9, 2e-9, 40.0);
    let (pair, _) = run(&sweep_of(&zener("material", 1e-9, 2e-9, 40.0), &equal));
    let (twice, _) = run(&sweep_of(&zener("material", 2e-9, 4e-9, 40.0), ""));
    // Every compliance is doubled exactly, by an addition or by the file.
    let same =
        "energy_loss_j approach_max_m contact_radius_max_m peak_pressure_max_pa dissipated_j";
    for column in same.split(' ') {
        assert_eq!(pair.cells(column), twice.cells(column), "{column}");
    }
    for row in 0..pair.len() {
        let [part, whole] = pair.row(row, ["dissipated_in_indenter_j", "dissipated_j"]);
        near!(part / whole, 0.5, 1e-12); // as written, to 15 digits or more
    }
    assert_eq!(twice.cells("dissipated_in_indenter_j"), ["", ""]);
}

#[test]
fn a_rigid_indenter_is_told_where_it_costs_more_than_the_error_bars() {
    let told = |indenter: &str, bars: bool| {
        let text = sweep_of("[material]\nlibrary = \"pmma\"\n", indenter);
        let text = text.replace("error_bars = false", &format!("error_bars = {bars}"));
        let place = Place::with("two.toml", &text);
        let said = words(&place.done("sweep two.toml --out out").stdout);
        let page = place.text("out/index.html");
        let note = "note: the indenter is taken as rigid: a steel one would add up to ";
        assert_eq!(said.contains(note), page.contains("a steel one would add"));
        said.split_once(note).map(|(_, rest)| rest.to_owned())
    };
    // (1 - 0.3^2)/210 GPa beside (1 - 0.38^2)/2.4 GPa.
    let note = told("", true).unwrap();
    let expected = "1.1 % to the compliance, which is more than the error bars of 2 of 2 cases";
    assert!(note.starts_with(expected), "{note}");
    assert_eq!(told("", false), None);
    let steel = "[indenter.material]\nlibrary = \"steel\"\n";
    assert_eq!(told(steel, true), None);
}

#[test]
fn each_body_dissipates_what_its_branches_do() {
    let (table, _) = run(&sweep_of(
        &zener("material", 1e-9, 2e-9, 40.0),
        &zener("indenter.material", 1e-9, 1e-9, 400.0),
    ));
    for row in 0..table.len() {
        let [base, indenter] = table.row(row, ["branch_1_loss_j", "branch_2_loss_j"]);
        let [of_indenter, loss] = table.row(row, ["dissipated_in_indenter_j", "energy_loss_j"]);
        assert_eq!(of_indenter, indenter);
        // Of 32 steps a cycle: the discretisation error of the loop.
        near!(base + indenter, loss, 0.01);
    }
}

#[test]
fn what_the_indenter_is_made_of_is_an_axis_like_any_number() {
    let pmma = "[material]\nlibrary = \"pmma\"\n";
    let elastic = |modulus: &str| {
        let block = format!("modulus = \"{modulus}\", poisson_ratio = 0.3");
        format!("[indenter.material]\nelastic = {{ {block} }}\n")
    };
    let over = |axis: &str| {
        let text = sweep_of(pmma, &elastic("210 GPa"));
        text.replace("[sweep]\n", &format!("[sweep]\n{axis}\n"))
    };
    let axis = "indenter.material.elastic.modulus = [\"3 GPa\", \"70 GPa\"]";
    let (table, resolved) = run(&over(axis));
    let alone = ["3 GPa", "70 GPa"].map(|modulus| run(&sweep_of(pmma, &elastic(modulus))).0);
    for column in ["energy_loss_j", "phase_lag_rad", "storage_modulus_pa"] {
        let alone = alone.each_ref().map(|alone| alone.cells(column)).concat();
        assert_eq!(table.cells(column), alone, "{column}");
    }
    let moduli = table.numbers("indenter_material_elastic_modulus_pa");
    assert_eq!(moduli, [3e9, 3e9, 70e9, 70e9]);
    assert_eq!(run(&resolved), (table, resolved));
    // Beside an axis of the body: every pair.
    let both = format!(
        "{axis}\ndrive.amplitude = [\"2 N\", \"5 N\"]\nmaterial.poisson_ratio = [0.3, 0.4]"
    );
    let pmma_of_ratio = "[material]\nlibrary = \"pmma\"\npoisson_ratio = 0.38\n";
    let (table, _) = run(&over(&both).replace(pmma, pmma_of_ratio));
    let losses: HashSet<_> = table.cells("energy_loss_j").into_iter().collect();
    assert_eq!((table.len(), losses.len()), (16, 16));
}
