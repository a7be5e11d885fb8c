//! Units: their symbols and prefixes, and the reading of products and quotients of them.

use std::f64::consts::PI;

use super::ZERO_CELSIUS_K;

/// Exponents of metre, kilogram, second, radian, cycle, kelvin and volt.
///
/// Radian and cycle are kept apart from a pure number, so that rad/s and Hz are not confused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Exponents(pub(super) [i32; 7]);

impl Exponents {
    pub(super) const NONE: Exponents = Exponents([0; 7]);

    fn plus(self, other: Exponents, times: i32) -> Exponents {
        Exponents(std::array::from_fn(|k| self.0[k] + other.0[k] * times))
    }
}

/// A unit in terms of SI: `10^decimal_exponent * (seconds ratio) * (pi/180)^degrees`, counted from `zero_k`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    pub(super) exponents: Exponents,
    pub(super) decimal_exponent: i32,
    /// Whole numbers by which to multiply and to divide: 60, 3600 and 86400 and their products.
    multiplier: f64,
    divisor: f64,
    degrees: i32,
    /// Where a scale of temperatures begins (K); zero for every other unit, and where °C is part of a product.
    pub(super) zero_k: f64,
}

/// Why a text is no unit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum UnitProblem {
    /// A symbol that does not exist.
    Unknown(String),
    /// A product after a division sign.
    Ambiguous,
}

/// A unit symbol that stands for itself.
struct Symbol {
    text: &'static str,
    unit: Unit,
    takes_prefix: bool,
}

const fn prefixable(text: &'static str, exponents: [i32; 7]) -> Symbol {
    Symbol {
        text,
        unit: Unit::of(exponents),
        takes_prefix: true,
    }
}

const fn without_prefix(text: &'static str, unit: Unit) -> Symbol {
    Symbol {
        text,
        unit,
        takes_prefix: false,
    }
}

const fn time(text: &'static str, seconds: f64) -> Symbol {
    let mut unit = Unit::of([0, 0, 1, 0, 0, 0, 0]);
    unit.multiplier = seconds;
    without_prefix(text, unit)
}

const GRAM: Unit = Unit {
    decimal_exponent: -3,
    ..Unit::of([0, 1, 0, 0, 0, 0, 0])
};
const ANGSTROM: Unit = Unit {
    decimal_exponent: -10,
    ..Unit::of([1, 0, 0, 0, 0, 0, 0])
};
const DEGREE: Unit = Unit {
    degrees: 1,
    ..Unit::of([0, 0, 0, 1, 0, 0, 0])
};
const CELSIUS: Unit = Unit {
    zero_k: ZERO_CELSIUS_K,
    ..Unit::of([0, 0, 0, 0, 0, 1, 0])
};

const SYMBOLS: [Symbol; 18] = [
    prefixable("m", [1, 0, 0, 0, 0, 0, 0]),
    prefixable("N", [1, 1, -2, 0, 0, 0, 0]),
    prefixable("Pa", [-1, 1, -2, 0, 0, 0, 0]),
    prefixable("s", [0, 0, 1, 0, 0, 0, 0]),
    prefixable("J", [2, 1, -2, 0, 0, 0, 0]),
    prefixable("Hz", [0, 0, -1, 0, 1, 0, 0]),
    prefixable("rad", [0, 0, 0, 1, 0, 0, 0]),
    Symbol {
        text: "g",
        unit: GRAM,
        takes_prefix: true,
    },
    without_prefix("Å", ANGSTROM),
    time("min", 60.0),
    time("h", 3600.0),
    time("d", 86400.0),
    without_prefix("deg", DEGREE),
    without_prefix("°", DEGREE),
    prefixable("K", [0, 0, 0, 0, 0, 1, 0]),
    // What a photodetector gives of a deflection: never joined with the units of mechanics.
    prefixable("V", [0, 0, 0, 0, 0, 0, 1]),
    without_prefix("°C", CELSIUS),
    without_prefix("degC", CELSIUS),
];

impl Symbol {
    /// The symbol with every prefix that it takes, each as it is spelt.
    fn spellings(&self) -> impl Iterator<Item = (&'static str, String)> {
        let prefixes = PREFIXES.iter().map(|(prefix, _)| *prefix);
        let taken = prefixes.filter(|prefix| self.takes_prefix || prefix.is_empty());
        taken.map(|prefix| (prefix, format!("{prefix}{}", self.text)))
    }
}

/// SI prefixes from femto to tera; the first of two spellings is the one that is written.
const PREFIXES: [(&str, i32); 15] = [
    ("f", -15),
    ("p", -12),
    ("n", -9),
    ("µ", -6),
    ("u", -6),
    ("m", -3),
    ("c", -2),
    ("d", -1),
    ("", 0),
    ("da", 1),
    ("h", 2),
    ("k", 3),
    ("M", 6),
    ("G", 9),
    ("T", 12),
];

/// Words that people write for symbols, without a plural s.
const WORDS: [(&str, &str); 18] = [
    ("meter", "m"),
    ("metre", "m"),
    ("micron", "µm"),
    ("millimeter", "mm"),
    ("millimetre", "mm"),
    ("newton", "N"),
    ("pascal", "Pa"),
    ("sec", "s"),
    ("second", "s"),
    ("minute", "min"),
    ("hr", "h"),
    ("hour", "h"),
    ("day", "d"),
    ("joule", "J"),
    ("hertz", "Hz"),
    ("radian", "rad"),
    ("degree", "deg"),
    ("angstrom", "Å"),
];

/// Units that are not read, and what one of them is in units that are.
const FOREIGN: [(&str, &str); 10] = [
    (
        "%",
        "a hundredth of another quantity: write what it comes to",
    ),
    ("kgf", "9.80665 N"),
    ("kp", "9.80665 N"),
    ("gf", "9.80665 mN"),
    ("lbf", "4.4482216 N"),
    ("dyn", "10 µN"),
    ("bar", "0.1 MPa"),
    ("psi", "6894.7573 Pa"),
    ("ksi", "6.8947573 MPa"),
    ("inch", "25.4 mm"),
];

/// What one of a unit that is not read is in units that are.
pub(super) fn conversion(unknown: &str) -> Option<&'static str> {
    let lower = unknown.to_lowercase();
    let known = FOREIGN.iter().find(|(unit, _)| *unit == lower);
    known.map(|(_, equal)| *equal)
}

/// Every symbol of a unit with these exponents, with every prefix that it takes.
pub(super) fn alone(exponents: Exponents) -> Vec<String> {
    let symbols = SYMBOLS.iter().filter(|s| s.unit.exponents == exponents);
    let mut all = Vec::new();
    for symbol in symbols {
        all.extend(symbol.spellings().map(|(_, spelling)| spelling));
        if symbol.takes_prefix {
            all.push(format!("\u{03BC}{}", symbol.text));
        }
    }
    if exponents == ANGSTROM.exponents {
        all.push("\u{212B}".to_owned());
    }
    all
}

/// The prefix of a power of ten, empty for one that has none.
pub(super) fn prefix_symbol(power: i32) -> &'static str {
    let known = PREFIXES.iter().find(|(_, exponent)| *exponent == power);
    known.map_or("", |(symbol, _)| symbol)
}

impl Unit {
    const ONE: Unit = Unit::of([0; 7]);

    const fn of(exponents: [i32; 7]) -> Unit {
        Unit {
            exponents: Exponents(exponents),
            decimal_exponent: 0,
            multiplier: 1.0,
            divisor: 1.0,
            degrees: 0,
            zero_k: 0.0,
        }
    }

    /// Reads a unit such as `mm`, `1/MPa`, `GPa s`, `rad/s`, `N/mm^2` or `Pa⁻¹`.
    pub(super) fn read(text: &str) -> Result<Unit, UnitProblem> {
        let plain = plain_spelling(text);
        let mut rest = plain.trim();
        let mut unit = Unit::ONE;
        let (mut divided, mut factors_below) = (false, 0);
        while !rest.is_empty() {
            if let Some(after) = rest.strip_prefix('/') {
                (divided, factors_below) = (true, 0);
                rest = after.trim_start();
            } else if let Some(after) = rest.strip_prefix('*') {
                rest = after.trim_start();
            }
            let Some((factor, power, after)) = read_factor(rest)? else {
                return Err(UnitProblem::Unknown(text.trim().to_owned()));
            };
            factors_below += i32::from(divided);
            if factors_below > 1 {
                return Err(UnitProblem::Ambiguous);
            }
            unit = unit.times(&factor, if divided { -power } else { power });
            rest = after.trim_start();
        }
        Ok(unit)
    }

    /// One symbol with or without prefix.
    fn from_symbol(text: &str) -> Option<Unit> {
        let prefixed = |symbol: &Symbol| {
            let prefix = text.strip_suffix(symbol.text)?;
            let known = PREFIXES.iter().find(|(spelling, _)| *spelling == prefix)?;
            Some((symbol.unit, known.1))
        };
        let exact = SYMBOLS.iter().find(|symbol| symbol.text == text);
        let mut prefixable = SYMBOLS.iter().filter(|symbol| symbol.takes_prefix);
        let (unit, power) =
            (exact.map(|symbol| (symbol.unit, 0))).or_else(|| prefixable.find_map(prefixed))?;
        Some(Unit {
            decimal_exponent: unit.decimal_exponent + power,
            ..unit
        })
    }

    fn times(self, other: &Unit, power: i32) -> Unit {
        let (multiplier, divisor) = if power < 0 {
            (other.divisor, other.multiplier)
        } else {
            (other.multiplier, other.divisor)
        };
        Unit {
            exponents: self.exponents.plus(other.exponents, power),
            decimal_exponent: self.decimal_exponent + other.decimal_exponent * power,
            multiplier: self.multiplier * multiplier.powi(power.abs()),
            divisor: self.divisor * divisor.powi(power.abs()),
            degrees: self.degrees + other.degrees * power,
            // A difference of temperatures, but for a unit that stands alone.
            zero_k: match self == Unit::ONE && power == 1 {
                true => other.zero_k,
                false => 0.0,
            },
        }
    }

    /// A number to which the power of ten has been applied, times the rest of the unit.
    pub(super) fn without_powers_of_ten(&self, decimal: f64) -> f64 {
        let mut value = decimal * self.multiplier / self.divisor;
        // Dividing first makes 45, 90 and 180 degrees exact fractions of pi.
        for _ in 0..self.degrees {
            value = value / 180.0 * PI;
        }
        for _ in self.degrees..0 {
            value = value / PI * 180.0;
        }
        match self.zero_k == 0.0 {
            // Zero keeps its sign.
            true => value,
            false => value + self.zero_k,
        }
    }
}

/// One symbol with its exponent (or the number one) at the beginning of a text, and what follows.
fn read_factor(text: &str) -> Result<Option<(Unit, i32, &str)>, UnitProblem> {
    if let Some(after) = text.strip_prefix('1')
        && !after.starts_with(|character: char| character.is_ascii_digit() || character == '.')
    {
        return Ok(Some((Unit::ONE, 1, after)));
    }
    let is_symbol = |character: char| character.is_alphabetic() || character == '°';
    let (symbol, after) = leading(text, is_symbol);
    if symbol.is_empty() {
        return Ok(None);
    }
    let unit = Unit::from_symbol(symbol).ok_or_else(|| UnitProblem::Unknown(symbol.to_owned()))?;
    Ok(read_power(after).map(|(power, rest)| (unit, power, rest)))
}

/// The exponent after a symbol, one if there is none; `None` if it is broken or beyond one digit.
fn read_power(text: &str) -> Option<(i32, &str)> {
    let after = text.strip_prefix('^').unwrap_or(text);
    let (sign, unsigned) = match after.strip_prefix('-') {
        Some(unsigned) => (-1, unsigned),
        None => (1, after),
    };
    let (digits, rest) = leading(unsigned, |character| character.is_ascii_digit());
    if digits.is_empty() {
        return (unsigned == text).then_some((1, text));
    }
    let power: i32 = digits.parse().ok()?;
    (1..=9).contains(&power).then_some((sign * power, rest))
}

/// The characters at the beginning of a text that are such a part, and what follows them.
pub(super) fn leading(text: &str, is_part: impl Fn(char) -> bool) -> (&str, &str) {
    let end = text.find(|character| !is_part(character));
    text.split_at(end.unwrap_or(text.len()))
}

/// One spelling for everything that has several: micro, ångström, minus, dots and superscripts.
fn plain_spelling(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    let mut raised = false;
    for character in text.chars() {
        let digit = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
            .chars()
            .position(|superscript| superscript == character);
        if digit.is_some() && !raised {
            plain.push('^');
        }
        raised = digit.is_some();
        plain.push(match (digit, character) {
            (Some(position), _) => char::from(b"0123456789-"[position]),
            (None, '\u{03BC}') => 'µ',
            (None, '\u{212B}') => 'Å',
            (None, '\u{2212}') => '-',
            (None, '·' | '⋅' | '×') => '*',
            (None, other) => other,
        });
    }
    plain
}

/// At most three units that look like an unknown one; where some are of the expected dimension, only those.
pub(super) fn suggestions(unknown: &str, expected: Exponents) -> Vec<String> {
    let lower = unknown.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    let word = WORDS
        .iter()
        .find(|(word, _)| *word == singular || *word == lower);
    if let Some((_, symbol)) = word {
        return vec![(*symbol).to_owned()];
    }
    let mut ranked: Vec<(bool, bool, usize, String)> = Vec::new();
    for symbol in &SYMBOLS {
        for (_, candidate) in symbol.spellings().filter(|(prefix, _)| *prefix != "u") {
            let distance = strsim::damerau_levenshtein(&candidate.to_lowercase(), &lower);
            let is_other = symbol.unit.exponents != expected;
            // One slip in three letters or more, of what was expected in two; in shorter words only the case may differ.
            let letters = lower.chars().count();
            if distance <= usize::from(letters >= 3 || letters == 2 && !is_other) {
                // Of slips, those that leave the case as it is come first.
                let in_its_case = match distance {
                    0 => 0,
                    _ => strsim::damerau_levenshtein(&candidate, unknown),
                };
                ranked.push((distance > 0, is_other, in_its_case, candidate));
            }
        }
    }
    // Where one is of what was expected, the others were not meant.
    if ranked.iter().any(|(_, is_other, ..)| !is_other) {
        ranked.retain(|(_, is_other, ..)| !is_other);
    }
    ranked.sort();
    // Where only the case is wrong, nothing else was meant.
    if ranked.first().is_some_and(|(slip, ..)| !slip) {
        ranked.retain(|(slip, ..)| !slip);
    }
    let run_together = split_product(unknown, expected).into_iter();
    run_together
        .chain(ranked.into_iter().map(|(.., candidate)| candidate))
        .take(3)
        .collect()
}

/// `N m` for `Nm`: two symbols run together whose product is what was expected.
fn split_product(unknown: &str, expected: Exponents) -> Option<String> {
    unknown.char_indices().skip(1).find_map(|(index, _)| {
        let (left, right) = unknown.split_at(index);
        let product = Unit::from_symbol(left)?.times(&Unit::from_symbol(right)?, 1);
        (product.exponents == expected).then(|| format!("{left} {right}"))
    })
}
