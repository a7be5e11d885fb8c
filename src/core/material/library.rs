//! Materials with published constants, each with its source.

use std::f64::consts::TAU;

use super::dynamic::shift_law::Wlf;
use super::{Material, MaterialError, ModulusKind, Relaxation, RelaxationBranch};

/// One material of the library.
#[derive(Debug, Clone, Copy, serde::Serialize)]
pub struct LibraryEntry {
    /// The name by which it is asked for, in lower case.
    pub name: &'static str,
    /// The name to print.
    pub title: &'static str,
    /// Where the constants come from, as a full citation.
    pub source: &'static str,
    /// How they were measured and what to keep in mind.
    pub notes: &'static str,
    /// First and last time (s) at which it was observed; `None` for an elastic body, which is the same at all times.
    pub measured_window_s: Option<(f64, f64)>,
    #[serde(skip)]
    build: fn() -> Result<Material, MaterialError>,
}

impl LibraryEntry {
    /// The material itself.
    ///
    /// # Errors
    /// None for the entries of this file, whose constants are tested.
    pub fn material(&self) -> Result<Material, MaterialError> {
        Ok(self.describe((self.build)()?))
    }

    /// A material made of the numbers of this one, with its title and the times in which it was observed.
    pub fn describe(&self, material: Material) -> Material {
        let mut material = material.named(self.title);
        let window_s = self.measured_window_s;
        material.origin.measured_window_s = window_s.or(material.origin.measured_window_s);
        material
    }
}

/// All materials, by name.
pub fn entries() -> &'static [LibraryEntry] {
    &ENTRIES
}

static ENTRIES: [LibraryEntry; 9] = [
    LibraryEntry {
        name: "diamond",
        title: "diamond",
        source: "W. C. Oliver and G. M. Pharr, \"An improved technique for determining hardness and elastic modulus using load and displacement sensing indentation experiments\", Journal of Materials Research 7 (1992) 1564, doi:10.1557/JMR.1992.1564",
        notes: "Elastic: the indenter of instrumented indentation, 1141 GPa, Poisson ratio 0.07.",
        measured_window_s: None,
        build: || elastic(1141e9, 0.07),
    },
    LibraryEntry {
        name: "epoxy",
        title: "epoxy resin 3501-6",
        source: "P. D. Soden, M. J. Hinton and A. S. Kaddour, \"Lamina properties, lay-up configurations and loading conditions for a range of fibre-reinforced composite laminates\", Composites Science and Technology 58 (1998) 1011",
        notes: "Elastic: a cured resin of carbon-fibre composites at room temperature, 4.2 GPa, Poisson ratio 0.34. What it loses in a cycle is not in these numbers.",
        measured_window_s: None,
        build: || elastic(4.2e9, 0.34),
    },
    LibraryEntry {
        name: "glass",
        title: "soda-lime glass",
        source: "EN 572-1, Glass in building: basic soda lime silicate glass products, part 1: definitions and general physical and mechanical properties",
        notes: "Elastic: 70 GPa, Poisson ratio 0.2.",
        measured_window_s: None,
        build: || elastic(70e9, 0.2),
    },
    LibraryEntry {
        name: "liver",
        title: "human liver",
        source: "P. Asbach, D. Klatt, U. Hamhaber, J. Braun, R. Somasundaram, B. Hamm and I. Sack, \"Assessment of liver viscoelasticity using multifrequency MR elastography\", Magnetic Resonance in Medicine 60 (2008) 373, the means of eight healthy volunteers",
        notes: "Healthy liver in the living body: shear moduli 1.16 kPa and 1.97 kPa and viscosity 7.3 Pa s of the standard linear solid, from shear waves of 25 Hz to 62.5 Hz, far smaller than the strains of most contacts; the volunteers scatter by 0.28 kPa, 0.30 kPa and 2.3 Pa s. Poisson ratio 0.5, taken as constant.",
        measured_window_s: Some((1.0 / (TAU * 62.5), 1.0 / (TAU * 25.0))),
        // A spring beside a spring of 1970 Pa and a dashpot of 7.3 Pa s in series.
        build: || prony(ModulusKind::Shear, 0.5, 1160.0, &[(1970.0, 7.3 / 1970.0)]),
    },
    LibraryEntry {
        name: "pdms",
        title: "PDMS (Sylgard 184)",
        source: "I. D. Johnston, D. K. McCluskey, C. K. L. Tan and M. C. Tracey, \"Mechanical characterization of bulk Sylgard 184 for microfluidics and microengineering\", Journal of Micromechanics and Microengineering 24 (2014) 035017, doi:10.1088/0960-1317/24/3/035017",
        notes: "Elastic: cured at 25 °C, 1.32 MPa in tension (2.97 MPa where it is cured at 200 °C); Poisson ratio 0.5. What it loses in a cycle is not in these numbers.",
        measured_window_s: None,
        build: || elastic(1.32e6, 0.5),
    },
    LibraryEntry {
        name: "pmma",
        title: "PMMA",
        source: "M. V. Ramesh Kumar and R. Narasimhan, \"Analysis of spherical indentation of linear viscoelastic materials\" (the experiments); as the two-term Prony series of S. Spinu, \"Viscoelastic Contact Simulation under Harmonic Cyclic Load\", Advances in Tribology 2018, 9432894, equation (8), doi:10.1155/2018/9432894, after W. W. Chen, Q. J. Wang, Z. Huan and X. Luo, \"Semi-Analytical Viscoelastic Contact Modeling of Polymer-Based Materials\", Journal of Tribology 133 (2011) 041404, doi:10.1115/1.4004928",
        notes: "Polymethyl methacrylate. Longitudinal relaxation modulus from uniaxial compression, observed for 1000 s (from when on is not said; 1 s is assumed); Poisson ratio 0.38, taken as constant. Two relaxation times describe that window only: far above 1 rad/s or below 1 mrad/s the series is an extrapolation.",
        // The end is the source's. It does not say when the first sample was taken; one second is what a testing machine needs
        // to put the strain on, and a ninth of the shortest time of the series, of which nothing is seen before.
        measured_window_s: Some((1.0, 1000.0)),
        build: || {
            prony(
                ModulusKind::Longitudinal,
                0.38,
                1973e6,
                &[(254.776e6, 8.93), (263.6628e6, 117.96)],
            )
        },
    },
    LibraryEntry {
        name: "pvb",
        title: "PVB",
        source: "A. van Duser, A. Jagota and S. J. Bennison, \"Analysis of Glass/Polyvinyl Butyral Laminates Subjected to Uniform Pressure\", Journal of Engineering Mechanics 125 (1999) 435, doi:10.1061/(ASCE)0733-9399(1999)125:4(435); it gives the shear moduli of the table \"PVB\" in the Engineering Structural Glass Design Guide (National Council of Structural Engineers Associations)",
        notes: "Plasticised polyvinyl butyral, the interlayer of laminated glass, by dynamic tests at small strain: shear relaxation modulus at 20 °C, which shifts with the temperature by WLF constants 20.7 and 91.1 K; any `temperature` may be asked for. The times it was observed at are taken to be those of its series. Poisson ratio 0.49, taken as constant: against 0.5 the modulus of the contact changes by 2 %.",
        measured_window_s: Some((PVB[0].1, PVB[PVB.len() - 1].1)),
        build: pvb,
    },
    LibraryEntry {
        name: "rubber",
        title: "natural rubber",
        source: "L. A. Wood, \"Modulus of Natural Rubber Cross-Linked by Dicumyl Peroxide. II. Comparison With Theory\", Journal of Research of the National Bureau of Standards 77A (1973) 171, equation G = 5.925e-3 (fp - 0.45) T + 0.0684 (fp - 0.45) + 2.70 of its abstract (Mdyn/cm2, K, parts of decomposed peroxide per hundred of rubber)",
        notes: "Elastic: natural rubber cross-linked by 2 parts of dicumyl peroxide per hundred, 25 °C, unfilled: shear modulus 0.554 MPa by that equation, 1.66 MPa in tension; Poisson ratio 0.5.",
        measured_window_s: None,
        build: rubber,
    },
    LibraryEntry {
        name: "steel",
        title: "steel",
        source: "EN 1993-1-1:2005, Eurocode 3: design of steel structures, part 1-1: general rules and rules for buildings, section 3.2.6",
        notes: "Elastic: 210 GPa, Poisson ratio 0.3.",
        measured_window_s: None,
        build: || elastic(210e9, 0.3),
    },
];

/// Incompressible, of the shear modulus of the equation; 1 Mdyn/cm2 is 1e5 Pa.
fn rubber() -> Result<Material, MaterialError> {
    let (peroxide, temperature_k) = (2.0, 298.15);
    let beyond_gel = peroxide - 0.45;
    let shear = 5.925e-3 * beyond_gel * temperature_k + 0.0684 * beyond_gel + 2.70;
    elastic(3.0 * shear * 1e5, 0.5)
}

/// Shares of the instantaneous shear modulus, and relaxation times (s) at 20 °C.
const PVB: [(f64, f64); 11] = [
    (0.1606, 3.2557e-11),
    (0.078_777, 4.9491e-9),
    (0.2912, 7.2427e-8),
    (0.071_155, 9.8635e-6),
    (0.2688, 2.8059e-3),
    (0.089_586, 1.6441e-1),
    (0.030_183, 2.2648),
    (0.007_605_6, 3.5364e1),
    (0.000_963_4, 9.3675e3),
    (0.000_405_9, 6.4141e5),
    (0.000_614_3, 4.1347e7),
];

fn pvb() -> Result<Material, MaterialError> {
    const INSTANTANEOUS_PA: f64 = 0.471e9;
    let shares: f64 = PVB.iter().map(|(share, _)| share).sum();
    let equilibrium_pa = (1.0 - shares) * INSTANTANEOUS_PA;
    let branches = PVB.map(|(share, time_s)| (share * INSTANTANEOUS_PA, time_s));
    let mut material = prony(ModulusKind::Shear, 0.49, equilibrium_pa, &branches)?;
    material.origin.temperature_k = Some(293.15);
    material.origin.shift = Some(Wlf {
        reference_temperature_k: 293.15,
        c1: 20.7,
        c2_k: 91.1,
        c1_error: 0.0,
        c2_error_k: 0.0,
    });
    Ok(material)
}

/// A material of these moduli (Pa) and times (s).
fn prony(
    kind: ModulusKind,
    poisson_ratio: f64,
    equilibrium_pa: f64,
    branches: &[(f64, f64)],
) -> Result<Material, MaterialError> {
    let branches = branches.iter();
    let branches = branches.map(|&(modulus_pa, time_s)| RelaxationBranch { modulus_pa, time_s });
    let relaxation = Relaxation::new(equilibrium_pa, branches.collect())?;
    Material::from_relaxation(relaxation, kind, poisson_ratio)
}

/// An elastic body of this Young's modulus.
pub fn elastic(modulus_pa: f64, poisson_ratio: f64) -> Result<Material, MaterialError> {
    prony(ModulusKind::Longitudinal, poisson_ratio, modulus_pa, &[])
}

/// The entry of that name, whatever the case and surrounding blanks.
pub fn find(name: &str) -> Option<&'static LibraryEntry> {
    let wanted = name.trim();
    entries()
        .iter()
        .find(|entry| entry.name.eq_ignore_ascii_case(wanted))
}

/// The names of all entries, in a sentence.
pub fn names() -> String {
    let names: Vec<&str> = entries().iter().map(|entry| entry.name).collect();
    names.join(", ")
}

/// The name nearest to one that [`find`] does not know, if it looks like a slip of the pen.
pub fn suggest(name: &str) -> Option<&'static str> {
    let wanted = name.trim().to_lowercase();
    entries()
        .iter()
        .map(|entry| (strsim::damerau_levenshtein(entry.name, &wanted), entry.name))
        .min()
        // In a short name one letter makes another polymer: PVC is no slip for PVB.
        .filter(|(distance, known)| 3 * distance < known.chars().count())
        .map(|(_, known)| known)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::LossPeak;
    use approx::assert_relative_eq;

    #[test]
    fn every_entry_builds_and_is_found_by_its_own_name() {
        for entry in entries() {
            assert_eq!(entry.material().unwrap().name(), Some(entry.title));
            assert!(entry.material().unwrap().contact_compliance().is_ok());
            let window_s = entry.material().unwrap().origin.measured_window_s;
            assert!(window_s.is_none_or(|(first_s, last_s)| 0.0 < first_s && first_s < last_s));
            assert_eq!(find(&entry.name.to_uppercase()).unwrap().name, entry.name);
            assert_eq!(entry.name, entry.name.to_lowercase());
        }
    }

    #[test]
    fn a_slip_of_the_pen_gets_a_suggestion_and_another_word_does_not() {
        assert!(find("pmam").is_none());
        assert_eq!(suggest("pmam"), Some("pmma"));
        assert_eq!(suggest(" PMA "), Some("pmma"));
        assert_eq!(suggest("copper"), None);
        assert_eq!(suggest("pvc"), None);
        assert_eq!(suggest(""), None);
    }

    #[test]
    fn pmma_has_the_published_relaxation_modulus() {
        let material = find("pmma").unwrap().material().unwrap();
        let relaxation = material.relaxation().unwrap();
        // Six digits, as printed in tables of the series.
        assert_relative_eq!(relaxation.modulus(0.0), 2491.44e6, max_relative = 2e-6);
        assert_relative_eq!(relaxation.modulus(1000.0), 1973.05e6, max_relative = 3e-6);
    }

    #[test]
    fn pvb_has_the_shear_moduli_of_the_design_guide() {
        // Table "PVB" of the Engineering Structural Glass Design Guide, MPa, to the digits it prints; as the package structuralglass
        // 0.0.3 gives it. From a day on the table repeats itself here and there, and is not the series any more.
        let pvb = find("pvb").unwrap().material().unwrap();
        let (series, law) = (
            pvb.relaxation().unwrap(),
            pvb.origin.shift.as_ref().unwrap(),
        );
        let temperatures_c = [20.0, 30.0, 40.0, 50.0];
        let table = [
            (3.0, [8.06, 0.971, 0.610, 0.440]),
            (60.0, [1.64, 0.753, 0.455, 0.290]),
            (3600.0, [0.840, 0.441, 0.234, 0.052]),
        ];
        for (time_s, row_mpa) in table {
            for (celsius, modulus_mpa) in temperatures_c.iter().zip(row_mpa) {
                let a_t = 10_f64.powf(law.log10_a_t(celsius + 273.15).unwrap());
                let found = series.modulus(time_s / a_t) / 1e6;
                // One in the third digit after the point, and in the fourth of all.
                assert!(
                    (found - modulus_mpa).abs() < 1e-3 + 4e-4 * modulus_mpa,
                    "{found} {modulus_mpa}"
                );
            }
        }
    }

    #[test]
    fn liver_has_the_complex_modulus_of_its_elements() {
        let liver = find("liver").unwrap().material().unwrap();
        let omega = TAU * 50.0;
        let dashpot = num_complex::Complex::new(0.0, omega * 7.3);
        let expected = 1160.0 + dashpot * 1970.0 / (dashpot + 1970.0);
        let found = liver.shear_complex_modulus(omega);
        assert!((found - expected).norm() < 1e-12 * expected.norm());
    }

    #[test]
    fn pmma_has_the_creep_function_of_the_paper() {
        let material = find("pmma").unwrap().material().unwrap();
        let phi = material.shear_creep_function().unwrap();
        let per_mpa = |compliance_per_pa: f64| compliance_per_pa * 1e6;
        let equilibrium = per_mpa(phi.equilibrium_compliance().unwrap());
        let [fast, slow] = phi.branches() else {
            panic!("two retardation times")
        };
        // Sixty-digit arithmetic (mpmath); here a dozen roundings.
        assert_relative_eq!(
            equilibrium,
            0.000_699_442_473_390_775_5,
            max_relative = 1e-14
        );
        assert_relative_eq!(
            per_mpa(fast.compliance_per_pa),
            6.174_206_011_876_47e-5,
            max_relative = 1e-14
        );
        assert_relative_eq!(
            per_mpa(slow.compliance_per_pa),
            8.380_360_472_909_171e-5,
            max_relative = 1e-14
        );
        assert_relative_eq!(fast.time_s, 9.936_295_903_145_377, max_relative = 1e-15);
        assert_relative_eq!(slow.time_s, 133.870_487_456_205_86, max_relative = 1e-15);
        // Equation (10) of the paper, to the digits it prints:
        // Phi = 7e-4 - 6.17e-5 exp(-0.1 t) - 8.38e-5 exp(-7.47e-3 t) per MPa.
        assert_eq!(format!("{equilibrium:.0e}"), "7e-4");
        assert_eq!(
            format!("{:.2e}", per_mpa(fast.compliance_per_pa)),
            "6.17e-5"
        );
        assert_eq!(format!("{:.0e}", 1.0 / fast.time_s), "1e-1");
        assert_eq!(
            format!("{:.2e}", per_mpa(slow.compliance_per_pa)),
            "8.38e-5"
        );
        assert_eq!(format!("{:.2e}", 1.0 / slow.time_s), "7.47e-3");
    }

    #[test]
    fn pmma_loses_most_at_the_known_frequencies() {
        let material = find("pmma").unwrap().material().unwrap();
        let peaks = material.loss_peaks(ModulusKind::Longitudinal).unwrap();
        let assert_peaks = |found: &[LossPeak], expected: &[(f64, f64)], digits: f64| {
            assert_eq!(found.len(), expected.len());
            for (peak, (omega, value)) in found.iter().zip(expected) {
                // Half a unit in the last printed digit.
                assert_relative_eq!(
                    peak.angular_frequency_rad_per_s,
                    *omega,
                    max_relative = 7e-4
                );
                assert_relative_eq!(peak.value, *value, max_relative = digits);
            }
        };
        assert_peaks(
            &peaks.loss_modulus,
            &[(0.01009, 152.63e6), (0.0926, 149.06e6)],
            4e-5,
        );
        assert_peaks(
            &peaks.loss_compliance,
            &[(0.00844, 3.3865e-11), (0.0765, 2.743e-11)],
            2e-4,
        );
        let highest = peaks
            .loss_tangent
            .iter()
            .max_by(|left, right| left.value.total_cmp(&right.value))
            .unwrap();
        assert_peaks(&[*highest], &[(0.00921, 0.0719)], 7e-4);
    }
}
