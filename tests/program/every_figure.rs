//! Every kind of figure that the program draws, from small inputs. At every size of a journal nothing in any of them covers anything
//! else: texts, data, rings, leaders and legends, measured where their ink is. And each looks as it did: `tests/figures.txt` has them in
//! letters, so small that a curve more or an axis upside down is seen and a hair's breadth is not.
//!
//! `RENEW=1 cargo test --test program every_figure` writes that file anew, and with it the sheets of reports/figures, to be looked at.

use std::sync::LazyLock;

use crate::input_keys::{assert_current, is_renewed, root};
use crate::prelude::*;
use crate::{folders, sweep_figures};
use contact_dma::drive::HarmonicDrive;
use contact_dma::engine::EngineKind;
use contact_dma::figures::paper::resolution;
use contact_dma::indenter::Sphere;
use contact_dma::report::chart::Drawing;
use contact_dma::report::figure::units::Units;
use contact_dma::report::figure::{Figure, Picture, of_sweep, pressure_map};
use contact_dma::report::kept_figures::KeptFigures;
use contact_dma::report::scenario;
use contact_dma::report::scenario_tables::History;
use contact_dma::sweep::plan::adhesion::AdhesionPlan;
use contact_dma::sweep::plan::figures::{Colors, FigurePlan};
use contact_dma::sweep::search::run::{self, Mode};
use contact_dma::sweep::store::Store;
use rayon::prelude::*;
use resvg::tiny_skia::{Color, Pixmap, PixmapPaint, Transform};

const WIDTHS_MM: [f64; 4] = [60.0, 84.0, 120.0, 174.0];
const SIZES_PT: [f64; 4] = [6.0, 8.0, 10.0, 12.0];

/// Pictures by the names of their figures, after what they are of.
type Pictures = Vec<(String, Picture)>;

/// All of them.
static EVERY: LazyLock<Pictures> = LazyLock::new(|| {
    let parts: [fn() -> Pictures; 3] = [of_sweeps, of_histories, of_commands];
    parts.into_par_iter().flat_map(|part| part()).collect()
});

fn named(of: &str, figures: impl IntoIterator<Item = Figure>) -> Pictures {
    let named = |figure: Figure| (format!("{} ({of})", figure.name), figure.picture);
    figures.into_iter().map(named).collect()
}

/// One curve; over amplitudes, with maps; the same at one frequency; and on cells, whose work is a map over the surface.
fn of_sweeps() -> Pictures {
    // Nine frequencies over four decades, and three over less than one.
    let wide: Vec<f64> = (0..9)
        .map(|k| 1e-4 * 10_f64.powf(f64::from(k) / 2.0))
        .collect();
    let few = sweep_figures::pmma(&[0.004, 0.008, 0.02]);
    let amplitudes = [0.5, 2.0, 6.0, 9.5];
    let at = |frequencies: &[f64]| {
        sweep_figures::with_amplitudes(sweep_figures::pmma(frequencies), &amplitudes)
    };
    let mut cells = few.clone();
    (cells.solver.engine, cells.solver.cells) = (EngineKind::HalfSpace, 24);
    let attracted = |drive: HarmonicDrive, omegas: &[f64]| {
        let mut plan = sweep_figures::pmma(omegas);
        plan.base.contact.indenter = Arc::new(Sphere::new(1e-6).unwrap());
        plan.base.contact.adhesion = Some(AdhesionPlan {
            range_m: Some(1e-9),
            ..AdhesionPlan::of_work(0.05)
        });
        plan.base.drive = drive.attracted_by(f64::INFINITY).unwrap();
        (plan.cycle.steps, plan.solver.springs) = (64, 100);
        plan
    };
    let load = HarmonicDrive::load(1e-7, 0.8e-7).unwrap();
    let approach = HarmonicDrive::approach(0.0, 10e-9).unwrap();
    [
        of_sweep("sweep", few),
        of_sweep("amplitudes", at(&wide)),
        of_sweep("one frequency", at(&[0.008])),
        of_sweep("on cells", cells),
        of_sweep("attracted", attracted(load, &wide)),
        of_sweep("pulled off", attracted(approach, &[0.004, 0.02])),
    ]
    .concat()
}

fn of_sweep(name: &str, plan: SweepPlan) -> Pictures {
    let folder = TempDir::new().unwrap();
    let setup = Setup::new(plan).unwrap();
    let store = Store::open(folder.path(), "a sweep", false).unwrap();
    let never = AtomicBool::new(false);
    let outcome = run::run(&setup, &store, Mode::on_threads(2), &never, &()).unwrap();
    named(name, of_sweep::figures(setup.plan(), &outcome).unwrap().0)
}

fn of_histories() -> Pictures {
    let of = |name: &str| {
        let file = root().join("tests/inputs").join(format!("{name}.toml"));
        let simulation = plans::history(&fs::read_to_string(file).unwrap());
        let history = History::from(followed(&simulation));
        let units = Units::of_scenario(simulation.plan()).unwrap();
        let lines = scenario::lines(simulation.plan(), &history, &units).0;
        let maps = pressure_map::figures(&history.outcome.fields, &units).unwrap();
        named(&format!("history on {name}"), lines.into_iter().chain(maps))
    };
    ["springs", "cells"].map(of).concat()
}

/// The figures that commands keep in the folders that they write.
fn of_commands() -> Pictures {
    let place = folders::inputs();
    let isotherms = root().join("sweeps/pyvisco-freq-user-raw.csv");
    let isotherms = format!(
        "material fit {} --quantity dynamic --modulus longitudinal --poisson-ratio 0.35 --spectrum",
        isotherms.display()
    );
    let commands = [
        ("analyse", "analyse raw/0.csv raw/1.csv"),
        ("identify", "identify identify.toml"),
        ("material", "material show pmma"),
        (
            "creep",
            "material fit creep.csv --quantity creep --modulus longitudinal --poisson-ratio 0.4 --spectrum",
        ),
        ("isotherms", &isotherms),
        ("compare", "compare swept swept"),
    ];
    let kept = commands.map(|(name, command)| {
        place.done(&format!("{command} --out out"));
        let kept = KeptFigures::read(&place.bytes("out/records/figures.json")).unwrap();
        fs::remove_dir_all(place.path("out")).unwrap();
        let pictures = kept.into_pictures();
        pictures
            .map(|(figure, picture)| (format!("{figure} ({name})"), picture))
            .collect::<Pictures>()
    });
    kept.concat()
}

/// On paper, in outlines whatever the machine.
fn on_paper(width_mm: f64, pt: f64) -> FigurePlan {
    FigurePlan {
        width_m: Some(1e-3 * width_mm),
        font_size_pt: Some(pt),
        ..FigurePlan::default()
    }
}

#[test]
fn nothing_in_any_figure_covers_anything_else_at_any_size() {
    let sizes = WIDTHS_MM
        .into_iter()
        .flat_map(|mm| SIZES_PT.map(|pt| (mm, pt)));
    let sizes: Vec<(f64, f64)> = sizes.collect();
    let faults = EVERY.par_iter().flat_map_iter(|(name, picture)| {
        sizes.iter().flat_map(move |&(mm, pt)| {
            let told = |what: &dyn std::fmt::Display| format!("{name} at {mm} mm, {pt} pt: {what}");
            match picture.as_asked(&on_paper(mm, pt), "") {
                Ok(drawing) => {
                    let overlaps = drawing.overlaps();
                    let mut said: Vec<String> =
                        overlaps.iter().map(|overlap| told(overlap)).collect();
                    let caption = drawing.captioned("");
                    if caption.contains("has no room") && (mm >= 84.0 || pt <= 8.0) {
                        said.push(told(&caption));
                    }
                    said
                }
                Err(error) => vec![told(&error)],
            }
        })
    });
    let faults: Vec<String> = faults.collect();
    assert!(
        faults.is_empty(),
        "{} faults in {} pictures:\n{}",
        faults.len(),
        EVERY.len(),
        faults.join("\n")
    );
}

/// So many pixels of a thumbnail are a letter, across and down.
const LETTER_PX: [u32; 2] = [10, 20];
/// What stands for how much ink: none to speak of, a line, more, an area.
const LETTERS: [(f64, char); 4] = [(0.02, ' '), (0.15, '.'), (0.45, 'o'), (2.0, '#')];

/// A drawing in letters.
fn in_letters(drawing: &Drawing) -> String {
    let pixmap = Pixmap::decode_png(&drawing.to_png(1.0).unwrap()).unwrap();
    let [across, down] = LETTER_PX;
    let letter = |column: u32, row: u32| {
        let places = (0..down).flat_map(|y| (0..across).map(move |x| (x, y)));
        let ink = places.filter_map(|(x, y)| {
            let pixel = pixmap.pixel(column * across + x, row * down + y)?;
            let lightness = [pixel.red(), pixel.green(), pixel.blue()].map(f64::from);
            Some(1.0 - lightness.iter().sum::<f64>() / 765.0)
        });
        let ink = ink.sum::<f64>() / f64::from(across * down);
        LETTERS.iter().find(|(most, _)| ink < *most).unwrap().1
    };
    let columns = pixmap.width().div_ceil(across);
    let line = |row: u32| {
        let line: String = (0..columns).map(|column| letter(column, row)).collect();
        format!("{}\n", line.trim_end())
    };
    (0..pixmap.height().div_ceil(down)).map(line).collect()
}

#[test]
fn every_figure_looks_as_it_did() {
    let thumbnails = EVERY.par_iter().map(|(name, picture)| {
        let drawing = picture.as_asked(&on_paper(120.0, 9.0), "").unwrap();
        format!("{name}\n{}\n", in_letters(&drawing))
    });
    assert_current("tests/figures.txt", &thumbnails.collect::<String>());
    if is_renewed() {
        let grey = FigurePlan {
            colors: Colors::Grey,
            ..on_paper(84.0, 8.0)
        };
        sheet("every-figure-84mm-10pt", &on_paper(84.0, 10.0), 7);
        sheet("every-figure-174mm-8pt", &on_paper(174.0, 8.0), 5);
        sheet("every-figure-grey", &grey, 7);
    }
}

/// Two of each name in one picture, in so many columns, each under its name.
fn sheet(name: &str, plan: &FigurePlan, columns: usize) {
    let plan = FigurePlan {
        dpi: Some(72),
        titles: Some(true),
        ..plan.clone()
    };
    let mut seen = BTreeMap::new();
    let shown = EVERY.iter().filter(|(name, _)| {
        let count = seen.entry(name.split(' ').next()).or_insert(0);
        *count += 1;
        *count <= 2
    });
    let shown: Vec<_> = shown.collect();
    let pictures = shown.par_iter().map(|(name, picture)| {
        let drawing = picture.as_asked(&plan, name).unwrap();
        let png = drawing.to_png_at(resolution(&plan).unwrap()).unwrap();
        Pixmap::decode_png(&png).unwrap()
    });
    let pictures: Vec<Pixmap> = pictures.collect();
    let gap = 10;
    let width = pictures.iter().map(Pixmap::width).max().unwrap() + gap;
    // Each goes below the column that is shortest.
    let mut heights = vec![gap; columns];
    let places: Vec<(usize, u32)> = (pictures.iter())
        .map(|picture| {
            let column = (0..columns).min_by_key(|&column| heights[column]).unwrap();
            let top = heights[column];
            heights[column] += picture.height() + gap;
            (column, top)
        })
        .collect();
    let height = *heights.iter().max().unwrap();
    let mut sheet = Pixmap::new(width * columns as u32 + gap, height).unwrap();
    sheet.fill(Color::from_rgba8(222, 222, 222, 255));
    for (picture, (column, top)) in pictures.iter().zip(places) {
        let left = gap + width * column as u32;
        sheet.draw_pixmap(
            left as i32,
            top as i32,
            picture.as_ref(),
            &PixmapPaint::default(),
            Transform::identity(),
            None,
        );
    }
    let file = root().join("reports/figures").join(format!("{name}.png"));
    fs::write(file, sheet.encode_png().unwrap()).unwrap();
}
