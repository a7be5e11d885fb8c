//! Quantiles of Student's distribution.

/// The half width of the 95 % interval, in standard deviations that were estimated with these degrees of freedom; without them the
/// standard deviation is known.
///
/// G. W. Hill, Communications of the ACM 13 (1970) 619, algorithm 396: right to four digits from two degrees of freedom on.
pub(super) fn half_width_95(degrees_of_freedom: Option<usize>) -> f64 {
    /// Of the normal distribution.
    const NORMAL: f64 = 1.959_963_984_540_054;
    const P: f64 = 0.05;
    let n = match degrees_of_freedom {
        None => return NORMAL,
        // Closed forms: t = tan(pi/2 (1 - P)), and (2 / (P (2 - P)) - 2)^(1/2).
        Some(0 | 1) => return (std::f64::consts::FRAC_PI_2 * (1.0 - P)).tan(),
        Some(2) => return (2.0 / (P * (2.0 - P)) - 2.0).sqrt(),
        Some(n) => n as f64,
    };
    let a = 1.0 / (n - 0.5);
    let b = 48.0 / (a * a);
    let c = ((20_700.0 * a / b - 98.0) * a - 16.0) * a + 96.36;
    let d = ((94.5 / (b + c) - 3.0) / b + 1.0) * (a * std::f64::consts::FRAC_PI_2).sqrt() * n;
    let x = d * P;
    let mut y = x.powf(2.0 / n);
    if y > 0.05 + a {
        let x = -NORMAL;
        y = x * x;
        let mut c = c;
        if n < 5.0 {
            c += 0.3 * (n - 4.5) * (x + 0.6);
        }
        c += (((0.05 * d * x - 5.0) * x - 7.0) * x - 2.0) * x + b;
        y = (((((0.4 * y + 6.3) * y + 36.0) * y + 94.5) / c - y - 3.0) / b + 1.0) * x;
        y = (a * y * y).exp_m1();
    } else {
        y = ((1.0 / (((n + 6.0) / (n * y) - 0.089 * d - 0.822) * (n + 2.0) * 3.0)
            + 0.5 / (n + 4.0))
            * y
            - 1.0)
            * (n + 1.0)
            / (n + 2.0)
            + 1.0 / y;
    }
    (n * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_the_tables() {
        // W. S. Gosset's distribution, two-sided 5 %.
        for (degrees, expected) in [
            (1, 12.7062),
            (2, 4.302_65),
            (3, 3.182_45),
            (5, 2.570_58),
            (10, 2.228_14),
            (21, 2.079_61),
            (120, 1.979_93),
        ] {
            let found = half_width_95(Some(degrees));
            assert!((found / expected - 1.0).abs() < 2e-4, "{degrees}: {found}");
        }
        assert!((half_width_95(Some(100_000)) / half_width_95(None) - 1.0).abs() < 1e-4);
    }
}
