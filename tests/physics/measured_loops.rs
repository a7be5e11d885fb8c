//! Measured loops, made of exact cycles of the contact with noise, drift and jitter of known size: what is read from them against
//! what was put in.

use crate::prelude::*;
use contact_dma::measured::moduli::{Contact, Radius};
use contact_dma::measured::{Corrections, MeasuredLoop, Options, Quantity, Signal, analyse};

/// An exact stabilised cycle under a sinusoidal load.
struct Exact {
    mean_n: f64,
    amplitude_n: f64,
    approach_mean_m: f64,
    /// Harmonics |a| sin(n omega t + arg a) of the approach, the load's phase being zero.
    approach_m: Vec<Complex<f64>>,
}

impl Exact {
    /// Under a mean load of 10 N.
    fn cycle(indenter: Arc<dyn Indenter>, material: Material, amplitude_n: f64, hz: f64) -> Self {
        let mean_n = 10.0;
        let drive = HarmonicDrive::load(mean_n, amplitude_n).unwrap();
        let sweep = Sweep::from(SweepPlan::new(material, indenter, drive));
        let sweep = sweep.steps(200).unwrap().springs(200).unwrap();
        let record = sweep.without_error_bars().case_at_hz(hz).unwrap();
        let samples = &record.result.unwrap().cycle.samples.approach_m;
        let n = samples.len() - 1;
        let harmonic = |k: usize| {
            let sum: Complex<f64> = (0..n)
                .map(|i| samples[i] * Complex::cis(-TAU * (k * i) as f64 / n as f64))
                .sum();
            // cos x = sin(x + pi/2).
            sum * Complex::new(0.0, 2.0 / n as f64)
        };
        Self {
            mean_n,
            amplitude_n,
            approach_mean_m: samples[..n].iter().sum::<f64>() / n as f64,
            approach_m: (1..=20).map(harmonic).collect(),
        }
    }

    fn all() -> Vec<Self> {
        let zener = || solid(1e9, &[(3e9, 1.0)], 0.4);
        let cycle =
            |material, amplitude_n, hz| Self::cycle(sphere(0.01), material, amplitude_n, hz);
        vec![
            cycle(pmma_material(), 5.0, 1.3e-3),
            cycle(pmma_material(), 2.0, 0.02),
            cycle(zener(), 5.0, 0.1),
            cycle(zener(), 9.0, 0.3),
        ]
    }

    fn loss_j(&self) -> f64 {
        PI * self.amplitude_n * self.approach_m[0].norm() * self.phase_lag_rad().sin()
    }

    fn phase_lag_rad(&self) -> f64 {
        -self.approach_m[0].arg()
    }

    /// Load and approach at an angle of the load.
    fn at(&self, angle: f64) -> (f64, f64) {
        let harmonics = self.approach_m.iter().enumerate();
        let waves = harmonics.map(|(k, a)| (a * Complex::cis((k + 1) as f64 * angle)).im);
        (
            self.mean_n + self.amplitude_n * angle.sin(),
            self.approach_mean_m + waves.sum::<f64>(),
        )
    }
}

/// How a record is made.
#[derive(Debug, Clone, Copy)]
struct Recording {
    hz: f64,
    points: f64,
    cycles: f64,
    /// Standard deviation over the amplitude, of both signals.
    noise: f64,
    /// Correlation of the noise of neighbouring samples.
    correlation: f64,
    drift: Drift,
    /// Of the times, over the interval, standard deviation; the times are recorded as they are.
    jitter: f64,
    phase: f64,
}

#[derive(Debug, Clone, Copy)]
enum Drift {
    None,
    /// Over the record, in amplitudes.
    Line(f64),
    Parabola(f64, f64),
    /// With a time constant in records.
    Exponential(f64, f64),
}

impl Recording {
    /// Without noise of correlation, drift or jitter.
    fn plain(hz: f64, points: f64, cycles: f64, noise: f64, phase: f64) -> Self {
        Self {
            hz,
            points,
            cycles,
            noise,
            correlation: 0.0,
            drift: Drift::None,
            jitter: 0.0,
            phase,
        }
    }

    fn any(random: &mut Random) -> Self {
        let cycles = random.between_logarithms(3.0, 50.0);
        // At most 20,000 samples: more take long and show nothing else.
        let points = random.between_logarithms(20.0, 2000.0).min(2e4 / cycles);
        let size = 2.0 * random.unit() - 1.0;
        Self {
            hz: random.between_logarithms(1e-3, 1e2),
            points,
            cycles: cycles.max(3.0),
            noise: random.one_of(&[2e-3, 1e-2, 3e-2]),
            correlation: random.one_of(&[0.0, 0.0, 0.5, 0.8]),
            drift: match (random.unit() * 4.0) as usize {
                0 => Drift::None,
                1 => Drift::Line(size),
                2 => Drift::Parabola(size, random.unit() - 0.5),
                _ => Drift::Exponential(size, random.between_logarithms(0.15, 0.6)),
            },
            jitter: random.one_of(&[0.0, 0.02, 0.1]),
            phase: TAU * random.unit(),
        }
    }

    fn record(&self, exact: &Exact, random: &mut Random) -> Signal {
        let interval_s = 1.0 / (self.hz * self.points);
        let samples = (self.cycles * self.points).ceil() as usize;
        let mut signal = Signal::default();
        let (mut noise_w, mut noise_d) = (random.gauss(), random.gauss());
        let fresh = (1.0 - self.correlation * self.correlation).sqrt();
        let amplitude_m = exact.approach_m[0].norm();
        for i in 0..samples {
            let time_s = interval_s * (i as f64 + self.jitter * random.gauss());
            let (load_n, approach_m) = exact.at(TAU * self.hz * time_s + self.phase);
            let part = time_s * self.hz / self.cycles;
            let drift = match self.drift {
                Drift::None => 0.0,
                Drift::Line(size) => size * part,
                Drift::Parabola(size, bend) => size * part + bend * part * part,
                Drift::Exponential(size, time) => size * (-part / time).exp(),
            };
            noise_w = self.correlation * noise_w + fresh * random.gauss();
            noise_d = self.correlation * noise_d + fresh * random.gauss();
            signal.time_s.push(time_s);
            let off_n = self.noise * exact.amplitude_n * noise_w;
            let off_m = amplitude_m * (drift + self.noise * noise_d);
            signal.load_n.push(load_n + off_n);
            signal.approach_m.push(approach_m + off_m);
        }
        signal
    }
}

#[test]
fn loss_and_phase_lie_within_their_intervals_in_at_least_95_of_100_records() {
    const RECORDS: u64 = 500;
    let exact = Exact::all();
    let (mut loss, mut phase, mut frequency, mut unsettled) = (0, 0, 0, 0);
    let mut widths = Vec::new();
    // Deviations over their standard errors of loss, phase and amplitude of the approach, and the correlation of the last two, which are
    // the data of an identification.
    let (mut squares, mut correlation) = ([0.0; 3], 0.0);
    for seed in 0..RECORDS {
        let mut random = Random(seed);
        let exact = &exact[seed as usize % exact.len()];
        let recording = Recording::any(&mut random);
        let signal = recording.record(exact, &mut random);
        let measured = analyse(&signal, &Options::default()).unwrap();
        let Some(found) = measured.energy_loss_j() else {
            unsettled += 1;
            continue;
        };
        let lag = measured.phase_lag_rad().unwrap();
        let off = |value: f64, truth: f64, error: f64| (value - truth).abs() / error;
        let loss_off = off(found.value, exact.loss_j(), found.error.unwrap());
        let phase_off = off(lag.value, exact.phase_lag_rad(), lag.error.unwrap());
        loss += usize::from(loss_off <= 1.0);
        phase += usize::from(phase_off <= 1.0);
        let z_loss = (found.value - exact.loss_j()) / found.standard_error.unwrap();
        let z_phase = (lag.value - exact.phase_lag_rad()) / lag.standard_error.unwrap();
        let amplitude = measured.mean(Quantity::ApproachAmplitude).unwrap();
        let exact_m = exact.approach_m[0].norm();
        let z_amplitude = (amplitude.value - exact_m) / amplitude.standard_error.unwrap();
        for (sum, z) in squares.iter_mut().zip([z_loss, z_phase, z_amplitude]) {
            *sum += z * z / RECORDS as f64;
        }
        correlation += z_phase * z_amplitude / RECORDS as f64;
        let own = measured.frequency.standard_error_hz.unwrap();
        let error_hz = (measured.frequency.hz - recording.hz).abs();
        // Of 60 samples with 3 % of noise no method reads more than the bound of Cramér and Rao, which is 1e-3.
        frequency += usize::from(error_hz <= (1e-4 * recording.hz).max(3.0 * own));
        widths.push(found.error.unwrap() / exact.loss_j());
        if loss_off > 1.0 || phase_off > 1.0 {
            println!("{seed} {loss_off:.2} {phase_off:.2} {recording:?}");
        }
    }
    widths.sort_by(f64::total_cmp);
    let median = widths[widths.len() / 2];
    println!("{loss} {phase} {frequency} of {RECORDS}, median width {median:?}");
    println!("mean squares over standard errors {squares:?}, correlation {correlation}");
    assert_eq!(unsettled, 0);
    // Standard deviations, not half-widths: of half-widths the mean square would be a quarter or less.
    for square in squares {
        assert!((0.6..1.3).contains(&square), "{squares:?}");
    }
    // Of 500 independent pairs three standard deviations are 0.13; loss and phase of one loop have up to 1.
    assert!(correlation.abs() < 0.13, "{correlation}");
    assert!(loss >= 475, "{loss} of {RECORDS}");
    assert!(phase >= 475, "{phase} of {RECORDS}");
    assert!(frequency >= 495, "{frequency} of {RECORDS}");
    // And not by intervals that hold everything: a loss of ten degrees' lag with a tenth of a per cent of its noise.
    below!(median, 0.05);
}

/// An instrument of known properties: force and displacement of its moving part for a contact that is a spring and a dashpot.
fn nano_dma(instrument: &Corrections, hz: f64, random: &mut Random) -> (Signal, f64, f64) {
    let (stiffness, lag) = (2e4, 0.08);
    let omega = TAU * hz;
    // Approach 20 nm about 500 nm; the load leads by the lag.
    let contact = Complex::from_polar(2e-8, -0.4);
    let load = stiffness * contact * Complex::cis(lag);
    let (approach_mean, load_mean) = (5e-7, 3e-3);
    let x = contact + instrument.frame_compliance_m_per_n * load;
    let x_mean = approach_mean + instrument.frame_compliance_m_per_n * load_mean;
    let i = Complex::i();
    let dynamic = instrument.stiffness_n_per_m - instrument.mass_kg * omega * omega
        + i * instrument.damping_n_s_per_m * omega;
    let force: Complex<f64> = load + dynamic * x;
    let force_mean = load_mean + instrument.stiffness_n_per_m * x_mean;
    let late: Complex<f64> = x * Complex::cis(-omega * instrument.time_lag_s);
    let points = 80.3;
    let mut signal = Signal::default();
    for k in 0..(20.0 * points) as usize {
        let time_s = k as f64 / (points * hz);
        let turn = Complex::cis(omega * time_s);
        let noise = 1e-4 * random.gauss();
        signal.time_s.push(time_s);
        let load_n = force_mean + (force * turn).im + noise * force.norm();
        signal.load_n.push(load_n);
        let drift = instrument.thermal_drift_m_per_s * time_s;
        signal.approach_m.push(x_mean + (late * turn).im + drift);
    }
    (signal, stiffness, lag)
}

#[test]
fn mass_damping_stiffness_frame_and_lag_of_an_instrument_are_taken_out_from_1_to_200_hz() {
    let instrument = Corrections {
        frame_compliance_m_per_n: 2e-6,
        mass_kg: 2e-4,
        damping_n_s_per_m: 0.02,
        stiffness_n_per_m: 150.0,
        time_lag_s: 3e-5,
        thermal_drift_m_per_s: 1e-10,
        ..Corrections::default()
    };
    let mut random = Random(5);
    for hz in [1.0, 3.0, 10.0, 45.0, 110.0, 200.0] {
        let (signal, stiffness, lag) = nano_dma(&instrument, hz, &mut random);
        let read = |corrections: Corrections| {
            let options = Options {
                corrections,
                ..Options::default()
            };
            let measured = analyse(&signal, &options).unwrap();
            let mean = |quantity| measured.mean(quantity).unwrap().value;
            (
                mean(Quantity::LoadAmplitude) / mean(Quantity::ApproachAmplitude),
                mean(Quantity::PhaseLag),
                mean(Quantity::ApproachMean),
                mean(Quantity::LoadMean),
            )
        };
        let (found, phase, approach, load) = read(instrument.clone());
        near!(found, stiffness, 1e-3, "{hz} Hz");
        below!((phase - lag).abs(), 1e-3 * lag.max(0.1), "{hz} Hz");
        near!(approach, 5e-7, 1e-3, "{hz} Hz");
        near!(load, 3e-3, 1e-3, "{hz} Hz");
        // There is something to take out.
        let (raw, ..) = read(Corrections::default());
        assert!(relative(raw, stiffness).abs() > 0.02, "{hz} Hz: {raw}");
    }
}

/// What is read from a loop of a contact; `known` is what the setup says of the indenter's material.
fn read_contact(
    signal: &Signal,
    (indenter, known): (Arc<dyn Indenter>, Option<Material>),
    material: &Material,
) -> MeasuredLoop {
    let contact = Contact {
        poisson_ratio: material.poisson_ratio().unwrap(),
        radius: Radius::Geometry,
        indenter: Some(indenter),
        indenter_material: known,
        bias: true,
    };
    let options = Options {
        contact: Some(contact),
        ..Options::default()
    };
    analyse(signal, &options).unwrap()
}

/// The moduli with and without bias over those of the material, storage first.
fn moduli(
    known: Option<Material>,
    indenter: Arc<dyn Indenter>,
    material: &Material,
    amplitude_n: f64,
    hz: f64,
) -> [(f64, f64); 2] {
    let exact = Exact::cycle(Arc::clone(&indenter), material.clone(), amplitude_n, hz);
    let recording = Recording::plain(hz, 200.0, 6.3, 1e-5, 0.7);
    let signal = recording.record(&exact, &mut Random(1));
    let measured = read_contact(&signal, (indenter, known), material);
    let own = material.relaxation().unwrap().complex_modulus(TAU * hz);
    let formula = |quantity| measured.mean(quantity).unwrap().value;
    let (storage, loss) = (
        formula(Quantity::StorageModulus) / own.re,
        formula(Quantity::LossModulus) / own.im,
    );
    let unbiased = measured.unbiased.as_ref();
    let unbiased = unbiased.unwrap_or_else(|| panic!("{:?}", measured.findings));
    [
        (storage, unbiased.storage_modulus_pa.value / own.re),
        (loss, unbiased.loss_modulus_pa.value / own.im),
    ]
}

#[test]
fn what_the_indenter_yields_is_taken_off_the_moduli() {
    // A ball that yields a tenth as much as the specimen, and dissipates.
    let specimen = solid(1e9, &[(3e9, 1.0)], 0.4);
    let ball = solid(2e10, &[(1e10, 1.0)], 0.4);
    let pressed = specimen.against(ball.clone());
    let [storage, loss] = moduli(Some(ball), sphere(0.01), &pressed, 5.0, 0.2);
    near!(storage.1, 1.0, 0.01);
    near!(loss.1, 1.0, 0.01);
    let [as_rigid, _] = moduli(None, sphere(0.01), &pressed, 5.0, 0.2);
    below!(as_rigid.1, 0.95);
}

#[test]
fn the_bias_of_the_formula_is_computed_and_taken_out_at_half_the_mean_load() {
    let (pmma, zener) = (pmma_material(), solid(1e9, &[(3e9, 1.0)], 0.4));
    // None of these is the solid that the bias is computed with.
    let wide = [(5e8, 10.0), (5e8, 1.0), (5e8, 0.1), (5e8, 0.01)];
    let wide = solid(2e8, &wide, 0.4);
    let mut largest = 0.0_f64;
    for (name, material, hz) in [
        ("pmma", &pmma, 1.3e-3),
        ("pmma", &pmma, 0.02),
        ("zener", &zener, 0.05),
        ("zener", &zener, 0.5),
        ("wide", &wide, 0.1),
        ("wide", &wide, 3.0),
    ] {
        for part in [0.1, 0.5] {
            let [storage, loss] = moduli(None, sphere(0.01), material, 10.0 * part, hz);
            near!(storage.1, 1.0, 0.01, "{name} {hz} {part}");
            near!(loss.1, 1.0, 0.01, "{name} {hz} {part}");
            largest = largest.max((loss.0 - 1.0).abs());
        }
    }
    // There is something to take out.
    assert!(largest > 0.05, "{largest}");
    // Nothing moves the edge of a flat punch, and the formula is exact.
    for (formula, unbiased) in moduli(None, punch(1e-3), &zener, 5.0, 0.1) {
        near!(formula, 1.0, 2e-3);
        near!(unbiased, 1.0, 2e-3);
    }
}

/// A solid of so many branches over four decades about 1 s, of any strengths.
fn any_solid(random: &mut Random, branches: usize) -> Material {
    let branch = |random: &mut Random| {
        let modulus_pa = random.between_logarithms(2e8, 5e9);
        (modulus_pa, random.between_logarithms(1e-2, 1e2))
    };
    let branches: Vec<_> = (0..branches).map(|_| branch(random)).collect();
    let equilibrium_pa = random.between_logarithms(2e8, 2e9);
    solid(equilibrium_pa, &branches, 0.2 + 0.3 * random.unit())
}

#[test]
fn moduli_without_bias_lie_within_their_intervals_whatever_the_spectrum() {
    const SOLIDS: usize = 60;
    let (mut inside, mut known) = (0, 0);
    for seed in 0..SOLIDS {
        let mut random = Random(1000 + seed as u64);
        let material = any_solid(&mut random, [1, 2, 5][seed % 3]);
        let hz = random.between_logarithms(0.01, 1.0);
        let amplitude_n = 10.0 * random.between_logarithms(0.05, 0.7);
        let indenter = match random.unit() < 0.5 {
            true => sphere(0.01),
            false => cone(1.2),
        };
        let exact = Exact::cycle(indenter.clone(), material.clone(), amplitude_n, hz);
        let noise = random.between_logarithms(3e-4, 1e-2);
        let recording = Recording::plain(hz, 60.0, 12.3, noise, TAU * random.unit());
        let signal = recording.record(&exact, &mut random);
        let measured = read_contact(&signal, (indenter, None), &material);
        // A loss that the noise hides has no solid.
        let Some(unbiased) = measured.unbiased else {
            continue;
        };
        let own = material.relaxation().unwrap().complex_modulus(TAU * hz);
        for (modulus, truth) in [
            (unbiased.storage_modulus_pa, own.re),
            (unbiased.loss_modulus_pa, own.im),
        ] {
            known += 1;
            let off = (modulus.value - truth).abs() / modulus.error.unwrap();
            inside += usize::from(off <= 1.0);
            if off > 1.0 {
                println!("{seed} {off:.2} {amplitude_n:.1} {recording:?}");
            }
        }
    }
    println!("{inside} of {known}");
    assert!(known >= 2 * SOLIDS - 12, "{known}");
    assert!(100 * inside >= 93 * known, "{inside} of {known}");
}

#[test]
fn harmonics_lie_within_their_intervals_and_none_is_made_of_noise() {
    const RECORDS: u64 = 60;
    let all = Exact::all();
    let (mut inside, mut of) = (0, 0);
    let kinds = [
        (0.0, Drift::None),
        (0.0, Drift::Exponential(1.0, 0.3)),
        (0.8, Drift::None),
    ];
    for (kind, (correlation, drift)) in kinds.into_iter().enumerate() {
        let mut own = 0;
        for seed in 0..RECORDS {
            let mut random = Random(5000 * kind as u64 + seed);
            let exact = &all[seed as usize % all.len()];
            let mut recording = Recording::plain(1.0, 40.3, 20.2, 0.01, TAU * random.unit());
            (recording.correlation, recording.drift) = (correlation, drift);
            let measured = analyse(&recording.record(exact, &mut random), &Options::default());
            let measured = measured.unwrap();
            for (n, quantity) in [(1, Quantity::Harmonic2), (2, Quantity::Harmonic3)] {
                let truth = exact.approach_m[n].norm() / exact.approach_m[0].norm();
                let found = measured.mean(quantity).unwrap();
                own += usize::from((found.value - truth).abs() <= found.error.unwrap());
            }
        }
        println!("{own} of {} with kind {kind}", 2 * RECORDS);
        assert!(own >= 2 * RECORDS as usize * 9 / 10, "kind {kind}: {own}");
        inside += own;
        of += 2 * RECORDS as usize;
    }
    assert!(100 * inside >= 93 * of, "{inside} of {of}");
}

#[test]
fn the_steps_of_a_coarse_converter_are_in_the_interval() {
    const RECORDS: u64 = 40;
    let exact = &Exact::all()[0];
    // Steps over the amplitude, samples a cycle.
    for (size, points, is_locked) in [
        (2e-3, 100.0, true),
        (2e-2, 100.0, true),
        (2e-3, 100.37, false),
    ] {
        let (mut inside, mut found) = (0, 0);
        for seed in 0..RECORDS {
            let mut random = Random(seed);
            let phase = TAU * random.unit();
            let recording = Recording::plain(1.0, points, 20.0, 0.1 * size, phase);
            let mut signal = recording.record(exact, &mut random);
            for (column, amplitude) in [
                (&mut signal.load_n, exact.amplitude_n),
                (&mut signal.approach_m, exact.approach_m[0].norm()),
            ] {
                let (step, offset) = (size * amplitude, random.unit());
                let rounded = |value: f64| ((value / step + offset).round() - offset) * step;
                column.iter_mut().for_each(|value| *value = rounded(*value));
            }
            let measured = analyse(&signal, &Options::default()).unwrap();
            let loss = measured.energy_loss_j().unwrap();
            inside += usize::from((loss.value - exact.loss_j()).abs() <= loss.error.unwrap());
            let findings = measured.findings.iter();
            found += findings.filter(|f| f.code() == "quantised").count() as u64;
        }
        assert!(100 * inside >= 93 * RECORDS as usize, "{size}: {inside}");
        // Of both signals.
        let expected = if is_locked { 2 * RECORDS } else { 0 };
        assert_eq!(found, expected, "{size} {points}");
    }
}
