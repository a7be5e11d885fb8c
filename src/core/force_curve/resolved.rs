//! What an identification file says of force curves: its keys, and the same with every default written out.

use std::ops::Bound;

use super::fit::CurvePlan;
use super::record::ForceCurve;
use crate::identify::SoughtAttraction;
use crate::identify::resolved::{ATTRACTION, IDENTIFY_BRANCHES, LAW, SAMPLES, branches_setting};
use crate::indenter::Indenter;
use crate::measured::response::ChannelResponse;
use crate::quantity::Dimension;
use crate::quantity::block::{Block as _, Conflict};
use crate::quantity::key::{Entries, Kind, Limits, number, quantity};
use crate::quantity::setting::{Table, document};
use crate::sweep::plan::resolved::{compressibility, indenter_material_text};
use crate::{block_with_defaults, keys};

const CURVES: Entries = Entries::of(1..=100_000, "name at least one file of force curves");

/// Most branches of a series where the curve is to choose.
pub const MOST_CHOSEN: usize = 4;

keys! {
    /// A force curve: a table with `time_s`, `force_n` and `indentation_m`, or with `piezo_m` and `deflection_m` or `force_n`; several
    /// curves where it has a column `curve`. Or a list of such files. Where the contact begins is found.
    CURVE = "curve", Kind::Texts(CURVES);
}

const UNCERTAINTY: Limits = Limits::new(Bound::Included(0.0), Bound::Included(0.5));

impl Probe {
    fn in_conflict(&self) -> Option<Conflict> {
        self.response().in_conflict()
    }

    /// What the channel of the motion does beside that of the force.
    pub(super) fn response(&self) -> ChannelResponse<'_> {
        ChannelResponse {
            time_lag_s: self.time_lag_s,
            frequency_hz: &self.response_frequency_hz,
            gain: &self.response_gain,
            phase_rad: &self.response_phase_rad,
        }
    }

    /// The drag at this height (m) above the surface, as a part of that at the surface.
    pub(super) fn drag_at(&self, height_m: f64) -> f64 {
        self.drag_height_m
            .map_or(1.0, |scale_m| 1.0 / (1.0 + height_m.max(0.0) / scale_m))
    }

    /// The relative standard deviation (1) that its uncertainties give to all forces; the force of a sphere goes with the root of its radius,
    /// that of a flat punch with it.
    pub fn scale_uncertainty(&self, indenter: &dyn Indenter) -> f64 {
        let power = if indenter.shape() == "sphere" {
            0.5
        } else {
            1.0
        };
        self.spring_constant_uncertainty
            .hypot(power * self.radius_uncertainty)
    }
}

block_with_defaults! {
    /// What is known of the instrument of force curves.
    pub struct Probe in "instrument" unless in_conflict {
        /// Spring constant of a cantilever: the force over its deflection.
        spring_constant_n_per_m: Option<f64> = None => "spring_constant", Kind::Number(quantity(Dimension::Stiffness).above_zero());
        /// Deflection of a cantilever over the signal of its detector, of curves whose deflection is in volts.
        sensitivity_m_per_v: Option<f64> = None => "sensitivity", Kind::Number(quantity(Dimension::Sensitivity).above_zero());
        /// Compliance of frame and mount, which the indentation is less by.
        frame_compliance_m_per_n: f64 = 0.0 => "frame_compliance", Kind::Number(quantity(Dimension::FrameCompliance).not_negative());
        /// Drag on the probe while it moves, where it is known; otherwise it is found, of curves that have a part before contact.
        drag_n_s_per_m: Option<f64> = None => "drag", Kind::Number(quantity(Dimension::Damping).not_negative());
        /// Height above the surface over which the drag falls to a half, as `drag / (1 + height / drag_height)` (J. Alcaraz et al., Langmuir
        /// 18 (2002) 716); left out: it does not change.
        drag_height_m: Option<f64> = None => "drag_height", Kind::Number(quantity(Dimension::Length).above_zero());
        /// Delay of the channel of the piezo, or of an indentation without one, relative to that of the force; negative if it is earlier.
        time_lag_s: f64 = 0.0 => "time_lag", Kind::Number(quantity(Dimension::Time));
        /// Frequencies at which gain and phase of that channel were measured against a stiff specimen or another sensor, ascending. Between them both
        /// are linear in the logarithm of the frequency, outside they are those at the ends; but the phase of slower motion is that of a delay,
        /// proportional to the frequency.
        response_frequency_hz: Vec<f64> = Vec::new() => "response_frequency", Kind::Numbers(quantity(Dimension::Frequency).above_zero(), Entries::ANY);
        /// Gain of that channel over that of the force at these frequencies.
        response_gain: Vec<f64> = Vec::new() => "response_gain", Kind::Numbers(number("1.02").above_zero(), Entries::ANY);
        /// Phase by which that channel is behind the channel of the force at these frequencies.
        response_phase_rad: Vec<f64> = Vec::new() => "response_phase", Kind::Numbers(quantity(Dimension::Angle), Entries::ANY);
        /// Relative standard uncertainty of the spring constant, which all curves have in common: 0.05 for 5 %.
        spring_constant_uncertainty: f64 = 0.0 => "spring_constant_uncertainty", Kind::Number(number("0.05").within(UNCERTAINTY));
        /// Relative standard uncertainty of the radius of a sphere or a flat punch.
        radius_uncertainty: f64 = 0.0 => "radius_uncertainty", Kind::Number(number("0.02").within(UNCERTAINTY));
    }
}

/// An identification from force curves.
#[derive(Debug, Clone)]
pub struct CurvesPlan {
    pub title: String,
    pub fit: CurvePlan,
    /// Names of laws, as asked for.
    pub laws: Vec<String>,
    /// Branches of a series; `None` lets the curve choose.
    pub branches: Option<usize>,
    /// As the file names them.
    pub files: Vec<String>,
    pub curves: Vec<ForceCurve>,
}

/// The plan as the text of an identification file.
pub fn resolved_text(plan: &CurvesPlan) -> String {
    let known = &plan.fit.contact.material;
    let material = Table::new("material").and(compressibility(&known.compressibility));
    let indenter = known.indenter_material.as_ref().map(indenter_material_text);
    let contact = plan.fit.contact.blocks(indenter);
    let identify = Table::new("identify")
        .and(CURVE.setting(plan.files.clone()))
        .and(LAW.setting(plan.laws.clone()))
        .and(IDENTIFY_BRANCHES.setting(branches_setting(plan.branches)))
        .and(SAMPLES.setting(plan.fit.samples));
    let identify = match plan.fit.attraction {
        SoughtAttraction::Known => identify,
        sought => identify.and(ATTRACTION.setting(sought)),
    };
    let blocks = [
        material.toml(),
        contact.layer,
        contact.indenter,
        contact.adhesion,
        identify.toml(),
        plan.fit.probe.table().toml(),
    ];
    document(&plan.title, blocks)
}
