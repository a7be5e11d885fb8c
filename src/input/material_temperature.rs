//! Materials that know temperatures, and which of them a file asks for: `[material] temperature`, or the axis of a sweep.

use super::diagnostic::Location;
use super::document::reader::TableReader;
use super::document::{Located, block};
use super::keys::material::{
    self, EQUILIBRIUM, ISOTHERMS, MEASURED_TEMPERATURES, MODULUS, RELAXATION_BRANCHES, REPLICAS,
    Replica, TEMPERATURE,
};
use super::material_block::{branches, measured_window};
use crate::material::dynamic::shift_law::{Arrhenius, Wlf};
use crate::material::{Material, ModulusKind, Origin, Relaxation, RelaxationBranch};
use crate::quantity::celsius;

/// A material at a temperature (K), or at the one that counts where none is asked for, with this Poisson ratio; else why there is none.
pub(super) type AtTemperature = Box<dyn Fn(Option<f64>, f64) -> Result<Material, String>>;

/// Reads the temperature of `[material]`, and gives the material at this temperature and at those of an axis, where there is one;
/// the first of these is then the material of the file.
pub(super) fn read(
    block: &mut TableReader<'_>,
    known: Option<AtTemperature>,
    poisson_ratio: Option<f64>,
    axis: Option<&Located<Vec<f64>>>,
    place: &Location,
) -> Option<(Material, Vec<Material>)> {
    let (own, problems) = (block.read_if(&TEMPERATURE), block.problems());
    let (known, poisson_ratio, own) = (known?, poisson_ratio?, own?);
    let material = |temperature_k: Option<f64>, place: &Location| {
        problems.accept(place, known(temperature_k, poisson_ratio))
    };
    if let Some(axis) = axis {
        let each = axis.value.iter();
        let each = each.map(|temperature_k| material(Some(*temperature_k), &axis.location));
        let each = each.collect::<Option<Vec<Material>>>()?;
        return Some((each.first()?.clone(), each));
    }
    let place = own.as_ref().map_or(place, |own| &own.location);
    let own = material(own.as_ref().map(|own| own.value), place)?;
    Some((own, Vec::new()))
}

/// Refuses temperatures of a material that knows none; false where there were any.
pub(super) fn refuse(block: &mut TableReader<'_>, axis: Option<&Located<Vec<f64>>>) -> bool {
    let own = block.key_location(&TEMPERATURE);
    let Some(place) = own.as_ref().or(axis.map(|axis| &axis.location)) else {
        return true;
    };
    block.problems()
        .at(place, "this material is known at one temperature alone, and does not say at which")
        .help("give dynamic data measured at several temperatures in [material.dynamic], or a series for each in [[material.isotherm]]");
    false
}

/// The replicas of a series.
pub(super) fn replicas(table: &mut TableReader<'_>) -> Option<Vec<Relaxation>> {
    let replicas = table.tables(&REPLICAS, |mut table| {
        let (place, problems) = (table.as_ref().clone(), table.problems());
        let replica: Option<Replica> = block::read_from(&mut table, None);
        let times_place = table.value_place("times");
        table.finish();
        let replica = replica?;
        let (moduli, times) = (replica.moduli_pa.len(), replica.times_s.len());
        if moduli != times {
            problems
                .at(&times_place?, format!("{times} times for {moduli} moduli"))
                .help("give one time for each modulus");
            return None;
        }
        let branches = replica.moduli_pa.into_iter().zip(replica.times_s);
        let branches = branches.map(|(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
        let series = Relaxation::new(replica.equilibrium_pa, branches.collect());
        problems.accept(&place, series)
    });
    replicas.map(|replicas| replicas.value)
}

/// A series with its replicas that holds at a temperature, and by its law at others.
struct Isotherm {
    temperature_k: f64,
    law: Option<Wlf>,
    measured_window_s: Option<(f64, f64)>,
    isotherms_k: Option<(f64, f64)>,
    kind: ModulusKind,
    relaxation: Relaxation,
    replicas: Vec<Relaxation>,
}

/// Reads `[[material.isotherm]]`.
pub(super) fn isotherms(block: &mut TableReader<'_>) -> Option<AtTemperature> {
    let all = block.tables(&ISOTHERMS, |mut table| {
        let (place, problems) = (table.as_ref().clone(), table.problems());
        let at: Option<material::AtTemperature> = block::read_from(&mut table, None);
        let law = at.as_ref().map(|at| law(&mut table, at));
        let measured = measured_window(&mut table);
        let isotherms_k = measured_temperatures(&mut table);
        let (kind, equilibrium) = (table.value(&MODULUS), table.value(&EQUILIBRIUM));
        let branches = branches(&mut table, &RELAXATION_BRANCHES);
        let replicas = replicas(&mut table);
        table.finish();
        let relaxation = problems.accept(&place, Relaxation::new(equilibrium?, branches?));
        Some(Isotherm {
            temperature_k: at?.temperature_k,
            law: law??,
            measured_window_s: measured?,
            isotherms_k: isotherms_k?,
            kind: kind?,
            relaxation: relaxation?,
            replicas: replicas?,
        })
    })?;
    if all.value.is_empty() {
        (block.problems())
            .at(&all, "there is no isotherm")
            .help("give at least one [[material.isotherm]]");
        return None;
    }
    Some(Box::new(move |temperature_k, nu| {
        of_isotherms(&all.value, temperature_k, nu)
    }))
}

/// What a material knows of temperatures that says itself at which its series holds, and how it shifts; `None` for one that does not.
pub(super) fn shifting(material: &Material) -> Option<AtTemperature> {
    let isotherm = Isotherm {
        temperature_k: material.origin.temperature_k?,
        law: Some(*material.origin.shift.as_ref()?),
        measured_window_s: material.origin.measured_window_s,
        isotherms_k: material.origin.isotherms_k,
        kind: material.kind(),
        relaxation: material.relaxation()?.clone(),
        replicas: Vec::new(),
    };
    Some(Box::new(move |temperature_k, nu| {
        isotherm.material(temperature_k.unwrap_or(isotherm.temperature_k), nu)
    }))
}

/// The temperatures (K) of a `measured_temperatures`, where there is one; `None` where a problem was reported.
fn measured_temperatures(table: &mut TableReader<'_>) -> Option<Option<(f64, f64)>> {
    let Some(ends) = table.read_if::<Vec<f64>>(&MEASURED_TEMPERATURES)? else {
        return Some(None);
    };
    if let [lowest, highest] = ends.value[..]
        && highest >= lowest
    {
        return Some(Some((lowest, highest)));
    }
    let what = "`measured_temperatures` takes the lowest and the highest temperature of the test";
    let report = table.problems().at(&ends, what);
    report.help("write the lowest first: measured_temperatures = [\"-10 °C\", \"80 °C\"]");
    None
}

/// The law by which a series at this temperature shifts; `None` where a problem was reported.
fn law(table: &mut TableReader<'_>, at: &material::AtTemperature) -> Option<Option<Wlf>> {
    let reference_temperature_k = at.temperature_k;
    Some(match (at.wlf.as_deref(), at.activation_energy) {
        (Some(_), Some(_)) => {
            let [wlf, energy] = ["wlf", "activation_energy"].map(|key| table.value_place(key));
            (table.problems())
                .at(&energy?, "a series shifts by one law")
                .label(&wlf?, "another")
                .help("keep one of them");
            return None;
        }
        (Some(&[c1, c2_k]), None) => Some(Wlf {
            reference_temperature_k,
            c1,
            c2_k,
            c1_error: 0.0,
            c2_error_k: 0.0,
        }),
        // The key has two entries.
        (Some(_), None) => None,
        (None, Some(activation_energy_j_per_mol)) => {
            let law = Arrhenius {
                reference_temperature_k,
                activation_energy_j_per_mol,
                activation_energy_error_j_per_mol: 0.0,
            };
            Some(law.into())
        }
        (None, None) => None,
    })
}

impl Isotherm {
    /// The material at a temperature (K), its own or one that its law reaches.
    fn material(&self, temperature_k: f64, poisson_ratio: f64) -> Result<Material, String> {
        let is_own = temperature_k == self.temperature_k;
        let law = (self.law).and_then(|law| Some((law, law.referred_to(temperature_k)?)));
        let shifted = law.and_then(|(law, _)| law.log10_a_t(temperature_k));
        let log10_a_t = if is_own { Some(0.0) } else { shifted };
        let a_t = 10_f64.powf(log10_a_t.unwrap_or(f64::NAN));
        if !(a_t.is_normal() && a_t > 0.0) {
            return Err(format!(
                "the series at {} has no shift to {}",
                celsius(self.temperature_k),
                celsius(temperature_k)
            ));
        }
        let shifted = |series: &Relaxation| {
            let branches = series.branches().iter().map(|branch| RelaxationBranch {
                time_s: a_t * branch.time_s,
                ..*branch
            });
            let shifted = Relaxation::new(series.equilibrium_modulus(), branches.collect());
            shifted.and_then(|series| Material::from_relaxation(series, self.kind, poisson_ratio))
        };
        let replicas: Result<_, _> = self.replicas.iter().map(shifted).collect();
        let made = shifted(&self.relaxation).and_then(|own| Ok((own, replicas?)));
        let (mut material, replicas) = made.map_err(|error| error.to_string())?;
        let window_s = self.measured_window_s;
        material.origin = Origin {
            measured_window_s: window_s.map(|(first_s, last_s)| (a_t * first_s, a_t * last_s)),
            temperature_k: Some(temperature_k),
            shift: law.map(|(_, law)| law),
            isotherms_k: self.isotherms_k,
            replicas,
            ..Origin::default()
        };
        Ok(material)
    }
}

/// The material of series at some temperatures, at the one asked for.
fn of_isotherms(
    isotherms: &[Isotherm],
    temperature_k: Option<f64>,
    poisson_ratio: f64,
) -> Result<Material, String> {
    let wanted_k = match (temperature_k, isotherms) {
        (Some(temperature_k), _) => temperature_k,
        (None, [only]) => only.temperature_k,
        (None, _) => {
            let several =
                "there are several isotherms: write `temperature` with that of one of them";
            return Err(several.to_owned());
        }
    };
    let at = |isotherm: &&Isotherm| isotherm.temperature_k == wanted_k;
    // Where there is no isotherm of its own, the nearest that shifts.
    let away = |isotherm: &&Isotherm| (isotherm.temperature_k - wanted_k).abs();
    let shifting = isotherms.iter().filter(|isotherm| isotherm.law.is_some());
    let nearest = shifting.min_by(|a, b| away(a).total_cmp(&away(b)));
    let isotherm = isotherms.iter().find(at).or(nearest).ok_or_else(|| {
        let known: Vec<String> = isotherms.iter().map(|i| celsius(i.temperature_k)).collect();
        let wanted = celsius(wanted_k);
        format!(
            "no isotherm at {wanted}: there are {}, and none has a shift law (`wlf` or `activation_energy`)",
            known.join(", ")
        )
    })?;
    isotherm.material(wanted_k, poisson_ratio)
}
