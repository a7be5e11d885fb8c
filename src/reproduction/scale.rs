//! The paper's normalised units: Hertz contact of a sphere at the reference load and the instantaneous compliance.

use super::{ReproductionError, Result};
use crate::contact::surface::Surface;
use crate::indenter::Indenter;
use crate::material::{Creep, Material};
use crate::reference::elastic::Hertz;

/// What results are divided by.
#[derive(Debug, Clone)]
pub struct Scale {
    pub load_n: f64,
    pub contact_radius_m: f64,
    pub approach_m: f64,
    pub pressure_pa: f64,
    /// Radius of the sphere (m).
    pub sphere_radius_m: f64,
    pub contact_compliance: Creep,
}

/// A point of a profile in normalised units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProfilePoint {
    pub radius: f64,
    /// `None` where the pressure is not bounded.
    pub pressure: Option<f64>,
    pub displacement: f64,
}

impl Scale {
    /// The Hertz contact of this sphere on this body under this load (N).
    pub fn new(material: &Material, indenter: &dyn Indenter, load_n: f64) -> Result<Self> {
        let contact_compliance = material.contact_compliance()?;
        let unfit = || ReproductionError::Unfit("the figures need a sphere".to_owned());
        let body = indenter.axisymmetric().ok_or_else(unfit)?;
        let hertz = Hertz {
            // Of a sphere G(x) = x^2 / R; at an x of 1 m the formula is as good as anywhere.
            radius_m: body.transformed_gap_m(1.0).recip(),
            load_n,
            compliance_per_pa: contact_compliance.instantaneous_compliance(),
        };
        Ok(Self {
            load_n,
            contact_radius_m: hertz.contact_radius_m(),
            approach_m: hertz.approach_m(),
            pressure_pa: hertz.peak_pressure_pa(),
            sphere_radius_m: hertz.radius_m,
            contact_compliance,
        })
    }

    /// Energy (J) in whose units losses are given: W0 delta_H.
    pub fn energy_j(&self) -> f64 {
        self.load_n * self.approach_m
    }

    /// A surface from the axis outwards: along the radius, or over the cells of the row beside the middle.
    pub fn profile(&self, surface: &Surface) -> Vec<ProfilePoint> {
        let point = |r_m: f64, p_pa: Option<f64>, u_m: f64| ProfilePoint {
            radius: r_m / self.contact_radius_m,
            pressure: p_pa.map(|p_pa| p_pa / self.pressure_pa),
            displacement: u_m / self.approach_m,
        };
        match surface {
            Surface::Radial(radial) => {
                let values = radial.pressure_pa.iter().zip(&radial.displacement_m);
                let points = radial.radius_m.iter().zip(values);
                points.map(|(&r, (&p, &u))| point(r, p, u)).collect()
            }
            Surface::Cells(cells) => {
                let grid = &cells.grid;
                let row = grid.cells_y() / 2;
                (grid.cells_x() / 2..grid.cells_x())
                    .map(|ix| {
                        let cell = row * grid.cells_x() + ix;
                        let (x_m, y_m) = grid.center(cell);
                        let values = (cells.pressure_pa[cell], cells.displacement_m[cell]);
                        point(x_m.hypot(y_m), Some(values.0), values.1)
                    })
                    .collect()
            }
        }
    }
}

/// A quantity of a profile at a radius, linear between points; at the axis that of the first point. `None` beyond the profile,
/// and beside a point where the quantity is undefined.
pub fn at(
    profile: &[ProfilePoint],
    radius: f64,
    value: fn(&ProfilePoint) -> Option<f64>,
) -> Option<f64> {
    let next = profile.iter().position(|p| p.radius >= radius)?;
    let outer = profile.get(next)?;
    let Some(inner) = next.checked_sub(1).and_then(|i| profile.get(i)) else {
        return value(outer);
    };
    let share = (radius - inner.radius) / (outer.radius - inner.radius);
    let (from, to) = (value(inner)?, value(outer)?);
    Some(from + share * (to - from))
}

/// The largest of these differences; `None` where there are none, or one is undefined.
pub fn largest(mut differences: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let first = differences.next()??;
    differences.try_fold(first, |largest, next| Some(largest.max(next?)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_undefined_at_a_point_is_undefined_beside_it_and_in_the_largest() {
        let point = |radius: f64, pressure: Option<f64>| ProfilePoint {
            radius,
            pressure,
            displacement: 1.0,
        };
        let profile = [
            point(0.25, Some(3.0)),
            point(0.5, Some(1.0)),
            point(0.75, None),
        ];
        let pressure = |radius: f64| at(&profile, radius, |p| p.pressure);
        assert_eq!(
            [0.0, 0.375, 0.625, 1.0].map(pressure),
            [Some(3.0), Some(2.0), None, None]
        );
        assert_eq!(at(&profile, 0.625, |p| Some(p.displacement)), Some(1.0));
        assert_eq!(largest(profile[..2].iter().map(|p| p.pressure)), Some(3.0));
        assert_eq!(largest(profile.iter().map(|p| p.pressure)), None);
        assert_eq!(largest(std::iter::empty()), None);
    }
}
