//! Tables of measured cycles: columns of `sweep.csv` under their names, one row a cycle, cells empty where nothing was measured.

use super::data_file::{Column, DataFile, Holds, Holes, Table};
use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::drive::{Control, HarmonicDrive};
use crate::identify::ApproachZero;
use crate::identify::data::{Datum, Number, TableColumns};
use crate::measured::statistics::NORMAL;
use crate::quantity::Dimension::{AngularFrequency, Force, Frequency, Length};

const ANGULAR: Column = Column {
    unit_may_be_absent: true,
    ..Column::new(
        &["angular_frequency"],
        AngularFrequency,
        "angular frequencies",
    )
};
const HERTZ: Column = Column::new(&["frequency"], Frequency, "frequencies");

/// A number, and the column of its values.
struct Measured {
    number: Number,
    value: Column,
}

impl Measured {
    /// Standard deviations, or in a table of an analysis half widths of the interval of 95 %.
    fn error(&self) -> Column {
        self.value.of_errors(Holds::Errors, "errors")
    }

    /// Standard deviations in every table.
    fn standard_error(&self) -> Column {
        self.value.of_errors(Holds::StandardErrors, "errors")
    }

    fn columns(&self) -> [Column; 3] {
        [self.value, self.error(), self.standard_error()]
    }
}

/// A number under its names.
const fn measured(number: Number, names: &'static [&'static str]) -> Measured {
    let value = Column::new(names, number.dimension(), names[0]);
    Measured { number, value }
}

const APPROACH_AMPLITUDE: Measured = measured(
    Number::ApproachAmplitude,
    &["approach_amplitude", "depth_amplitude"],
);
const LOAD_AMPLITUDE: Measured = measured(
    Number::LoadAmplitude,
    &["load_amplitude", "force_amplitude"],
);

#[rustfmt::skip]
static MEASURED: [Measured; 12] = [
    measured(Number::EnergyLoss, &["energy_loss", "loss", "loss_energy", "dissipated_energy", "energy_dissipation"]),
    measured(Number::PhaseLag, &["phase_lag", "phase", "phase_angle", "loss_angle"]),
    measured(Number::StorageModulus, &["storage_modulus"]),
    measured(Number::LossModulus, &["loss_modulus"]),
    measured(Number::ApproachMin, &["approach_min", "min_approach", "depth_min", "min_depth", "minimum_depth"]),
    measured(Number::ApproachMax, &["approach_max", "max_approach", "depth_max", "max_depth", "maximum_depth"]),
    APPROACH_AMPLITUDE,
    LOAD_AMPLITUDE,
    measured(Number::ContactRadiusMin, &["contact_radius_min"]),
    measured(Number::ContactRadiusMax, &["contact_radius_max"]),
    measured(Number::PeakPressureMin, &["peak_pressure_min"]),
    measured(Number::PeakPressureMax, &["peak_pressure_max"]),
];

/// Columns that only the table of an analysis of records has.
const OF_ANALYSIS: [Column; 2] = [
    Column::pure(&["cycles_measured"], "counts"),
    Column::pure(&["points_per_cycle"], "counts"),
];

const DERIVED: &str =
    "a formula makes it from the amplitudes and the phase, which has a bias at every amplitude";
const LOSS_TWICE: &str = "it follows from the amplitudes and the phase";
const NO_ZERO: &str = "the zero of the approach is not known";
const NO_QUANTITY: &str = "the table has not the quantity that these are the errors of";
const PRESCRIBED: &str = "the drive prescribes it";

/// By what factor the drive of a table may differ from the one of the file that names it.
const ANOTHER_DRIVE: f64 = 2.0;

/// Two frequencies of a row farther apart than this are two.
const SAME_FREQUENCY: f64 = 1e-3;

const EMPTY: &str = "write a number, or leave the cell empty where nothing was measured";

/// What was measured, and what became of the columns.
type Found = (Vec<Datum>, TableColumns);

/// Reads a table; rows without a `drive_mean` and a `drive_amplitude` of their own are under this drive.
///
/// # Errors
/// What [`DataFile`] refuses; no frequency, no column that a material shows in; errors that are not above zero; frequencies or a
/// drive that contradict others; each with its place.
pub(super) fn parse(
    name: &str,
    bytes: &[u8],
    (drive, approach_zero): (HarmonicDrive, Option<ApproachZero>),
) -> Result<Found, Diagnostics> {
    let file = DataFile::from_bytes(name, bytes)?;
    let is_analysis = OF_ANALYSIS.iter().all(|column| file.has_any(&[*column]));
    // In a record the zero of the approach is not known, and drifts, unless the file says otherwise.
    let has_zero = match approach_zero {
        Some(zero) => zero == ApproachZero::FirstContact,
        None => !is_analysis,
    };
    let (data_columns, set_aside) = quantities(&file, drive.control(), has_zero);
    let (wanted, drive_columns) = wanted(&file, drive.control(), is_analysis, &data_columns)?;
    let problems = Problems::new();
    let rows = Rows {
        table: file.columns(&wanted, Holes::Kept, EMPTY)?,
        wanted,
        drive,
        drive_columns,
        data_columns,
        is_analysis,
        has_zero,
        problems: &problems,
    };
    let mut data = Vec::new();
    for row in 0..rows.table.len() {
        let numbers = rows.numbers(row).filter(|numbers| !numbers.is_empty());
        let Some((cycle, numbers)) = numbers.and_then(|all| Some((rows.cycle(row)?, all))) else {
            continue;
        };
        let (place, drive) = cycle;
        data.extend(numbers.into_iter().map(|(number, value, error)| Datum {
            place,
            drive: Some(drive),
            row: row + 1,
            number,
            value,
            error,
        }));
    }
    rows.refuse_another_drive(&data);
    let (read, _) = file.headings(&rows.wanted);
    // Errors of what is set aside are set aside with it.
    let known = MEASURED.iter().flat_map(Measured::columns);
    let known: Vec<Column> = rows.wanted.iter().copied().chain(known).collect();
    let (_, unread) = file.headings(&known);
    let columns = TableColumns {
        read,
        set_aside,
        unread,
        rows_passed_over: 0,
    };
    problems.into_result(Some((data, columns)))
}

/// The amplitude of what is not prescribed.
fn response(control: Control) -> Number {
    match control {
        Control::Load => Number::ApproachAmplitude,
        Control::Approach => Number::LoadAmplitude,
    }
}

/// The amplitude of what is prescribed.
fn prescribed(control: Control) -> Measured {
    match control {
        Control::Load => LOAD_AMPLITUDE,
        Control::Approach => APPROACH_AMPLITUDE,
    }
}

/// The quantities of a table that are its data, and the headings of those that are not beside them, with the reason.
fn quantities(
    file: &DataFile,
    control: Control,
    has_zero: bool,
) -> (Vec<&'static Measured>, Vec<(String, &'static str)>) {
    let there = MEASURED.iter().filter(|own| file.has_any(&[own.value]));
    let there: Vec<Number> = there.map(|own| own.number).collect();
    let has = |number: Number| there.contains(&number);
    let response = response(control);
    let prescribed = prescribed(control).number;
    let why_not = |number: Number| match number {
        number if number == prescribed => Some(PRESCRIBED),
        Number::StorageModulus | Number::LossModulus
            if has(Number::EnergyLoss) || has(Number::PhaseLag) =>
        {
            Some(DERIVED)
        }
        Number::EnergyLoss if has(Number::PhaseLag) && has(response) => Some(LOSS_TWICE),
        Number::ApproachMin | Number::ApproachMax if !has_zero => Some(NO_ZERO),
        _ => None,
    };
    let (mut data, mut set_aside) = (Vec::new(), Vec::new());
    for own in &MEASURED {
        let (columns, why) = match (has(own.number), why_not(own.number)) {
            (true, None) => {
                data.push(own);
                continue;
            }
            (true, Some(why)) => (vec![own.value], why),
            (false, _) => (vec![own.error(), own.standard_error()], NO_QUANTITY),
        };
        let (headings, _) = file.headings(&columns);
        set_aside.extend(headings.into_iter().map(|heading| (heading, why)));
    }
    (data, set_aside)
}

/// The columns that a table may have: frequencies, mean and amplitude of the drive, quantities, and the errors of these. Beside them
/// mean and amplitude of the drive.
fn wanted(
    file: &DataFile,
    control: Control,
    is_analysis: bool,
    data: &[&Measured],
) -> Result<(Vec<Column>, [Column; 2]), Diagnostic> {
    let lacks = |what: &str| Diagnostic::at(&file.first_line(), what);
    let mut wanted = vec![ANGULAR, HERTZ];
    if !file.has_any(&wanted) {
        return Err(lacks("no column of frequencies")
            .help("name it `angular_frequency_rad_per_s` or `frequency_hz`"));
    }
    let of_drive = drive_columns(control, is_analysis);
    if of_drive.iter().all(|column| file.has_any(&[*column])) {
        wanted.extend(of_drive);
    }
    if is_analysis {
        let of_drive = prescribed(control);
        wanted.extend([of_drive.error(), of_drive.standard_error()]);
    }
    if data.is_empty() {
        let names = MEASURED
            .each_ref()
            .map(|own| own.value.name_in_si())
            .join(", ");
        return Err(lacks("no column that shows the material")
            .because(format!(
                "the columns are {}",
                file.headings(&[]).1.join(", ")
            ))
            .help(format!("give at least one of {names}")));
    }
    wanted.extend(data.iter().flat_map(|own| own.columns()));
    Ok((wanted.into_iter().map(Column::optional).collect(), of_drive))
}

/// The rows of a table.
struct Rows<'a> {
    table: Table,
    wanted: Vec<Column>,
    drive: HarmonicDrive,
    drive_columns: [Column; 2],
    data_columns: Vec<&'static Measured>,
    is_analysis: bool,
    /// Whether approaches are counted from first contact.
    has_zero: bool,
    problems: &'a Problems,
}

impl Rows<'_> {
    /// The place of a column, where the table has it.
    fn place_of(&self, column: &Column) -> Option<usize> {
        let is_it = |of: &Column| (of.names, of.holds) == (column.names, column.holds);
        self.wanted.iter().position(is_it)
    }

    /// The number in a cell, with its place; `None` where there is none.
    fn cell(&self, row: usize, column: &Column) -> Option<(f64, Location)> {
        let value = self.number(row, column)?;
        Some((value, self.table.cell(row, self.place_of(column)?)))
    }

    fn number(&self, row: usize, column: &Column) -> Option<f64> {
        self.table.number(row, self.place_of(column)?)
    }

    /// What was measured in a row, with its standard deviations where they are known; `None` where a problem was reported.
    fn numbers(&self, row: usize) -> Option<Vec<(Number, f64, Option<f64>)>> {
        let mut found = Vec::new();
        for own in &self.data_columns {
            let Some(value) = self.number(row, &own.value) else {
                continue;
            };
            let errors = [own.error(), own.standard_error()].map(|column| self.cell(row, &column));
            if let Some((_, place)) = errors.iter().flatten().find(|(error, _)| *error <= 0.0) {
                self.problems
                    .at(place, "an error must be above zero")
                    .help("write a standard deviation, or leave the cell empty: the noise is then estimated");
                return None;
            }
            let of_drive = match own.number == response(self.drive.control()) {
                true => self.relative_deviation_of_drive(row).unwrap_or(0.0),
                false => 0.0,
            };
            let deviation = self.standard_deviation(row, own);
            let deviation = deviation.map(|own| own.hypot(of_drive * value));
            found.push((own.number, value, deviation));
        }
        Some(found)
    }

    /// The standard deviation of a number in a row, where it is known.
    fn standard_deviation(&self, row: usize, own: &Measured) -> Option<f64> {
        let error = self.number(row, &own.error());
        let of_error = match self.is_analysis {
            true => error.map(|half_width| half_width / NORMAL),
            false => error,
        };
        self.number(row, &own.standard_error()).or(of_error)
    }

    /// The relative standard deviation of the amplitude of the drive in a table of an analysis, where it is measured. The model is driven by
    /// this amplitude exactly, and answers in proportion.
    fn relative_deviation_of_drive(&self, row: usize) -> Option<f64> {
        let prescribed = self.is_analysis.then(|| prescribed(self.drive.control()))?;
        let [_, amplitude] = self.drive_columns;
        Some(self.standard_deviation(row, &prescribed)? / self.number(row, &amplitude)?)
    }

    /// Angular frequency (rad/s) and drive of the cycle of a row; `None` where a problem was reported.
    fn cycle(&self, row: usize) -> Option<(f64, HarmonicDrive)> {
        let angular_frequency_rad_per_s = self.frequency(row)?;
        let [mean, amplitude] = self.drive_columns.map(|column| self.number(row, &column));
        let mean = match self.drive.control() {
            Control::Approach if !self.has_zero => Some(self.drive.mean()),
            Control::Approach | Control::Load => mean,
        };
        let drive = match (mean, amplitude) {
            (Some(mean), Some(amplitude)) => {
                let (phase_rad, hold_s) = (self.drive.phase_rad(), self.drive.hold_s());
                let own = self.drive.with(mean, amplitude, phase_rad, hold_s);
                self.problems.accept(&self.table.row(row), own)?
            }
            _ => self.drive,
        };
        Some((angular_frequency_rad_per_s, drive))
    }

    /// The angular frequency (rad/s) of a row.
    fn frequency(&self, row: usize) -> Option<f64> {
        let angular = self.cell(row, &ANGULAR);
        let hertz = self.cell(row, &HERTZ);
        let hertz = hertz.map(|(value, place)| (value * std::f64::consts::TAU, place));
        if let (Some((angular, also)), Some((hertz, place))) = (&angular, &hertz)
            && (hertz / angular - 1.0).abs() > SAME_FREQUENCY
        {
            self.problems
                .at(place, "two frequencies of one row contradict one another")
                .label(also, "the angular frequency, 2 pi times the frequency")
                .help("keep one of the two columns");
            return None;
        }
        let omega = angular.or(hertz).map(|(value, _)| value);
        let omega = omega.filter(|omega| *omega > 0.0);
        if omega.is_none() {
            let what = "a row without a frequency above zero";
            let report = self.problems.at(&self.table.row(row), what);
            report.help("write its frequency, or leave the whole row out");
        }
        omega
    }

    /// Refuses drives that are nothing like the one of the file.
    fn refuse_another_drive(&self, data: &[Datum]) {
        let [mean, _] = self.drive_columns;
        let is_like = |drive: HarmonicDrive| {
            let ratio = drive.mean() / self.drive.mean();
            (ANOTHER_DRIVE.recip()..=ANOTHER_DRIVE).contains(&ratio)
        };
        let mut drives = data
            .iter()
            .filter_map(|datum| Some((datum.row, datum.drive?)));
        let (Some((row, first)), Some(mean)) = (drives.clone().next(), self.place_of(&mean)) else {
            return;
        };
        if drives.any(|(_, drive)| is_like(drive)) || self.drive.mean() == 0.0 {
            return;
        }
        let message = format!(
            "the table was measured under a mean of {:e}, and [drive] has {:e} (SI units)",
            first.mean(),
            self.drive.mean()
        );
        let report = self.problems.at(&self.table.cell(row - 1, mean), message);
        report.help("give [drive] the mean and amplitude of the measurement");
    }
}

/// Mean and amplitude of the drive; the table of an analysis has those of a prescribed approach under the names of the approach.
fn drive_columns(control: Control, is_analysis: bool) -> [Column; 2] {
    let (names, dimension): ([&'static [&'static str]; 2], _) = match (control, is_analysis) {
        (Control::Load, _) => ([&["drive_mean"], &["drive_amplitude"]], Force),
        (Control::Approach, false) => ([&["drive_mean"], &["drive_amplitude"]], Length),
        (Control::Approach, true) => ([&["approach_mean"], &["approach_amplitude"]], Length),
    };
    let whats = ["means of the drive", "amplitudes of the drive"];
    std::array::from_fn(|k| Column {
        // `sweep.csv` has them without, since the unit is that of the control.
        unit_may_be_absent: true,
        ..Column::new(names[k], dimension, whats[k])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::diagnostic::Styling;

    fn under_load(text: &str) -> Result<Found, Diagnostics> {
        parsed(text, None)
    }

    fn parsed(text: &str, zero: Option<ApproachZero>) -> Result<Found, Diagnostics> {
        let drive = HarmonicDrive::load(10.0, 5.0).unwrap();
        parse("measured.csv", text.as_bytes(), (drive, zero))
    }

    #[test]
    fn an_angular_frequency_is_in_rad_per_s_and_never_in_hertz() {
        let read = |unit: &str| {
            let text = format!("angular_frequency{unit},phase_lag_rad\n2,0.1\n");
            under_load(&text).map(|(data, _)| data[0].place)
        };
        for unit in ["", " [1/s]", "_rad_per_s", " (rad/s)"] {
            assert_eq!(read(unit).unwrap(), 2.0, "{unit}");
        }
        let refused = read(" [Hz]").unwrap_err().to_string();
        assert!(refused.contains("`Hz` is no unit"), "{refused}");
    }

    #[test]
    fn errors_are_those_that_are_called_so() {
        let text =
            "frequency_hz,phase_lag_rad,phase_lag_std [%],Error of phase lag [mrad]\n1,0.1,3,2\n";
        let (data, columns) = under_load(text).unwrap();
        assert_eq!(data[0].error, Some(2e-3));
        assert_eq!(columns.unread, ["phase_lag_std [%]"]);
    }

    #[test]
    fn the_first_name_of_a_number_is_that_of_its_column() {
        for own in &MEASURED {
            assert_eq!(own.value.name_in_si(), own.number.column());
        }
    }

    #[test]
    fn columns_are_read_in_their_units_with_errors_and_gaps() {
        let text = "frequency_hz,energy_loss_uJ,energy_loss_error_uJ,phase_lag_deg,status,drive_mean,drive_amplitude\n\
                    1,2,0.1,,converged,10,5\n2,,,,failed,10,5\n4,3,,9,converged,11,4\n";
        let (data, columns) = under_load(text).unwrap();
        assert_eq!((data[0].row, data[0].place), (1, std::f64::consts::TAU));
        let of_second = (data[1].row, data[1].drive.unwrap().mean());
        assert_eq!(of_second, (3, 11.0));
        assert_eq!(data[2].row, 3);
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(near(data[0].value, 2e-6) && near(data[0].error.unwrap(), 1e-7));
        assert_eq!((data.len(), data[1].error), (3, None));
        assert!(near(data[2].value, std::f64::consts::PI / 20.0));
        assert_eq!(data[2].number, Number::PhaseLag);
        assert_eq!(
            (columns.read.len(), &columns.unread[..]),
            (6, &["status".to_owned()][..])
        );
    }

    #[test]
    fn common_words_are_read_and_every_other_heading_is_kept_for_the_report() {
        let text = "Frequency (Hz);Loss (uJ);Phase (deg);Max depth (um);Fase fault (deg);Remark\n1;2;9;30;None;a\n2;2;None;31;1;b\n";
        let (data, columns) = under_load(text).unwrap();
        let approach = Number::ApproachMax;
        let numbers: Vec<Number> = data.iter().map(|datum| datum.number).collect();
        assert_eq!(
            numbers,
            [
                Number::EnergyLoss,
                Number::PhaseLag,
                approach,
                Number::EnergyLoss,
                approach
            ]
        );
        let rows: Vec<usize> = data.iter().map(|datum| datum.row).collect();
        assert_eq!(rows, [1, 1, 1, 2, 2]);
        assert_eq!(columns.unread, ["Fase fault (deg)", "Remark"]);
    }

    #[test]
    fn of_an_analysis_the_amplitude_and_the_phase_are_data_and_errors_are_half_widths() {
        let text = "frequency_hz,drive_mean,drive_amplitude,energy_loss_j,energy_loss_error_j,phase_lag_rad,phase_lag_error_rad,\
                    phase_lag_standard_error_rad,storage_modulus_pa,approach_max_m,approach_amplitude_m,approach_amplitude_error_m,\
                    load_amplitude_n,cycles_measured,points_per_cycle,harmonic_2\n\
                    1,10,5,1e-6,1e-8,0.2,2e-3,5e-4,1e7,1e-5,1e-6,1e-8,5,12,80,0.01\n";
        let (data, columns) = under_load(text).unwrap();
        assert_eq!(data.len(), 2, "{data:?}");
        // The model is driven by the amplitude as measured, with its error: that of the answer holds it too.
        let with_drive = text
            .replace(
                "load_amplitude_n,",
                "load_amplitude_n,load_amplitude_error_n,",
            )
            .replace(",5,12,", ",5,0.075,12,");
        let (of_both, _) = under_load(&with_drive).unwrap();
        let [own, both] = [data[1], of_both[1]].map(|datum| datum.error.unwrap() / datum.value);
        assert!((both / own.hypot(0.015 / NORMAL) - 1.0).abs() < 1e-12);
        assert_eq!(of_both[0], data[0]);
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(data[0].number == Number::PhaseLag && near(data[0].error.unwrap(), 5e-4));
        assert_eq!(data[1].number, Number::ApproachAmplitude);
        assert!(near(data[1].error.unwrap(), 1e-8 / NORMAL));
        let aside: Vec<&str> = columns
            .set_aside
            .iter()
            .map(|(name, _)| name.as_str())
            .collect();
        assert_eq!(
            aside,
            [
                "energy_loss_j",
                "storage_modulus_pa",
                "approach_max_m",
                "load_amplitude_n"
            ]
        );
        // The same numbers in a table of one's own: standard deviations where they are named so.
        let own = text.replace("points_per_cycle", "points");
        let (data, _) = under_load(&own).unwrap();
        assert!(data[0].number == Number::PhaseLag && near(data[0].error.unwrap(), 5e-4));
        assert!(data.iter().any(|datum| datum.number == Number::ApproachMax));
    }

    #[test]
    fn approaches_whose_zero_is_unknown_are_set_aside_and_amplitudes_are_not() {
        let text = "frequency_hz,phase_lag_rad,approach_amplitude_m,approach_max_m,approach_min_m\n1,0.2,1e-6,1e-5,8e-6\n";
        let numbers = |zero| {
            let (data, columns) = parsed(text, zero).unwrap();
            (data.len(), columns.set_aside)
        };
        assert_eq!(numbers(None), (4, Vec::new()));
        let (count, set_aside) = numbers(Some(ApproachZero::Unknown));
        let expected = ["approach_min_m", "approach_max_m"].map(|name| (name.to_owned(), NO_ZERO));
        assert_eq!((count, &set_aside[..]), (2, &expected[..]));
    }

    #[test]
    fn a_table_of_which_nothing_can_be_made_is_refused_at_its_place() {
        for (text, place, reason) in [
            (
                "energy_loss_j\n1\n",
                "measured.csv:1:1",
                "no column of frequencies",
            ),
            (
                "frequency_hz,note\n1,a\n",
                "measured.csv:1:1",
                "shows the material",
            ),
            (
                "frequency_hz,energy_loss_j\n0,1\n",
                "measured.csv:2:1",
                "above zero",
            ),
            (
                "frequency_hz,energy_loss_j,energy_loss_error_j\n1,1,0\n",
                "measured.csv:2:5",
                "an error must be above zero",
            ),
            (
                "angular_frequency_rad_per_s,frequency_hz,energy_loss_j\n1,1,1\n",
                "measured.csv:2:3",
                "contradict",
            ),
            (
                "frequency_hz,energy_loss_j,drive_mean,drive_amplitude\n1,1,1,0.5\n",
                "measured.csv:2:5",
                "mean of 1e0, and [drive] has 1e1",
            ),
        ] {
            let refused = under_load(text).unwrap_err().render(Styling::Plain);
            assert!(
                refused.contains(place) && refused.contains(reason),
                "{refused}"
            );
        }
    }
}
