//! The computed figures of S. Spinu, *Viscoelastic Contact Simulation under Harmonic Cyclic Load*, Advances in Tribology
//! 2018, 9432894: each as a picture with its data, and every number that can be read from the paper or worked out for it as
//! a claim, computed by both engines and held against its exact value.
//!
//! What a figure shows, how its numbers are read and what the paper states of them are data (`figures.toml`, read by `spec`). From
//! there the way is one for all figures: the curves of each family (`curve`), what has to be computed for them, each once (`run`),
//! rows in the paper's units read of that (`table`) or known exactly (`exact`), and of these the picture with its data (`draw`) and
//! the numbers (`value`), which the statements of the paper are held against (`statement`).
//!
//! The scenarios and sweeps are the files of `sweeps/spinu-2018/`, built into the program; they come in as finished plans,
//! because reading them is the business of another module. This module alone among those that serve users knows
//! [`mod@crate::reference`]: it draws closed forms as lines and compares with them, and computes nothing from them.
//!
//! What is written must be the same bytes wherever and whenever it is made. Numbers are therefore printed to five
//! significant digits, and differences below what the computation resolves as "< 1e-9" (`number`).

mod claim;
mod curve;
mod draw;
mod exact;
mod number;
mod page;
mod readme;
mod run;
mod spec;
mod statement;
mod table;
mod value;

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;

use rayon::prelude::*;

pub use claim::{Claim, Source, Verdict, claims};
pub use run::ByEngine;
pub use statement::{Judged, counted};

use crate::figures::paper;
use crate::report::ReportError;
use crate::report::chart::Chart;
use crate::report::figure::Picture;
use crate::report::figure::press::{Files, Press};
use crate::report::page::Pictures;
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::SweepPlan;
use crate::sweep::plan::figures::FigurePlan;
use crate::sweep::search::run::{RunError, pool};
use crate::sweep::store::files::{DATA, Place};
use curve::Curve;
use run::unfit;
use spec::FigureSpec;

/// The figures of the paper that show computed results; 2 and 3 are flowcharts.
pub const FIGURES: [u8; 11] = [1, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13];

/// Numbers of a figure in its caption; all are in claims.csv.
const NUMBERS_IN_CAPTION: usize = 4;

macro_rules! files {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../sweeps/spinu-2018/", $name, ".toml")))),*]
    };
}

/// Scenario files by name.
pub const SCENARIOS: [(&str, &str); 12] = files! {
    "figure-01", "figure-04", "figure-05", "figure-06-case-1", "figure-06-case-2", "figure-06-case-3", "figure-07-maxwell",
    "figure-07-zener", "figure-08-a", "figure-08-b", "figure-09", "figure-13-first-touch",
};

/// Sweep files by name.
pub const SWEEPS: [(&str, &str); 5] = files! {
    "figure-10", "figure-11", "figure-12", "figure-12-peak", "figure-13",
};

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
    #[error("{0}")]
    Unfit(String),
    #[error(transparent)]
    Setup(#[from] crate::sweep::case::SetupError),
    #[error(transparent)]
    Material(#[from] crate::material::MaterialError),
    #[error(transparent)]
    Engine(#[from] crate::engine::EngineError),
    #[error(transparent)]
    Contact(#[from] crate::contact::ContactError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Drive(#[from] crate::drive::HistoryError),
    #[error(transparent)]
    Peak(#[from] crate::sweep::search::peak::PeakError),
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
    /// A discussion of what disagrees.
    pub discussion: Option<String>,
    /// The panels from top to bottom.
    pub panels: Vec<Chart>,
    /// The data behind it, as CSV.
    pub data: Vec<u8>,
    pub claims: Vec<Claim>,
    /// What the paper states of them.
    pub statements: Vec<Judged>,
}

impl Figure {
    fn new(spec: &FigureSpec, curves: &[Curve<'_>], interrupt: &AtomicBool) -> Result<Self> {
        let (panels, data) = draw::draw(spec, curves, interrupt)?;
        let mut claims = value::claims(curves, interrupt)?;
        let statements = spec.statements.iter();
        let statements = statements.map(|statement| statement.judged(&mut claims));
        Ok(Self {
            number: spec.number,
            statements: statements.collect::<Result<_>>()?,
            caption: curves[0].filled(&spec.caption),
            discussion: spec.discussion.clone(),
            panels,
            data,
            claims,
        })
    }

    /// The name of its files, without ending.
    pub fn name(&self) -> String {
        format!("figure-{:02}", self.number)
    }

    /// The caption to stand beside the picture alone: with units and the first numbers.
    fn full_caption(&self) -> String {
        let claims = self.claims.iter();
        let exact = claims.map(|claim| (&claim.quantity, claim.texts()[0].clone()));
        let defined = exact.filter(|(_, exact)| !exact.is_empty());
        let named = defined.map(|(name, exact)| format!("{name}: {exact}"));
        let numbers: Vec<String> = named.take(NUMBERS_IN_CAPTION).collect();
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
    fn scenario(&self, name: &str) -> Result<&ScenarioPlan> {
        let plan = self.scenarios.get(name);
        plan.ok_or_else(|| unfit(format!("there is no scenario named {name}")))
    }

    fn sweep(&self, name: &str) -> Result<&SweepPlan> {
        let plan = self.sweeps.get(name);
        plan.ok_or_else(|| unfit(format!("there is no sweep named {name}")))
    }
}

/// Makes these figures, in their order in the paper, on at most this many threads; the result does not depend on the number.
/// `finished` is called with every figure for which everything is computed.
///
/// # Errors
/// [`ReproductionError`] of the first that cannot be made.
pub fn make(
    plans: &Plans,
    numbers: &[u8],
    threads: usize,
    interrupt: &AtomicBool,
    finished: &(dyn Fn(u8) + Sync),
) -> Result<Vec<Figure>> {
    let mut specs = spec::figures()?;
    specs.retain(|spec| numbers.contains(&spec.number));
    let mut figures = Vec::new();
    for spec in &specs {
        let mut curves = Vec::new();
        for family in &spec.families {
            curves.extend(curve::curves(family, plans)?);
        }
        figures.push((spec, curves));
    }
    pool(threads)?.install(|| {
        let runs = figures.iter().flat_map(|(spec, curves)| {
            let runs = curves.iter().flat_map(|curve| curve.runs.iter().flatten());
            runs.map(|(_, run)| (spec.number, run))
        });
        let outcomes = run::outcomes(&runs.collect::<Vec<_>>(), interrupt, finished)?;
        let mut outcomes = outcomes.into_iter();
        for curve in figures.iter_mut().flat_map(|(_, curves)| curves) {
            let of_engine = |runs: &Vec<_>| outcomes.by_ref().take(runs.len()).collect();
            curve.outcomes = curve.runs.each_ref().map(of_engine);
        }
        let figures = figures.par_iter().with_max_len(1);
        let figures = figures.map(|(spec, curves)| Figure::new(spec, curves, interrupt));
        figures.collect()
    })
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
        press
            .put(&name, DATA, &figure.data)
            .map_err(ReportError::from)?;
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
