//! `bulk_modulus` in place of `poisson_ratio` in the files: what comes of it.

use crate::prelude::*;

fn sweep(material: &str) -> String {
    format!(
        "title = \"t\"\n[material]\n{material}\n[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n[drive]\nmean = \"1 N\"\n\
         amplitude = \"0.1 N\"\n[sweep]\nangular_frequency = [\"0.1 rad/s\", \"10 rad/s\"]\n[cycle]\nsteps = 20\nerror_bars = false\n"
    )
}

const SERIES: &str = "relaxation = { modulus = \"KIND\", equilibrium = \"2 MPa\", branches = [{ modulus = \"900 MPa\", time = \"1 s\" }] }";

fn series(kind: &str) -> String {
    SERIES.replace("KIND", kind)
}

#[test]
fn a_resolved_sweep_of_either_kind_of_moduli_gives_the_same_losses_again() {
    for kind in ["shear", "longitudinal"] {
        let place = Place::new();
        let material = format!("bulk_modulus = \"3 GPa\"\n{}", series(kind));
        let table = place.swept(&sweep(&material));
        let resolved = place.text("out/resolved.toml");
        says(&resolved, &["bulk_modulus = \"3000000000 Pa\""]);
        assert!(!resolved.contains("poisson_ratio"));
        assert_eq!(place.swept(&resolved), table);
        assert_eq!(place.text("out/resolved.toml"), resolved);
    }
}

#[test]
fn the_material_shows_how_its_poisson_ratio_grows() {
    // (3K - 2G)/(2(3K + G)) of 902 MPa and of 2 MPa.
    let parts = ["Bulk modulus 3 GPa", " 0 0.3634", "inf 0.4997"];
    let place = Place::lent("bulk-modulus.toml");
    place.done("material show bulk-modulus.toml").says(&parts);
}
