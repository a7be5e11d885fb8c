//! Several asperities on one rigid body: the lower envelope of paraboloids, each with its own centre, radius and height.

use super::{Domain, Indenter, IndenterError, LENGTH, POSITION, Setting, Value};
use super::{finite_position, positive_length};
use crate::keys;
use crate::quantity::Dimension;
use crate::quantity::key::{Entries, Kind, quantity};
use crate::quantity::rows::{Rows, table};

/// More asperities than this are a height map.
const MOST_ASPERITIES: usize = 10_000;

keys! {
    /// The asperities.
    ASPERITY_LIST = "asperities", Kind::Tables(&ASPERITY, MOST_ASPERITIES, ", or a height map");
    /// Position of the summit along x and y.
    CENTER = "center", Kind::Numbers(quantity(Dimension::Length), Entries::two(POSITION));
    /// Radius of curvature at the summit.
    ASPERITY_RADIUS = "radius", LENGTH;
    /// Height of the summit towards the half-space.
    ASPERITY_HEIGHT = "height", Kind::Number(quantity(Dimension::Length)), or 0.0;
}

static ASPERITY: Rows = table(
    " One asperity.",
    &[&[CENTER, ASPERITY_RADIUS, ASPERITY_HEIGHT]],
);

/// One spherical summit, in small-slope form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Asperity {
    pub center_x_m: f64,
    pub center_y_m: f64,
    /// Radius of curvature.
    pub radius_m: f64,
    /// Height of the summit, positive towards the half-space; only differences count.
    pub height_m: f64,
}

impl Asperity {
    fn distance_squared(&self, x_m: f64, y_m: f64) -> f64 {
        let (dx, dy) = (x_m - self.center_x_m, y_m - self.center_y_m);
        dx * dx + dy * dy
    }
}

/// A rigid body with these asperities: g = min over them of (highest height - height) + r^2 / (2 R).
#[derive(Debug, Clone, PartialEq)]
pub struct Asperities {
    asperities: Vec<Asperity>,
    highest_m: f64,
}

impl Asperities {
    /// A body with these asperities. The highest summit touches first: the gap there is 0.
    ///
    /// # Errors
    /// [`IndenterError`] where there are none, a radius is no length, or a position or height is not finite.
    pub fn new(asperities: Vec<Asperity>) -> Result<Self, IndenterError> {
        for asperity in &asperities {
            positive_length("asperity's radius", asperity.radius_m)?;
            finite_position("asperity's centre", asperity.center_x_m)?;
            finite_position("asperity's centre", asperity.center_y_m)?;
            finite_position("asperity's height", asperity.height_m)?;
        }
        let heights = asperities.iter().map(|a| a.height_m);
        let highest_m = heights
            .reduce(f64::max)
            .ok_or(IndenterError::NoAsperities)?;
        Ok(Self {
            asperities,
            highest_m,
        })
    }

    /// The asperities, as given.
    pub fn asperities(&self) -> &[Asperity] {
        &self.asperities
    }

    /// How far the summit of an asperity lies behind the one that touches first (m).
    fn depth_m(&self, asperity: &Asperity) -> f64 {
        self.highest_m - asperity.height_m
    }

    /// Half widths along x and y of the rectangle that just holds the elastic contact.
    ///
    /// Every asperity alone, carrying all the load, would approach further than the body does; the least of these bounds
    /// the approach, and with it how deep each asperity goes and how wide (Hertz) its contact becomes.
    fn elastic_half_widths_m(&self, load_n: f64, compliance_per_pa: f64) -> (f64, f64) {
        let alone = |a: &Asperity| {
            let contact_m = (0.75 * load_n * a.radius_m * compliance_per_pa).cbrt();
            self.depth_m(a) + contact_m * contact_m / a.radius_m
        };
        let approaches_m = self.asperities.iter().map(alone);
        self.half_widths_under_approach_m(approaches_m.fold(f64::INFINITY, f64::min))
    }
}

impl Indenter for Asperities {
    fn shape(&self) -> &'static str {
        "asperities"
    }

    /// What each asperity alone would have for a contact (Hertz), as deep as it then is.
    fn half_widths_under_approach_m(&self, approach_m: f64) -> (f64, f64) {
        let (mut x_m, mut y_m) = (0.0_f64, 0.0_f64);
        for asperity in self
            .asperities
            .iter()
            .filter(|a| self.depth_m(a) < approach_m)
        {
            let contact_m = (asperity.radius_m * (approach_m - self.depth_m(asperity))).sqrt();
            x_m = x_m.max(asperity.center_x_m.abs() + contact_m);
            y_m = y_m.max(asperity.center_y_m.abs() + contact_m);
        }
        (x_m, y_m)
    }

    fn parameters(&self) -> Vec<Setting> {
        let table = |asperity: &Asperity| {
            let settings = [
                CENTER.setting(vec![asperity.center_x_m, asperity.center_y_m]),
                ASPERITY_RADIUS.setting(asperity.radius_m),
                ASPERITY_HEIGHT.setting(asperity.height_m),
            ];
            settings.into_iter().flatten().collect()
        };
        let tables = self.asperities.iter().map(table).collect();
        vec![Setting::new(ASPERITY_LIST.name, Value::Tables(tables))]
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        let gap =
            |a: &Asperity| self.depth_m(a) + a.distance_squared(x_m, y_m) / (2.0 * a.radius_m);
        let gaps_m = self.asperities.iter().map(gap);
        gaps_m.fold(f64::INFINITY, f64::min)
    }

    fn not_axisymmetric_because(&self) -> String {
        "are not a body of revolution".to_owned()
    }

    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        let (x_m, y_m) = self.elastic_half_widths_m(load_n, compliance_per_pa);
        x_m.max(y_m)
    }

    /// A rectangle of square cells, because each contact is about round.
    fn domain(&self, load_n: f64, compliance_per_pa: f64) -> Domain {
        Domain::around(self.elastic_half_widths_m(load_n, compliance_per_pa))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Sphere;
    use super::*;

    fn asperity(center_x_m: f64, radius_m: f64, height_m: f64) -> Asperity {
        Asperity {
            center_x_m,
            center_y_m: 0.0,
            radius_m,
            height_m,
        }
    }

    #[test]
    fn one_asperity_is_a_sphere_whatever_its_height() {
        let sphere = Sphere::new(0.01).unwrap();
        let one = Asperities::new(vec![asperity(0.0, 0.01, -3e-6)]).unwrap();
        for (x, y) in [(0.0, 0.0), (1e-4, 0.0), (-2e-4, 3e-4)] {
            assert_eq!(one.gap_m(x, y), sphere.gap_m(x, y));
        }
        let (own, its) = (
            one.elastic_half_width_m(10.0, 4e-10),
            sphere.elastic_half_width_m(10.0, 4e-10),
        );
        // a, and sqrt(R a^2 / R).
        assert!((own / its - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_gap_is_the_lower_envelope_and_0_at_the_highest_summit() {
        let pair = vec![asperity(-1e-3, 0.01, 2e-6), asperity(2e-3, 0.03, 5e-6)];
        let pair = Asperities::new(pair).unwrap();
        assert_eq!(pair.gap_m(2e-3, 0.0), 0.0);
        assert!((pair.gap_m(-1e-3, 0.0) - 3e-6).abs() < 1e-20);
        let far_left = pair.gap_m(-2e-3, 0.0);
        assert!((far_left - (3e-6 + 1e-6 / 0.02)).abs() < 1e-18);
    }

    #[test]
    fn an_asperity_too_low_to_touch_does_not_enlarge_the_domain() {
        let touching = vec![asperity(-1e-3, 0.01, 0.0), asperity(1e-3, 0.01, 0.0)];
        let mut with_a_low_one = touching.clone();
        with_a_low_one.push(asperity(9e-3, 0.01, -1.0));
        let half = |list| {
            let body: Asperities = Asperities::new(list).unwrap();
            body.elastic_half_widths_m(1.0, 4e-10)
        };
        let (x_m, y_m) = half(touching.clone());
        assert_eq!(half(with_a_low_one), (x_m, y_m));
        let hertz = Sphere::new(0.01).unwrap().elastic_half_width_m(1.0, 4e-10);
        assert!((x_m - 1e-3 - hertz).abs() < 1e-15 && (y_m - hertz).abs() < 1e-15);
    }

    #[test]
    fn asperities_that_are_none_or_not_finite_are_refused() {
        assert_eq!(
            Asperities::new(Vec::new()),
            Err(IndenterError::NoAsperities)
        );
        for (x, radius, height, what) in [
            (0.0, 0.0, 0.0, "radius"),
            (f64::NAN, 1.0, 0.0, "centre"),
            (0.0, 1.0, f64::INFINITY, "height"),
        ] {
            let refused = Asperities::new(vec![asperity(x, radius, height)]).unwrap_err();
            assert!(refused.to_string().contains(what), "{refused}");
        }
    }
}
