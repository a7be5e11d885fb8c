//! A material as input of finite element programs: Prony series and WLF constants in the normalisation and syntax of each.
//!
//! A [`Material`] has one relaxation function and a Poisson ratio that does not depend on time, so its bulk modulus relaxes as
//! its shear modulus does. Programs take the two apart; each file of this folder says how its program is given both, and from
//! which document that is taken. All values are SI: Pa, s, K.
//!
//! Numbers are rounded to thirteen digits, or to what a column holds, and the largest relative difference of `E*` that this makes is
//! reported.

mod abaqus;
mod ansys;
mod comsol;
mod csv;
mod ls_dyna;
mod number;

use super::dynamic::shift_law::Wlf;
use super::{
    Material, MaterialError, ModulusKind, Relaxation, RelaxationBranch, branches_in_words,
};
use crate::numerics::grid;
use number::{digits, rounded, rounded_down};

/// A program that takes a material.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Program {
    Abaqus,
    Ansys,
    LsDyna,
    Comsol,
    /// Columns `modulus_pa`, `time_s`.
    Csv,
}

impl Program {
    /// Every program.
    pub const ALL: [Program; 5] = [
        Program::Abaqus,
        Program::Ansys,
        Program::LsDyna,
        Program::Comsol,
        Program::Csv,
    ];

    /// The name as it is asked for, as its vendor writes it, and what begins a comment; CSV has none.
    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Abaqus => ["abaqus", "Abaqus", "**"],
            Self::Ansys => ["ansys", "ANSYS", "!"],
            Self::LsDyna => ["ls-dyna", "LS-DYNA", "$"],
            Self::Comsol => ["comsol", "COMSOL", "%"],
            Self::Csv => ["csv", "CSV", ""],
        }
    }

    /// The name as it is asked for.
    pub fn name(self) -> &'static str {
        self.words()[0]
    }

    /// The name as its vendor writes it.
    pub fn title(self) -> &'static str {
        self.words()[1]
    }
}

/// A material as text for a program.
#[derive(Debug, Clone, PartialEq)]
pub struct Export {
    /// What the program reads.
    pub text: String,
    /// What a user has to know of it, one remark a string; comments of the text too, but for CSV, which has none.
    pub remarks: Vec<String>,
    /// Largest relative difference `|E*(written)/E*(series) - 1|` over the band.
    pub conversion_error: f64,
    /// Lowest and highest angular frequency (rad/s) of that comparison: two decades beyond the reciprocal times.
    pub band_rad_per_s: (f64, f64),
}

/// Why a material cannot be given to a program.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// Kelvin-Voigt.
    #[error(
        "the material has no relaxation modulus (it has no instantaneous compliance, as a Kelvin-Voigt solid), and {program} takes a \
         material by that: give it an instantaneous compliance"
    )]
    NoRelaxation { program: &'static str },
    /// No finite bulk modulus.
    #[error(
        "{program} cannot hold an incompressible material here, because {because}: write the material into a file with the Poisson \
         ratio below 0.5 that you choose, for example `poisson_ratio = 0.499`, and export that"
    )]
    Incompressible {
        program: &'static str,
        because: &'static str,
    },
    /// More branches than the program takes.
    #[error(
        "{program} takes at most {most} terms, and this material has {found} (the equilibrium modulus counts where it is one): fit \
         it with fewer branches, as with `material fit --branches {most}`, and export that"
    )]
    TooManyTerms {
        program: &'static str,
        most: usize,
        found: usize,
    },
    /// No equilibrium modulus, where the program asks for one.
    #[error(
        "{program} adds branches to an elastic material, and this one is a fluid, whose equilibrium modulus is zero: give it an \
         equilibrium modulus that is small over your frequencies"
    )]
    Fluid { program: &'static str },
    /// Numbers beyond the range of a double.
    #[error(transparent)]
    Material(#[from] MaterialError),
}

/// Text of the material for a program; `shift` where the time-temperature shift of the material is known.
///
/// # Errors
/// [`ExportError`].
pub fn export(
    material: &Material,
    shift: Option<&Wlf>,
    program: Program,
) -> Result<Export, ExportError> {
    let series = Series::new(material, shift, program)?;
    match program {
        Program::Abaqus => abaqus::export(&series),
        Program::Ansys => ansys::export(&series),
        Program::LsDyna => ls_dyna::export(&series),
        Program::Comsol => comsol::export(&series),
        Program::Csv => csv::export(&series),
    }
}

/// A series as programs take it that divide by the instantaneous modulus.
struct Ratios {
    /// Digits of the instantaneous Young's modulus.
    young: String,
    /// Digits of the ratio and the time of every branch.
    pairs: Vec<[String; 2]>,
    /// The series of these digits, longitudinal.
    made: Relaxation,
}

/// A material as every program takes it.
struct Series<'a> {
    material: &'a Material,
    program: Program,
    shift: Option<&'a Wlf>,
    nu: f64,
    /// Of the material's own kind.
    own: Relaxation,
    longitudinal: Relaxation,
    shear: Relaxation,
}

impl<'a> Series<'a> {
    fn new(
        material: &'a Material,
        shift: Option<&'a Wlf>,
        program: Program,
    ) -> Result<Self, ExportError> {
        let of = |kind| -> Result<Relaxation, ExportError> {
            let relaxation = material.relaxation_as(kind)?;
            relaxation.ok_or(ExportError::NoRelaxation {
                program: program.title(),
            })
        };
        Ok(Self {
            material,
            program,
            shift,
            nu: material
                .poisson_ratio()
                .ok_or(MaterialError::NoPoissonRatio { what: "an export" })?,
            own: of(material.kind())?,
            longitudinal: of(ModulusKind::Longitudinal)?,
            shear: of(ModulusKind::Shear)?,
        })
    }

    fn is_incompressible(&self) -> bool {
        self.nu == 0.5
    }

    /// Reference temperature (K), C1 and C2 (K) of the shift as they are printed.
    fn wlf(&self) -> Option<[String; 3]> {
        let wlf = self.shift?;
        Some([wlf.reference_temperature_k, wlf.c1, wlf.c2_k].map(|number| digits(rounded(number))))
    }

    fn title(&self) -> String {
        ascii(self.material.name().unwrap_or("Material"))
    }

    /// The name with letters, digits and underscores alone, a letter first.
    fn label(&self) -> String {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let label: String = self.title().chars().take(70).map(letter).collect();
        match label.starts_with(|c: char| c.is_ascii_alphabetic()) {
            true => label,
            false => format!("M_{label}"),
        }
    }

    /// `K_i / G_i`, the same for all terms; refused where there is no finite bulk modulus.
    fn bulk_over_shear(&self, because: &'static str) -> Result<f64, ExportError> {
        let (nu, program) = (self.nu, self.program.title());
        match self.is_incompressible() {
            true => Err(ExportError::Incompressible { program, because }),
            false => Ok(2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu))),
        }
    }

    fn at_most(&self, most: usize, found: usize) -> Result<(), ExportError> {
        let program = self.program.title();
        match found > most {
            true => Err(ExportError::TooManyTerms {
                program,
                most,
                found,
            }),
            false => Ok(()),
        }
    }

    /// A text without comments, of whose digits the program makes this longitudinal series, with what there is to say of it.
    fn export(&self, text: &str, made: &Relaxation, remarks: Vec<String>) -> Export {
        let band_rad_per_s = band(&self.longitudinal);
        let conversion_error = largest_difference(made, &self.longitudinal, band_rad_per_s);
        let (low, high) = band_rad_per_s;
        let remarks = self.remarks().into_iter().chain(remarks);
        let accuracy = match conversion_error == 0.0 {
            true => {
                "Error of the conversion: none; the digits below are the material's own.".to_owned()
            }
            false => format!(
                "Error of the conversion: E* of the digits below is within {conversion_error:.1e} of the material's from {low:.3e} to \
                 {high:.3e} rad/s."
            ),
        };
        let remarks: Vec<String> = remarks.chain([accuracy]).collect();
        let comments = match self.program.words() {
            [.., ""] => String::new(),
            [.., mark] => {
                let lines = remarks
                    .iter()
                    .flat_map(|remark| wrapped(&ascii(remark), 90));
                lines.map(|line| format!("{mark} {line}\n")).collect()
            }
        };
        Export {
            text: comments + text,
            remarks,
            conversion_error,
            band_rad_per_s,
        }
    }

    /// What is true of every text.
    fn remarks(&self) -> Vec<String> {
        let kind = self.material.kind().name();
        let mut remarks = vec![
            format!(
                "{}: {kind} relaxation series of {}, written by contact-dma for {}.",
                self.title(),
                branches_in_words(self.own.branches().len()),
                self.program.title(),
            ),
            "Units: Pa, s, K.".to_owned(),
        ];
        if let Some((first, last)) = self.material.origin.measured_window_s {
            remarks.push(format!(
                "Known from {:.3e} to {:.3e} rad/s; an extrapolation elsewhere.",
                last.recip(),
                first.recip()
            ));
        }
        if let Some([reference, c1, c2]) = self.wlf() {
            remarks.push(format!(
                "The series is that of {reference} K; log10 a_T = -C1 (T - Tr)/(C2 + T - Tr) with Tr = {reference} K, C1 = {c1}, C2 = {c2} K."
            ));
        }
        remarks
    }

    /// Moduli over the instantaneous one, rounded down so that they never add up to more than one.
    fn ratios(&self) -> Result<Ratios, MaterialError> {
        let instantaneous = self.own.instantaneous_modulus();
        // Beside an equilibrium modulus the rounding of a quotient does not matter: what was written as 0.2912 stays that.
        let rounding = match self.own.equilibrium_modulus() > 1e-9 * instantaneous {
            true => 4.0 * f64::EPSILON,
            false => 0.0,
        };
        let ratio = |modulus_pa: f64| rounded_down(modulus_pa / instantaneous * (1.0 + rounding));
        let branches = self.own.branches().iter();
        let pairs: Vec<[f64; 2]> = branches
            .map(|branch| [ratio(branch.modulus_pa), rounded(branch.time_s)])
            .collect();
        let young_pa = rounded(self.longitudinal.instantaneous_modulus());
        let sum: f64 = pairs.iter().map(|[ratio, _]| ratio).sum();
        let branches = pairs.iter().map(|&[ratio, time_s]| RelaxationBranch {
            modulus_pa: ratio * young_pa,
            time_s,
        });
        // Ratios of a fluid add up to one, but for the rounding of the sum.
        let made = Relaxation::new(young_pa * (1.0 - sum).max(0.0), branches.collect())?;
        Ok(Ratios {
            young: digits(young_pa),
            pairs: pairs.into_iter().map(|pair| pair.map(digits)).collect(),
            made,
        })
    }
}

/// Printable ASCII, which every program takes in a comment.
fn ascii(text: &str) -> String {
    let plain = |c: char| match c {
        ' '..='~' => c,
        _ => '?',
    };
    text.chars().map(plain).collect()
}

/// Lines of at most `width` characters; a longer word has its own.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// Two decades beyond the reciprocal times, where the limits are reached; about 1 rad/s for an elastic material.
fn band(relaxation: &Relaxation) -> (f64, f64) {
    let times = relaxation.branches();
    match (times.first(), times.last()) {
        (Some(shortest), Some(longest)) => (0.01 / longest.time_s, 100.0 / shortest.time_s),
        _ => (0.01, 100.0),
    }
}

/// Largest relative difference of the complex moduli, at twenty frequencies per decade.
fn largest_difference(made: &Relaxation, exact: &Relaxation, (low, high): (f64, f64)) -> f64 {
    let difference = |omega: f64| {
        let exact = exact.complex_modulus(omega);
        (made.complex_modulus(omega) - exact).norm() / exact.norm()
    };
    let grid = grid::logarithmic(low, high, 20.0, 10_000);
    grid.into_iter().map(difference).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::classical::kelvin_voigt;
    use crate::material::{Creep, CreepBranch, library};

    fn series(equilibrium: f64, count: i32, kind: ModulusKind, nu: f64) -> Material {
        let branch = |k: i32| RelaxationBranch {
            modulus_pa: 1e9 / (3.0 + f64::from(k * k)),
            time_s: 10_f64.powf(f64::from(k) * 0.7 - 4.0),
        };
        let relaxation = Relaxation::new(equilibrium, (0..count).map(branch).collect()).unwrap();
        Material::from_relaxation(relaxation, kind, nu).unwrap()
    }

    #[test]
    fn the_error_of_the_conversion_is_that_of_the_digits() {
        for kind in [ModulusKind::Shear, ModulusKind::Longitudinal] {
            let material = series(2e6, 12, kind, 0.45);
            for program in Program::ALL {
                let error = export(&material, None, program).unwrap().conversion_error;
                let most = match program {
                    // The shortest text that reads as the same double.
                    Program::Csv => 0.0,
                    // Five digits at least.
                    Program::LsDyna => 5e-5,
                    // Thirteen digits, of which the difference of the ratios from one takes three: the equilibrium is 1/1000.
                    _ => 1e-9,
                };
                assert!(error <= most, "{program:?}: {error:e}");
                assert!(program != Program::LsDyna || error > 0.0);
            }
        }
    }

    #[test]
    fn fluids_and_creep_are_given_by_their_relaxation_and_kelvin_voigt_has_none() {
        let branch = CreepBranch {
            compliance_per_pa: 2e-9,
            time_s: 3.0,
        };
        let creep = Creep::new(1e-9, vec![branch], Some(1e12)).unwrap();
        let fluid = Material::from_creep(creep, ModulusKind::Longitudinal, 0.4).unwrap();
        for program in Program::ALL {
            match export(&fluid, None, program) {
                Err(ExportError::Fluid { program }) => assert_eq!(program, "COMSOL"),
                // As above; a fluid's modulus at the end of the band is 1/100 of the last branch.
                written => assert!(written.unwrap().conversion_error < 5e-5, "{program:?}"),
            }
        }
        let kelvin = kelvin_voigt(1e6, 2.0).unwrap();
        let kelvin = Material::from_creep(kelvin, ModulusKind::Shear, 0.3).unwrap();
        let refused = export(&kelvin, None, Program::Abaqus).unwrap_err();
        assert!(refused.to_string().contains("Abaqus"), "{refused}");
    }

    #[test]
    fn what_a_program_cannot_hold_is_refused() {
        let rubber = series(1e6, 3, ModulusKind::Shear, 0.5);
        for program in [Program::Ansys, Program::LsDyna] {
            let refused = export(&rubber, None, program).unwrap_err().to_string();
            assert!(refused.contains("poisson_ratio"), "{refused}");
        }
        for program in [Program::Abaqus, Program::Comsol] {
            let text = export(&rubber, None, program).unwrap().text;
            assert!(text.contains("Poisson ratio 0.5: "), "{text}");
        }
        let long = series(1e6, 18, ModulusKind::Shear, 0.4);
        let refused = export(&long, None, Program::LsDyna).unwrap_err();
        assert!(refused.to_string().contains("18 terms"), "{refused}");
        // Without the equilibrium they are 18.
        assert!(
            export(
                &series(0.0, 18, ModulusKind::Shear, 0.4),
                None,
                Program::LsDyna
            )
            .is_ok()
        );
    }

    #[test]
    fn the_shift_law_is_written_where_there_is_one() {
        let wlf = Wlf {
            reference_temperature_k: 298.15,
            c1: 8.86,
            c2_k: 101.6,
            c1_error: 0.1,
            c2_error_k: 1.0,
        };
        let material = series(1e6, 3, ModulusKind::Shear, 0.4);
        for (program, line) in [
            (
                Program::Abaqus,
                "*TRS, DEFINITION=WLF\n298.15, 8.86, 101.6\n",
            ),
            (
                Program::Ansys,
                "TB,SHIFT,1,1,3,WLF\nTBDATA,1,298.15,8.86,101.6\n",
            ),
            (Program::LsDyna, "Tr = 298.15 K, C1 = 8.86"),
            (Program::Comsol, "C1WLF = 8.86"),
        ] {
            let text = export(&material, Some(&wlf), program).unwrap().text;
            let joined = text.replace("\n% ", " ").replace("\n$ ", " ");
            assert!(text.contains(line) || joined.contains(line), "{text}");
            let without = export(&material, None, program).unwrap().text;
            assert!(!without.contains("8.86"), "{without}");
        }
    }

    #[test]
    fn ratios_that_a_person_wrote_stay_as_they_are() {
        // Moduli of these shares of the instantaneous one, whose quotients are 0.07877699999999999 and 0.29119999999999996.
        let pvb = library::find("pvb").unwrap().material().unwrap();
        let text = export(&pvb, None, Program::Abaqus).unwrap().text;
        assert!(
            text.contains("\n0.078777, ") && text.contains("\n0.2912, "),
            "{text}"
        );
    }

    #[test]
    fn a_name_of_any_letters_ends_no_comment_and_no_keyword() {
        let material = series(1e6, 1, ModulusKind::Shear, 0.4).named("1, Gummi\n*END µ");
        for program in Program::ALL {
            let text = export(&material, None, program).unwrap().text;
            assert!(text.is_ascii() && !text.contains("\n*END"), "{text}");
        }
        let text = export(&material, None, Program::Abaqus).unwrap().text;
        assert!(text.contains("NAME=M_1__Gummi__END__\n"), "{text}");
    }
}
