//! What the terminal and the comments of a material block say of dynamic data.

use super::DynamicReport;
use crate::material::dynamic::DynamicPoint;
use crate::material::dynamic::master_curve::MasterCurve;
use crate::material::dynamic::shift_law::{Arrhenius, ShiftLaw, Wlf};
use crate::quantity::{celsius, format_human};
use crate::report::fit::relaxation_branches;
use crate::report::number::{four_digits, scientific};
use crate::report::text::{Column, Table, Text};
use crate::report::words::listed;

impl DynamicReport<'_> {
    /// What was read, how well it fits and what to know of it.
    pub fn text(&self) -> Text {
        self.lines().into_iter().collect()
    }

    /// The same, one fact a line.
    pub fn lines(&self) -> Vec<String> {
        let notes = self.source.notes.iter().map(|note| format!("Note: {note}"));
        let warnings = self.warnings().into_iter();
        let mut lines = vec![self.read()];
        lines.extend(notes);
        lines.extend(self.made.master.iter().flat_map(laws));
        lines.extend(self.quality());
        let beside = self.beside.map(|beside| beside.lines(self.made.kind));
        lines.extend(beside.into_iter().flatten());
        lines.extend(warnings.map(|warning| format!("Warning: {warning}.")));
        lines
    }

    /// Files, format, isotherms.
    fn read(&self) -> String {
        let source = self.source;
        let how = match source.how.is_empty() {
            true => String::new(),
            false => format!(" ({})", source.how),
        };
        let points = self.data.points().count();
        let isotherms = self.data.isotherms();
        let ends = [isotherms.first(), isotherms.last()].map(|i| i?.temperature_k.map(celsius));
        let isotherms = match (isotherms.len(), ends) {
            (1, [Some(at), _]) => format!("at {at}"),
            (count, [Some(from), Some(to)]) => format!("in {count} isotherms from {from} to {to}"),
            _ => "at a temperature that the file does not name".to_owned(),
        };
        let (symbol, files) = (self.symbol(), listed(&source.files));
        format!(
            "{files}: {}{how}; {points} points of {symbol}′ and {symbol}″ {isotherms}.",
            source.format
        )
    }

    /// Series, misfit, window, consistency.
    fn quality(&self) -> Vec<String> {
        let (fit, symbol) = (&self.made.fit, self.symbol());
        let count = self.relaxation().branches().len();
        let plural = if count == 1 { "" } else { "es" };
        let at = self.reference_temperature_k();
        let at = at.map_or(String::new(), |at| format!(" at {}", celsius(at)));
        let unit = self.source.frequency_unit;
        let frequency = |omega| format_human(unit.of(omega), unit.dimension(), 4);
        let (lowest, highest) = fit.window_rad_per_s;
        let mut lines = vec![
            format!(
                "Series{at}: {count} branch{plural}; misfit relative to the data {} rms of {symbol}′, {} rms of {symbol}″.",
                percent(fit.storage_rms),
                percent(fit.loss_rms)
            ),
            format!(
                "Measured from {} = {} to {}{at}; outside, the series is an extrapolation.",
                unit.symbol(),
                frequency(lowest),
                frequency(highest)
            ),
        ];
        let simple = self.made.master.as_ref().and_then(|m| m.simplicity);
        lines.extend(simple.map(|simplicity| {
            format!(
                "Thermorheological simplicity: the isotherms lie {} times the noise from one common curve (about 1 where one curve \
                 describes them all).",
                scientific(simplicity, 2)
            )
        }));
        lines.push(match fit.kramers_kronig {
            Some(number) => format!(
                "Kramers-Kronig: no passive material comes closer to {symbol}′ and {symbol}″ together than {} times the noise (about 1 \
                 where the two are consistent).",
                scientific(number, 2)
            ),
            None => "Kramers-Kronig: too few points to tell whether the two moduli are consistent.".to_owned(),
        });
        if !self.made.replicas.is_empty() {
            lines.push(format!(
                "{} bootstrap samples of the series carry the noise of the data on.",
                self.made.replicas.len()
            ));
        }
        lines
    }

    /// The shift factors as a table; nothing without a master curve.
    pub fn shift_table(&self) -> Text {
        let Some(master) = &self.made.master else {
            return Text::default();
        };
        let vertical = master.shifts.iter().any(|shift| shift.b_t != 1.0);
        let unit = self.source.frequency_unit;
        let symbol = unit.symbol();
        let columns = [
            Column::right("Temperature", 11),
            Column::right("log10 a_T", 11),
            Column::right("std. error", 11),
            Column::right("points", 7),
            Column::right(format!("{symbol} from"), 8),
            Column::right(format!("{symbol} to"), 8),
        ];
        let b_t = vertical.then(|| Column::right("vertical b_T", 12));
        let mut table = Table::new(2, columns.into_iter().chain(b_t));
        for shift in &master.shifts {
            let mut isotherms = self.data.isotherms().iter();
            let is_of = |t: f64| (t - shift.temperature_k).abs() < 0.01;
            let isotherm = isotherms.find(|i| i.temperature_k.is_some_and(is_of));
            let points = isotherm.map(|i| &i.points[..]).unwrap_or_default();
            let or_dash = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
            let omega = |point: Option<&DynamicPoint>| {
                or_dash(point.map(|p| four_digits(unit.of(p.angular_frequency_rad_per_s))))
            };
            // Adding zero takes the sign off a zero.
            let log10_a_t = (1e4 * shift.log10_a_t).round() / 1e4 + 0.0;
            let cells = [
                celsius(shift.temperature_k),
                format!("{log10_a_t:.4}"),
                or_dash(shift.log10_a_t_error.map(|error| format!("{error:.4}"))),
                points.len().to_string(),
                omega(points.first()),
                omega(points.last()),
            ];
            let b_t = vertical.then(|| format!("{:.4}", shift.b_t));
            table.row(cells.into_iter().chain(b_t));
        }
        table.into()
    }

    /// Equilibrium and branches, to be read; exact ones are in the material block.
    pub fn branches(&self) -> Text {
        relaxation_branches(self.relaxation())
    }
}

/// Reference temperature and the laws through the shift factors.
fn laws(master: &MasterCurve) -> Vec<String> {
    let reference = celsius(master.reference_temperature_k);
    // Alone, a law is preferred to nothing.
    let both = master.wlf.is_some() && master.arrhenius.is_some();
    let line = |law: String, is_preferred: bool| match is_preferred && both {
        true => format!("{law}; the data prefer it."),
        false => format!("{law}."),
    };
    let prefers_wlf = matches!(master.preferred, Some(ShiftLaw::Wlf(_)));
    let prefers_arrhenius = matches!(master.preferred, Some(ShiftLaw::Arrhenius(_)));
    let of_wlf = master.wlf.iter().map(|law| line(wlf(law), prefers_wlf));
    let of_arrhenius = master.arrhenius.iter();
    let of_arrhenius = of_arrhenius.map(|law| line(arrhenius(law), prefers_arrhenius));
    let opening = [format!("Master curve at {reference}.")].into_iter();
    opening.chain(of_wlf).chain(of_arrhenius).collect()
}

/// The constants of a WLF law with their errors.
pub(in crate::report) fn wlf(law: &Wlf) -> String {
    format!(
        "WLF: c1 = {}, c2 = {} K",
        plus_minus(law.c1, law.c1_error),
        plus_minus(law.c2_k, law.c2_error_k)
    )
}

/// The activation energy with its error.
pub(in crate::report) fn arrhenius(law: &Arrhenius) -> String {
    let (energy, error) = (
        law.activation_energy_j_per_mol,
        law.activation_energy_error_j_per_mol,
    );
    format!(
        "Arrhenius: activation energy {} kJ/mol",
        plus_minus(1e-3 * energy, 1e-3 * error)
    )
}

/// A value with as many decimals as the first two digits of its error take.
fn plus_minus(value: f64, error: f64) -> String {
    if !(error.is_finite() && error > 0.0) {
        return scientific(value, 5);
    }
    let decimals = (1 - error.log10().floor() as i32).clamp(0, 6) as usize;
    format!("{value:.decimals$} ± {error:.decimals$}")
}

/// A share in per cent, in two digits.
pub(in crate::report) fn percent(share: f64) -> String {
    format!("{} %", scientific(100.0 * share, 2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::quantity::{Dimension, FrequencyUnit};
    use crate::report::dynamic::Source;
    use crate::report::dynamic::tests::{measured, source};

    #[test]
    fn the_text_says_all_of_it_in_eighty_columns() {
        let (data, mut made) = measured();
        let source = source();
        made.master.as_mut().unwrap().shifts[3].log10_a_t_error = None;
        let report = DynamicReport {
            source: &source,
            data: &data,
            made: &made,
            beside: None,
        };
        let text = format!(
            "{}{}{}",
            report.text(),
            report.shift_table(),
            report.branches()
        );
        assert!(
            text.lines().all(|line| line.chars().count() <= 80),
            "{text}"
        );
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        for part in [
            "solid.csv: generic table (columns named with their units); 45 points of E′ and E″ in 5 isotherms from 5 °C to 45 °C.",
            "Note: two points",
            "Master curve at 25 °C.",
            "WLF: c1 = 12.00 ± 0.20, c2 = 60.0 ± 1.5 K; the data prefer it.",
            "Arrhenius: activation energy 310.0 ± 4.0 kJ/mol.",
            "Series at 25 °C: 2 branches; misfit relative to the data 0.71 % rms of E′, 1.4 % rms of E″.",
            "25 °C 0.0000 0.0000 9 0.1000 100.0",
            "35 °C -1.7143 - 9",
            "2 60.000 MPa 10.000 s",
        ] {
            assert!(words.contains(part), "{part}\n{text}");
        }
        // Data that are all in Hz are spoken of in Hz.
        let [in_hertz, in_radians] = [FrequencyUnit::Hz, FrequencyUnit::RadPerS].map(|unit| {
            let source = Source {
                frequency_unit: unit,
                ..source.clone()
            };
            let report = DynamicReport {
                source: &source,
                ..report
            };
            report.text().to_string() + &report.shift_table().to_string()
        });
        let (low, high) = made.fit.window_rad_per_s;
        let hertz = |omega| format_human(FrequencyUnit::Hz.of(omega), Dimension::Frequency, 4);
        let measured = format!("Measured from f = {} to {}", hertz(low), hertz(high));
        assert!(in_hertz.contains(&measured), "{in_hertz}");
        assert!(in_radians.contains("Measured from ω = ") && in_radians.contains("ω from"));
        assert!(
            !in_hertz.contains("ω") && in_hertz.contains("f from"),
            "{in_hertz}"
        );
    }
}
