//! Setup files: what is known of the instrument and of the contact of measured loops.

use std::sync::Arc;

use super::diagnostic::Diagnostics;
use super::document::reader::TableReader;
use super::document::{Document, block};
use super::indenter_block;
use super::keys::setup::{
    CONTACT, ContactKeys, INSTRUMENT, RadiusFrom, SETUP_INDENTER, SETUP_TITLE,
};
use crate::indenter::Indenter;
use crate::measured::moduli::{Contact, Radius};
use crate::measured::{Corrections, Options};

/// What a setup file says.
#[derive(Debug, Clone, Default)]
pub struct Setup {
    pub title: Option<String>,
    /// Without a frequency.
    pub options: Options,
}

/// The setup in a file.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn setup(document: &Document) -> Result<Setup, Diagnostics> {
    document.read_whole(|root| {
        let title = root.value(&SETUP_TITLE);
        let corrections = root.table_or(&INSTRUMENT, Corrections::default(), |t| {
            block::read(t, None)
        });
        let indenter_at = root.key_location(&SETUP_INDENTER);
        let indenter = root.table_or(&SETUP_INDENTER, None, |table| {
            indenter_block::read(table).map(Some)
        });
        if let (Some(place), false) = (&indenter_at, root.has(&CONTACT)) {
            root.problems()
                .at(place, "an indenter without a table `[contact]`")
                .because("asks for moduli")
                .help(
                    "add `[contact]` with the Poisson ratio of the specimen: poisson_ratio = 0.4",
                );
        }
        let indenter_material = indenter_block::material(root);
        let contact = root.table_or(&CONTACT, None, |table| {
            contact(table, indenter.clone().flatten(), indenter_at.is_some()).map(Some)
        });
        // An indenter that was refused has been reported.
        indenter?;
        Some(Setup {
            title: title?,
            options: Options {
                frequency_hz: None,
                corrections: corrections?,
                contact: contact?
                    .zip(indenter_material)
                    .map(|(contact, body)| Contact {
                        indenter_material: body.map(|body| body.value),
                        ..contact
                    }),
            },
        })
    })
}

fn contact(
    mut table: TableReader<'_>,
    indenter: Option<Arc<dyn Indenter>>,
    has_indenter: bool,
) -> Option<Contact> {
    let (table_place, problems) = (table.as_ref().clone(), table.problems());
    let keys = block::read_from::<ContactKeys>(&mut table, None);
    let places = ["radius", "area_function"].map(|key| table.value_place(key));
    table.finish();
    let keys = keys?;
    let [from_place, terms_place] = places.map(|place| place.unwrap_or(table_place.clone()));
    let radius = match (keys.radius, keys.area_function) {
        (RadiusFrom::AreaFunction, Some(coefficients)) => Radius::AreaFunction {
            coefficients,
            epsilon: keys.epsilon,
        },
        (RadiusFrom::AreaFunction, None) => {
            problems
                .at(&from_place, "an area function without its coefficients")
                .help("add them: area_function = [24.5, 1e-7]");
            return None;
        }
        (_, Some(_)) => {
            problems
                .at(&terms_place, "an area function that is not used")
                .help("write radius = \"area-function\", or remove `area_function`");
            return None;
        }
        (RadiusFrom::Column, None) => Radius::Column,
        (RadiusFrom::Geometry, None) => Radius::Geometry,
    };
    let is_of_revolution = indenter
        .as_ref()
        .is_some_and(|i| i.axisymmetric().is_some());
    if radius == Radius::Geometry && !(has_indenter && (indenter.is_none() || is_of_revolution)) {
        let report = match &indenter {
            None => problems.at(
                &table_place,
                "no contact radius: the setup has no `[indenter]`",
            ),
            Some(shape) => {
                let because = shape.not_axisymmetric_because();
                problems
                    .at(&table_place, "no contact radius from this shape")
                    .because(format!("the {} {because}", shape.shape()))
            }
        };
        report.help("add `[indenter]` with a body of revolution, or write radius = \"column\" or radius = \"area-function\"");
        return None;
    }
    Some(Contact {
        poisson_ratio: keys.poisson_ratio,
        radius,
        indenter,
        indenter_material: None,
        bias: keys.bias,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: &str = r#"
title = "nano-DMA"
[instrument]
frame_compliance = "0.2 um/N"
mass = "150 mg"
damping = "0.02 N s/m"
stiffness = "150 N/m"
time_lag = "20 us"
thermal_drift = "0.05 nm/s"
approach_at_touch = "3 nm"
response_frequency = ["1 Hz", "100 Hz"]
response_gain = [1.0, 1.1]
response_phase = ["0 rad", "20 mrad"]
[contact]
poisson_ratio = 0.38
radius = "area-function"
area_function = [24.5, 1e-7]
epsilon = 0.72
bias = false
[indenter]
shape = "sphere"
radius = "10 um"
"#;

    fn read(text: &str) -> Result<Setup, String> {
        let document = Document::parse("setup.toml", text).map_err(|e| e.to_string())?;
        setup(&document).map_err(|refused| refused.to_string())
    }

    #[test]
    fn every_key_arrives_in_si_units() {
        let Setup { title, options } = read(WHOLE).unwrap();
        assert_eq!(title.as_deref(), Some("nano-DMA"));
        let expected = Corrections {
            frame_compliance_m_per_n: 2e-7,
            mass_kg: 1.5e-4,
            damping_n_s_per_m: 0.02,
            stiffness_n_per_m: 150.0,
            time_lag_s: 2e-5,
            thermal_drift_m_per_s: 5e-11,
            approach_at_touch_m: 3e-9,
            response_frequency_hz: vec![1.0, 100.0],
            response_gain: vec![1.0, 1.1],
            response_phase_rad: vec![0.0, 0.02],
        };
        let found = options.corrections;
        let pairs = [
            (
                found.frame_compliance_m_per_n,
                expected.frame_compliance_m_per_n,
            ),
            (found.mass_kg, expected.mass_kg),
            (found.damping_n_s_per_m, expected.damping_n_s_per_m),
            (found.stiffness_n_per_m, expected.stiffness_n_per_m),
            (found.time_lag_s, expected.time_lag_s),
            (found.thermal_drift_m_per_s, expected.thermal_drift_m_per_s),
            (found.approach_at_touch_m, expected.approach_at_touch_m),
        ];
        for (found, expected) in pairs {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
        assert_eq!(found.response_frequency_hz, expected.response_frequency_hz);
        assert_eq!(found.response_gain, expected.response_gain);
        assert_eq!(found.response_phase_rad, expected.response_phase_rad);
        let contact = options.contact.unwrap();
        assert_eq!((contact.poisson_ratio, contact.bias), (0.38, false));
        let area = Radius::AreaFunction {
            coefficients: vec![24.5, 1e-7],
            epsilon: 0.72,
        };
        assert_eq!(contact.radius, area);
        assert_eq!(contact.indenter.unwrap().shape(), "sphere");
        assert!(read("").unwrap().options.contact.is_none());
    }

    #[test]
    fn an_indenter_may_be_made_of_something() {
        let text = format!("{WHOLE}[indenter.material]\nlibrary = \"steel\"\n");
        let contact = read(&text).unwrap().options.contact.unwrap();
        let steel = contact.indenter_material.unwrap();
        assert!(steel.contact_complex_modulus(1.0).re > 1e11);
        assert!(
            read(WHOLE)
                .unwrap()
                .options
                .contact
                .unwrap()
                .indenter_material
                .is_none()
        );
    }

    #[test]
    fn what_is_missing_or_does_not_go_together_is_told_at_its_place() {
        let sphere = "[indenter]\nshape = \"sphere\"\nradius = \"1 mm\"\n";
        for (text, reason) in [
            (sphere.to_owned(), "an indenter without a table `[contact]`"),
            ("[contact]\npoisson_ratio = 0.4\n".to_owned(), "the setup has no `[indenter]`"),
            (format!("[contact]\n{sphere}"), "poisson_ratio"),
            (
                "[contact]\npoisson_ratio = 0.4\nradius = \"area-function\"\n".to_owned(),
                "without its coefficients",
            ),
            (
                format!("[contact]\npoisson_ratio = 0.4\narea_function = [1.0]\n{sphere}"),
                "that is not used",
            ),
            ("[instrument]\nmass = \"1 mm\"\n".to_owned(), "a mass is expected"),
            ("[instrument]\nmas = \"1 mg\"\n".to_owned(), "did you mean `mass`"),
            (
                "[contact]\npoisson_ratio = 0.4\n[indenter]\nshape = \"ellipsoid\"\nradius_x = 1\nradius_y = 2\n"
                    .to_owned(),
                "no contact radius from this shape",
            ),
        ] {
            let refused = read(&text).unwrap_err();
            let words = refused.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(words.contains(reason), "{text}\n{refused}");
            assert!(words.contains("setup.toml:"), "{refused}");
        }
    }
}
