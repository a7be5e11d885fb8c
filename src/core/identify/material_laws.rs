//! Laws of functions of the material itself: of storage and loss modulus over frequency, of a relaxation modulus or a creep compliance over
//! time.

use nalgebra::DVector;

use super::laws::{Laws, Numbers, fitted};
use super::series::Point;
use crate::material::dynamic::DynamicPoint;
use crate::material::dynamic::prony::PronyFit;
use crate::material::fit::Fit;
use crate::material::law::{Form, Law, Solid};
use crate::material::tabulated::Tabulated;
use crate::material::{MaterialFunction, Relaxation};

/// The least relative noise of moduli: a stretched exponential is known no better from its series.
const LEAST_NOISE: f64 = 1e-3;

/// The laws of points to which a series was fitted; `None` where none could be fitted.
pub fn of_moduli(points: &[DynamicPoint], fit: &PronyFit, forms: &[Form]) -> Option<Laws> {
    let (lowest, highest) = fit.window_rad_per_s;
    let numbers = Numbers {
        count: 2 * points.len(),
        is_noise_known: true,
        times_s: (1.0 / highest, 1.0 / lowest),
    };
    let residuals = |solid: &Solid| {
        let each = points.iter().flat_map(|point| {
            let modulus = solid.complex_modulus_pa(point.angular_frequency_rad_per_s);
            let [storage, loss] = fit.deviations_pa(point, LEAST_NOISE);
            [
                (modulus.re - point.storage_modulus_pa) / storage,
                (modulus.im - point.loss_modulus_pa) / loss,
            ]
        });
        Some(DVector::from_iterator(numbers.count, each))
    };
    let starts = starts(forms, &fit.relaxation, numbers.times_s);
    fitted(&starts, &numbers, &residuals)
}

/// The laws of a table to which a series was fitted; `None` where none could be fitted.
pub fn of_table(table: &Tabulated, fit: &Fit, forms: &[Form]) -> Option<Laws> {
    let own = fit.relaxation()?;
    let all = table.times_s().iter().zip(table.values());
    let samples: Vec<(f64, f64)> = all
        .map(|(t, value)| (*t, *value))
        .filter(|(t, _)| *t > 0.0)
        .collect();
    let numbers = Numbers {
        count: samples.len(),
        is_noise_known: false,
        times_s: table.window_s(),
    };
    let residuals = |solid: &Solid| {
        let series = solid.clone().series_within(numbers.times_s)?;
        let ln = |computed: f64, (_, value): &(f64, f64)| (computed / value).ln();
        let each: Vec<f64> = match table.function() {
            MaterialFunction::Relaxation => {
                samples.iter().map(|s| ln(series.modulus(s.0), s)).collect()
            }
            MaterialFunction::Creep => {
                let creep = series.to_creep().ok()?;
                samples
                    .iter()
                    .map(|s| ln(creep.compliance(s.0), s))
                    .collect()
            }
        };
        Some(DVector::from_vec(each))
    };
    let starts = starts(forms, &own, numbers.times_s);
    fitted(&starts, &numbers, &residuals)
}

/// Laws with unknowns to begin with: of a series those that were found.
fn starts(forms: &[Form], own: &Relaxation, times_s: (f64, f64)) -> Vec<(Form, Vec<Vec<f64>>)> {
    let found = own.branches().len();
    let modulus_pa = own
        .complex_modulus((times_s.0 * times_s.1).sqrt().recip())
        .norm();
    let wants_series = forms.iter().any(|form| form.law == Law::Series);
    let others = forms.iter().filter(|form| form.law != Law::Series);
    let others = others.map(|form| (*form, form.starts(modulus_pa, times_s)));
    let series = wants_series.then(|| {
        let form = Form {
            law: Law::Series,
            branches: found,
        };
        (form, vec![Point::of(own, None).0])
    });
    others.chain(series).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::identify::resolved::forms;
    use crate::material::ModulusKind;
    use crate::material::{dynamic::prony, fit};
    use crate::numerics::grid::logarithmic;
    use crate::numerics::random::Noise;

    fn auto() -> Vec<Form> {
        forms(&["auto".to_owned()], None, 2)
    }

    /// A fractional Zener solid with its true exponent and what is found of it.
    fn holds_exponent(laws: &Laws, exponent: f64) {
        let best = laws.best();
        assert_eq!(best.form.law, Law::FractionalZener, "{:?}", best.form);
        let found = best.parameters[3];
        assert!(found.low < exponent && exponent < found.high, "{found:?}");
        assert!(found.high - found.low < 0.1, "{found:?}");
    }

    fn zener(exponent: f64) -> Solid {
        let form = Form {
            law: Law::FractionalZener,
            branches: 1,
        };
        form.solid(&[1e6, 1e8, 0.1, exponent], (1e-4, 1e3)).unwrap()
    }

    #[test]
    fn a_fractional_solid_is_found_in_its_moduli_its_relaxation_and_its_creep() {
        let solid = zener(0.45);
        let mut noise = Noise::stream(5, 0);
        let points = logarithmic(1e-2, 1e3, 8.0, 41).into_iter().map(|omega| {
            let modulus = solid.complex_modulus_pa(omega);
            DynamicPoint {
                temperature_k: None,
                angular_frequency_rad_per_s: omega,
                storage_modulus_pa: modulus.re * (1.0 + 0.01 * noise.normal()),
                loss_modulus_pa: modulus.im * (1.0 + 0.01 * noise.normal()),
                errors_pa: None,
            }
        });
        let points: Vec<DynamicPoint> = points.collect();
        let fitted = prony::fit(&points, None).unwrap();
        holds_exponent(&of_moduli(&points, &fitted, &auto()).unwrap(), 0.45);
        let series = solid.series_within((1e-4, 1e3)).unwrap();
        let creep = series.to_creep().unwrap();
        let times = logarithmic(1e-3, 1e2, 12.0, 61);
        for function in [MaterialFunction::Relaxation, MaterialFunction::Creep] {
            let exact = |t: f64| match function {
                MaterialFunction::Relaxation => series.modulus(t),
                MaterialFunction::Creep => creep.compliance(t),
            };
            let values = times
                .iter()
                .map(|t| exact(*t) * (1.0 + 0.01 * noise.normal()));
            let (values, kind) = (values.collect(), ModulusKind::Longitudinal);
            let table = Tabulated::new(function, kind, times.clone(), values).unwrap();
            let fitted = fit::fit(&table, None).unwrap();
            holds_exponent(&of_table(&table, &fitted, &auto()).unwrap(), 0.45);
        }
    }
}
