//! Contacts of bodies of revolution that attract one another: the zone of D. Maugis, J. Colloid Interface Sci. 150 (1992) 243, on
//! springs with memory.
//!
//! The surfaces attract with a constant stress s while their gap is below a range h, so that the work of adhesion is w = s h. The
//! contact is the disc r < a, the attracted ring a < r < c. On the springs of the method of dimensionality reduction a stress that
//! ends at c is a line force that ends there, and memory is local to each spring, whatever the body remembers:
//!
//! ```text
//! 0 <= x <= a   u = delta - G(x), and the force q answers
//! a <  x <= c   q = -2 s sqrt(c^2 - x^2), and the displacement u answers
//! x >  c        q = 0
//! at a          q is continuous: no stress is singular
//! at c          (2/pi) * integral from a to c of (u + G - delta) / sqrt(c^2 - x^2) dx = h
//! load          W = 2 * integral from 0 to c of q dx
//! ```
//!
//! So an instant has two unknowns, a and c, and what is prescribed. Within a time step the edges a and c and the approach move straight,
//! and every spring goes exactly through what that asks of it: displaced while it is in contact, loaded while it is attracted. The
//! force of a spring at the edge c has an infinite rate, whose work a step that is straight in the force would miss.
//!
//! * [`attraction`]: the stress, and what it is on springs;
//! * [`body`]: the memory of a body driven by force and driven by displacement, and the maps between the two;
//! * [`weights`]: what a time step does to both;
//! * [`springs`]: the row of springs and its state; `passage`: a spring on its way through a step; `opening`: gap and load of edges;
//! * [`instant`]: the edges that belong to a load or an approach, on the branch where the contact is, and its jumps;
//! * [`cycle`]: the stabilised cycle; `missing`: what is missing to its memory.

pub mod attraction;
pub mod body;
pub mod cycle;
pub mod instant;
mod missing;
mod opening;
mod passage;
pub mod springs;
pub mod weights;

pub use attraction::Attraction;
pub use body::Body;
pub use cycle::{Cycle, Ending, Found, Layout, Start};
pub use springs::{Edges, Springs};
pub use weights::StepWeights;

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use super::*;
    use crate::contact::{ContactError, Prescribed};
    use crate::indenter::{Axisymmetric, Cone, Indenter, PowerLaw, Sphere};
    use crate::material::{Creep, Relaxation, RelaxationBranch};
    use crate::reference::adhesive::{Maugis, jkr};

    const RADIUS_M: f64 = 1.0;
    const WORK_J_PER_M2: f64 = 1e-3;
    const PI_W_R: f64 = PI * WORK_J_PER_M2 * RADIUS_M;
    /// (R w^2 / E^2)^(1/3) at E = 1.
    const LENGTH_M: f64 = 1e-2;

    fn solid(branches: &[(f64, f64)]) -> Creep {
        let branch = |&(modulus_pa, time_s): &(f64, f64)| RelaxationBranch { modulus_pa, time_s };
        let relaxation = Relaxation::new(1.0, branches.iter().map(branch).collect());
        relaxation
            .and_then(|relaxation| relaxation.to_creep())
            .unwrap()
    }

    fn sphere(tabor_number: f64) -> (Maugis, Attraction) {
        let maugis = Maugis::of_tabor_number(tabor_number, RADIUS_M, 1.0, WORK_J_PER_M2);
        let attraction = Attraction {
            stress_pa: maugis.stress_pa,
            range_m: WORK_J_PER_M2 / maugis.stress_pa,
        };
        (maugis, attraction)
    }

    fn evenly(from_m: f64, to_m: f64, springs: usize) -> Vec<f64> {
        let at = |spring| from_m + (to_m - from_m) * spring as f64 / springs as f64;
        (0..=springs).map(at).collect()
    }

    /// Steps of an elastic body to these values, one after the other, as far as there is a contact, and at which of them it jumped.
    fn elastic(
        profile: &dyn Axisymmetric,
        attraction: Attraction,
        row_m: f64,
        values: impl Iterator<Item = Prescribed>,
    ) -> (Vec<Edges>, Vec<usize>) {
        let body = Body::new(&solid(&[]), 1.0).unwrap();
        let mut springs = Springs::new(&body, profile, attraction, evenly(0.0, row_m, 40));
        let jump = StepWeights::new(&body, 0.0);
        let (mut edges, mut jumps) = (Vec::new(), Vec::new());
        for value in values {
            match springs.step(&jump, value) {
                Ok(found) => edges.push(found),
                Err(ContactError::PulledOff { .. }) => break,
                Err(error) => panic!("{error}"),
            }
            if springs.jumped_j().is_some() {
                jumps.push(edges.len() - 1);
            }
        }
        (edges, jumps)
    }

    fn there_and_back(from: f64, to: f64, count: usize) -> impl Iterator<Item = f64> {
        let at = move |step: usize| from + (to - from) * step as f64 / count as f64;
        (0..=count).chain((0..count).rev()).map(at)
    }

    #[test]
    fn an_elastic_sphere_is_that_of_maugis_on_the_way_in_and_out_whatever_its_tabor_number() {
        let ball = Sphere::new(RADIUS_M).unwrap();
        let profile = ball.axisymmetric().unwrap();
        for tabor_number in [0.05, 0.1, 0.3, 1.0, 3.24, 5.0, 20.0] {
            let (maugis, attraction) = sphere(tabor_number);
            let range = there_and_back(-8.0 * LENGTH_M, 6.0 * LENGTH_M, 200);
            let (under_approach, jumps) =
                elastic(profile, attraction, 0.8, range.map(Prescribed::ApproachM));
            let loads = there_and_back(0.1 * PI_W_R, 8.0 * PI_W_R, 100)
                .chain((0..200).map(|k| -0.01 * PI_W_R * f64::from(k)));
            let (under_load, _) = elastic(profile, attraction, 0.8, loads.map(Prescribed::LoadN));
            let touching = under_approach
                .iter()
                .chain(&under_load)
                .filter(|e| e.contact_m > 0.0);
            assert!(touching.clone().count() > 300, "{tabor_number}");
            for edges in touching {
                let exact = maugis.contact(edges.contact_m);
                let off = [
                    (edges.load_n - exact.load_n) / PI_W_R,
                    (edges.approach_m - exact.approach_m) / LENGTH_M,
                    edges.zone_m / exact.zone_radius_m - 1.0,
                ];
                assert!(
                    off.iter().all(|off| off.abs() < 1e-9),
                    "{tabor_number}: {off:?}"
                );
            }
            // It comes off at the least load that any contact bears.
            let radii_m = (1..4000).map(|k| 1e-4 * f64::from(k));
            let least_n = radii_m
                .map(|a| maugis.contact(a).load_n)
                .fold(0.0, f64::min);
            let last_n = under_load.last().unwrap().load_n;
            assert!(last_n - least_n >= -1e-6 * PI_W_R && last_n - least_n < 0.011 * PI_W_R);
            // The attraction pulls the contact shut and keeps it from opening, where it is strong enough; it opens later than it shuts.
            if tabor_number > 1.0 {
                let [shut, opened] = jumps[..] else {
                    panic!("{jumps:?}")
                };
                assert!(
                    under_approach[opened].approach_m
                        < under_approach[shut].approach_m - 0.1 * LENGTH_M
                );
                assert!(
                    under_approach[shut].contact_m > 0.0 && under_approach[opened].contact_m == 0.0
                );
            } else if tabor_number < 0.2 {
                // A disc of attraction forms and vanishes at once, however small.
                let change_n = |k: &usize| under_approach[*k].load_n - under_approach[k - 1].load_n;
                assert!(
                    jumps.iter().all(|k| change_n(k).abs() < 0.1 * PI_W_R),
                    "{jumps:?}"
                );
            }
        }
    }

    #[test]
    fn pull_off_goes_to_that_of_jkr_with_the_second_power_and_to_that_of_dmt_with_the_power_of_three_halves()
     {
        let pull_off = |tabor_number: f64| {
            let (maugis, _) = sphere(tabor_number);
            let radii_m = (1..40_000).map(|k| 1e-5 * f64::from(k));
            let least_n = radii_m
                .map(|a| maugis.contact(a).load_n)
                .fold(0.0, f64::min);
            -least_n / PI_W_R
        };
        assert!((pull_off(0.5) - 1.69).abs() < 0.005 && (pull_off(1.0) - 1.58).abs() < 0.005);
        assert!((pull_off(3.24) - 1.51).abs() < 0.005);
        let order = |near: f64, far: f64| (far / near).log2();
        let of_jkr = order(pull_off(20.0) - 1.5, pull_off(10.0) - 1.5);
        let of_dmt = order(2.0 - pull_off(0.02), 2.0 - pull_off(0.04));
        assert!((of_jkr - 2.0).abs() < 0.05, "{of_jkr}");
        assert!((of_dmt - 1.5).abs() < 0.05, "{of_dmt}");
        let (maugis, _) = sphere(50.0);
        let contact = maugis.contact(0.25);
        let (load_n, approach_m) = jkr(&maugis, 0.25);
        assert!((contact.load_n - load_n).abs() < 2e-2 * load_n.abs());
        assert!((contact.approach_m - approach_m).abs() < 2e-2 * approach_m.abs());
        let ratio = maugis.pull_off_of_dmt_n() / maugis.pull_off_of_jkr_n();
        assert!((ratio - 4.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn what_a_cone_and_a_power_law_do_on_the_way_in_they_undo_on_the_way_out() {
        let cone = Cone::new(1.4).unwrap();
        let power_law = PowerLaw::new(3.0, 0.3, 0.1).unwrap();
        let profiles: [&dyn Indenter; 2] = [&cone, &power_law];
        for profile in profiles {
            let profile = profile.axisymmetric().unwrap();
            let (_, attraction) = sphere(1.0);
            let values = there_and_back(0.5 * LENGTH_M, 6.0 * LENGTH_M, 100);
            let (edges, jumps) =
                elastic(profile, attraction, 0.8, values.map(Prescribed::ApproachM));
            assert!(jumps.iter().all(|jump| *jump == 0));
            for (there, back) in edges.iter().zip(edges.iter().rev()) {
                assert!((there.load_n - back.load_n).abs() < 1e-9 * PI_W_R);
            }
            // The work of the load is that of the springs: dU/d(delta) = W at fixed edges, whatever the profile.
            let slope = |k: usize| {
                (edges[k + 1].load_n - edges[k - 1].load_n)
                    / (edges[k + 1].approach_m - edges[k - 1].approach_m)
            };
            assert!(slope(50) > 0.0);
        }
    }

    /// Instants of a march of so many cycles of a load, of a Zener sphere at rest before, seen after each step.
    fn marched(
        (omega, cycles): (f64, usize),
        (steps, springs): (usize, usize),
        mut see: impl FnMut(&Springs<'_>),
    ) -> Vec<Edges> {
        let ball = Sphere::new(RADIUS_M).unwrap();
        let (_, attraction) = sphere(3.24);
        let body = Body::new(&solid(&[(9.0, 1.0)]), omega.recip()).unwrap();
        let mut places_m = vec![0.0];
        places_m.extend(evenly(0.238, 0.27, springs));
        let profile = ball.axisymmetric().unwrap();
        let mut springs = Springs::new(&body, profile, attraction, places_m);
        let mut edges = vec![springs.rest(Prescribed::LoadN(0.5 * PI_W_R)).unwrap()];
        let weights = StepWeights::new(&body, TAU / omega / steps as f64);
        for step in 1..=cycles * steps {
            let phase = TAU * step as f64 / steps as f64;
            let load_n = PI_W_R * (0.5 + 0.4 * phase.sin());
            edges.push(springs.step(&weights, Prescribed::LoadN(load_n)).unwrap());
            see(&springs);
        }
        edges
    }

    /// The loss of the second cycle, over pi w R (R w^2 / E^2)^(1/3).
    fn loss(omega: f64, steps: usize, springs: usize) -> f64 {
        area(&marched((omega, 2), (steps, springs), |_| ())[steps..])
    }

    #[test]
    fn the_loss_of_a_cycle_is_of_second_order_in_the_steps_and_settles_with_the_springs() {
        for (omega, limit) in [(0.1, 0.1450), (0.01, 0.0854)] {
            let losses = [50, 100, 200].map(|steps| loss(omega, steps, 300));
            let order = ((losses[1] - losses[0]) / (losses[2] - losses[1])).log2();
            assert!(order > 1.5, "{omega}: {order} {losses:?}");
            assert!(
                (losses[2] / limit - 1.0).abs() < 0.005,
                "{omega}: {losses:?}"
            );
            let [fine, coarse] = [400, 100].map(|springs| loss(omega, 100, springs));
            assert!(
                (fine / coarse - 1.0).abs() < 0.01,
                "{omega}: {fine} {coarse}"
            );
        }
        // Far below the relaxation the edge moves slowly beside its zone, and the steps are far longer than the relaxation.
        assert!((loss(1e-3, 100, 400) / 0.0555 - 1.0).abs() < 0.01);
    }

    fn cycle_of<'a>(
        body: &'a Body,
        profile: &'a dyn Axisymmetric,
        drive: &'a (dyn Fn(f64) -> Prescribed + Sync),
        omega: f64,
    ) -> Cycle<'a> {
        let (_, attraction) = sphere(3.24);
        Cycle {
            body,
            profile,
            attraction,
            drive,
            mean: Prescribed::LoadN(0.5 * PI_W_R),
            maximum: Prescribed::LoadN(0.9 * PI_W_R),
            period_s: TAU / omega,
        }
    }

    fn area(edges: &[Edges]) -> f64 {
        let steps = edges.windows(2);
        let work =
            steps.map(|e| 0.5 * (e[0].load_n + e[1].load_n) * (e[1].approach_m - e[0].approach_m));
        work.sum::<f64>() / (PI_W_R * LENGTH_M)
    }

    #[test]
    fn the_stabilised_cycle_is_the_one_that_marching_comes_to() {
        let ball = Sphere::new(RADIUS_M).unwrap();
        let profile = ball.axisymmetric().unwrap();
        let drive =
            |fraction: f64| Prescribed::LoadN(PI_W_R * (0.5 + 0.4 * (TAU * fraction).sin()));
        let (omega, steps) = (0.01_f64, 100);
        let body = Body::new(&solid(&[(9.0, 1.0)]), omega.recip()).unwrap();
        let cycle = cycle_of(&body, profile, &drive, omega);
        let ending = Ending {
            tolerance: 1e-5,
            most_cycles: 20,
            stop: &|| false,
        };
        let layout = cycle.layout(&|| false).unwrap();
        let found = cycle
            .stabilised(&layout, (steps, 300), Start::Rest, ending)
            .unwrap();
        assert!(
            found.distance <= 1e-5 && found.cycles < 10 && found.jumps.is_empty(),
            "{found:?}"
        );
        let marched = marched((omega, 6), (steps, 400), |_| ());
        // The edge remembers for five cycles what the body forgets in one.
        let (last, second) = (
            area(&marched[5 * steps..]),
            area(&marched[steps..=2 * steps]),
        );
        assert!(
            (area(&found.edges) / last - 1.0).abs() < 2e-3,
            "{} {last}",
            area(&found.edges)
        );
        assert!((second / last - 1.0).abs() > 0.02, "{second} {last}");
    }

    /// What the dashpots of all springs take up in a cycle, and the area of its loop, of the seventh cycle of a march.
    fn dissipated_and_lost(omega: f64, steps: usize, springs: usize) -> (f64, f64) {
        let step_s = TAU / omega / steps as f64;
        let (mut seen, mut dissipated_j, mut before) = (0, 0.0, Vec::new());
        let edges = marched((omega, 7), (steps, springs), |springs| {
            seen += 1;
            let state = springs.state();
            let after = state.parts().0.to_vec();
            if seen > 6 * steps {
                let moved = before.iter().zip(&after);
                let moved = moved.map(|(before, after): (&f64, &f64)| (after - before).powi(2));
                // E tau times the square of the rate.
                let power: Vec<f64> = moved.map(|square| 9.0 * square / step_s).collect();
                let places = springs.places_m().windows(2).zip(power.windows(2));
                let rows = places.map(|(x, p)| (x[1] - x[0]) * (p[0] + p[1]));
                dissipated_j += rows.sum::<f64>();
            }
            before = after;
        });
        (
            dissipated_j / (PI_W_R * LENGTH_M),
            area(&edges[6 * steps..]),
        )
    }

    #[test]
    fn what_the_dashpots_take_up_is_what_the_loop_loses() {
        let off = |omega: f64, steps: usize, springs: usize| {
            let (dissipated, lost) = dissipated_and_lost(omega, steps, springs);
            dissipated / lost - 1.0
        };
        assert!(off(0.1, 200, 400).abs() < 1e-3);
        // The rate of a spring at the edge has no bound, and squares of differences are below its own.
        let [coarse, fine] = [(100, 200), (200, 400)].map(|(n, m)| off(0.01, n, m));
        assert!(
            fine.abs() < 3e-3 && fine.abs() < 0.6 * coarse.abs(),
            "{coarse} {fine}"
        );
    }

    #[test]
    fn a_memory_driven_by_force_is_the_one_driven_by_displacement() {
        let body = Body::new(&solid(&[(3.0, 0.01), (0.2, 1.0), (40.0, 5.0)]), 1.0).unwrap();
        // Displaced straight, then the forces that make this displacement: the same branches.
        let forces = [0.3, -2.0, 1.1];
        let (mut displacements_m, mut back) = ([0.0; 3], [0.0; 3]);
        body.displacements_m(&forces, &mut displacements_m);
        body.forces(&displacements_m, &mut back);
        for (force, back) in forces.iter().zip(back) {
            assert!((force - back).abs() < 1e-12, "{force} {back}");
        }
        // The force of a displacement that the forces make is the one that it was made with.
        let force = 0.7;
        let displacement_m =
            body.instantaneous_compliance_per_pa * force + body.retarded_m(&forces);
        assert!((body.force(displacement_m, &displacements_m) - force).abs() < 1e-12);
    }

    #[test]
    fn a_load_that_no_contact_bears_pulls_the_surfaces_apart_and_leaves_the_springs_as_they_were() {
        let ball = Sphere::new(RADIUS_M).unwrap();
        let (_, attraction) = sphere(1.0);
        let body = Body::new(&solid(&[(9.0, 1.0)]), 1.0).unwrap();
        let profile = ball.axisymmetric().unwrap();
        let mut springs = Springs::new(&body, profile, attraction, evenly(0.0, 0.5, 60));
        let rest = springs.rest(Prescribed::LoadN(PI_W_R)).unwrap();
        let long = StepWeights::new(&body, 1e6);
        let ended = springs.step(&long, Prescribed::LoadN(-1.9 * PI_W_R));
        assert!(
            matches!(ended, Err(ContactError::PulledOff { .. })),
            "{ended:?}"
        );
        assert_eq!(springs.edges(), rest);
        // At once the body is stiffer, and bears it.
        let at_once = springs.step(
            &StepWeights::new(&body, 0.0),
            Prescribed::LoadN(-1.9 * PI_W_R),
        );
        assert!(at_once.unwrap().contact_m > 0.5 * rest.contact_m);
        assert!(
            springs
                .step(&long, Prescribed::LoadN(1e3 * PI_W_R))
                .is_err()
        );
    }
}
