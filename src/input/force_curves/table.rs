//! Force curves as tables: time, and force over indentation, or what an instrument has in their place.

use std::collections::BTreeMap;

use crate::force_curve::ForceCurve;
use crate::force_curve::resolved::Probe;
use crate::input::data_file::{Column, DataFile, Holds, Holes, TIME};
use crate::input::diagnostic::{Diagnostic, Diagnostics, Location, Problems, Source};
use crate::quantity::Dimension::{Force, Length, Voltage};

const CURVE: Column = Column::pure(
    &["curve", "curve_number", "curve_index"],
    "numbers of curves",
)
.optional();

/// Of a cantilever, as a length or as its detector gives it.
const DEFLECTION: [&str; 6] = [
    "deflection",
    "cantilever_deflection",
    "vertical_deflection",
    "cantilever",
    "deflection_signal",
    "photodetector",
];

#[rustfmt::skip]
const COLUMNS: [Column; 8] = [
    TIME,
    Column::new(&["force", "load", "normal_force"], Force, "forces").by_first_name().optional(),
    Column::new(&["indentation", "depth", "approach", "penetration", "tip_sample_separation", "disp"], Length, "indentations")
        .by_first_name().optional(),
    Column::new(&["piezo", "z_piezo", "piezo_position", "height", "z"], Length, "piezo positions").by_first_name().optional(),
    Column::new(&DEFLECTION, Length, "deflections").by_first_name().optional(),
    CURVE,
    // That of a load in a history of this program is the error of its computation.
    Column::new(&["force"], Force, "errors of forces").of_errors(Holds::Errors, "errors of forces").optional(),
    Column::new(&DEFLECTION, Voltage, "deflections in volts").by_unit().by_first_name().optional(),
];

/// The curves of a table that messages call `name`.
///
/// # Errors
/// What [`DataFile`] refuses; columns that make no force and no indentation; times in no order; each at its place.
pub(super) fn parse(
    name: &str,
    bytes: &[u8],
    probe: &Probe,
) -> Result<Vec<ForceCurve>, Diagnostics> {
    let file = DataFile::from_bytes(name, bytes)?;
    let without_number = "write a number, or leave the cell empty where nothing was measured";
    let table = file.columns(&COLUMNS, Holes::PassedOver, without_number)?;
    let column = |place: usize| table.has(place).then(|| table.column(place));
    let [force_n, indentation_m, piezo_m, deflection_m] = [1, 2, 3, 4].map(column);
    let header = file.first_line();
    let deflection_m = match (deflection_m, column(7), probe.sensitivity_m_per_v) {
        (None, Some(signal_v), Some(sensitivity)) => Some(times(&signal_v, sensitivity)),
        (None, Some(_), None) if force_n.is_none() => {
            return Err(Diagnostic::at(&header, "a deflection in volts, and no sensitivity")
                .because("the deflection is their product")
                .help("add `[instrument]` with `sensitivity = \"50 nm/V\"`, or a column `deflection_m` or `force_n`")
                .into());
        }
        (deflection_m, ..) => deflection_m,
    };
    let signals = Signals {
        header,
        force_n,
        indentation_m,
        piezo_m,
        deflection_m,
        spring: probe.spring_constant_n_per_m,
    };
    let (force_n, indentation_m) = (signals.force_n()?, signals.indentation_m()?);
    let piezo_m = signals.piezo_m;
    let time_s = table.column(0);
    let of_row = column(5).unwrap_or_else(|| vec![0.0; time_s.len()]);
    let mut curves: BTreeMap<u64, ForceCurve> = BTreeMap::new();
    let problems = Problems::new();
    let stem = super::stem(name);
    let many = table.has(5);
    let force_error_n = column(6);
    if let Some(row) = force_error_n
        .iter()
        .flatten()
        .position(|error| *error <= 0.0)
    {
        let report = Diagnostic::at(&table.cell(row, 6), "an error must be above zero");
        return Err(report
            .help(
                "write a standard deviation, or leave the column out: the noise is then estimated",
            )
            .into());
    }
    let mut squares: BTreeMap<u64, f64> = BTreeMap::new();
    for (row, number) in of_row.iter().enumerate() {
        let curve = curves.entry(number.to_bits()).or_default();
        if curve.time_s.is_empty() {
            curve.name = match many {
                true => format!("{stem}-{number}"),
                false => stem.clone(),
            };
        }
        if curve.time_s.last().is_some_and(|last| time_s[row] <= *last) {
            problems
                .at(&table.cell(row, 0), "this time does not follow the one above")
                .help("sort the rows of every curve by time, and keep one row per time; number several curves in a column `curve`");
            break;
        }
        curve.time_s.push(time_s[row]);
        curve.force_n.push(force_n[row]);
        if let Some(errors) = &force_error_n {
            // The noise of a curve is one number: the root mean square of its errors.
            let sum = squares.entry(number.to_bits()).or_default();
            *sum += errors[row] * errors[row];
            let count = curve.force_n.len() as f64;
            curve.force_error_n = Some((*sum / count).sqrt());
        }
        let gives_m = probe.frame_compliance_m_per_n * force_n[row];
        curve.indentation_m.push(indentation_m[row] - gives_m);
        if let Some(piezo_m) = &piezo_m {
            curve.travel_m.get_or_insert_default().push(piezo_m[row]);
        }
    }
    if curves.is_empty() {
        let whole = Location::whole(&Source::file(name, ""));
        return Err(Diagnostic::at(&whole, "the table has no rows")
            .help("give a row per sample")
            .into());
    }
    problems.into_result(Some(curves.into_values().collect()))
}

/// What a table has, and the spring constant (N/m), where it is known.
struct Signals {
    header: Location,
    force_n: Option<Vec<f64>>,
    indentation_m: Option<Vec<f64>>,
    piezo_m: Option<Vec<f64>>,
    deflection_m: Option<Vec<f64>>,
    spring: Option<f64>,
}

const COLUMNS_OF_A_CURVE: &str = "give `time_s,force_n,indentation_m`, or `time_s,piezo_m,deflection_m` with the spring constant in \
                                  `[instrument]`";

impl Signals {
    fn refused(&self, what: &str) -> Diagnostic {
        Diagnostic::at(&self.header, what)
    }

    /// The force, or what a deflection says of it.
    fn force_n(&self) -> Result<Vec<f64>, Diagnostic> {
        match (&self.force_n, &self.deflection_m, self.spring) {
            (Some(force_n), ..) => Ok(force_n.clone()),
            (None, Some(deflection_m), Some(spring)) => Ok(times(deflection_m, spring)),
            (None, Some(_), None) => Err(self
                .refused("a deflection, and no spring constant")
                .because("the force is their product")
                .help("add `[instrument]` with `spring_constant = \"0.1 N/m\"`, or a column `force_n`")),
            (None, None, _) => Err(self
                .refused("no column `force_n` and no column `deflection_m`")
                .help(COLUMNS_OF_A_CURVE)),
        }
    }

    /// The indentation, or the position of the piezo less the deflection.
    fn indentation_m(&self) -> Result<Vec<f64>, Diagnostic> {
        let piezo_m = match (&self.indentation_m, &self.piezo_m) {
            (Some(indentation_m), _) => return Ok(indentation_m.clone()),
            (None, Some(piezo_m)) => piezo_m,
            (None, None) => {
                return Err(self
                    .refused("no column `indentation_m` and no column `piezo_m`")
                    .help(COLUMNS_OF_A_CURVE));
            }
        };
        let deflection_m = match (&self.deflection_m, &self.force_n, self.spring) {
            (Some(deflection_m), ..) => deflection_m.clone(),
            (None, Some(force_n), Some(spring)) => times(force_n, 1.0 / spring),
            _ => {
                return Err(self
                    .refused("a piezo position and a force, and no spring constant")
                    .because("the indentation is the position less the deflection")
                    .help("add `[instrument]` with `spring_constant = \"0.1 N/m\"`, or a column `deflection_m` or `indentation_m`"));
            }
        };
        let both = piezo_m.iter().zip(&deflection_m);
        Ok(both.map(|(piezo, deflection)| piezo - deflection).collect())
    }
}

fn times(values: &[f64], factor: f64) -> Vec<f64> {
    values.iter().map(|value| factor * value).collect()
}
