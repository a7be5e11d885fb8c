//! The tables of force curves: a row for every curve, the points of the fits, the moduli with their bands, the ensemble.

use super::{CurvesReport, Found};
use crate::identify::SoughtAttraction;
use crate::report::identify::tables::{COLUMNS, MODULI, SAMPLED, cells_of, sampled, with_ends};
use crate::report::table::{Cell, cells, csv};

/// `curves.csv`: a row for every curve.
pub fn curves(report: &CurvesReport<'_>) -> Vec<u8> {
    let before = ["curve", "x_m", "y_m", "status", "law", "law_weight"];
    let behind = [
        "contact_point_m",
        "contact_point_low_m",
        "contact_point_high_m",
        "reduced_chi_squared",
        "message",
    ];
    let sought = report.plan.fit.attraction != SoughtAttraction::Known;
    let work = ["work_j_per_m2", "work_low_j_per_m2", "work_high_j_per_m2"];
    let work = if sought { &work[..] } else { &[] };
    let columns = [&before[..], &MODULI, work, &behind].concat();
    let rows = report.curves().iter().map(|(curve, found)| {
        let (x_m, y_m) = curve.place_m.unzip();
        let mut row = cells![curve.name.clone(), x_m, y_m].to_vec();
        match found {
            Err(error) => {
                row.push("failed".to_owned().into());
                row.resize(columns.len() - 1, Cell::Absent);
                row.push(error.to_string().into());
            }
            Ok(found) => {
                let (fit, omega) = (found.fit, found.middle());
                let values = fit
                    .laws
                    .band(omega)
                    .map(|band| with_ends(omega, &band).map(Some));
                let contact = fit.contact_point_m;
                row.extend(cells![
                    "converged",
                    fit.laws.best().form.in_words(),
                    fit.laws.best().weight
                ]);
                row.extend(values.unwrap_or([None; 7]).map(Cell::from));
                if let Some(work) = fit.attraction.first() {
                    row.extend(cells![work.value, work.low, work.high]);
                }
                row.extend(cells![
                    contact.value,
                    contact.low,
                    contact.high,
                    fit.laws.reduced_chi_squared,
                    String::new()
                ]);
            }
        }
        row
    });
    csv(&columns, rows)
}

/// `fit.csv`: every point as measured and as computed.
pub fn points(report: &CurvesReport<'_>) -> Vec<u8> {
    let columns = [
        "curve",
        "time_s",
        "indentation_m",
        "force_n",
        "force_error_n",
        "computed_n",
    ];
    let rows = report.found().flat_map(|Found { curve, fit, .. }| {
        (0..fit.computed_n.len()).map(|k| {
            cells![
                curve.name.clone(),
                fit.points.time_s[k],
                fit.points.indentation_m[k],
                fit.points.force_n[k],
                fit.error_n[k],
                fit.computed_n[k],
            ]
        })
    });
    csv(&columns, rows)
}

/// `ensemble.csv`: the moduli of every sample, at both ends of the window and in the middle.
pub fn ensemble(report: &CurvesReport<'_>) -> Vec<u8> {
    let before = ["curve", "sample", "law", "contact_point_m"];
    let rows = report.found().flat_map(|Found { curve, fit, .. }| {
        let samples = fit.ensemble.iter().enumerate();
        samples.flat_map(|(number, (drawn, contact_point_m))| {
            let law = drawn.form.in_words();
            let before = cells![curve.name.clone(), number + 1, law, *contact_point_m];
            sampled(&before, drawn, fit.window_rad_per_s)
        })
    });
    csv(&[&before[..], &SAMPLED].concat(), rows)
}

/// `moduli.csv`: E' and E'' with their 95 % bands, over the curve and a little beyond; of several curves each by its name.
pub fn moduli(report: &CurvesReport<'_>) -> Vec<u8> {
    let is_single = report.single().is_some();
    let name = (!is_single).then_some("curve");
    let columns: Vec<&str> = name.into_iter().chain(COLUMNS).collect();
    let rows = report.found().flat_map(|Found { curve, bands, fit }| {
        bands.iter().map(move |(omega, band)| {
            let name = (!is_single).then(|| Cell::from(curve.name.clone()));
            let values = cells_of(*omega, band, fit.window_rad_per_s);
            name.into_iter().chain(values).collect::<Vec<Cell>>()
        })
    });
    csv(&columns, rows)
}
