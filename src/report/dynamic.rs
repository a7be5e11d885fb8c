//! Dynamic data as text: what was read, the shift factors and their laws, how well the series fits, and what to know of it. Tables
//! for files are in [`tables`], the summary in [`summary`].

pub mod summary;
pub mod tables;
mod text;

pub(super) use text::{arrhenius, wlf};

use std::borrow::Cow;

use super::number::scientific;
use crate::input::dynamic::DynamicFile;
use crate::material::continuous::Spectrum;
use crate::material::dynamic::{Characterisation, DynamicData, DynamicError, DynamicPoint};
use crate::material::{MaterialFunction, Relaxation};
use crate::quantity::FrequencyUnit;
use crate::report::laws::{Beside, spectrum_csv};
use crate::sweep::plan::resolved;

/// Where dynamic data come from.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Source {
    /// Names of the files.
    pub files: Vec<String>,
    /// The format found.
    pub format: String,
    /// How it was found.
    pub how: String,
    /// Hz where all data are in it; in this unit text and axes have frequencies.
    pub frequency_unit: FrequencyUnit,
    /// What the reader had to assume or leave out.
    pub notes: Vec<String>,
}

impl Source {
    /// Of files of these names, the format of which was named or found.
    pub fn of(files: Vec<String>, format_named: bool, file: &DynamicFile) -> Self {
        let how = match format_named {
            true => "as named",
            false => "found from the content",
        };
        Self {
            files,
            format: file.format.name().to_owned(),
            how: how.to_owned(),
            frequency_unit: file.frequency_unit,
            notes: file.notes.clone(),
        }
    }
}

/// Dynamic data, where they come from, and what was made of them.
#[derive(Debug, Clone, Copy)]
pub struct DynamicReport<'a> {
    pub source: &'a Source,
    pub data: &'a DynamicData,
    pub made: &'a Characterisation,
    /// Laws or a spectrum beside the series, where they were asked for.
    pub beside: Option<&'a Beside>,
}

/// Inconsistent by more than this many times the noise, storage and loss modulus are warned of.
const INCONSISTENT: f64 = 3.0;

impl<'a> DynamicReport<'a> {
    /// Every file of the folder but figures and page: name and bytes. `block` is the `[material]` block, `shifting` the one that
    /// shifts with the temperature.
    pub fn files(&self, block: &str, shifting: Option<&str>) -> Vec<(&'static str, Vec<u8>)> {
        let master = self.made.master.as_ref();
        let summary = format!("{:#}\n", summary::summary(self));
        let files = [
            ("material.toml", Some(block.into())),
            ("shifting.toml", shifting.map(Into::into)),
            ("prony.csv", Some(tables::prony(self.relaxation()))),
            ("shift.csv", master.map(tables::shift_factors)),
            ("master.csv", Some(tables::master_curve(self))),
            ("summary.json", Some(summary.into())),
            ("spectrum.csv", self.spectrum().map(spectrum_csv)),
        ];
        let present = files.into_iter();
        present
            .filter_map(|(name, bytes)| Some((name, bytes?)))
            .collect()
    }

    /// The continuous spectrum, where it was asked for.
    pub fn spectrum(&self) -> Option<&'a Spectrum> {
        self.beside.and_then(Beside::spectrum)
    }

    /// The points that the series was fitted to, in the order of its residuals: on the master curve, or as measured.
    pub fn points(&self) -> Cow<'a, [DynamicPoint]> {
        match &self.made.master {
            Some(master) => Cow::Borrowed(&master.points),
            None => Cow::Owned(self.data.points().copied().collect()),
        }
    }

    /// The series.
    pub fn relaxation(&self) -> &'a Relaxation {
        &self.made.fit.relaxation
    }

    /// The letter of the modulus.
    pub fn symbol(&self) -> char {
        MaterialFunction::Relaxation.symbol(self.made.kind)
    }

    /// The temperature (K) that the series belongs to, where the data name one.
    pub fn reference_temperature_k(&self) -> Option<f64> {
        self.made.temperature_k
    }

    /// First and last time (s) at which the material was observed.
    pub fn window_s(&self) -> (f64, f64) {
        let (lowest, highest) = self.made.fit.window_rad_per_s;
        (highest.recip(), lowest.recip())
    }

    /// What to know before the series is used, in whole sentences without their full stops.
    pub fn warnings(&self) -> Vec<String> {
        let master = self.made.master.iter().flat_map(|master| &master.warnings);
        let mut warnings: Vec<String> = master.map(ToString::to_string).collect();
        let symbol = self.symbol();
        let kramers_kronig = self.made.fit.kramers_kronig;
        if let Some(kramers_kronig) = kramers_kronig.filter(|number| *number > INCONSISTENT) {
            warnings.push(format!(
                "{symbol}′ and {symbol}″ do not belong to one another by {} times the noise: no passive material has both \
                 (Kramers and Kronig); look for slip of the clamps, the compliance or inertia of the instrument, or another \
                 modulus in one of the columns",
                scientific(kramers_kronig, 2)
            ));
        }
        if self.relaxation().is_fluid() {
            warnings.push(
                "the series has no equilibrium modulus: the material is a fluid and creeps without end under a mean load; \
                 `simulate` takes it, `sweep` does not"
                    .to_owned(),
            );
        }
        warnings
    }
}

/// Half widths (Pa) of the bands about the moduli of the series that its replicas make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Band {
    pub storage_pa: f64,
    pub loss_pa: f64,
}

impl Band {
    /// The half widths at a frequency, as [`replicas::error`] or [`replicas::band`] has them; `None` without at least two replicas.
    ///
    /// [`replicas::error`]: crate::material::dynamic::replicas::error
    /// [`replicas::band`]: crate::material::dynamic::replicas::band
    pub fn of(
        made: &Characterisation,
        angular_frequency_rad_per_s: f64,
        half_width: fn(f64, &[f64]) -> Option<f64>,
    ) -> Option<Self> {
        let at = |series: &Relaxation| series.complex_modulus(angular_frequency_rad_per_s);
        let own = at(&made.fit.relaxation);
        let moduli = made.replicas.iter().map(|replica| at(&replica.relaxation));
        let (storage, loss): (Vec<f64>, Vec<f64>) = moduli.map(|m| (m.re, m.im)).unzip();
        Some(Self {
            storage_pa: half_width(own.re, &storage)?,
            loss_pa: half_width(own.im, &loss)?,
        })
    }
}

impl DynamicReport<'_> {
    /// The material block of a sweep file, every number exact, with where it comes from.
    ///
    /// # Errors
    /// What the series refuses to be a material with.
    pub fn block(&self, poisson_ratio: Option<f64>) -> Result<String, DynamicError> {
        // Without a Poisson ratio there is none in the text either: the series does not depend on it.
        let nu = poisson_ratio.unwrap_or(0.0);
        let mut material = self.made.material(None, nu)?;
        material.origin.replicas = self.made.replica_materials(None, nu)?;
        if let Some(beside) = self.beside {
            material = beside.in_place_of(material, self.made.kind, nu)?;
        }
        let block = match poisson_ratio {
            Some(_) => resolved::material_text(&material),
            None => resolved::material_text_without_poisson_ratio(&material),
        };
        Ok(self.text().as_comments() + &block)
    }

    /// The block of the same series with its temperature and the law by which it shifts to others; `None` where the data prefer no law, or
    /// no Poisson ratio was given.
    ///
    /// # Errors
    /// As [`DynamicReport::block`].
    pub fn shifting_block(
        &self,
        poisson_ratio: Option<f64>,
    ) -> Result<Option<String>, DynamicError> {
        let Some(nu) = poisson_ratio else {
            return Ok(None);
        };
        let material = self.made.whole_material(None, nu)?;
        let has_law = material.origin.shift.is_some();
        Ok(has_law.then(|| resolved::material_text(&material)))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::material::dynamic::master_curve::{MasterCurve, MasterCurveWarning, ShiftFactor};
    use crate::material::dynamic::prony::PronyFit;
    use crate::material::dynamic::replicas::{Replica, band};
    use crate::material::dynamic::shift_law::{Arrhenius, ShiftLaw, Wlf};
    use crate::material::{ModulusKind, RelaxationBranch};

    /// A solid of two branches at 25 °C.
    pub(crate) fn solid() -> Relaxation {
        let branch = |modulus_pa, time_s| RelaxationBranch { modulus_pa, time_s };
        Relaxation::new(5e6, vec![branch(8e8, 1e-3), branch(6e7, 10.0)]).unwrap()
    }

    /// Its isotherms from 5 to 45 °C, exact, shifted by a WLF law, and what is made of them when nothing goes wrong.
    pub(crate) fn measured() -> (DynamicData, Characterisation) {
        let law = Wlf {
            reference_temperature_k: 298.15,
            c1: 12.0,
            c2_k: 60.0,
            c1_error: 0.2,
            c2_error_k: 1.5,
        };
        let truth = solid();
        let temperatures = [278.15, 288.15, 298.15, 308.15, 318.15];
        let isotherm = |temperature_k: f64| -> Vec<DynamicPoint> {
            let a_t = 10_f64.powf(law.log10_a_t(temperature_k).unwrap());
            let frequencies = (0..=8).map(|i| 10_f64.powf(-1.0 + 0.375 * f64::from(i)));
            let point = |omega: f64| {
                let modulus = truth.complex_modulus(a_t * omega);
                DynamicPoint {
                    temperature_k: Some(temperature_k),
                    angular_frequency_rad_per_s: omega,
                    storage_modulus_pa: modulus.re,
                    loss_modulus_pa: modulus.im,
                    errors_pa: None,
                }
            };
            frequencies.map(point).collect()
        };
        let kind = ModulusKind::Longitudinal;
        let data = DynamicData::new(kind, temperatures.map(isotherm).into()).unwrap();
        let mut points: Vec<DynamicPoint> = data.points().copied().collect();
        for point in &mut points {
            let temperature_k = point.temperature_k.unwrap();
            point.angular_frequency_rad_per_s *= 10_f64.powf(law.log10_a_t(temperature_k).unwrap());
        }
        let omega = |p: &DynamicPoint| p.angular_frequency_rad_per_s;
        points.sort_by(|a, b| omega(a).total_cmp(&omega(b)));
        let window_rad_per_s = (omega(&points[0]), omega(points.last().unwrap()));
        let factor = |temperature_k| ShiftFactor {
            temperature_k,
            log10_a_t: law.log10_a_t(temperature_k).unwrap(),
            log10_a_t_error: Some(match temperature_k == 298.15 {
                true => 0.0,
                false => 0.08,
            }),
            b_t: 1.0,
        };
        let arrhenius = Arrhenius {
            reference_temperature_k: 298.15,
            activation_energy_j_per_mol: 3.1e5,
            activation_energy_error_j_per_mol: 4e3,
        };
        let made = Characterisation {
            kind,
            temperature_k: Some(298.15),
            fit: PronyFit {
                residuals: (0..points.len())
                    .map(|i| (0.01 * (i as f64).sin(), 0.02 * (1.7 * i as f64).cos()))
                    .collect(),
                storage_rms: 0.01 / 2.0_f64.sqrt(),
                loss_rms: 0.02 / 2.0_f64.sqrt(),
                window_rad_per_s,
                kramers_kronig: Some(1.1),
                noise: (0.007, 0.014),
                relaxation: truth.clone(),
            },
            replicas: (1..=50)
                .map(|i| Replica {
                    relaxation: truth.scaled(1.0 + 4e-4 * f64::from(i - 25)).unwrap(),
                    master: None,
                })
                .collect(),
            master: Some(MasterCurve {
                reference_temperature_k: 298.15,
                shifts: temperatures.map(factor).into(),
                wlf: Some(law),
                arrhenius: Some(arrhenius),
                preferred: Some(ShiftLaw::Wlf(law)),
                points,
                simplicity: Some(1.2),
                warnings: Vec::new(),
            }),
        };
        (data, made)
    }

    pub(crate) fn source() -> Source {
        Source {
            files: vec!["solid.csv".to_owned()],
            format: "generic table".to_owned(),
            how: "columns named with their units".to_owned(),
            frequency_unit: FrequencyUnit::RadPerS,
            notes: vec!["two points without a loss modulus were left out".to_owned()],
        }
    }

    #[test]
    fn warnings_are_sentences_about_what_is_wrong() {
        let (data, mut made) = measured();
        let source = source();
        let report = |made: &Characterisation| {
            let report = DynamicReport {
                source: &source,
                data: &data,
                made,
                beside: None,
            };
            report.warnings()
        };
        assert!(report(&made).is_empty());
        let master = made.master.as_mut().unwrap();
        master.warnings = vec![
            MasterCurveWarning::NotSimple {
                simplicity: 6.4,
                storage_rms: 0.01,
                loss_rms: 0.03,
            },
            MasterCurveWarning::NoOverlap {
                lower_k: 278.15,
                upper_k: 288.15,
            },
        ];
        made.fit.kramers_kronig = Some(8.0);
        made.fit.relaxation = Relaxation::new(0.0, solid().branches().to_vec()).unwrap();
        let warnings = report(&made);
        let parts = [
            "6.4 times the noise",
            "5 °C and 15 °C",
            "by 8 times",
            "a fluid",
        ];
        assert_eq!(warnings.len(), parts.len());
        for (warning, part) in warnings.iter().zip(parts) {
            assert!(warning.contains(part), "{warning}");
        }
    }

    #[test]
    fn a_band_is_about_the_series_and_takes_replicas() {
        let (_, mut made) = measured();
        let exact = solid().complex_modulus(3.0);
        let found = Band::of(&made, 3.0, band).unwrap();
        // Replicas are the series times 1 + 4e-4 (i - 25): the same share of both moduli.
        let (storage, loss) = (found.storage_pa / exact.re, found.loss_pa / exact.im);
        // Rounding of the differences, which are a hundredth of the values.
        assert!(storage > 0.0 && (storage / loss - 1.0).abs() < 1e-10);
        made.replicas.truncate(1);
        assert_eq!(Band::of(&made, 3.0, band), None);
        made.replicas.clear();
        assert_eq!(Band::of(&made, 3.0, band), None);
    }
}
