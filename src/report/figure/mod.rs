//! Figures, one file each: a chart, its caption and the data behind it. [`press`] writes them in the forms asked for.

pub mod cole_cole;
pub mod comparison;
pub mod curve;
pub mod dissipation;
pub mod dissipation_map;
pub mod dissipation_profile;
pub mod drive_map;
pub mod energy_loss;
pub mod equivalent;
pub mod fit;
pub mod harmonic_map;
pub mod history;
pub mod loops;
pub mod loss_map;
pub mod loss_tangent;
pub mod moduli;
pub mod moduli_error;
pub mod of_sweep;
pub mod press;
pub mod pressure_map;
pub mod profiles;
pub mod relaxation;
pub mod units;
pub mod van_gurp_palmen;

use super::caption::Caption;
use super::chart::{self, Chart, ChartError, Drawing, HeatMap};

/// A picture, the name of its files, what is to be said of it, and its data as CSV.
pub struct Figure {
    pub name: &'static str,
    pub picture: Picture,
    pub caption: Caption,
    /// Empty where another file holds them.
    pub data: Vec<u8>,
}

/// What a figure shows.
#[derive(Clone)]
pub enum Picture {
    Chart(Box<Chart>),
    /// Charts one above another.
    Stack(Vec<Chart>),
}

impl From<Chart> for Picture {
    fn from(chart: Chart) -> Self {
        Self::Chart(Box::new(chart))
    }
}

impl From<HeatMap> for Picture {
    fn from(map: HeatMap) -> Self {
        Self::from(Chart::from(map))
    }
}

impl Picture {
    pub(super) fn draw(&self) -> Result<Drawing, ChartError> {
        match self {
            Self::Chart(chart) => chart.draw(),
            Self::Stack(charts) => chart::stack(charts),
        }
    }
}

/// A figure, or why there is none: an empty frame says less than a sentence.
pub enum Drawn {
    Figure(Figure),
    LeftOut(String),
}

impl Drawn {
    fn left_out(why: &str) -> Self {
        Self::LeftOut(why.to_owned())
    }
}

/// The power of ten and its prefix in which values up to `largest` read well: (factor to multiply by, prefix).
pub(super) fn prefix(largest: f64) -> (f64, &'static str) {
    const PREFIXES: [(f64, &str); 11] = [
        (1e-15, "f"),
        (1e-12, "p"),
        (1e-9, "n"),
        (1e-6, "µ"),
        (1e-3, "m"),
        (1.0, ""),
        (1e3, "k"),
        (1e6, "M"),
        (1e9, "G"),
        (1e12, "T"),
        (1e15, "P"),
    ];
    if largest == 0.0 {
        return (1.0, "");
    }
    let fits = PREFIXES.iter().rev().find(|(unit, _)| largest >= *unit);
    let (unit, name) = fits.unwrap_or(&PREFIXES[0]);
    (unit.recip(), name)
}

/// A number with a power of ten in superscript where it is not of everyday size: `8.44 × 10⁻³`, `0.278`, `10⁻⁴`.
pub fn scientific(value: f64, significant: usize) -> String {
    let text = format!("{value:.*e}", significant.saturating_sub(1));
    let Some((mantissa, exponent)) = text.split_once('e') else {
        return text;
    };
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-1..=3).contains(&exponent) {
        let decimals = (significant as i32 - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{value:.decimals$}"));
    }
    let mantissa = trimmed(mantissa);
    let power = superscript(exponent);
    if mantissa == "1" {
        format!("10{power}")
    } else {
        format!("{mantissa} × 10{power}")
    }
}

/// Without zeros at the end of the decimals.
fn trimmed(number: &str) -> String {
    if number.contains('.') {
        number
            .trim_end_matches('0')
            .trim_end_matches('.')
            .to_owned()
    } else {
        number.to_owned()
    }
}

fn superscript(exponent: i32) -> String {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let raised = |c: char| match c.to_digit(10) {
        Some(digit) => DIGITS[digit as usize % 10],
        None => '⁻',
    };
    exponent.to_string().chars().map(raised).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_as_in_print() {
        assert_eq!(scientific(8.44e-3, 3), "8.44 × 10⁻³");
        assert_eq!(scientific(1e-4, 3), "10⁻⁴");
        assert_eq!(scientific(0.278, 3), "0.278");
        assert_eq!(scientific(1.0, 3), "1");
        assert_eq!(scientific(12.0, 3), "12");
        assert_eq!(scientific(2.5e12, 3), "2.5 × 10¹²");
    }

    #[test]
    fn a_prefix_keeps_the_largest_value_between_one_and_a_thousand() {
        for (largest, name) in [(3.5e-6, "µ"), (15.0, ""), (1e3, "k"), (2e-20, "f")] {
            assert_eq!(prefix(largest).1, name);
        }
        let (factor, _) = prefix(999e-9);
        assert!((999e-9 * factor - 999.0).abs() < 1e-9);
    }
}
