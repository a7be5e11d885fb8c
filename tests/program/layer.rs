//! A layer in sweep files: what is told of it.

use crate::prelude::*;
use contact_dma::quantity::{Dimension, format_si};

const SWEEP: &str = "title = \"t\"\n[material]\nlibrary = \"pmma\"\n[layer]\nthickness = \"10 um\"\nbase = \"frictionless\"\n\
                     [indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n[drive]\nmean = \"10 N\"\namplitude = \"1 N\"\n\
                     [sweep]\nangular_frequency = [\"0.01 rad/s\"]\n[cycle]\nsteps = 20\nerror_bars = false\n";

#[test]
fn a_layer_is_solved_on_cells_where_nothing_else_is_asked_for() {
    let place = Place::with("layer.toml", SWEEP);
    place.done("sweep layer.toml --quiet --set solver.cells=24 --out out");
    let thickness = format_si(1e-5, Dimension::Length);
    let block = format!("[layer]\nthickness = \"{thickness}\"\nbase = \"frictionless\"\n");
    assert!(place.text("out/resolved.toml").contains(&block));
    let page = place.text("out/index.html");
    assert!(page.contains("a layer on a rigid base without friction"));
    // 10 N press a sphere of 10 mm in by more than a micrometre of ten.
    assert!(place.text("out/sweep.csv").contains("deep-in-layer"));
}

#[test]
fn a_base_that_yields_is_told() {
    let sweep = |ratio: f64| {
        let base = format!("base_modulus_ratio = {ratio}\nbase_poisson_ratio = 0.4");
        SWEEP.replace("base = \"frictionless\"", &base)
    };
    let place = Place::with("layer.toml", &sweep(4.0));
    let run = "sweep layer.toml --quiet --set solver.cells=24 --out out";
    place.done(run);
    let resolved = place.text("out/resolved.toml");
    assert!(resolved.contains("base_modulus_ratio = 4.0\nbase_poisson_ratio = 0.4\n"));
    let page = place.text("out/index.html");
    assert!(page.contains("bonded to a base of 4 times its shear modulus"));
    // Other numbers of the base are another sweep.
    place.put("layer.toml", sweep(5.0));
    place.refused(run);
}
