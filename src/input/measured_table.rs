//! Tables of measured cycles: columns of `sweep.csv` under their names, one row a cycle, cells empty where nothing was measured.

use super::data_file::{Column, DataFile, Table};
use super::diagnostic::{Diagnostic, Diagnostics, Location, Problems};
use crate::drive::{Control, HarmonicDrive};
use crate::identify::data::{Datum, MeasuredCycle, Number};
use crate::quantity::Dimension::{
    self, Angle, AngularFrequency, Energy, Force, Frequency, Length, Stress,
};
use crate::sweep::record::error_bars::Quantity;

const ANGULAR: Column = Column::new(
    &["angular_frequency"],
    AngularFrequency,
    "angular frequencies",
);
const HERTZ: Column = Column::new(&["frequency"], Frequency, "frequencies");

/// A quantity, the column of its values, and that of its errors.
const fn measured(
    quantity: Quantity,
    value: &'static [&'static str],
    error: &'static [&'static str],
    dimension: Dimension,
) -> (Quantity, Column, Column) {
    (
        quantity,
        Column::new(value, dimension, value[0]),
        Column::new(error, dimension, error[0]),
    )
}

#[rustfmt::skip]
const MEASURED: [(Quantity, Column, Column); 10] = [
    measured(Quantity::EnergyLoss, &["energy_loss"], &["energy_loss_error"], Energy),
    measured(Quantity::PhaseLag, &["phase_lag"], &["phase_lag_error"], Angle),
    measured(Quantity::StorageModulus, &["storage_modulus"], &["storage_modulus_error"], Stress),
    measured(Quantity::LossModulus, &["loss_modulus"], &["loss_modulus_error"], Stress),
    measured(Quantity::ApproachMin, &["approach_min"], &["approach_min_error"], Length),
    measured(Quantity::ApproachMax, &["approach_max"], &["approach_max_error"], Length),
    measured(Quantity::ContactRadiusMin, &["contact_radius_min"], &["contact_radius_min_error"], Length),
    measured(Quantity::ContactRadiusMax, &["contact_radius_max"], &["contact_radius_max_error"], Length),
    measured(Quantity::PeakPressureMin, &["peak_pressure_min"], &["peak_pressure_min_error"], Stress),
    measured(Quantity::PeakPressureMax, &["peak_pressure_max"], &["peak_pressure_max_error"], Stress),
];

/// By what factor the drive of a table may differ from the one of the file that names it.
const ANOTHER_DRIVE: f64 = 2.0;

/// Two frequencies of a row farther apart than this are two.
const SAME_FREQUENCY: f64 = 1e-3;

const EMPTY: &str = "write a number, or leave the cell empty where nothing was measured";

/// Cycles, and what was measured of them.
type Measured = (Vec<MeasuredCycle>, Vec<Datum>);

/// Reads a table; rows without a `drive_mean` and a `drive_amplitude` of their own are under this drive.
///
/// # Errors
/// What [`DataFile`] refuses; no frequency, no column that a material shows in; errors that are not above zero; frequencies or a
/// drive that contradict others; each with its place.
pub(super) fn parse(
    name: &str,
    bytes: &[u8],
    drive: HarmonicDrive,
) -> Result<Measured, Diagnostics> {
    let file = DataFile::from_bytes(name, bytes)?;
    let wanted = wanted(&file, drive.control())?;
    let problems = Problems::new();
    let rows = Rows {
        table: file.columns_with_holes(&wanted, EMPTY)?,
        wanted,
        drive,
        problems: &problems,
    };
    let (mut cycles, mut data) = (Vec::new(), Vec::new());
    for row in 0..rows.table.len() {
        let numbers = rows.numbers(row).filter(|numbers| !numbers.is_empty());
        let Some((cycle, numbers)) = numbers.and_then(|all| Some((rows.cycle(row)?, all))) else {
            continue;
        };
        data.extend(numbers.into_iter().map(|(quantity, value, error)| Datum {
            place: cycles.len(),
            number: Number::OfCycle(quantity),
            value,
            error,
        }));
        cycles.push(cycle);
    }
    rows.refuse_another_drive(&cycles);
    problems.into_result(Some((cycles, data)))
}

/// The columns that a table has: frequencies, mean and amplitude of the drive, quantities, and the errors of these.
fn wanted(file: &DataFile, control: Control) -> Result<Vec<Column>, Diagnostic> {
    let is_there = |column: &Column| file.has_any(&[*column]);
    let lacks = |what: &str| Diagnostic::at(&file.first_line(), what);
    let mut wanted = vec![ANGULAR, HERTZ];
    wanted.retain(is_there);
    if wanted.is_empty() {
        return Err(lacks("no column of frequencies")
            .help("name it `angular_frequency_rad_per_s` or `frequency_hz`"));
    }
    let of_drive = drive_columns(control);
    if of_drive.iter().all(is_there) {
        wanted.extend(of_drive);
    }
    let quantities = MEASURED.iter().filter(|(_, value, _)| is_there(value));
    let quantities = quantities.flat_map(|(_, value, error)| [*value, *error]);
    let quantities: Vec<Column> = quantities.filter(is_there).collect();
    if quantities.is_empty() {
        let names = MEASURED.map(|(_, value, _)| value.name_in_si()).join(", ");
        return Err(lacks("no column that shows the material")
            .help(format!("give at least one of {names}")));
    }
    wanted.extend(quantities);
    Ok(wanted)
}

/// The rows of a table.
struct Rows<'a> {
    table: Table,
    wanted: Vec<Column>,
    drive: HarmonicDrive,
    problems: &'a Problems,
}

impl Rows<'_> {
    /// The place of a column, where the table has it.
    fn place_of(&self, column: &Column) -> Option<usize> {
        self.wanted.iter().position(|of| of.names == column.names)
    }

    /// The number in a cell, with its place; `None` where there is none.
    fn cell(&self, row: usize, column: &Column) -> Option<(f64, Location)> {
        let place = self.place_of(column)?;
        let value = self.table.values[row * self.table.width() + place];
        (!value.is_nan()).then(|| (value, self.table.cell(row, place)))
    }

    fn number(&self, row: usize, column: &Column) -> Option<f64> {
        self.cell(row, column).map(|(value, _)| value)
    }

    /// What was measured in a row, with its errors where they are known; `None` where a problem was reported.
    fn numbers(&self, row: usize) -> Option<Vec<(Quantity, f64, Option<f64>)>> {
        let mut found = Vec::new();
        for (quantity, value, error) in &MEASURED {
            let Some(value) = self.number(row, value) else {
                continue;
            };
            let error = self.cell(row, error);
            if let Some((_, place)) = error.as_ref().filter(|(error, _)| *error <= 0.0) {
                self.problems
                    .at(place, "an error must be above zero")
                    .help("write a standard deviation, or leave the cell empty: the noise is then estimated");
                return None;
            }
            found.push((*quantity, value, error.map(|(error, _)| error)));
        }
        Some(found)
    }

    /// The cycle of a row; `None` where a problem was reported.
    fn cycle(&self, row: usize) -> Option<MeasuredCycle> {
        let angular_frequency_rad_per_s = self.frequency(row)?;
        let own = drive_columns(self.drive.control()).map(|column| self.number(row, &column));
        let drive = match own {
            [Some(mean), Some(amplitude)] => {
                let (phase_rad, hold_s) = (self.drive.phase_rad(), self.drive.hold_s());
                let own = self.drive.with(mean, amplitude, phase_rad, hold_s);
                self.problems.accept(&self.table.row(row), own)?
            }
            _ => self.drive,
        };
        Some(MeasuredCycle {
            angular_frequency_rad_per_s,
            drive,
            row: row + 1,
        })
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
    fn refuse_another_drive(&self, cycles: &[MeasuredCycle]) {
        let [mean, _] = drive_columns(self.drive.control());
        let is_like = |cycle: &MeasuredCycle| {
            let ratio = cycle.drive.mean() / self.drive.mean();
            (ANOTHER_DRIVE.recip()..=ANOTHER_DRIVE).contains(&ratio)
        };
        let (Some(first), Some(mean)) = (cycles.first(), self.place_of(&mean)) else {
            return;
        };
        if cycles.iter().any(is_like) || self.drive.mean() == 0.0 {
            return;
        }
        let message = format!(
            "the table was measured under a mean of {:e}, and [drive] has {:e} (SI units)",
            first.drive.mean(),
            self.drive.mean()
        );
        let report = self
            .problems
            .at(&self.table.cell(first.row - 1, mean), message);
        report.help("give [drive] the mean and amplitude of the measurement");
    }
}

fn drive_columns(control: Control) -> [Column; 2] {
    let dimension = match control {
        Control::Load => Force,
        Control::Approach => Length,
    };
    let column = |names, what| Column {
        names,
        dimension,
        what,
        // `sweep.csv` has them without, since the unit is that of the control.
        unit_may_be_absent: true,
    };
    [
        column(&["drive_mean"], "means of the drive"),
        column(&["drive_amplitude"], "amplitudes of the drive"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::input::diagnostic::Styling;

    fn under_load(text: &str) -> Result<Measured, Diagnostics> {
        let drive = HarmonicDrive::load(10.0, 5.0).unwrap();
        parse("measured.csv", text.as_bytes(), drive)
    }

    #[test]
    fn columns_are_read_in_their_units_with_errors_and_gaps() {
        let text = "frequency_hz,energy_loss_uJ,energy_loss_error_uJ,phase_lag_deg,status,drive_mean,drive_amplitude\n\
                    1,2,0.1,,converged,10,5\n2,,,,failed,10,5\n4,3,,9,converged,11,4\n";
        let (cycles, data) = under_load(text).unwrap();
        assert_eq!(cycles.len(), 2);
        assert_eq!(cycles[0].angular_frequency_rad_per_s, std::f64::consts::TAU);
        assert_eq!((cycles[1].row, cycles[1].drive.mean()), (3, 11.0));
        let near = |a: f64, b: f64| (a / b - 1.0).abs() < 1e-12;
        assert!(near(data[0].value, 2e-6) && near(data[0].error.unwrap(), 1e-7));
        assert_eq!((data.len(), data[1].error), (3, None));
        assert!(near(data[2].value, std::f64::consts::PI / 20.0));
        assert_eq!(data[2].number, Number::OfCycle(Quantity::PhaseLag));
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
