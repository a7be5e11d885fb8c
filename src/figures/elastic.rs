//! What normalised figures are in units of: the elastic contact that the same indenter makes on the body as stiff as it is at
//! once. For a sphere it is that of Hertz, by which S. Spinu, Advances in Tribology 2018, 9432894, normalises.

use crate::drive::Control;
use crate::indenter::Indenter;
use crate::material::{Material, ModulusKind};
use crate::numerics::roots::bisect;
use crate::simulation::scenario::ScenarioPlan;
use crate::sweep::plan::contact::ContactPlan;
use crate::sweep::plan::{SweepPlan, Varied};

/// The elastic contact at the instantaneous compliance, under the mean load (or approach) of a sweep or the largest of a
/// history, and the time scale of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ElasticScale {
    pub load_n: f64,
    pub approach_m: f64,
    pub contact_radius_m: f64,
    /// Instantaneous longitudinal modulus E₀ (Pa).
    pub modulus_pa: f64,
    /// Retardation time (s) of the branch of largest creep compliance; `None` for an elastic body.
    pub time_s: Option<f64>,
}

/// Why there is no such contact.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoScale {
    #[error("the {0} is no convex body of revolution, which the elastic contact is computed for")]
    Shape(&'static str),
    #[error("the body is a layer, on which the elastic contact has no closed form")]
    Layer,
    #[error("each material or indenter of a list has an elastic contact of its own")]
    Several,
    #[error("the mean approach is not above zero, and has no elastic contact")]
    NoContact,
    #[error("the material is evaluated from its samples, and has no branches to take a time from")]
    Samples,
    #[error("the elastic contact cannot be computed: {0}")]
    Material(String),
}

/// Panels of the quadrature of the transformed gap, and halvings of an interval.
const PANELS: usize = 4000;
const HALVINGS: u32 = 200;

impl ElasticScale {
    /// The scale of a sweep: under the mean of its `[drive]`.
    ///
    /// # Errors
    /// [`NoScale`].
    pub fn of_sweep(plan: &SweepPlan) -> Result<Self, NoScale> {
        let mut axes = plan.axes.iter().flat_map(|axes| &axes.over);
        if axes.any(Varied::is_whole) {
            return Err(NoScale::Several);
        }
        let contact = &plan.base.contact;
        Self::new(
            contact,
            &contact.material,
            plan.base.drive.control(),
            plan.base.drive.mean(),
        )
    }

    /// The scale of a history: under the largest value of its drive.
    ///
    /// # Errors
    /// [`NoScale`].
    pub fn of_scenario(plan: &ScenarioPlan) -> Result<Self, NoScale> {
        let material = plan.contact.material.series().ok_or(NoScale::Samples)?;
        let largest = plan.drive.maximum() + plan.drive.pull_off_n();
        Self::new(&plan.contact, material, plan.drive.control(), largest)
    }

    /// That of any contact under this load (N) or approach (m).
    fn new<M>(
        of: &ContactPlan<M>,
        material: &Material,
        control: Control,
        value: f64,
    ) -> Result<Self, NoScale> {
        if of.layer.is_some() {
            return Err(NoScale::Layer);
        }
        let failed = |error: crate::material::MaterialError| NoScale::Material(error.to_string());
        let compliance = material.contact_compliance().map_err(failed)?;
        let longitudinal = material
            .creep_as(ModulusKind::Longitudinal)
            .map_err(failed)?;
        let compliance_per_pa = compliance.instantaneous_compliance();
        let (load_n, approach_m, contact_radius_m) =
            contact(of.indenter.as_ref(), control, value, compliance_per_pa)?;
        let branches = compliance.branches().iter();
        let largest = branches.max_by(|a, b| a.compliance_per_pa.total_cmp(&b.compliance_per_pa));
        Ok(Self {
            load_n,
            approach_m,
            contact_radius_m,
            modulus_pa: longitudinal.instantaneous_compliance().recip(),
            time_s: largest.map(|branch| branch.time_s),
        })
    }

    /// Energy (J): W₀ δ₀.
    pub fn energy_j(&self) -> f64 {
        self.load_n * self.approach_m
    }

    /// Pressure (Pa): 3 W₀ / (2 π a₀²), the peak pressure of Hertz for a sphere.
    pub fn pressure_pa(&self) -> f64 {
        1.5 * self.load_n / (std::f64::consts::PI * self.contact_radius_m.powi(2))
    }
}

/// Load (N), approach (m) and radius (m) of the elastic contact where one of the first two is given, by the method of
/// dimensionality reduction: delta = G(a), W = (2/C) times the integral from 0 to a of delta - G(x).
fn contact(
    indenter: &dyn Indenter,
    control: Control,
    value: f64,
    compliance_per_pa: f64,
) -> Result<(f64, f64, f64), NoScale> {
    let body = indenter.axisymmetric();
    let body = body.ok_or_else(|| NoScale::Shape(indenter.shape()))?;
    if value <= 0.0 {
        return Err(NoScale::NoContact);
    }
    let gap = |x_m: f64| body.transformed_gap_m(x_m);
    let integral = |radius_m: f64| {
        let width_m = radius_m / PANELS as f64;
        let middles = (0..PANELS).map(|k| gap((k as f64 + 0.5) * width_m));
        width_m * middles.sum::<f64>()
    };
    match control {
        Control::Load => {
            let radius_m = indenter.elastic_half_width_m(value, compliance_per_pa);
            // Where the radius is right the approach does not change with it: an error of it enters squared.
            let approach_m = (0.5 * value * compliance_per_pa + integral(radius_m)) / radius_m;
            Ok((value, approach_m, radius_m))
        }
        Control::Approach => {
            let limit_m = body.contact_limit_m().unwrap_or(f64::INFINITY);
            let mut high_m = value.min(limit_m);
            while high_m < limit_m && gap(high_m) < value {
                high_m = (2.0 * high_m).min(limit_m);
            }
            let (radius_m, _) = bisect(0.0, high_m, HALVINGS, |r_m| gap(r_m) < value);
            let load_n = 2.0 / compliance_per_pa * (value * radius_m - integral(radius_m));
            Ok((load_n, value, radius_m))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::indenter::{Asperities, Asperity, Cone, FlatPunch, Sphere};
    use crate::reference::elastic::Hertz;

    const COMPLIANCE: f64 = 3e-10;

    #[test]
    fn a_sphere_gives_the_contact_of_hertz_from_load_and_from_approach() {
        let sphere = Sphere::new(10e-3).unwrap();
        let hertz = Hertz {
            radius_m: 10e-3,
            load_n: 10.0,
            compliance_per_pa: COMPLIANCE,
        };
        let (delta, a) = (hertz.approach_m(), hertz.contact_radius_m());
        for (control, value) in [(Control::Load, 10.0), (Control::Approach, delta)] {
            let found = contact(&sphere, control, value, COMPLIANCE).unwrap();
            // Midpoints on a parabola: an error of 1/(4 PANELS^2) of the integral.
            for (found, exact) in [(found.0, 10.0), (found.1, delta), (found.2, a)] {
                assert!((found / exact - 1.0).abs() < 1e-7, "{found} {exact}");
            }
            let scale = ElasticScale {
                load_n: found.0,
                approach_m: found.1,
                contact_radius_m: found.2,
                modulus_pa: 1.0,
                time_s: None,
            };
            assert!((scale.pressure_pa() / hertz.peak_pressure_pa() - 1.0).abs() < 1e-7);
        }
    }

    #[test]
    fn a_punch_and_a_cone_give_theirs_and_what_is_no_body_of_revolution_none() {
        let punch = FlatPunch::new(1e-3).unwrap();
        let (_, delta, a) = contact(&punch, Control::Load, 10.0, COMPLIANCE).unwrap();
        assert!((delta / (0.5 * 10.0 * COMPLIANCE / 1e-3) - 1.0).abs() < 1e-12 && a == 1e-3);
        let (load, _, _) = contact(&punch, Control::Approach, delta, COMPLIANCE).unwrap();
        assert!((load / 10.0 - 1.0).abs() < 1e-9);
        // Sneddon: W = 2 tan(alpha) delta^2 / (pi C), delta = (pi/2) a cot(alpha).
        let angle = 70_f64.to_radians();
        let cone = Cone::new(angle).unwrap();
        let (load, delta, a) = contact(&cone, Control::Approach, 1e-6, COMPLIANCE).unwrap();
        let pi = std::f64::consts::PI;
        assert!(
            (load / (2.0 * angle.tan() * delta * delta / (pi * COMPLIANCE)) - 1.0).abs() < 1e-9
        );
        assert!((a / (2.0 * delta * angle.tan() / pi) - 1.0).abs() < 1e-9);
        let asperity = Asperity {
            center_x_m: 0.0,
            center_y_m: 0.0,
            radius_m: 1e-3,
            height_m: 0.0,
        };
        let two = Asperities::new(vec![asperity; 2]).unwrap();
        let refused = contact(&two, Control::Load, 1.0, COMPLIANCE);
        assert_eq!(refused, Err(NoScale::Shape("asperities")));
        let refused = contact(&cone, Control::Approach, 0.0, COMPLIANCE);
        assert_eq!(refused, Err(NoScale::NoContact));
    }
}
