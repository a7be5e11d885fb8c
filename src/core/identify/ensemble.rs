//! Solids of data with their noise drawn anew: a parametric bootstrap (B. Efron, R. J. Tibshirani, *An Introduction to the Bootstrap*, Chapman &
//! Hall 1993, section 6.5) on the linearised contact, with the factors of the exact model about the solid that was found.

use rayon::prelude::*;

use super::identified::Identified;
use super::laws::{Drawn, OfLaw, beyond};
use super::selection::Linearised;
use super::series::Point;
use crate::material::law::{Form, Law, Solid};
use crate::numerics::levenberg_marquardt::{Ending, minimise};
use crate::numerics::random::Noise;

const SEED: u64 = 1;

const EXACTLY: Ending = Ending {
    iterations: 40,
    enough: 1e-6,
};

/// What is found where the noise falls otherwise, each alike in probability: laws as often as their weights in the band say, and series of
/// other numbers of branches likewise.
pub(super) fn ensemble(
    linearised: &mut Linearised<'_>,
    found: &Identified,
    samples: usize,
) -> Vec<Drawn> {
    if samples == 0 {
        return Vec::new();
    }
    let (times_s, end_s) = linearised.times_s();
    linearised.take_factors(&Point::of(&found.relaxation, end_s), &found.computed(), 1.0);
    let missed = found.missed();
    let of_series = |point: &Point| {
        let (law, branches) = (Law::Series, point.branches());
        (Form { law, branches }, point.0.clone())
    };
    let linearised = &*linearised;
    let draw = |number: usize| {
        let mut random = Noise::stream(SEED, number as u64);
        let share = random.uniform();
        let (form, start) = match (&found.laws, found.law()) {
            (Some(laws), Some(_)) => {
                let law = laws.drawn(share);
                (law.form, law.unknowns.clone())
            }
            _ => of_series(found.drawn(share)),
        };
        // The data that are fitted are the computed numbers with the noise that the residuals have.
        let spread = found.compared.iter().zip(&linearised.noise.relative);
        let drawn = spread.map(|(compared, relative)| {
            let own = (compared.error / compared.measured).max(*relative);
            found.inflation * own * random.normal()
        });
        let shift: Vec<f64> = missed
            .iter()
            .zip(drawn)
            .map(|(off, noise)| off + noise)
            .collect();
        let residuals = |solid: &Solid| linearised.of_solid(solid, Some(&shift));
        let problem = OfLaw {
            form,
            times_s,
            residuals: &residuals,
        };
        let values = form.values(&minimise(&problem, &start, EXACTLY)?.unknowns);
        Some(Drawn {
            form,
            series: form.series_within(&values, beyond(times_s))?,
            values,
        })
    };
    (0..samples).into_par_iter().filter_map(draw).collect()
}
