//! Names and titles that could command a terminal, a spreadsheet or an SVG are refused; figures that cannot be drawn, or lack letters,
//! are warnings beside the finished result.

use crate::prelude::*;

/// A cheap sweep of one frequency.
const ONE: &str = "[sweep]\nangular_frequency = \"0.01 rad/s\"\n[cycle]\nsteps = 16\nerror_bars = false\n[solver]\nsprings = 16\n";

#[test]
fn letters_that_the_typeface_lacks_are_said() {
    let place = Place::lent("letters.toml");
    let run = place.done(&format!("sweep letters.toml --out out {SVG}"));
    run.says(&["does not have 料 材"]);
}

#[test]
fn an_underscore_in_a_name_sets_no_subscript() {
    let place = Place::lent("letters.toml");
    let text = place.text("letters.toml").replace("材料", "poly_2");
    place.put("letters.toml", text);
    place.done(&format!(
        "sweep letters.toml --out out {SVG} --set figures.svg_text=text"
    ));
    let svg = place.text("out/figures/energy-loss.svg");
    assert!(svg.contains(">poly_2</text>"), "{svg}");
    assert!(
        place
            .text("out/figures/energy-loss.caption.txt")
            .contains("poly_2")
    );
}

#[test]
fn a_name_with_the_letters_of_a_header_stays_as_it_is() {
    let body = "[indenter.material]\nname = \"steel [material 4]\"\nelastic = { modulus = \"210 GPa\", poisson_ratio = 0.3 }\n";
    let place = Place::new();
    place.swept(&pmma_sweep(ONE).replace("[drive]", &format!("{body}[drive]")));
    let resolved = place.text("out/resolved.toml");
    assert!(resolved.contains("[indenter.material]"), "{resolved}");
    assert!(resolved.contains("\"steel [material 4]\""), "{resolved}");
}

/// A strip too narrow for a map with labels.
#[test]
fn a_figure_that_cannot_be_drawn_is_a_warning_beside_a_finished_history() {
    let row: Vec<String> = (0..256)
        .map(|x| format!("{:e}", 1e-8 * f64::from(x % 64)))
        .collect();
    let place = Place::with("map.csv", &vec![row.join(","); 16].join("\n"));
    place.lend("strip.toml");
    let run = place.done(&format!("simulate strip.toml --out out {SVG}"));
    run.says(&["no figure pressure-map"]);
    for name in ["history.csv", "index.html", "figures/history.svg"] {
        assert!(place.has(&format!("out/{name}")), "{name}");
    }
}

#[test]
fn an_angle_is_told_in_degrees_everywhere() {
    let axis = "[sweep]\ndrive.phase = { from = \"-30 deg\", to = \"10 deg\", points = 2, spacing = \"linear\" }";
    let frequencies = "[\"0.005 rad/s\", \"0.008 rad/s\", \"0.02 rad/s\"]";
    let text = pmma_sweep(ONE).replace("[sweep]", axis);
    let place = Place::with("angle.toml", &text.replace("\"0.01 rad/s\"", frequencies));
    let printed = place
        .done(&format!("sweep angle.toml --out out {SVG}"))
        .stdout;
    let caption = place.text("out/figures/energy-loss.caption.txt");
    assert!(printed.contains("phase 10°"), "{printed}");
    assert!(caption.contains("-30° to 10°"), "{caption}");
    assert!(!(printed + &caption).contains("0.5236"));
}
