//! Nothing in any figure covers anything else: texts, data, rings, leaders and legends, measured where their ink is, at every size of a
//! journal.

use crate::prelude::*;
use crate::{folders, sweep_figures};
use contact_dma::report::figure::units::Units;
use contact_dma::report::figure::{Figure, Picture, of_sweep};
use contact_dma::report::kept_figures::KeptFigures;
use contact_dma::report::scenario;
use contact_dma::report::scenario_tables::History;
use contact_dma::sweep::plan::figures::FigurePlan;
use contact_dma::sweep::search::run::{self, Mode};
use contact_dma::sweep::store::Store;

const WIDTHS_MM: [f64; 4] = [60.0, 84.0, 120.0, 174.0];
const SIZES_PT: [f64; 4] = [6.0, 8.0, 10.0, 12.0];

/// Pictures by the names of their figures, after what they are of.
type Pictures = Vec<(String, Picture)>;

fn named(of: &str, figures: Vec<Figure>) -> Pictures {
    let named = |figure: Figure| (format!("{of}/{}", figure.name), figure.picture);
    figures.into_iter().map(named).collect()
}

fn of_sweep(name: &str, plan: SweepPlan) -> Pictures {
    let folder = TempDir::new().unwrap();
    let setup = Setup::new(plan).unwrap();
    let store = Store::open(folder.path(), "a sweep", false).unwrap();
    let never = AtomicBool::new(false);
    let outcome = run::run(&setup, &store, Mode::on_threads(2), &never, &()).unwrap();
    let (figures, _) = of_sweep::figures(setup.plan(), &outcome).unwrap();
    named(name, figures)
}

/// The figures that a command keeps in the folder that it writes.
fn kept(place: &Place, command: &str) -> Pictures {
    place.done(&format!("{command} --out out"));
    let kept = KeptFigures::read(&place.bytes("out/records/figures.json")).unwrap();
    fs::remove_dir_all(place.path("out")).unwrap();
    let pictures = kept.into_pictures();
    pictures
        .map(|(name, picture)| (format!("{command}: {name}"), picture))
        .collect()
}

fn of_history(name: &str) -> Pictures {
    let inputs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/inputs");
    let simulation = plans::history(&fs::read_to_string(inputs.join(name)).unwrap());
    let history = History::from(followed(&simulation));
    let units = Units::of_scenario(simulation.plan()).unwrap();
    named(name, scenario::lines(&history, &units).0)
}

/// What overlaps in these pictures at every size, and those that cannot be drawn at a size that the program takes.
fn faults(pictures: &Pictures) -> Vec<String> {
    /// A figure is at least as wide in px of its text, or is refused when its size is read.
    const LEAST_WIDTH_PX: f64 = 320.0;
    let sizes = WIDTHS_MM
        .into_iter()
        .flat_map(|mm| SIZES_PT.map(|pt| (mm, pt)));
    let mut faults = Vec::new();
    for (width_mm, pt) in sizes {
        let plan = FigurePlan {
            width_m: Some(1e-3 * width_mm),
            font_size_pt: Some(pt),
            ..FigurePlan::default()
        };
        for (name, picture) in pictures {
            let is_taken = width_mm / 25.4 * 72.0 / pt * 16.0 >= LEAST_WIDTH_PX;
            match picture.as_asked(&plan, "") {
                Ok(drawing) => {
                    let overlaps = drawing.overlaps();
                    faults.extend(
                        overlaps
                            .iter()
                            .map(|overlap| format!("{name} at {width_mm} mm, {pt} pt: {overlap}")),
                    );
                }
                Err(error) if is_taken => {
                    faults.push(format!("{name} at {width_mm} mm, {pt} pt: {error}"));
                }
                Err(_) => {}
            }
        }
    }
    faults
}

#[track_caller]
fn nothing_overlaps(pictures: &Pictures) {
    let faults = faults(pictures);
    assert!(
        faults.is_empty(),
        "{} of {} pictures:\n{}",
        faults.len(),
        pictures.len(),
        faults.join("\n")
    );
}

#[test]
fn nothing_overlaps_in_figures_of_sweeps() {
    // Nine frequencies over four decades, and three over less than one.
    let wide: Vec<f64> = (0..9)
        .map(|k| 1e-4 * 10_f64.powf(f64::from(k) / 2.0))
        .collect();
    let one = of_sweep("one curve", sweep_figures::pmma(&[0.004, 0.008, 0.02]));
    let several = sweep_figures::with_amplitudes(sweep_figures::pmma(&wide), &[0.5, 2.0, 8.0]);
    nothing_overlaps(&[one, of_sweep("amplitudes", several)].concat());
}

#[test]
fn nothing_overlaps_in_figures_of_histories() {
    nothing_overlaps(&["springs.toml", "cells.toml"].map(of_history).concat());
}

#[test]
fn nothing_overlaps_in_figures_of_measurements_materials_and_comparisons() {
    let place = folders::inputs();
    let commands = [
        "analyse raw/0.csv",
        "identify identify.toml",
        "material show pmma",
        "material fit creep.csv --quantity creep --modulus longitudinal --poisson-ratio 0.4",
        "material fit dma.csv --quantity dynamic --modulus shear --poisson-ratio 0.4",
        "compare swept swept",
    ];
    nothing_overlaps(&commands.map(|command| kept(&place, command)).concat());
}
