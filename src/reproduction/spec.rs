//! The figures of the paper as data, `sweeps/spinu-2018/figures.toml`, where every key is explained.

use serde::Deserialize;

use super::Result;
use super::exact::Exact;
use super::run::unfit;
use super::statement::Statement;
use super::table::Quantity;
use crate::report::chart::{Axis, LegendPlace, Marker};
use crate::sweep::record::Quarter;

const FILE: &str = include_str!("../../sweeps/spinu-2018/figures.toml");

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    figure: Vec<FigureSpec>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FigureSpec {
    pub number: u8,
    pub caption: String,
    /// A discussion of what disagrees.
    pub discussion: Option<String>,
    /// Names of the columns of the data, and what stands in them.
    pub columns: Vec<(String, Content)>,
    pub panels: Vec<PanelSpec>,
    pub families: Vec<Family>,
    pub statements: Vec<Statement>,
}

/// What stands in a column.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Content {
    At,
    Source,
    Name,
    Label,
    State,
    X,
    Y,
    #[serde(untagged)]
    Quantity(Quantity),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PanelSpec {
    pub x: Axis,
    pub y: Axis,
    pub legend: Option<LegendPlace>,
    pub size: Option<(u32, u32)>,
    /// Distinct colours in place of a ramp.
    #[serde(default)]
    pub palette: bool,
    /// A line at this x.
    pub vertical: Option<(f64, String)>,
    /// At the maximum of the first curve.
    pub peak: Option<String>,
}

/// Curves of one file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(super) struct Family {
    pub file: String,
    pub of: Of,
    pub x: Quantity,
    pub y: Quantity,
    /// What is 1 on the axis of the picture.
    pub x_unit: Option<f64>,
    pub exact: Option<Exact>,
    pub draws_refined: bool,
    /// From, to (without end: to the edge of the contact), parts.
    pub sampled: Option<(f64, f64, usize)>,
    pub frequencies: Vec<Frequencies>,
    pub more: Vec<Frequencies>,
    pub quarters: Vec<Quarter>,
    /// Cells per side, where others than in the file.
    pub side: Option<usize>,
    /// The peak is that of a parabola through these.
    pub peak: Option<[f64; 3]>,
    /// Whether its exact place is searched for.
    pub search: bool,
    pub name: String,
    pub labels: Vec<String>,
    pub states: Vec<String>,
    pub shown: Option<[f64; 2]>,
    pub beyond: Option<[usize; 2]>,
    /// Numbers of points at most: exact, on springs, on cells.
    pub thin: Option<[usize; 3]>,
    pub drawn: Option<[usize; 3]>,
    pub every_cell: Option<usize>,
    /// Those of the curves at this alone are drawn.
    pub drawn_at: Option<f64>,
    /// Where its curves are drawn; in none they are only there for claims.
    pub panels: Vec<usize>,
    pub draw: Vec<Drawn>,
    pub claims: Vec<ClaimSpec>,
}

/// What is read of a computation.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Of {
    /// Its instants.
    #[default]
    Time,
    /// Its surface at a time, or at a quarter of a cycle.
    Surface,
    /// Its numbers.
    Cycle,
    /// The numbers of all, over frequency.
    Spectrum,
}

/// All of a sweep file, or one in rad/s.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Frequencies {
    File(String),
    Omega(f64),
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Drawn {
    pub y: Quantity,
    pub label: String,
    pub marker: Option<Marker>,
    /// The label of the symbols; where there is none, those of the panel's last curve name the engines.
    pub symbols: Option<String>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClaimSpec {
    pub quantity: String,
    /// The first curve of the family of which it is claimed.
    #[serde(default)]
    pub from: usize,
    /// Of the last curve of the family alone.
    #[serde(default)]
    pub closing: bool,
    pub of: Option<Of>,
    pub x: Option<Quantity>,
    pub y: Option<Quantity>,
    pub exact: Option<Exact>,
    pub exact_at: Option<f64>,
    pub known: Option<f64>,
    pub value: Option<Value>,
    /// A largest error leaves out this many cells at the edge of the contact, and is taken at about this many points.
    pub edge_cells: Option<f64>,
    pub points: Option<usize>,
    /// The x of an extremum instead of its y, counted from another x.
    #[serde(default)]
    pub place: bool,
    #[serde(default)]
    pub after: f64,
    pub times: Option<f64>,
    pub unit: Option<String>,
    pub tolerance: [f64; 2],
    /// Whether the second is in sides of a cell.
    #[serde(default)]
    pub in_cells: bool,
    #[serde(default)]
    pub note: String,
}

/// How a number is read from a curve.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum Value {
    /// y at this x.
    At(f64),
    /// y where the curve itself is: at the time of a profile, at the frequency of a cycle.
    Here,
    /// y at the first x less y at the second.
    Difference([f64; 2]),
    /// y at x = 0 over that of another curve of the family.
    AtAxisOverCurve(usize),
    /// The extremum between two x; with samples to either side through which its parabola goes: refined, on springs, on cells.
    Largest([f64; 2], [usize; 3]),
    Smallest([f64; 2], [usize; 3]),
    /// The maximum over frequency.
    Peak,
    /// y at this x over the maximum.
    ShareAt(f64),
    /// The first cycle, from 1, that is nowhere further from the last than this part of the largest y.
    CyclesToWithin(f64),
    /// Number of maxima of y.
    Maxima,
    /// Largest difference from the exact curve.
    LargestError,
    /// Largest difference between the last two of this many cycles.
    LastCycleDiffers(usize),
    /// Largest difference of the pressure between the engines at the quarters of a cycle.
    EnginesDiffer,
    /// Largest difference of the pressure, as a part of the peak, when the approach is imposed in place of the load.
    DrivenBack,
}

/// The figures.
///
/// # Errors
/// [`ReproductionError::Unfit`] with file, line and key where the file says what is not understood.
pub(super) fn figures() -> Result<Vec<FigureSpec>> {
    read(FILE)
}

fn read(text: &str) -> Result<Vec<FigureSpec>> {
    let file: Result<File, _> = toml::from_str(text);
    let file = file.map_err(|error| unfit(format!("figures.toml: {error}")))?;
    Ok(file.figure)
}

impl Family {
    /// Whether anything is compared with what is refined.
    pub fn compares_refined(&self) -> bool {
        let claims = self.claims.iter().map(|claim| claim.exact);
        let mut exact = claims.chain([self.exact]);
        exact.any(|exact| exact == Some(Exact::Refined))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_has_every_figure_with_claims_and_statements_and_panels_for_its_curves() {
        let figures = figures().unwrap();
        let numbers: Vec<u8> = figures.iter().map(|figure| figure.number).collect();
        assert_eq!(numbers, super::super::FIGURES);
        for figure in figures {
            assert!(!figure.statements.is_empty(), "{}", figure.number);
            assert!(
                figure
                    .families
                    .iter()
                    .any(|family| !family.claims.is_empty())
            );
            let mut panels: Vec<usize> = figure
                .families
                .iter()
                .flat_map(|family| &family.panels)
                .copied()
                .collect();
            panels.sort_unstable();
            panels.dedup();
            assert!(
                panels.into_iter().eq(0..figure.panels.len()),
                "{}",
                figure.number
            );
        }
    }

    #[test]
    fn what_is_not_understood_is_refused_with_file_line_and_key() {
        let line = |text: &str| 1 + FILE[..FILE.find(text).unwrap()].matches('\n').count();
        for (right, wrong, named) in [
            ("every_cell = 6", "every_cells = 6", "every_cells"),
            ("of = \"surface\"", "of = \"surfaces\"", "surfaces"),
            ("value = { at = 1000 }", "value = { near = 1000 }", "near"),
            ("exact = \"creep-term\"", "exact = \"creep\"", "creep"),
            (
                "tolerance = [1e-3, 1e-3]",
                "tolerances = [1e-3, 1e-3]",
                "tolerances",
            ),
            ("holds = \"falls\"", "holds = \"wobbles\"", "wobbles"),
        ] {
            let message = read(&FILE.replacen(right, wrong, 1))
                .unwrap_err()
                .to_string();
            let place = format!("figures.toml: TOML parse error at line {}, ", line(right));
            assert!(message.starts_with(&place), "{message}");
            assert!(message.contains(named), "{message}");
        }
    }
}
