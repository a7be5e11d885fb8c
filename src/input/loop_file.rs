//! Records of measured loops: time, load and approach as columns with units, as instruments write them, or as a `.npy` matrix in SI
//! units; perhaps the contact radius too.

use std::path::Path;

use super::data_file::{Column, DataFile, Holes, MAX_BYTES, contents};
use super::diagnostic::{Diagnostic, Diagnostics, Location, Source};
use super::field_file::npy;
use crate::measured::Signal;
use crate::quantity::Dimension::{Force, Length, Time};

/// Time, load, approach, contact radius. Where a file has several of the names of one, the first in this order counts.
#[rustfmt::skip]
const COLUMNS: [Column; 4] = [
    Column::new(&["time", "test_time", "elapsed_time", "timestamp", "time_stamp", "t"], Time, "times").by_first_name(),
    Column::new(
        &["load", "normal_load", "contact_load", "load_on_sample", "indent_act_load", "force", "normal_force", "fn", "fz", "w", "p"],
        Force, "loads",
    ).by_first_name(),
    Column::new(
        &[
            "approach", "depth", "indentation_depth", "penetration_depth", "indentation", "penetration", "indent_disp",
            "displacement_into_surface", "displacement", "disp", "delta", "h", "d",
        ],
        Length, "approaches",
    ).by_first_name(),
    Column::new(&["contact_radius", "radius_of_contact"], Length, "contact radii").by_first_name().optional(),
];

/// What to do about a cell that is no number and does not say that there is none.
const NO_NUMBER: &str = "leave the cell empty where the sample is missing";

const MATRIX: npy::Wanted = npy::Wanted {
    call: "numpy.save(\"loop.npy\", numpy.column_stack([time_s, load_n, approach_m]).astype(\"<f8\"))",
    layout: "save a matrix of three columns in SI units: time, load, approach; a fourth is the contact radius",
};

/// The record in a file.
///
/// # Errors
/// A file that cannot be read; what [`parse`] refuses.
pub fn read(path: &Path) -> Result<Signal, Diagnostics> {
    let (name, bytes) = contents(path, MAX_BYTES)?;
    parse(&name, &bytes)
}

/// The record in the bytes of a file that messages call `name`: `.npy` by its mark, otherwise text.
///
/// # Errors
/// Absent columns, absent or wrong units, cells that are neither numbers nor empty; each at its place.
pub fn parse(name: &str, bytes: &[u8]) -> Result<Signal, Diagnostics> {
    if bytes.starts_with(npy::MAGIC) {
        return of_matrix(name, bytes).map_err(Diagnostics::from);
    }
    let file = DataFile::from_bytes(name, bytes)?;
    let table = file.columns(&COLUMNS, Holes::Kept, NO_NUMBER)?;
    Ok(Signal {
        time_s: table.column(0),
        load_n: table.column(1),
        approach_m: table.column(2),
        contact_radius_m: table.has(3).then(|| table.column(3)),
    })
}

fn of_matrix(name: &str, bytes: &[u8]) -> Result<Signal, Diagnostic> {
    let matrix = npy::matrix(name, bytes, &MATRIX)?;
    // Three or four rows of many samples are columns that were stacked the other way.
    let is_wide = (3..=4).contains(&matrix.rows) && matrix.columns > 4;
    let (samples, signals) = match is_wide {
        true => (matrix.columns, matrix.rows),
        false => (matrix.rows, matrix.columns),
    };
    if !(3..=4).contains(&signals) {
        let place = Location::whole(&Source::file(name, ""));
        let message = format!("an array of shape ({}, {})", matrix.rows, matrix.columns);
        return Err(Diagnostic::at(&place, message).help(MATRIX.layout));
    }
    let signal = |which: usize| -> Vec<f64> {
        let (from, step) = if is_wide {
            (which * samples, 1)
        } else {
            (which, signals)
        };
        let values = matrix.values.iter().skip(from).step_by(step).take(samples);
        values.copied().collect()
    };
    Ok(Signal {
        time_s: signal(0),
        load_n: signal(1),
        approach_m: signal(2),
        contact_radius_m: (signals > 3).then(|| signal(3)),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Signal, String> {
        parse("loop.csv", text.as_bytes()).map_err(|refused| refused.to_string())
    }

    #[test]
    fn one_record_under_the_names_of_several_programs_is_the_same() {
        for text in [
            "time_s,load_n,approach_m\n0,1e-3,2e-9\n0.5,2e-3,4e-9\n",
            "Time (s),Load (mN),Depth (nm)\n0,1,2\n0.5,2,4\n",
            "Time [ms];Force [µN];Displacement [nm];Comment\n0;1000;2,0;a\n500;2000;4,0;b\n",
            "Test Time (s)\tIndent Disp. (nm)\tIndent Act. Load (uN)\n0\t2\t1000\n0.5\t4\t2000\n",
            "t,P,h\ns,mN,nm\n0,1,2\n0.5,2,4\n",
        ] {
            let signal = read(text).unwrap();
            assert_eq!(signal.time_s, [0.0, 0.5], "{text}");
            for (found, expected) in signal.load_n.iter().zip([1e-3, 2e-3]) {
                assert!((found / expected - 1.0).abs() < 1e-15, "{text}");
            }
            for (found, expected) in signal.approach_m.iter().zip([2e-9, 4e-9]) {
                assert!((found / expected - 1.0).abs() < 1e-15, "{text}");
            }
            assert_eq!(signal.contact_radius_m, None);
        }
    }

    #[test]
    fn a_missing_number_is_a_hole_and_anything_else_is_refused_at_its_place() {
        let signal = read("time_s,load_n,depth_m,contact_radius_um\n0,,2,3\nNaN,1,-,4\n").unwrap();
        assert!(signal.load_n[0].is_nan() && signal.time_s[1].is_nan());
        assert!(signal.approach_m[1].is_nan());
        assert!((signal.contact_radius_m.unwrap()[1] - 4e-6).abs() < 1e-20);
        for (text, place, reason) in [
            ("time_s,load_n,depth_m\n0,many,2\n", "2:3", "not a number"),
            ("time_s,load,depth_m\n0,1,2\n", "1:8", "no unit"),
            ("time_s,load_n\n0,1\n", "1:1", "no column `approach_m`"),
            (
                "time_s,load_m,depth_m\n0,1,2\n",
                "1:1",
                "no column `load_n`",
            ),
        ] {
            let refused = read(text).unwrap_err();
            let words = refused.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains(&format!("loop.csv:{place}")), "{refused}");
            assert!(words.contains(reason), "{refused}");
        }
    }

    /// A `.npy` file of version 1.
    fn npy(rows: usize, columns: usize, values: &[f64]) -> Vec<u8> {
        let header =
            format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}\n");
        let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
        bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
        bytes.extend(header.as_bytes());
        bytes.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    #[test]
    fn a_matrix_of_numpy_is_read_along_either_side() {
        let columns: Vec<f64> = (0..15).map(f64::from).collect();
        let signal = parse("a.npy", &npy(5, 3, &columns)).unwrap();
        assert_eq!(signal.load_n, [1.0, 4.0, 7.0, 10.0, 13.0]);
        let signal = parse("a.npy", &npy(3, 5, &columns)).unwrap();
        assert_eq!(signal.load_n, [5.0, 6.0, 7.0, 8.0, 9.0]);
        assert!(parse("a.npy", &npy(15, 1, &columns)).is_err());
    }
}
