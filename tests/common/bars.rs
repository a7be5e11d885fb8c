//! Error bars over true errors, of many cases at once.

use contact_dma::sweep::record::CaseResult;
use contact_dma::sweep::record::error_bars::Quantity;

/// Bars over true errors of a case, and what case it is.
pub struct Judged {
    pub ratios: Vec<(Quantity, f64)>,
    pub what: String,
}

impl Judged {
    /// By a result whose own error is far smaller: every quantity that has both.
    pub fn new(found: &CaseResult, exact: &CaseResult, what: String) -> Self {
        let of = |quantity| Some((quantity, bar_over_error(found, exact, quantity)?));
        let ratios = Quantity::ALL.into_iter().filter_map(of).collect();
        Self { ratios, what }
    }

    fn of(&self, quantity: Quantity) -> Option<f64> {
        let found = self.ratios.iter().find(|(of, _)| *of == quantity)?;
        Some(found.1)
    }
}

/// A quantity's bar over its distance from that of a finer result, where it has both.
pub fn bar_over_error(found: &CaseResult, exact: &CaseResult, quantity: Quantity) -> Option<f64> {
    let bar = found.errors.as_ref()?.of(quantity)?;
    let off = (quantity.of(found)? - quantity.of(exact)?).abs();
    Some(bar / off)
}

fn is_outside(ratio: f64) -> bool {
    ratio.is_nan() || ratio < 1.0
}

/// Prints of every quantity how many lie inside their bars, and what does not. As many as `allowed` of so many may be outside, and the
/// median bar of the loss is at most so many times its error.
pub fn check(
    name: &str,
    all: &[Judged],
    allowed: impl Fn(Quantity, f64) -> f64,
    largest_median: f64,
) {
    let mut wrong = Vec::new();
    for quantity in Quantity::ALL {
        let mut ratios: Vec<f64> = all.iter().filter_map(|one| one.of(quantity)).collect();
        ratios.sort_by(f64::total_cmp);
        let Some(&median) = ratios.get(ratios.len() / 2) else {
            continue;
        };
        let outside = ratios.iter().filter(|ratio| is_outside(**ratio)).count();
        let of = ratios.len();
        println!(
            "{name} {quantity:?}: {outside} of {of} outside, median bar over error {median:.2}"
        );
        for one in all {
            if let Some(ratio) = one.of(quantity).filter(|ratio| is_outside(*ratio)) {
                println!("    {ratio:.3}, {}", one.what);
            }
        }
        let is_wide = quantity == Quantity::EnergyLoss && median > largest_median;
        if outside as f64 > allowed(quantity, of as f64) || is_wide {
            wrong.push((quantity, outside, of, median));
        }
    }
    assert!(wrong.is_empty(), "{name}: {wrong:?}");
}
