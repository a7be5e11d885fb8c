//! The computed figures of S. Spinu, *Viscoelastic Contact Simulation under Harmonic Cyclic Load*, Advances in Tribology
//! 2018, 9432894: each as a picture with its data, and every number that can be read from the paper or worked out for it as
//! a claim, computed by both engines and held against its exact value.
//!
//! The scenarios and sweeps are the files of `sweeps/spinu-2018/`, built into the program; they come in as finished plans,
//! because reading files is another room's business. Everything is in the paper's normalised units ([`Scale`]). This room
//! alone among those that serve users knows [`mod@crate::reference`]: it draws closed forms as lines and compares with them,
//! and computes nothing from them.
//!
//! What is written must be the same bytes wherever and whenever it is made. Numbers are therefore printed to five
//! significant digits, and differences below what the computation resolves as "< 1e-9" (`number`).

mod by_engine;
mod claim;
mod curves;
mod cycles;
mod figure_01;
mod figure_06;
mod figure_08_09;
mod figure_10_12;
mod figure_13;
mod number;
mod page;
mod readme;
mod scale;
mod stabilised;
mod statement;
mod step_load;
mod wording;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

pub use by_engine::ByEngine;
pub use claim::{Claim, Measure, Source, Stated, Verdict, claims};
pub use scale::Scale;
pub use statement::{Count, Judged};

use crate::contact::ContactError;
use crate::cycle::LoopError;
use crate::drive::HistoryError;
use crate::engine::EngineError;
use crate::figures::paper;
use crate::material::{Material, MaterialError};
use crate::report::ReportError;
use crate::report::chart::Chart;
use crate::report::figure::Picture;
use crate::report::figure::press::{Files, Press};
use crate::report::page::Pictures;
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::case::SetupError;
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::search::peak::PeakError;
use crate::sweep::search::run::{self, RunError};
use crate::sweep::store::StoreError;
use crate::sweep::store::files::{DATA, Place};
use number::Data;

/// The figures of the paper that show computed results; 2 and 3 are flowcharts.
pub const FIGURES: [u8; 11] = [1, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13];

/// Numbers of a figure told in its caption; all are in claims.csv.
const NUMBERS_IN_CAPTION: usize = 4;

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../sweeps/spinu-2018/", $name, ".toml")))),*]
    };
}

/// Scenario files by name.
pub const SCENARIOS: [(&str, &str); 12] = files![
    "figure-01",
    "figure-04",
    "figure-05",
    "figure-06-case-1",
    "figure-06-case-2",
    "figure-06-case-3",
    "figure-07-maxwell",
    "figure-07-zener",
    "figure-08-a",
    "figure-08-b",
    "figure-09",
    "figure-13-first-touch",
];

/// Sweep files by name.
pub const SWEEPS: [(&str, &str); 5] = files![
    "figure-10",
    "figure-11",
    "figure-12",
    "figure-12-peak",
    "figure-13",
];

/// The plans that the files ask for.
#[derive(Debug, Clone, Default)]
pub struct Plans {
    pub scenarios: BTreeMap<&'static str, ScenarioPlan>,
    pub sweeps: BTreeMap<&'static str, SweepPlan>,
}

type Result<T, E = ReproductionError> = std::result::Result<T, E>;

/// Why a figure cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum ReproductionError {
    #[error("there is no plan named {0}")]
    NoPlan(&'static str),
    #[error("{0}")]
    Unfit(String),
    #[error(transparent)]
    Setup(#[from] SetupError),
    #[error(transparent)]
    Material(#[from] MaterialError),
    #[error(transparent)]
    Engine(#[from] EngineError),
    #[error(transparent)]
    Contact(#[from] ContactError),
    #[error(transparent)]
    Loop(#[from] LoopError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Drive(#[from] HistoryError),
    #[error(transparent)]
    Peak(#[from] PeakError),
    #[error(transparent)]
    Store(#[from] StoreError),
    #[error(transparent)]
    Run(#[from] RunError),
    #[error("interrupted")]
    Interrupted,
}

/// One figure, finished.
#[derive(Debug, Clone)]
pub struct Figure {
    pub number: u8,
    /// What is to be seen, for the page.
    pub caption: String,
    /// The panels from top to bottom.
    pub panels: Vec<Chart>,
    /// The data behind it, as CSV.
    pub data: Vec<u8>,
    pub claims: Vec<Claim>,
    /// What the paper states of them.
    pub statements: Vec<Judged>,
}

impl Figure {
    /// One of which the paper states nothing yet.
    fn new(
        number: u8,
        caption: impl Into<String>,
        panels: Vec<Chart>,
        data: Data,
        claims: Vec<Claim>,
    ) -> Self {
        Self {
            number,
            caption: caption.into(),
            panels,
            data: data.finish(),
            claims,
            statements: Vec::new(),
        }
    }

    /// The name of its files, without ending.
    pub fn name(&self) -> String {
        format!("figure-{:02}", self.number)
    }

    /// The caption to stand beside the picture alone: with units and the first numbers.
    fn full_caption(&self) -> String {
        let exact = self.claims.iter().map(|c| (&c.quantity, c.texts().exact));
        let told = exact
            .filter(|(_, exact)| !exact.is_empty())
            .take(NUMBERS_IN_CAPTION);
        let numbers: Vec<String> = told
            .map(|(name, exact)| format!("{name}: {exact}"))
            .collect();
        let numbers = match numbers.is_empty() {
            true => String::new(),
            false => format!(" Exact values: {}.", numbers.join("; ")),
        };
        format!(
            "{} After figure {} of S. Spinu, Advances in Tribology 2018, 9432894, in its units: lengths in Hertz contact radii, \
             approaches in Hertz approaches, pressures in Hertz peak pressures, loads in W₀, times in τ, all at W₀ and the \
             instantaneous compliance, where an axis names no other. Computed with contact-dma.{numbers}",
            self.caption, self.number
        )
    }
}

impl Plans {
    fn scenario(&self, name: &'static str) -> Result<&ScenarioPlan> {
        let plan = self.scenarios.get(name);
        plan.ok_or(ReproductionError::NoPlan(name))
    }

    fn sweep(&self, name: &'static str) -> Result<&SweepPlan> {
        self.sweeps.get(name).ok_or(ReproductionError::NoPlan(name))
    }
}

/// The material of a scenario as the series that the closed forms need.
fn series_of(plan: &ScenarioPlan) -> Result<&Material> {
    let unfit = || ReproductionError::Unfit("the scenario's material is no series".to_owned());
    plan.contact.material.series().ok_or_else(unfit)
}

/// What makes figures: one of them, or several from the same computations.
type Maker = fn(&Plans, &AtomicBool) -> Result<Vec<Figure>>;

/// The longest first, so that threads end together.
const MAKERS: [(&[u8], Maker); 7] = [
    (&[8, 9, 10, 11, 12], cycles::figures),
    (&[13], figure_13::figures),
    (&[6], figure_06::figures),
    (&[5], step_load::figure_5),
    (&[7], step_load::figure_7),
    (&[4], step_load::figure_4),
    (&[1], figure_01::figures),
];

/// Makes these figures, in their order in the paper, on so many threads; the result does not depend on the number.
/// `finished` hears of every figure.
///
/// # Errors
/// [`ReproductionError`] of the first that cannot be made.
pub fn make(
    plans: &Plans,
    figures: &[u8],
    threads: usize,
    interrupt: &AtomicBool,
    finished: &(dyn Fn(u8) + Sync),
) -> Result<Vec<Figure>> {
    let pool = run::pool(threads)?;
    let wanted = |numbers: &[u8]| numbers.iter().any(|number| figures.contains(number));
    let made: Vec<Vec<Figure>> = pool.install(|| {
        let makers = MAKERS.par_iter().with_max_len(1);
        let made = makers
            .filter(|(numbers, _)| wanted(numbers))
            .map(|(_, maker)| {
                let mut made = maker(plans, interrupt)?;
                made.retain(|figure| figures.contains(&figure.number));
                made.iter().for_each(|figure| finished(figure.number));
                Ok(made)
            });
        made.collect::<Result<_>>()
    })?;
    let mut made: Vec<Figure> = made.into_iter().flatten().collect();
    made.sort_by_key(|figure| figure.number);
    statement::judge(&mut made)?;
    Ok(made)
}

/// All files by their names: pictures and data of each figure, the claims as table, and everything in one text for a
/// repository and in one page for a browser.
///
/// # Errors
/// [`ReproductionError`] where a picture cannot be drawn.
pub fn files(figures: &[Figure], plan: &FigurePlan) -> Result<Vec<(String, Vec<u8>)>> {
    let files = Files::default();
    let write = |place: Place<'_>, bytes: &[u8]| {
        files.insert(place, bytes);
        Ok(())
    };
    // The page shows every picture, in whatever forms they are written.
    let pictures = Pictures::default();
    let press = Press {
        plan,
        write: &write,
        pictures: &pictures,
    };
    figures.par_iter().try_for_each(|figure| {
        let name = figure.name();
        let picture = Picture(figure.panels.clone());
        press.put(&name, DATA, &figure.data)?;
        // The page of the repository shows one resolution.
        let mut forms = paper::pictures(plan);
        forms.retain(|(ending, _)| *ending != "@2x.png");
        let names = (&name[..], "a figure of the paper");
        press.picture_in(&forms, names, &picture, &figure.full_caption())?;
        Ok::<(), ReproductionError>(())
    })?;
    let claims = claim::table(figures);
    files.insert("claims.csv", &claims[..]);
    files.insert("README.md", readme::text(figures));
    files.insert("index.html", page::page(figures, &pictures, &claims)?);
    Ok(files.into_vec())
}
