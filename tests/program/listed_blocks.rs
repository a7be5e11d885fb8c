//! Several materials or indenters by name in one sweep: the cases are those of sweeps of their own, to the last bit.

use crate::prelude::*;
use contact_dma::engine::EngineKind;

/// What all sweeps of this file have in common; `[sweep]` is open at its end.
const COMMON: &str = include_str!("../inputs/several.toml");

/// Materials by name: a header for each key, `HEAD` being where the block stands.
const MATERIALS: [(&str, &str); 3] = [
    ("pmma", "library = \"pmma\"\n"),
    (
        "dry, \"as made\"",
        "poisson_ratio = 0.4\n[HEAD.zener]\nspring = \"1 GPa\"\nkelvin_spring = \"0.5 GPa\"\ntime = \"1 s\"\n",
    ),
    (
        "warm",
        "poisson_ratio = 0.4\ntemperature = \"20 °C\"\n[[HEAD.isotherm]]\ntemperature = \"20 °C\"\nwlf = [8.86, 101.6]\n\
         modulus = \"shear\"\nequilibrium = \"1 MPa\"\nbranches = [{ modulus = \"9 MPa\", time = \"1 s\" }]\n",
    ),
];

const INDENTERS: [(&str, &str); 3] = [
    ("ball", "shape = \"sphere\"\nradius = \"10 mm\"\n"),
    (
        "glass cone",
        "shape = \"cone\"\nhalf_angle = \"80 deg\"\n[HEAD.material]\nlibrary = \"glass\"\n",
    ),
    (
        "lens",
        "shape = \"ellipsoid\"\nradius_x = \"10 mm\"\nradius_y = \"20 mm\"\n",
    ),
];

/// A block by itself.
fn alone(block: &str, (_, text): (&str, &str)) -> String {
    format!("[{block}]\n{}", text.replace("HEAD", block))
}

/// Blocks in a list.
fn listed(block: &str, all: &[(&str, &str)]) -> String {
    let one = |(name, text): &(&str, &str)| {
        // One of the library has a name already.
        let name = match text.starts_with("library") {
            true => String::new(),
            false => format!("name = '{name}'\n"),
        };
        let text = text.replace("HEAD", &format!("sweep.{block}"));
        format!("[[sweep.{block}]]\n{name}{text}")
    };
    all.iter().map(one).collect()
}

/// Holds a sweep to the separate ones that it is made of, and so what its resolved text gives.
fn assert_is_all_of(text: &str, separate: &[String]) {
    let results = |plan: &SweepPlan| plans::results(plan.clone());
    let expected = separate
        .iter()
        .flat_map(|text| results(&plans::sweep(text)));
    let expected: Vec<_> = expected.collect();
    let plan = plans::sweep(text);
    assert!(results(&plan) == expected, "{text}");
    assert!(results(&plans::again(&plan)) == expected, "{text}");
}

#[test]
fn the_cases_are_those_of_every_material_under_every_indenter() {
    let indenters = &INDENTERS[..2];
    let lists = [
        listed("material", &MATERIALS),
        listed("indenter", indenters),
    ];
    let text = format!("{COMMON}{}", lists.concat());
    let separate = MATERIALS.iter().flat_map(|material| {
        let under = |indenter: &(&str, &str)| {
            let (material, indenter) = (alone("material", *material), alone("indenter", *indenter));
            format!("{COMMON}{material}{indenter}")
        };
        indenters.iter().map(under)
    });
    assert_is_all_of(&text, &separate.collect::<Vec<_>>());
}

#[test]
fn numbers_vary_beside_a_list_all_combined_or_in_pairs() {
    let sphere = alone("indenter", INDENTERS[0]);
    let warm = [MATERIALS[2], ("warmer", MATERIALS[2].1)];
    let at = |celsius: &str| {
        let material = alone("material", warm[0]);
        let other = format!("temperature = \"{celsius} °C\"\n[[material.");
        material.replacen("temperature = \"20 °C\"\n[[material.", &other, 1)
    };
    let with_sphere = |material: String| format!("{COMMON}{material}{sphere}");
    let list = listed("material", &warm);
    let temperatures = "\"material.temperature\" = [\"40 °C\", \"25 °C\"]\n";
    let separate = ["25", "40", "25", "40"].map(at).map(with_sphere);
    assert_is_all_of(&format!("{COMMON}{temperatures}{list}{sphere}"), &separate);
    // Pairs are in the order of their numbers.
    let balls = [
        ("small", INDENTERS[0].1),
        ("large", "shape = \"sphere\"\nradius = \"20 mm\"\n"),
    ];
    let pmma = alone("material", MATERIALS[0]);
    let list = listed("indenter", &balls);
    let pairs = format!("{COMMON}pairs = true\n\"drive.amplitude\" = [0.7, 0.2]\n{pmma}{list}");
    let under = |(amplitude, ball): (&str, (&str, &str))| {
        let common = COMMON.replace("0.5 N", amplitude);
        format!("{common}{pmma}{}", alone("indenter", ball))
    };
    let separate = [("0.2 N", balls[1]), ("0.7 N", balls[0])].map(under);
    assert_is_all_of(&pairs, &separate);
    let names = plans::sweep(&pairs).axes.unwrap().over[0].names.clone();
    assert_eq!(names.to_vec(), ["large", "small"]);
}

#[test]
fn where_one_indenter_needs_cells_all_are_on_cells() {
    let pmma = alone("material", MATERIALS[0]);
    let lenses = [INDENTERS[0], INDENTERS[2]];
    let text = format!("{COMMON}{pmma}{}", listed("indenter", &lenses));
    assert_eq!(plans::sweep(&text).solver.engine, EngineKind::HalfSpace);
    let on_cells = COMMON.replace("[solver]", "[solver]\nengine = \"half-space\"");
    let under = |indenter| format!("{on_cells}{pmma}{}", alone("indenter", indenter));
    assert_is_all_of(&text, &lenses.map(under));
}

#[test]
fn tables_figures_and_comparisons_go_by_the_names() {
    let place = Place::new();
    let sphere = alone("indenter", INDENTERS[0]);
    let [pmma, dry, _] = MATERIALS;
    for (name, materials) in [
        ("one", &[pmma, dry][..]),
        ("other", &[dry, pmma]),
        ("less", &[dry]),
    ] {
        let list = listed("material", materials);
        place.put(&format!("{name}.toml"), format!("{COMMON}{sphere}{list}"));
        place.done(&format!("sweep {name}.toml --quiet --out {name}"));
    }
    let table = place.table("one/sweep.csv");
    assert_eq!(table.cells("material"), [pmma.0, pmma.0, dry.0, dry.0]);
    let caption = place.text("one/figures/energy-loss.caption.txt");
    says(&caption, &["2 curves, one per material"]);
    // Names have no order to draw along.
    assert!(!place.has("one/figures/loss-map.svg") && !place.has("one/figures/peaks.svg"));
    let same = place.done("compare one other");
    same.says(&["4 cases in both results"]);
    let differs = place.run("compare one less").ended(4);
    differs.says(&["(pmma, mean 1, amplitude 0.5)"]);
}
