//! Tables of measured cycles: columns of `sweep.csv` under their names, one row a cycle, cells empty where nothing was measured.

use super::data_file::{Column, DataFile, Table};
use super::diagnostic::{Diagnostic, Diagnostics, Problems};
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
    let columns = Columns::of(&file, drive.control())?;
    let table = file.columns_with_holes(&columns.wanted, EMPTY)?;
    let (mut cycles, mut data) = (Vec::new(), Vec::new());
    let problems = Problems::new();
    for row in 0..table.len() {
        match columns.row(&table, row, &drive) {
            Ok(None) => {}
            Ok(Some((mut cycle, of_cycle))) => {
                cycle.row = row + 1;
                let cycle_place = cycles.len();
                cycles.push(cycle);
                data.extend(of_cycle.into_iter().map(|(quantity, value, error)| Datum {
                    place: cycle_place,
                    number: Number::OfCycle(quantity),
                    value,
                    error,
                }));
            }
            Err(problem) => problems.extend((*problem).into()),
        }
    }
    if let Some(problem) = another_drive(&table, &columns, &cycles, &drive) {
        problems.extend(problem.into());
    }
    problems.into_result(Some((cycles, data)))
}

/// The columns that a table has.
struct Columns {
    wanted: Vec<Column>,
    angular: Option<usize>,
    hertz: Option<usize>,
    drive: Option<[usize; 2]>,
    quantities: Vec<(Quantity, usize, Option<usize>)>,
}

impl Columns {
    fn of(file: &DataFile, control: Control) -> Result<Self, Diagnostic> {
        let mut wanted: Vec<Column> = Vec::new();
        let mut place_of = |column: Column| {
            let place = wanted.len();
            file.has_any(&[column]).then(|| {
                wanted.push(column);
                place
            })
        };
        let (angular, hertz) = (place_of(ANGULAR), place_of(HERTZ));
        let of_drive = drive_columns(control);
        let drive = match of_drive.iter().all(|column| file.has_any(&[*column])) {
            true => place_of(of_drive[0]).zip(place_of(of_drive[1])),
            false => None,
        };
        let mut quantities = Vec::new();
        for (quantity, value, error) in MEASURED {
            if let Some(place) = place_of(value) {
                quantities.push((quantity, place, place_of(error)));
            }
        }
        if angular.is_none() && hertz.is_none() {
            return Err(
                Diagnostic::at(&file.first_line(), "no column of frequencies")
                    .help("name it `angular_frequency_rad_per_s` or `frequency_hz`"),
            );
        }
        if quantities.is_empty() {
            let names = MEASURED.map(|(_, value, _)| value.name_in_si()).join(", ");
            return Err(
                Diagnostic::at(&file.first_line(), "no column that shows the material")
                    .help(format!("give at least one of {names}")),
            );
        }
        Ok(Self {
            wanted,
            angular,
            hertz,
            drive: drive.map(|(mean, amplitude)| [mean, amplitude]),
            quantities,
        })
    }

    /// A row: its cycle, and what was measured of it; `None` where that is nothing.
    #[allow(clippy::type_complexity)]
    fn row(
        &self,
        table: &Table,
        row: usize,
        drive: &HarmonicDrive,
    ) -> Result<Option<(MeasuredCycle, Vec<(Quantity, f64, Option<f64>)>)>, Box<Diagnostic>> {
        let cell = |which: usize| {
            let value = table.values[row * table.width() + which];
            (!value.is_nan()).then_some(value)
        };
        let mut found = Vec::new();
        for (quantity, value, error) in &self.quantities {
            let Some(number) = cell(*value) else {
                continue;
            };
            let known = error.and_then(cell);
            if let Some(place) = error.filter(|_| known.is_some_and(|known| known <= 0.0)) {
                let problem =
                    Diagnostic::at(&table.cell(row, place), "an error must be above zero");
                let help = "write a standard deviation, or leave the cell empty: the noise is then estimated";
                return Err(Box::new(problem.help(help)));
            }
            found.push((*quantity, number, known));
        }
        if found.is_empty() {
            return Ok(None);
        }
        let angular_frequency_rad_per_s = self.frequency(table, row, cell)?;
        let drive = match self.drive.map(|places| places.map(cell)) {
            Some([Some(mean), Some(amplitude)]) => {
                let own = drive.with(mean, amplitude, drive.phase_rad(), drive.hold_s());
                own.map_err(|error| Box::new(Diagnostic::at(&table.row(row), error.to_string())))?
            }
            _ => *drive,
        };
        let cycle = MeasuredCycle {
            angular_frequency_rad_per_s,
            drive,
            row: row + 1,
        };
        Ok(Some((cycle, found)))
    }

    /// The angular frequency (rad/s) of a row.
    fn frequency(
        &self,
        table: &Table,
        row: usize,
        cell: impl Fn(usize) -> Option<f64>,
    ) -> Result<f64, Box<Diagnostic>> {
        let angular = self.angular.and_then(&cell);
        let hertz = self
            .hertz
            .and_then(&cell)
            .map(|f| f * std::f64::consts::TAU);
        if let (Some(angular), Some(hertz), Some(place)) = (angular, hertz, self.hertz)
            && (hertz / angular - 1.0).abs() > SAME_FREQUENCY
        {
            let problem = Diagnostic::at(
                &table.cell(row, place),
                "two frequencies of one row contradict one another",
            );
            let also = self.angular.map(|place| table.cell(row, place));
            let problem = match &also {
                Some(also) => {
                    problem.label(also, "the angular frequency, 2 pi times the frequency")
                }
                None => problem,
            };
            return Err(Box::new(problem.help("keep one of the two columns")));
        }
        match angular.or(hertz) {
            Some(omega) if omega > 0.0 => Ok(omega),
            _ => Err(Box::new(
                Diagnostic::at(&table.row(row), "a row without a frequency above zero")
                    .help("write its frequency, or leave the whole row out"),
            )),
        }
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

/// The drives of the table are nothing like the one of the file.
fn another_drive(
    table: &Table,
    columns: &Columns,
    cycles: &[MeasuredCycle],
    drive: &HarmonicDrive,
) -> Option<Diagnostic> {
    let [mean, _] = columns.drive?;
    let is_like = |cycle: &MeasuredCycle| {
        let ratio = cycle.drive.mean() / drive.mean();
        (ANOTHER_DRIVE.recip()..=ANOTHER_DRIVE).contains(&ratio)
    };
    if cycles.is_empty() || cycles.iter().any(is_like) || drive.mean() == 0.0 {
        return None;
    }
    let message = format!(
        "the table was measured under a mean of {:e}, and [drive] has {:e} (SI units)",
        cycles[0].drive.mean(),
        drive.mean()
    );
    let problem = Diagnostic::at(&table.cell(cycles[0].row - 1, mean), message);
    Some(problem.help("give [drive] the mean and amplitude of the measurement"))
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
