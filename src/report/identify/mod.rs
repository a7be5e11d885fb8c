//! What is reported of a material that was identified from measured cycles: lines for people, tables, the summary.

pub mod summary;
pub mod tables;

use serde_json::Value;

use crate::identify::data::Number;
use crate::identify::resolved::resolved_text;
use crate::identify::{
    CellError, Curve, Identified, IdentifyPlan, Knowledge, MOST_BRANCHES, Unknown,
};
use crate::material::MaterialError;
use crate::quantity::{Dimension, format_human};
use crate::report::dynamic::tables::prony;
use crate::report::laws::{self, laws_in_words};
use crate::report::measured::columns::of_records;
use crate::report::number::scientific;
use crate::report::quantities;
use crate::report::text::{Column, Table, Text};
use crate::report::words::listed;
use crate::sweep::plan::resolved::material_text;
use crate::sweep::store::files::{DATA, Place};

/// The table of moduli over frequency, which the figure of these shows.
const MODULI: Place<'_> = Place::Figure("moduli", DATA);

/// An identification and what it came to.
pub struct IdentifyReport<'a> {
    pub plan: &'a IdentifyPlan,
    pub found: &'a Identified,
    /// Of the model between the data, where there are any.
    pub curves: &'a [Curve],
}

impl IdentifyReport<'_> {
    /// Every file of the folder but figures and page: name and bytes; `block` is the `[material]` block.
    pub fn files(&self, summary: &Value, block: &str) -> Vec<(String, Vec<u8>)> {
        let top = |name, bytes| (Place::Top(name).to_string(), bytes);
        let mut files = vec![
            top("material.toml", block.into()),
            top("resolved.toml", resolved_text(self.plan).into()),
            top("prony.csv", prony(&self.found.relaxation)),
            top("fit.csv", tables::fit(self)),
            top("summary.json", format!("{summary:#}\n").into()),
            (MODULI.to_string(), tables::moduli(self)),
        ];
        if !self.found.ensemble.is_empty() {
            files.push(top("ensemble.csv", tables::ensemble(self)));
        }
        files
    }

    /// The `[material]` block of a sweep file, every number exact, below title and findings as comments.
    ///
    /// # Errors
    /// A series that is no material.
    pub fn block(&self) -> Result<String, MaterialError> {
        let mut text = Text::from(self.plan.title.as_str());
        text.append(self.text());
        let material = self.plan.material_of(self.found)?;
        Ok(text.as_comments() + &material_text(&material))
    }

    /// What was found.
    pub fn text(&self) -> Text {
        self.lines().into_iter().collect()
    }

    /// The same, one fact a line.
    pub fn lines(&self) -> Vec<String> {
        let measured = &self.plan.measurements;
        let notes = measured.notes().iter().map(|note| format!("Note: {note}."));
        let mut lines: Vec<String> = self.missed().map(warned).into_iter().collect();
        lines.push(self.data());
        lines.extend(self.columns());
        lines.extend(notes);
        lines.push(self.noise());
        lines.extend(self.law());
        lines.push(self.window());
        lines.extend(self.cells());
        let samples = self.found.ensemble.len();
        if samples > 0 {
            lines.push(format!(
                "Ensemble: the material found {samples} times with the noise drawn anew; each is a replica of the material, from which a sweep has \
                 a band about its loss."
            ));
        }
        if self.found.law().is_none() {
            lines.extend(self.open());
        }
        lines.extend(self.beyond().map(warned));
        lines.extend(self.unknown_cell_error().map(warned));
        if self.found.law().is_none() {
            lines.push(self.moduli().to_owned());
        }
        lines
    }

    /// Which law or series it is.
    fn law(&self) -> Vec<String> {
        let laws = self.found.laws.as_ref();
        let mut lines: Vec<String> = laws
            .map(|laws| laws_in_words(laws, "what was measured", 'E').to_vec())
            .into_iter()
            .flatten()
            .collect();
        if self.found.law().is_none() {
            lines.truncate(1);
            lines.push(self.series());
        }
        lines
    }

    /// Which modulus the unknowns are of.
    fn moduli(&self) -> &'static str {
        match self.found.relaxation.branches().len() {
            1 => "g_inf and g_1 are Young's moduli: E(t) = g_inf + g_1 exp(-t/tau_1).",
            _ => "g_inf and g_i are Young's moduli: E(t) = g_inf + sum of g_i exp(-t/tau_i).",
        }
    }

    /// What became of the columns of the table, without those of this program's own tables that are no data.
    fn columns(&self) -> Vec<String> {
        let columns = &self.plan.columns;
        let mut lines = Vec::new();
        if !columns.read.is_empty() {
            lines.push(format!("Columns read: {}.", listed(&columns.read)));
        }
        if columns.rows_passed_over > 0 {
            let rows = columns.rows_passed_over;
            let s = if rows == 1 { "" } else { "s" };
            lines.push(format!(
                "Note: {rows} row{s} passed over: a number is empty or marked as missing."
            ));
        }
        let mut aside: Vec<(&str, Vec<String>)> = Vec::new();
        for (heading, why) in &columns.set_aside {
            match aside.iter_mut().find(|(other, _)| other == why) {
                Some((_, headings)) => headings.push(heading.clone()),
                None => aside.push((why, vec![heading.clone()])),
            }
        }
        let aside = aside.into_iter();
        lines
            .extend(aside.map(|(why, headings)| {
                format!("Not taken as data: {}: {why}.", listed(&headings))
            }));
        let unknown = self.not_understood();
        if !unknown.is_empty() {
            let line = format!("columns not understood, and not read: {}", listed(&unknown));
            lines.push(warned(line));
        }
        lines
    }

    /// Columns that were not read and are none of this program's own tables.
    pub fn not_understood(&self) -> Vec<String> {
        let own = own_columns();
        let is_own =
            |heading: &String| own.contains(heading) || quantities::of_name(heading).is_some();
        let unread = self.plan.columns.unread.iter();
        unread.filter(|heading| !is_own(heading)).cloned().collect()
    }

    fn data(&self) -> String {
        let measured = &self.plan.measurements;
        let columns = measured.numbers().into_iter();
        let columns: Vec<String> = columns.map(|n| n.column().to_owned()).collect();
        let of = match measured.is_history() {
            true => "instants of a history",
            false => "cycles",
        };
        format!(
            "Measured: {} numbers of {} {of} ({}).",
            measured.data().len(),
            measured.places().count(),
            listed(&columns)
        )
    }

    /// The mean relative error of every column.
    pub fn noise_of(&self, number: Number) -> f64 {
        let of = self.found.compared.iter().filter(|c| c.number == number);
        let (sum, count) = of.fold((0.0, 0.0), |(sum, count), c| {
            (sum + c.error / c.measured, count + 1.0)
        });
        sum / f64::max(count, 1.0)
    }

    fn noise(&self) -> String {
        let numbers = self.plan.measurements.numbers().into_iter();
        let each: Vec<String> = numbers
            .map(|number| format!("{} of {}", percent(self.noise_of(number)), number.column()))
            .collect();
        let each = listed(&each);
        match self.found.knowledge {
            Knowledge::All => format!(
                "Errors as given: {each} on average; chi squared per degree of freedom {}.",
                scientific(self.found.reduced_chi_squared, 2)
            ),
            Knowledge::Some => format!(
                "Errors as given where they are, elsewhere estimated from the residuals: {each} on average."
            ),
            Knowledge::None => format!(
                "The data have no errors: their noise is estimated from the residuals, {each}."
            ),
        }
    }

    fn series(&self) -> String {
        let count = self.found.relaxation.branches().len();
        let plural = if count == 1 { "" } else { "es" };
        match self.plan.branches {
            Some(asked) if asked == count => {
                format!("Series: {count} branch{plural}, as asked for.")
            }
            _ => {
                let tried = self.found.candidates.len();
                format!("Series: {count} branch{plural}, chosen among 1 to {tried}.")
            }
        }
    }

    fn window(&self) -> String {
        let (lowest, highest) = self.found.window_rad_per_s;
        let (symbol, from, to, dimension) = match self.plan.measurements.is_history() {
            true => ("t", 1.0 / highest, 1.0 / lowest, Dimension::Time),
            false => ("ω", lowest, highest, Dimension::AngularFrequency),
        };
        let [from, to] = [from, to].map(|value| format_human(value, dimension, 4));
        format!("Measured from {symbol} = {from} to {to}; outside, the series is an extrapolation.")
    }

    /// What the data do not determine.
    pub fn open(&self) -> Vec<String> {
        let open = self.found.undetermined.iter().map(|open| {
            let parts = open.parts.iter();
            let parts: Vec<String> = parts.map(|(name, p)| power_of(name, *p)).collect();
            format!(
                "Not determined: {} may be off by a factor of {}.",
                parts.join(" · "),
                factor(open.factor)
            )
        });
        let open: Vec<String> = open.collect();
        match open.is_empty() {
            true => {
                vec!["All moduli and times are determined to within a factor of two.".to_owned()]
            }
            false => open,
        }
    }

    /// What a reader should know before using the material.
    pub fn warnings(&self) -> Vec<String> {
        let warnings = [self.missed(), self.beyond(), self.unknown_cell_error()];
        warnings.into_iter().flatten().collect()
    }

    /// What the number of cells changes, where that is known.
    fn cells(&self) -> Option<String> {
        let (change, follows) = match self.found.cell_error? {
            CellError::Included(change) => (
                change,
                "they are corrected by this change, and all intervals include it",
            ),
            CellError::Negligible(change) => (change, "too little beside the noise to matter"),
            CellError::Unknown => return None,
        };
        Some(format!(
            "Cells: twice as many change the computed numbers by {} at most; {follows}.",
            percent(change)
        ))
    }

    /// That the error of the cells is not known.
    fn unknown_cell_error(&self) -> Option<String> {
        (self.found.cell_error == Some(CellError::Unknown)).then(|| {
            let why = match self.plan.contact.indenter.own_cells() {
                Some(_) => "a map is solved on its own points, of which there are no more",
                None => {
                    "the contact was not found on twice as many; set solver.cells to another number"
                }
            };
            format!("the error of the cells is not known and not in the intervals: {why}")
        })
    }

    /// That the series misses the data by more than their errors, and where most.
    fn missed(&self) -> Option<String> {
        let found = self.found;
        if found.inflation <= 1.0 {
            return None;
        }
        let (worst, times) = found.worst()?;
        let than = if times > 0.0 { "above" } else { "below" };
        let off = percent((worst.computed / worst.measured - 1.0).abs());
        let cause = match (found.left_out, self.plan.branches) {
            (Some(_), _) => {
                "All others are met without it: it does not count in the fit, and is to be checked"
            }
            (None, Some(asked)) if asked < MOST_BRANCHES => {
                "More branches than were asked for may be needed, the errors may be too small, or the material or the contact is not \
                 what the model takes it for"
            }
            _ => {
                "The errors are too small, or the material or the contact is not what the model takes it for"
            }
        };
        Some(format!(
            "the series misses the data: chi squared per degree of freedom is {}, and all intervals are {} times as wide as the errors \
             of the data say. The worst is {} of row {}: the series is {off} {than} it, {} times its error. {cause}",
            scientific(found.reduced_chi_squared, 2),
            scientific(found.inflation, 2),
            worst.number.column(),
            worst.row,
            scientific(times.abs(), 2),
        ))
    }

    /// That branches lie beyond the data.
    fn beyond(&self) -> Option<String> {
        if self.found.law().is_some() {
            return None;
        }
        let (lowest, highest) = self.found.window_rad_per_s;
        let beyond = |time_s: f64| time_s * lowest > 1.0 || time_s * highest < 1.0;
        let branches = self.found.relaxation.branches().iter();
        let count = branches.filter(|branch| beyond(branch.time_s)).count();
        let (has, its) = match count {
            0 => return None,
            1 => ("branch has its time", "it shows"),
            _ => ("branches have their times", "they show"),
        };
        Some(format!(
            "{count} {has} beyond one over the measured frequencies, where {its} as a slope alone"
        ))
    }

    /// The unknowns with their intervals.
    pub fn unknowns(&self) -> Table {
        if let Some(law) = self.found.law() {
            return laws::table(&laws::named(law));
        }
        let columns = [
            Column::left("", 6),
            Column::right("value", 13),
            Column::right("known to", 14),
            Column::left("95 % interval", 0),
        ];
        let mut table = Table::new(2, columns);
        for unknown in &self.found.unknowns {
            let value = |value: f64| format_human(value, dimension(unknown), 4);
            let (known, interval) = match unknown.is_determined {
                true => {
                    let low = value(unknown.value / unknown.factor);
                    let high = value(unknown.value * unknown.factor);
                    let known = format!("± {}", percent(unknown.factor - 1.0));
                    (known, format!("{low} to {high}"))
                }
                false => {
                    let interval = format!("a factor of {}", factor(unknown.factor));
                    ("undetermined".to_owned(), interval)
                }
            };
            table.row([unknown.name.clone(), value(unknown.value), known, interval]);
        }
        table
    }
}

fn warned(warning: String) -> String {
    format!("Warning: {warning}.")
}

/// The columns of the tables that a sweep, a simulation and an analysis write.
fn own_columns() -> Vec<String> {
    let of_records = of_records().into_iter().map(|column| column.name);
    let names =
        |name: &str, error: Option<String>| [Some(name.to_owned()), error].into_iter().flatten();
    let history = quantities::HISTORY.iter();
    let history = history.flat_map(|column| names(column.name, column.error_name()));
    let attracted = quantities::ATTRACTED.iter();
    let attracted = attracted.flat_map(|column| names(column.name, column.error_name()));
    of_records.chain(history).chain(attracted).collect()
}

/// A part in two digits, as far as a hundredth of a per cent.
fn percent(part: f64) -> String {
    let percent = 100.0 * part;
    let decimals = match percent {
        p if p >= 9.95 => 0,
        p if p >= 0.995 => 1,
        _ => 2,
    };
    format!("{percent:.decimals$} %")
}

/// Pa for moduli, s for times, J/m^2 and m of an attraction.
pub fn dimension(unknown: &Unknown) -> Dimension {
    match &unknown.name[..] {
        "work" => Dimension::EnergyPerArea,
        "range" => Dimension::Length,
        name if name.starts_with("tau") => Dimension::Time,
        _ => Dimension::Stress,
    }
}

/// `g_1`, `tau_2^-0.8`.
fn power_of(name: &str, power: f64) -> String {
    match (power - 1.0).abs() < 0.05 {
        true => name.to_owned(),
        false if (power + 1.0).abs() < 0.05 => format!("{name}^-1"),
        false => format!("{name}^{power:.1}"),
    }
}

/// A factor in two digits, or that it is without bounds.
fn factor(factor: f64) -> String {
    match factor < 1e6 {
        true => scientific(factor, 2),
        false => "more than a million".to_owned(),
    }
}
