//! Laws from force curves of random solids and gels, made by the engine of a simulation: offset, drift, drag and noise, the contact point
//! unknown.
//!
//! `CURVES=100 SEED=9 cargo test --release --test physics force_curves -- --nocapture` tries as many as the guide on validation quotes.

use contact_dma::contact::half_space::layer::Base;
use contact_dma::force_curve::resolved::Probe;
use contact_dma::force_curve::{CurveFit, CurvePlan, ForceCurve, fit};
use contact_dma::identify::laws::Estimate;
use contact_dma::identify::{Sought, SoughtAttraction};
use contact_dma::material::fractional::Fractional;
use contact_dma::material::law::{Form, Law};
use contact_dma::sweep::plan::adhesion::AdhesionPlan;
use contact_dma::sweep::plan::contact::ContactPlan;
use contact_dma::sweep::plan::layer::LayerPlan;

use crate::prelude::*;

/// An approach, perhaps a hold, and a retraction at the same speed (s, m).
struct Motion {
    ramp_s: f64,
    hold_s: f64,
    depth_m: f64,
    /// Travelled before contact and after it.
    before_m: f64,
}

impl Motion {
    fn random(random: &mut Random) -> Self {
        let ramp_s = random.power_of_ten(-1.5, 0.5);
        let is_held = random.unit() < 0.5;
        let depth_m = random.between(0.2e-6, 0.8e-6);
        Self {
            ramp_s,
            hold_s: if is_held {
                ramp_s * random.between(0.5, 5.0)
            } else {
                0.0
            },
            depth_m,
            before_m: depth_m * random.between(0.3, 2.0),
        }
    }

    fn speed(&self) -> f64 {
        self.depth_m / self.ramp_s
    }

    fn contact_s(&self) -> f64 {
        2.0 * self.ramp_s + self.hold_s
    }

    /// Indentation and speed at a time after first touch, which may be before it.
    fn at(&self, t: f64) -> (f64, f64) {
        let speed = self.speed();
        let back_s = t - self.ramp_s - self.hold_s;
        match t {
            _ if t < self.ramp_s => (speed * t, speed),
            _ if back_s < 0.0 => (self.depth_m, 0.0),
            _ => (self.depth_m - speed * back_s, -speed),
        }
    }

    /// Loads of the springs engine while the indenter is below the surface.
    fn loads(&self, material: Material, indenter: Arc<dyn Indenter>) -> Vec<HistoryRow> {
        self.loads_of(material, indenter, |_| ())
    }

    /// Loads of a simulation with these changes; from far above the surface on, where it attracts.
    fn loads_of(
        &self,
        material: Material,
        indenter: Arc<dyn Indenter>,
        changes: impl FnOnce(&mut ScenarioPlan),
    ) -> Vec<HistoryRow> {
        let to = |to: f64| Segment::Ramp {
            to,
            duration_s: self.ramp_s,
        };
        let hold = Segment::Step {
            to: self.depth_m,
            duration_s: self.hold_s,
        };
        let all = [
            Some(to(self.depth_m)),
            (self.hold_s > 0.0).then_some(hold),
            Some(to(0.0)),
        ];
        let contact: Vec<Segment> = all.into_iter().flatten().collect();
        let drive = |all| SegmentedDrive::new(Control::Approach, all).unwrap();
        let mut plan = ScenarioPlan::new(material, indenter, drive(contact.clone()));
        plan.output.error_bars = false;
        plan.step_s = Some(self.ramp_s / 400.0);
        changes(&mut plan);
        let away_s = 1e-6 * self.ramp_s;
        let before_s = self.before_m / self.speed();
        let is_attracted = plan.contact.adhesion.is_some();
        if is_attracted {
            let apart = |duration_s| Segment::Ramp {
                to: -self.before_m,
                duration_s,
            };
            let touching = Segment::Ramp {
                to: 0.0,
                duration_s: before_s,
            };
            let away = [
                Segment::Step {
                    to: -self.before_m,
                    duration_s: away_s,
                },
                touching,
            ];
            let all = away.into_iter().chain(contact).chain([apart(before_s)]);
            plan.drive = drive(all.collect());
        }
        let outcome = Simulation::new(plan)
            .unwrap()
            .run(&AtomicBool::new(false), &|_, _| {});
        let mut rows = outcome.rows;
        let touched_s = if is_attracted { away_s + before_s } else { 0.0 };
        rows.iter_mut().for_each(|row| row.time_s -= touched_s);
        rows
    }
}

/// A curve, and where its contact begins.
struct Made {
    curve: ForceCurve,
    contact_point_m: f64,
}

fn made(random: &mut Random, motion: &Motion, rows: &[HistoryRow]) -> Made {
    let samples = random.power_of_ten(2.5, 3.7) as usize;
    let before_s = motion.before_m / motion.speed();
    let whole_s = 2.0 * before_s + motion.contact_s();
    let largest_n = rows.iter().map(|row| row.load_n).fold(0.0, f64::max);
    let offset_n = random.between(-0.3, 0.3) * largest_n;
    let drift = random.between(-0.1, 0.1) * largest_n / whole_s;
    let drag = random.between(0.0, 0.03) * largest_n / motion.speed();
    let contact_point_m = random.between(-5e-6, 5e-6);
    let mut curve = ForceCurve::default();
    for sample in 0..samples {
        let t = whole_s * (sample as f64 + 0.5) / samples as f64;
        let (depth_m, speed) = motion.at(t - before_s);
        let load_n = load_n(rows, t - before_s);
        let noise_n = 0.01 * largest_n * random.gauss();
        curve.time_s.push(t);
        curve
            .force_n
            .push(load_n + offset_n + drift * t + drag * speed + noise_n);
        curve.indentation_m.push(contact_point_m + depth_m);
    }
    Made {
        curve,
        contact_point_m,
    }
}

/// The load (N) at a time, none without contact.
fn load_n(rows: &[HistoryRow], t: f64) -> f64 {
    let after = rows.partition_point(|row| row.time_s < t);
    let beside = rows.get(after.wrapping_sub(1)).zip(rows.get(after));
    beside.map_or(0.0, |(a, b)| {
        a.load_n + (b.load_n - a.load_n) * (t - a.time_s) / (b.time_s - a.time_s)
    })
}

fn indenter(random: &mut Random) -> Arc<dyn Indenter> {
    match random.unit() < 0.6 {
        true => Arc::new(ball(2.5e-6)),
        false => Arc::new(Cone::new(random.between(55.0, 75.0).to_radians()).unwrap()),
    }
}

/// On a half-space of Poisson ratio 1/2, without attraction.
fn plan(indenter: Arc<dyn Indenter>) -> CurvePlan {
    let sought = Sought {
        compressibility: 0.5.into(),
        indenter_material: None,
    };
    CurvePlan {
        contact: ContactPlan::new(sought, indenter),
        attraction: SoughtAttraction::Known,
        forms: Vec::new(),
        probe: Probe::default(),
        samples: 0,
    }
}

/// E* (Pa) of a frequency.
type Truth = Box<dyn Fn(f64) -> Complex<f64>>;

fn gel(random: &mut Random, motion: &Motion) -> (Truth, Material) {
    let (pa, exponent) = (random.power_of_ten(2.0, 4.5), random.between(0.05, 0.5));
    let law = Fractional::springpot(pa, 1.0, exponent).unwrap();
    let band = (0.02 / motion.contact_s(), 1e4 / motion.ramp_s);
    let series = law.represent(band, 1e-4).unwrap().relaxation;
    let material = Material::from_relaxation(series, ModulusKind::Longitudinal, 0.5);
    (
        Box::new(move |omega| law.complex_modulus(omega)),
        material.unwrap(),
    )
}

fn solid(random: &mut Random, motion: &Motion) -> (Truth, Material) {
    let (count, pa) = (
        1 + (4.0 * random.unit()) as usize,
        random.power_of_ten(2.5, 5.0),
    );
    let above = random.power_of_ten(0.1, 1.5) - 1.0;
    let weights: Vec<f64> = (0..count).map(|_| random.power_of_ten(-1.0, 0.0)).collect();
    let sum: f64 = weights.iter().sum();
    let branch = |weight: f64| RelaxationBranch {
        modulus_pa: pa * above * weight / sum,
        time_s: random.between_logarithms(0.01 * motion.ramp_s, 3.0 * motion.contact_s()),
    };
    let series = Relaxation::new(pa, weights.into_iter().map(branch).collect()).unwrap();
    let material = Material::from_relaxation(series.clone(), ModulusKind::Longitudinal, 0.5);
    (
        Box::new(move |omega| series.complex_modulus(omega)),
        material.unwrap(),
    )
}

/// How many moduli lie in their bands, of how many, and whether the contact point does.
fn inside(found: &CurveFit, truth: &Truth, contact_point_m: f64) -> (usize, usize, bool) {
    let (low, high) = found.window_rad_per_s;
    let mut counts = (0, 0);
    for share in [0.0, 0.25, 0.5, 0.75, 1.0] {
        let omega = low * (high / low).powf(share);
        let (band, exact) = (found.laws.band(omega).unwrap(), truth(omega));
        for (value, factor, exact) in [
            (band.storage_pa, band.storage_factor, exact.re),
            (band.loss_pa, band.loss_factor, exact.im),
        ] {
            counts.0 += usize::from((value / exact).ln().abs() <= factor.ln());
            counts.1 += 1;
        }
    }
    let Estimate { low, high, .. } = found.contact_point_m;
    (
        counts.0,
        counts.1,
        low <= contact_point_m && contact_point_m <= high,
    )
}

/// How many curves are tried, and the seed they are drawn from.
fn tried(curves: u64) -> (u64, u64) {
    let of = |name| std::env::var(name).ok().and_then(|text| text.parse().ok());
    (of("CURVES").unwrap_or(curves), of("SEED").unwrap_or(9))
}

/// Curves of a kind: no refusal, moduli and contact points in their bands; the fits.
fn judge(kind: &str, body: fn(&mut Random, &Motion) -> (Truth, Material)) -> Vec<CurveFit> {
    let (curves, seed) = tried(12);
    let found = (0..curves).into_par_iter().map(|number| {
        let mut random = Random(seed.wrapping_mul(1_000_003) + number);
        let motion = Motion::random(&mut random);
        let (truth, material) = body(&mut random, &motion);
        let indenter = indenter(&mut random);
        let rows = motion.loads(material, Arc::clone(&indenter));
        let made = made(&mut random, &motion, &rows);
        let plan = CurvePlan {
            forms: Form::all(4),
            ..plan(indenter)
        };
        let found = fit(&plan, &made.curve, &AtomicBool::new(false)).unwrap();
        let counts = inside(&found, &truth, made.contact_point_m);
        (found, counts)
    });
    let found: Vec<(CurveFit, (usize, usize, bool))> = found.collect();
    let sum = |of: fn(&(usize, usize, bool)) -> usize| {
        found.iter().map(|(_, counts)| of(counts)).sum::<usize>() as f64
    };
    let (moduli, of_moduli) = (sum(|c| c.0), sum(|c| c.1));
    let contacts = sum(|c| usize::from(c.2));
    println!("{kind}: {moduli} of {of_moduli} moduli, {contacts} of {curves} contact points");
    // The numbers of a curve are right or wrong together.
    assert!(moduli >= 0.9 * of_moduli, "{moduli} of {of_moduli}");
    let chance = 2.0 * (0.05 * 0.95 * curves as f64).sqrt();
    assert!(
        contacts >= 0.95 * curves as f64 - chance,
        "{contacts} of {curves}"
    );
    found.into_iter().map(|(found, _)| found).collect()
}

#[test]
fn the_moduli_and_contact_points_of_gels_lie_in_their_bands_and_their_law_is_a_power_law() {
    let found = judge("gels", gel);
    let power = found
        .iter()
        .filter(|found| found.laws.best().form.law == Law::PowerLaw)
        .count();
    println!("{power} of {} are power laws", found.len());
    assert!(power as f64 >= 0.95 * found.len() as f64 - 1.0);
}

#[test]
fn the_moduli_and_contact_points_of_solids_of_one_to_four_branches_lie_in_their_bands() {
    judge("solids", solid);
}

#[test]
fn a_curve_without_noise_gives_the_solid_back() {
    let mut random = Random(4);
    let motion = Motion {
        ramp_s: 1.0,
        hold_s: 2.0,
        depth_m: 5e-7,
        before_m: 3e-7,
    };
    let series = Relaxation::new(
        1e3,
        vec![RelaxationBranch {
            modulus_pa: 4e3,
            time_s: 0.4,
        }],
    )
    .unwrap();
    let material = Material::from_relaxation(series, ModulusKind::Longitudinal, 0.5).unwrap();
    let rows = motion.loads(material, Arc::new(ball(2.5e-6)));
    let mut made = made(&mut random, &motion, &rows);
    let before_s = motion.before_m / motion.speed();
    let times = made.curve.time_s.iter();
    made.curve.force_n = times.map(|t| load_n(&rows, t - before_s)).collect();
    let plan = CurvePlan {
        forms: Form::all(1),
        ..plan(Arc::new(ball(2.5e-6)))
    };
    let found = fit(&plan, &made.curve, &AtomicBool::new(false)).unwrap();
    let law = found.laws.best();
    assert_eq!(law.form.law, Law::StandardSolid);
    for (parameter, exact) in law.parameters.iter().zip([1e3, 4e3, 0.4]) {
        assert!(
            (parameter.value / exact - 1.0).abs() < 3e-3,
            "{parameter:?} {exact}"
        );
    }
    assert!((found.contact_point_m.value - made.contact_point_m).abs() < 2e-3 * motion.depth_m);
}

/// A sphere that the surface attracts as strongly as that moves the pull-off: its work of adhesion is found with the law, from another one on.
struct Pulled {
    found: CurveFit,
    moduli: (usize, usize),
    is_contact_inside: bool,
    is_work_inside: bool,
}

fn pulled(number: u64, seed: u64, forms: &[Form]) -> Pulled {
    let radius_m = 2.5e-6_f64;
    let mut random = Random(seed.wrapping_mul(1_000_003) + number);
    let motion = Motion::random(&mut random);
    let (pa, above) = (random.power_of_ten(2.5, 5.0), random.between(0.3, 10.0));
    let time_s = random.between_logarithms(0.1 * motion.ramp_s, motion.contact_s());
    let branch = RelaxationBranch {
        modulus_pa: pa * above,
        time_s,
    };
    let series = Relaxation::new(pa, vec![branch]).unwrap();
    let material = Material::from_relaxation(series.clone(), ModulusKind::Longitudinal, 0.5);
    let truth: Truth = Box::new(move |omega| series.complex_modulus(omega));
    let stiff_pa = truth(1.0 / motion.ramp_s).re / 0.75;
    let elastic_n = 4.0 / 3.0 * stiff_pa * radius_m.sqrt() * motion.depth_m.powf(1.5);
    let work = random.between(0.05, 0.4) * elastic_n / (1.5 * PI * radius_m);
    let tabor = random.power_of_ten(-0.3, 0.7);
    let range_m = (radius_m * (work / stiff_pa).powi(2)).cbrt() / tabor;
    let adhesion = AdhesionPlan {
        range_m: Some(range_m),
        ..AdhesionPlan::of_work(work)
    };
    let indenter: Arc<dyn Indenter> = Arc::new(ball(radius_m));
    let rows = motion.loads_of(material.unwrap(), Arc::clone(&indenter), |plan| {
        plan.contact.adhesion = Some(adhesion);
        plan.solver.springs = 3000;
        plan.step_s = Some(motion.ramp_s / 1200.0);
    });
    let made = made(&mut random, &motion, &rows);
    let mut plan = CurvePlan {
        forms: forms.to_vec(),
        attraction: SoughtAttraction::Work,
        ..plan(indenter)
    };
    plan.contact.adhesion = Some(AdhesionPlan {
        work_j_per_m2: work * random.power_of_ten(-0.3, 0.3),
        ..adhesion
    });
    let found = fit(&plan, &made.curve, &AtomicBool::new(false)).unwrap();
    let (inside, of, is_contact_inside) = inside(&found, &truth, made.contact_point_m);
    let Estimate { low, high, .. } = found.attraction[0];
    Pulled {
        moduli: (inside, of),
        is_contact_inside,
        is_work_inside: low <= work && work <= high,
        found,
    }
}

#[test]
fn the_work_of_adhesion_and_the_moduli_of_attracted_curves_lie_in_their_bands() {
    let (curves, seed) = tried(8);
    let standard_solid = [Form {
        law: Law::StandardSolid,
        branches: 1,
    }];
    let all = (0..curves).into_par_iter();
    let all: Vec<Pulled> = all.map(|k| pulled(k, seed, &standard_solid)).collect();
    let count = |of: fn(&Pulled) -> usize| all.iter().map(of).sum::<usize>();
    let (moduli, of_moduli) = (count(|p| p.moduli.0), count(|p| p.moduli.1));
    let contacts = count(|p| usize::from(p.is_contact_inside));
    let works = count(|p| usize::from(p.is_work_inside));
    let misfit = all
        .iter()
        .map(|p| p.found.laws.reduced_chi_squared)
        .sum::<f64>()
        / curves as f64;
    println!(
        "attracted: {moduli} of {of_moduli} moduli, {contacts} contact points and {works} works of adhesion of {curves}; chi squared {misfit:.2}"
    );
    assert!(moduli as f64 >= 0.9 * of_moduli as f64);
    let chance = 2.0 * (0.05 * 0.95 * curves as f64).sqrt();
    let least = 0.95 * curves as f64 - chance;
    assert!(contacts as f64 >= least && works as f64 >= least);
    assert!(misfit < 1.5);
}

/// What a channel of first order, slow by a time constant, makes of a motion at a time after first touch.
fn slow(motion: &Motion, time_constant_s: f64, t: f64) -> f64 {
    let of_ramp = |t: f64| t.max(0.0) + time_constant_s * (-t.max(0.0) / time_constant_s).exp_m1();
    let hold_ends_s = motion.ramp_s + motion.hold_s;
    motion.speed() * (t - time_constant_s - of_ramp(t - motion.ramp_s) - of_ramp(t - hold_ends_s))
}

#[test]
fn gain_and_phase_of_a_slow_channel_are_taken_out_of_a_curve() {
    let (curves, seed) = tried(20);
    let of_curve = |number: u64| {
        let mut random = Random(seed.wrapping_mul(1_000_003) + number);
        let motion = Motion::random(&mut random);
        let (truth, material) = gel(&mut random, &motion);
        let indenter = indenter(&mut random);
        let rows = motion.loads(material, Arc::clone(&indenter));
        let mut made = made(&mut random, &motion, &rows);
        let time_constant_s = motion.ramp_s * random.between(0.05, 0.15);
        let before_s = motion.before_m / motion.speed();
        let curve = &mut made.curve;
        for (t, depth_m) in curve.time_s.iter().zip(&mut curve.indentation_m) {
            let noise_m = 2e-4 * motion.depth_m * random.gauss();
            let moved_m = slow(&motion, time_constant_s, t - before_s);
            *depth_m = made.contact_point_m + moved_m + noise_m;
        }
        // Calibrated until a twentieth of the motion is left.
        let hz: Vec<f64> = (0..40)
            .map(|n| 20.0 / (TAU * time_constant_s) * 0.8_f64.powi(39 - n))
            .collect();
        let over = |hz: &f64| TAU * hz * time_constant_s;
        let probe = Probe {
            response_gain: hz.iter().map(|hz| over(hz).hypot(1.0).recip()).collect(),
            response_phase_rad: hz.iter().map(|hz| over(hz).atan()).collect(),
            response_frequency_hz: hz,
            ..Probe::default()
        };
        let plan = CurvePlan {
            forms: vec![Form {
                law: Law::PowerLaw,
                branches: 1,
            }],
            ..plan(indenter)
        };
        let as_read = made.curve.clone();
        made.curve.take_response_back(&probe);
        [as_read, made.curve].map(|curve| {
            let found = fit(&plan, &curve, &AtomicBool::new(false)).unwrap();
            let (moduli, of, _) = inside(&found, &truth, made.contact_point_m);
            [moduli, of]
        })
    };
    let all = (0..curves).into_par_iter().map(of_curve);
    let none = || [[0; 2]; 2];
    let sum = |a: [[usize; 2]; 2], b: [[usize; 2]; 2]| {
        [0, 1].map(|which| [0, 1].map(|place| a[which][place] + b[which][place]))
    };
    let [[as_read, of], [taken_back, _]] = all.reduce(none, sum);
    println!("slow channel: {taken_back} of {of} moduli, {as_read} as it was read");
    assert!(taken_back as f64 >= 0.9 * of as f64);
    assert!(2 * as_read < of);
}

#[test]
fn the_moduli_of_a_thin_layer_lie_in_their_bands_and_as_a_half_space_it_seems_stiffer() {
    let (radius_m, thickness_m) = (2.5e-6, 1.5e-6);
    let motion = Motion {
        ramp_s: 0.5,
        hold_s: 1.0,
        depth_m: 4e-7,
        before_m: 3e-7,
    };
    let branch = RelaxationBranch {
        modulus_pa: 4e3,
        time_s: 0.3,
    };
    let series = Relaxation::new(2e3, vec![branch]).unwrap();
    let material = Material::from_relaxation(series.clone(), ModulusKind::Longitudinal, 0.5);
    let truth: Truth = Box::new(move |omega| series.complex_modulus(omega));
    let layer = LayerPlan {
        thickness_m,
        base: Base::Bonded,
        base_modulus_ratio: None,
        base_poisson_ratio: None,
    };
    let indenter: Arc<dyn Indenter> = Arc::new(ball(radius_m));
    let rows = motion.loads_of(material.unwrap(), Arc::clone(&indenter), |plan| {
        plan.contact.layer = Some(layer);
        plan.solver = SolverPlan {
            cells: 64,
            ..SolverPlan::of(plan.contact.indenter.as_ref(), true)
        };
        plan.step_s = Some(motion.ramp_s / 100.0);
    });
    let made = made(&mut Random(8), &motion, &rows);
    let half_space = CurvePlan {
        forms: Form::all(1),
        ..plan(indenter)
    };
    let mut on_layer = half_space.clone();
    on_layer.contact.layer = Some(layer);
    let [found, stiff] = [on_layer, half_space]
        .map(|plan| fit(&plan, &made.curve, &AtomicBool::new(false)).unwrap());
    let (moduli, of, contact) = inside(&found, &truth, made.contact_point_m);
    assert!(moduli + 1 >= of && contact, "{moduli} of {of}, {contact}");
    assert!(
        found.laws.reduced_chi_squared < 1.5,
        "{}",
        found.laws.reduced_chi_squared
    );
    let omega = 1.0 / motion.ramp_s;
    let seems =
        stiff.laws.band(omega).unwrap().storage_pa / found.laws.band(omega).unwrap().storage_pa;
    assert!(seems > 1.5, "{seems}");
}

#[test]
fn a_layer_far_thicker_than_its_contact_is_a_half_space() {
    let springs_of = |thickness_m: Option<f64>| {
        let motion = Motion {
            ramp_s: 0.5,
            hold_s: 0.0,
            depth_m: 4e-7,
            before_m: 3e-7,
        };
        let series = Relaxation::new(2e3, Vec::new()).unwrap();
        let material = Material::from_relaxation(series, ModulusKind::Longitudinal, 0.5).unwrap();
        let rows = motion.loads(material, Arc::new(ball(2.5e-6)));
        let made = made(&mut Random(8), &motion, &rows);
        let mut plan = CurvePlan {
            forms: Form::series(1, 1).collect(),
            ..plan(Arc::new(ball(2.5e-6)))
        };
        plan.contact.layer = thickness_m.map(|thickness_m| LayerPlan {
            thickness_m,
            base: Base::Bonded,
            base_modulus_ratio: None,
            base_poisson_ratio: None,
        });
        fit(&plan, &made.curve, &AtomicBool::new(false))
            .unwrap()
            .laws
            .band(2.0)
            .unwrap()
            .storage_pa
    };
    let half_space = springs_of(None);
    // What a thick layer is stiffer by falls with the thickness (E. K. Dimitriadis et al., Biophys. J. 82 (2002) 2798): 1.133 chi of it.
    let [near, far] =
        [1e-4, 1e-3].map(|thickness_m| half_space / springs_of(Some(thickness_m)) - 1.0);
    assert!(near > 5.0 * far && far > 0.0 && near < 0.03, "{near} {far}");
}

/// Ramps, holds and jumps of anything: what a detector writes that has lost its cantilever, or a file of something else.
#[test]
fn curves_of_anything_are_fitted_or_refused() {
    let outcomes = (0..60_u64).into_par_iter().map(|number| {
        let mut random = Random(number);
        let mut curve = ForceCurve::default();
        let (mut depth_m, mut force_n) = (0.0, 0.0);
        let noise_n = random.power_of_ten(-12.0, -9.0);
        for _ in 0..1 + (5.0 * random.unit()) as usize {
            let [speed, change] = [1e-8, 1e-10].map(|most| match random.unit() < 0.3 {
                true => 0.0,
                false => random.between(-most, most),
            });
            if random.unit() < 0.3 {
                force_n += random.between(-5e-9, 5e-9);
            }
            for _ in 0..4 + (60.0 * random.unit()) as usize {
                depth_m += speed;
                force_n += change;
                curve.time_s.push(0.01 * curve.time_s.len() as f64);
                curve.indentation_m.push(depth_m);
                curve.force_n.push(force_n + noise_n * random.gauss());
            }
        }
        let mut plan = CurvePlan {
            forms: vec![Form {
                law: Law::StandardSolid,
                branches: 1,
            }],
            ..plan(Arc::new(ball(2.5e-6)))
        };
        if number % 30 == 0 {
            plan.contact.adhesion = Some(AdhesionPlan {
                range_m: Some(1e-8),
                ..AdhesionPlan::of_work(1e-5)
            });
        }
        let found = fit(&plan, &curve, &AtomicBool::new(false));
        found.is_ok_and(|found| found.laws.reduced_chi_squared.is_finite())
    });
    let fitted: Vec<bool> = outcomes.collect();
    assert!(fitted.contains(&true) && fitted.contains(&false));
}
