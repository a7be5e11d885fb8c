//! The tables of a material made of dynamic data: its series, its shift factors, its master curve.

use super::DynamicReport;
use crate::material::Relaxation;
use crate::material::dynamic::master_curve::MasterCurve;
use crate::quantity::ZERO_CELSIUS_K;
use crate::report::table::{Cell, cells, csv};

/// `prony.csv`: the equilibrium modulus, which has no time, then the branches.
pub fn prony(relaxation: &Relaxation) -> Vec<u8> {
    let equilibrium = cells![relaxation.equilibrium_modulus(), Cell::Absent];
    let branches = relaxation.branches().iter();
    let branches = branches.map(|branch| cells![branch.modulus_pa, branch.time_s]);
    csv(
        &["modulus_pa", "time_s"],
        std::iter::once(equilibrium).chain(branches),
    )
}

/// `shift.csv`: decimal logarithms of the shift factors; an error that is not known is an empty cell.
pub fn shift_factors(master: &MasterCurve) -> Vec<u8> {
    let rows = master.shifts.iter().map(|shift| {
        cells![
            celsius(shift.temperature_k),
            shift.log10_a_t,
            shift.log10_a_t_error,
        ]
    });
    csv(&["temperature_c", "log10_a_t", "log10_a_t_error"], rows)
}

/// `master.csv`: every point at its reduced frequency, and the series there. A temperature that is not known is an empty cell.
pub fn master_curve(report: &DynamicReport<'_>) -> Vec<u8> {
    let points = report.points();
    let rows = points.iter().map(|point| {
        let fit = report
            .relaxation()
            .complex_modulus(point.angular_frequency_rad_per_s);
        cells![
            point.angular_frequency_rad_per_s,
            point.storage_modulus_pa,
            point.loss_modulus_pa,
            point.temperature_k.map(celsius),
            fit.re,
            fit.im,
        ]
    });
    let columns = [
        "angular_frequency_rad_per_s",
        "storage_modulus_pa",
        "loss_modulus_pa",
        "temperature_c",
        "storage_fit_pa",
        "loss_fit_pa",
    ];
    csv(&columns, rows)
}

/// A temperature in °C to a billionth of a degree: what a file said in °C comes out as it went in.
pub fn celsius(temperature_k: f64) -> f64 {
    // Adding zero takes the sign off a zero.
    ((temperature_k - ZERO_CELSIUS_K) * 1e9).round() / 1e9 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::dynamic::tests::{measured, solid, source};

    #[test]
    fn the_equilibrium_is_the_first_row_and_has_no_time() {
        let table = String::from_utf8(prony(&solid())).unwrap();
        assert_eq!(table, "modulus_pa,time_s\n5e6,\n8e8,1e-3\n6e7,1e1\n");
    }

    #[test]
    fn an_unknown_error_and_an_unknown_temperature_are_empty_cells() {
        let (data, mut made) = measured();
        let master = made.master.as_mut().unwrap();
        master.shifts.truncate(1);
        master.shifts[0].log10_a_t = 2.5;
        master.shifts[0].log10_a_t_error = None;
        let table = String::from_utf8(shift_factors(master)).unwrap();
        assert_eq!(
            table,
            "temperature_c,log10_a_t,log10_a_t_error\n5e0,2.5e0,\n"
        );
        master.points[0].temperature_k = None;
        let (points, source) = (master.points.len(), source());
        let table = master_curve(&DynamicReport {
            source: &source,
            data: &data,
            made: &made,
            beside: None,
        });
        let table = String::from_utf8(table).unwrap();
        assert_eq!(table.lines().count(), 1 + points);
        let cells = |row: usize| {
            table
                .lines()
                .nth(row)
                .unwrap()
                .split(',')
                .collect::<Vec<_>>()
        };
        assert_eq!(cells(1)[3], "");
        assert!(!cells(2)[3].is_empty());
    }

    #[test]
    fn temperatures_come_out_as_they_went_in() {
        for celsius_in in [-40.0, 0.0, 25.0, 21.7, 99.99] {
            let kelvin: f64 = celsius_in + ZERO_CELSIUS_K;
            assert_eq!(celsius(kelvin), celsius_in);
        }
    }
}
