//! Laws from force curves of random solids and gels, made by the engine of a simulation: offset, drift, drag and noise, the contact point
//! unknown.
//!
//! `CURVES=100 SEED=9 cargo test --release --test physics force_curves -- --nocapture` tries as many as the guide on validation quotes.

use contact_dma::force_curve::resolved::Probe;
use contact_dma::force_curve::{CurveFit, CurvePlan, ForceCurve, fit};
use contact_dma::identify::laws::Estimate;
use contact_dma::material::fractional::Fractional;
use contact_dma::material::law::{Form, Law};

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
        let drive = SegmentedDrive::new(Control::Approach, all.into_iter().flatten().collect());
        let mut plan = ScenarioPlan::new(material, indenter, drive.unwrap());
        plan.output.error_bars = false;
        plan.step_s = Some(self.ramp_s / 400.0);
        let outcome = Simulation::new(plan)
            .unwrap()
            .run(&AtomicBool::new(false), &|_, _| {});
        outcome.rows
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

/// Curves of a kind: no refusal, moduli and contact points in their bands; the fits.
fn judge(kind: &str, body: fn(&mut Random, &Motion) -> (Truth, Material)) -> Vec<CurveFit> {
    let of = |name: &str, default: u64| {
        std::env::var(name)
            .ok()
            .and_then(|text| text.parse().ok())
            .unwrap_or(default)
    };
    let (curves, seed) = (of("CURVES", 12), of("SEED", 9));
    let found = (0..curves).into_par_iter().map(|number| {
        let mut random = Random(seed.wrapping_mul(1_000_003) + number);
        let motion = Motion::random(&mut random);
        let (truth, material) = body(&mut random, &motion);
        let indenter = indenter(&mut random);
        let rows = motion.loads(material, Arc::clone(&indenter));
        let made = made(&mut random, &motion, &rows);
        let plan = CurvePlan {
            indenter,
            compressibility: 0.5.into(),
            indenter_material: None,
            forms: Form::all(4),
            probe: Probe::default(),
            samples: 0,
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
        indenter: Arc::new(ball(2.5e-6)),
        compressibility: 0.5.into(),
        indenter_material: None,
        forms: Form::all(1),
        probe: Probe::default(),
        samples: 0,
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
