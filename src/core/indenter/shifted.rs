//! An indenter moved sideways: the same shape about another point of the surface.

use std::sync::Arc;

use super::{Domain, Indenter, IndenterError, POSITION, Rim, Setting, finite_position};
use crate::keys;
use crate::quantity::Dimension;
use crate::quantity::key::{Entries, Kind, quantity};

keys! {
    /// Moves the indenter along x and y.
    OFFSET = "offset", Kind::Numbers(quantity(Dimension::Length), Entries::two(POSITION)), optional;
}

/// An indenter whose own origin lies at an offset.
///
/// On a uniform half-space only the fields move with it. The half-space engine keeps its domain centred on the origin and
/// widens it to hold the contact; an offset of whole cells then moves the fields by whole cells, any other one also places
/// the cells differently under the shape. The axisymmetric engine works about the indenter's own axis and sees no offset.
#[derive(Debug, Clone)]
pub struct Shifted {
    inner: Arc<dyn Indenter>,
    offset_x_m: f64,
    offset_y_m: f64,
}

/// Share of a cell up to which an offset beyond whole cells is rounding.
const WHOLE_CELL_TOLERANCE: f64 = 1e-6;

impl Shifted {
    /// This indenter, moved by these offsets (m).
    ///
    /// # Errors
    /// [`IndenterError::Position`] where an offset is not finite.
    pub fn new(
        inner: Arc<dyn Indenter>,
        offset_x_m: f64,
        offset_y_m: f64,
    ) -> Result<Self, IndenterError> {
        Ok(Self {
            inner,
            offset_x_m: finite_position("offset", offset_x_m)?,
            offset_y_m: finite_position("offset", offset_y_m)?,
        })
    }
}

/// Cells by which a grid grows so that a shape moved by this offset stays on it; even, so that cells stay over cells.
fn more_cells(offset_m: f64, spacing_m: f64) -> usize {
    // A cast of a float that is too large saturates, and the grid is then refused for its size.
    let cells = (offset_m.abs() / spacing_m - WHOLE_CELL_TOLERANCE).ceil();
    (cells.max(0.0) as usize).saturating_mul(2)
}

impl Indenter for Shifted {
    fn shape(&self) -> &'static str {
        self.inner.shape()
    }

    fn parameters(&self) -> Vec<Setting> {
        let mut parameters = self.inner.parameters();
        parameters.extend(OFFSET.setting(vec![self.offset_x_m, self.offset_y_m]));
        parameters
    }

    fn gap_m(&self, x_m: f64, y_m: f64) -> f64 {
        self.inner
            .gap_m(x_m - self.offset_x_m, y_m - self.offset_y_m)
    }

    fn made_of(&self) -> Option<&dyn Indenter> {
        Some(&*self.inner)
    }

    fn rim(&self) -> Option<Rim> {
        let rim = self.inner.rim()?;
        Some(Rim {
            center_x_m: rim.center_x_m + self.offset_x_m,
            center_y_m: rim.center_y_m + self.offset_y_m,
            ..rim
        })
    }

    fn elastic_half_width_m(&self, load_n: f64, compliance_per_pa: f64) -> f64 {
        self.inner.elastic_half_width_m(load_n, compliance_per_pa)
    }

    fn domain(&self, load_n: f64, compliance_per_pa: f64) -> Domain {
        let (x_m, y_m) = (self.offset_x_m.abs(), self.offset_y_m.abs());
        let wider = |(half_x_m, half_y_m)| (half_x_m + x_m, half_y_m + y_m);
        match self.inner.domain(load_n, compliance_per_pa) {
            Domain::Around {
                half_widths_m,
                cell_aspect_ratio,
                limit_m,
            } => Domain::Around {
                half_widths_m: wider(half_widths_m),
                cell_aspect_ratio,
                limit_m: limit_m.map(wider),
            },
            period @ Domain::Cells { .. } if self.inner.is_periodic() => period,
            Domain::Cells { cells, spacing_m } => Domain::Cells {
                cells: (
                    cells.0.saturating_add(more_cells(x_m, spacing_m.0)),
                    cells.1.saturating_add(more_cells(y_m, spacing_m.1)),
                ),
                spacing_m,
            },
        }
    }

    fn half_widths_under_approach_m(&self, approach_m: f64) -> (f64, f64) {
        let (x_m, y_m) = self.inner.half_widths_under_approach_m(approach_m);
        (x_m + self.offset_x_m.abs(), y_m + self.offset_y_m.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Sphere;
    use super::*;

    #[test]
    fn the_gap_moves_with_the_offset_and_the_domain_holds_it() {
        let sphere = Arc::new(Sphere::new(0.01).unwrap());
        let shifted = Shifted::new(Arc::clone(&sphere) as _, 2e-4, -1e-4).unwrap();
        assert_eq!(shifted.gap_m(2e-4, -1e-4), 0.0);
        assert_eq!(shifted.gap_m(3e-4, -1e-4), sphere.gap_m(3e-4 - 2e-4, 0.0));
        let contact_m = sphere.elastic_half_width_m(1.0, 4e-10);
        assert_eq!(
            shifted.domain(1.0, 4e-10),
            Domain::Around {
                half_widths_m: (contact_m + 2e-4, contact_m + 1e-4),
                cell_aspect_ratio: 1.0,
                limit_m: None,
            }
        );
        assert!(shifted.axisymmetric().is_some());
        assert!(Shifted::new(sphere, f64::NAN, 0.0).is_err());
    }

    #[test]
    fn a_map_moved_by_whole_cells_gets_as_many_more_on_both_sides() {
        assert_eq!(more_cells(0.0, 1e-8), 0);
        // 3e-8 / 1e-8 is not exactly 3.
        assert_eq!(more_cells(-3e-8, 1e-8), 6);
        assert_eq!(more_cells(2.5e-8, 1e-8), 6);
        assert_eq!(more_cells(1e300, 1e-300), usize::MAX);
    }
}
