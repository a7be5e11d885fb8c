//! The columns of `sweep.csv` and of `history.csv`, one row each: what a column is called, what it means, its unit, how its
//! value and its error are found in a record, and whether results are compared by it. Tables, JSON, comparison, pages and the
//! reference in `src/guide/results.md` read them here; a column is added by its row.

use super::table::{Cell, csv};
use crate::cycle::Harmonic;
use crate::measured::Quantity as OfLoop;
use crate::quantity::{Dimension, FrequencyUnit};
use crate::simulation::cycles::{CycleNumbers, HistoryCycle};
use crate::simulation::errors::RowErrors;
use crate::simulation::{HistoryRow, SimulationOutcome};
use crate::sweep::plan::Axes;
use crate::sweep::record::error_bars::Quantity;
use crate::sweep::record::{CaseRecord, CaseResult};

/// A column of a table whose rows are made of `R`.
pub struct Column<R: 'static> {
    /// With the SI unit as its last part; `{}` stands for the number of a branch.
    pub name: &'static str,
    /// What it means, for the reference of columns.
    pub meaning: &'static str,
    value: fn(&R) -> Cell,
    /// In its place, where there is one column for each branch of the creep compliance, counted from 0.
    of_branch: Option<fn(&R, usize) -> Cell>,
    /// `None` for counts, texts and ratios.
    pub dimension: Option<Dimension>,
    /// The quantity in words; the name where there are no better ones.
    pub heading: &'static str,
    /// How it is headed in the table of cases of a page, where it is among the columns shown there.
    pub in_cases: Option<&'static str>,
    error: Option<fn(&R) -> Option<f64>>,
    pub compared: Option<Compared>,
    /// Where value and error go that are read back from the table.
    place: Option<PlaceIn<R>>,
    error_place: Option<PlaceIn<R>>,
    /// Whether tables of earlier versions of the program do without it.
    pub(super) is_new: bool,
}

/// Where a value of a row goes that is read back from a table.
pub enum Place<'a> {
    Number(&'a mut f64),
    /// Of a cell that may be empty.
    Optional(&'a mut Option<f64>),
    Count(&'a mut usize),
    OptionalCount(&'a mut Option<usize>),
    Text(&'a mut String),
}

/// The place of a value in a row.
pub type PlaceIn<R> = for<'a> fn(&'a mut R) -> Place<'a>;

/// How two values of a column are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Compared {
    /// By their difference over the larger of them.
    Relatively,
    /// By their difference: they are relative already.
    Absolutely,
}

impl<R> Column<R> {
    pub(super) const fn new(
        name: &'static str,
        value: fn(&R) -> Cell,
        meaning: &'static str,
    ) -> Self {
        Self {
            name,
            meaning,
            value,
            of_branch: None,
            dimension: None,
            heading: name,
            in_cases: None,
            error: None,
            compared: None,
            place: None,
            error_place: None,
            is_new: false,
        }
    }

    const fn of_branch(
        name: &'static str,
        value: fn(&R, usize) -> Cell,
        meaning: &'static str,
    ) -> Self {
        let mut column = Self::new(name, |_| Cell::Absent, meaning);
        column.of_branch = Some(value);
        column
    }

    pub(super) const fn called(
        mut self,
        heading: &'static str,
        dimension: Option<Dimension>,
    ) -> Self {
        self.heading = heading;
        self.dimension = dimension;
        self
    }

    pub(super) const fn in_cases(mut self, heading: &'static str) -> Self {
        self.in_cases = Some(heading);
        self
    }

    pub(super) const fn with_error(mut self, error: fn(&R) -> Option<f64>) -> Self {
        self.error = Some(error);
        self
    }

    /// Where the value goes that is read back.
    pub(super) const fn read_into(mut self, place: PlaceIn<R>) -> Self {
        self.place = Some(place);
        self
    }

    /// Where the error goes that is read back.
    pub(super) const fn error_into(mut self, place: PlaceIn<R>) -> Self {
        self.error_place = Some(place);
        self
    }

    /// A column that tables of earlier versions do not have.
    const fn new_in_table(mut self) -> Self {
        self.is_new = true;
        self
    }

    const fn compared(mut self, compared: Compared) -> Self {
        self.compared = Some(compared);
        self
    }

    /// The column of its error, where it has one: `energy_loss_error_j` of `energy_loss_j`.
    pub fn error_name(&self) -> Option<String> {
        self.error?;
        let unit = self.dimension.map(Dimension::si_unit);
        let unit = unit.map_or(String::new(), |unit| format!("_{}", unit.to_lowercase()));
        let stem = self.name.strip_suffix(&unit).unwrap_or(self.name);
        Some(format!("{stem}_error{unit}"))
    }

    /// The value in a row that is a number.
    pub fn number(&self, row: &R) -> Option<f64> {
        (self.value)(row).number()
    }

    /// Its error in a row.
    pub fn error(&self, row: &R) -> Option<f64> {
        self.error.and_then(|error| error(row))
    }

    /// Unit in which it is read, and the factor to it from SI: angles in degrees.
    pub fn unit(&self) -> (&'static str, f64) {
        match self.dimension {
            Some(Dimension::Angle) => ("°", 180.0 / std::f64::consts::PI),
            Some(dimension) => (dimension.si_unit(), 1.0),
            None => ("", 1.0),
        }
    }

    /// Its columns that are read back: the name of each, and where its values go.
    pub(super) fn places(&self) -> impl Iterator<Item = (String, PlaceIn<R>)> {
        let value = self.place.map(|place| (self.name.to_owned(), place));
        let error = self
            .error_place
            .and_then(|place| Some((self.error_name()?, place)));
        value.into_iter().chain(error)
    }

    /// Its columns of values in a table: one, but for branches.
    pub(super) fn named(&self, branches: usize) -> Vec<Named<R>> {
        match self.of_branch {
            None => vec![Named::new(self.name, self.value)],
            Some(value) => (0..branches)
                .map(|k| {
                    let name = self.name.replace("{}", &(k + 1).to_string());
                    Named::new(name, move |row| value(row, k))
                })
                .collect(),
        }
    }

    pub(super) fn named_error(&self) -> Option<Named<R>> {
        let error = self.error?;
        Some(Named::new(self.error_name()?, move |row| error(row).into()))
    }
}

/// A column as it stands in a table: its name, and its cell in a row.
pub struct Named<R: 'static> {
    pub name: String,
    pub cell: Box<dyn Fn(&R) -> Cell>,
}

impl<R> Named<R> {
    fn new(name: impl Into<String>, cell: impl Fn(&R) -> Cell + 'static) -> Self {
        Self {
            name: name.into(),
            cell: Box::new(cell),
        }
    }
}

/// These columns, errors beside their values.
fn with_errors<R>(
    columns: impl Iterator<Item = &'static Column<R>>,
    branches: usize,
) -> Vec<Named<R>> {
    let named = |column: &Column<R>| {
        column
            .named(branches)
            .into_iter()
            .chain(column.named_error())
    };
    columns.flat_map(named).collect()
}

/// The columns of `sweep.csv`, errors beside their values; frequencies in the unit asked for come first, and before the drive
/// stands what other axes vary of something else. There are columns for this many branches of the material, and for an attraction that
/// moves the edge of the contact, if one does.
pub fn of_cases(
    (branches, is_attracted): (usize, bool),
    unit: FrequencyUnit,
    axes: Option<&Axes>,
) -> Vec<Named<CaseRecord>> {
    let mut named = with_errors(all_of_cases(is_attracted), branches);
    if let Some(leading) = named.iter().position(|c| c.name == unit.column()) {
        named[..=leading].rotate_right(1);
    }
    let own = axes.into_iter().flat_map(Axes::own_columns);
    let own = own.map(|(axis, varied)| {
        let (name, varied) = (varied.column(), varied.clone());
        Named::new(name, move |record: &CaseRecord| {
            Cell::of_axis(&varied, record.varied.get(axis))
        })
    });
    if let Some(place) = named.iter().position(|c| c.name == "drive_mean") {
        named.splice(place..place, own.collect::<Vec<_>>());
    }
    named
}

/// The columns of `history.csv`, errors behind all values.
pub fn of_moments() -> Vec<Named<Moment>> {
    let values = HISTORY.iter().flat_map(|column| column.named(0));
    let errors = HISTORY.iter().filter_map(Column::named_error);
    values.chain(errors).collect()
}

/// The columns that a `sweep.csv` may have, with those of an attraction that moves the edge of the contact or without.
pub fn all_of_cases(is_attracted: bool) -> impl Iterator<Item = &'static Column<CaseRecord>> {
    let of_attraction = if is_attracted { ATTRACTED } else { &[] };
    SWEEP.iter().chain(of_attraction)
}

/// The column of `sweep.csv` of this name, be it that of a branch.
pub fn of_name(name: &str) -> Option<&'static Column<CaseRecord>> {
    all_of_cases(true).find(|column| match column.name.split_once("{}") {
        None => column.name == name,
        Some((before, after)) => {
            let number = name.strip_prefix(before);
            let number = number.and_then(|rest| rest.strip_suffix(after));
            number.is_some_and(|number| number.parse::<usize>().is_ok())
        }
    })
}

/// A column with an error bar.
macro_rules! barred {
    ($quantity:ident, $heading:literal, $meaning:literal $(,)?) => {
        OfCase::new(
            Quantity::$quantity.column(),
            |r| of_result(r, |c| Quantity::$quantity.of(c)),
            $meaning,
        )
        .called($heading, Quantity::$quantity.dimension())
        .with_error(|r| {
            let errors = r.result.as_ref()?.errors.as_ref()?;
            errors.of(Quantity::$quantity)
        })
        .compared(match Quantity::$quantity.dimension() {
            Some(_) => Relatively,
            None => Absolutely,
        })
    };
}

/// A number of the result, where there is one.
fn of_result(record: &CaseRecord, value: impl Fn(&CaseResult) -> Option<f64>) -> Cell {
    record.result.as_ref().and_then(value).into()
}

type OfCase = Column<CaseRecord>;
type OfMoment = Column<Moment>;

use Compared::{Absolutely, Relatively};
use Dimension::{Energy, Length, Stress};
use Place::{Count, Number, Optional};

/// Which case it is; what has an error bar; what has none, and how the numbers came about.
#[rustfmt::skip]
pub static SWEEP: &[OfCase] = &[
    OfCase::new("angular_frequency_rad_per_s", |r| r.angular_frequency_rad_per_s.into(), "angular frequency ω of the drive")
        .called("angular frequency", Some(Dimension::AngularFrequency)),
    OfCase::new("frequency_hz", |r| r.frequency_hz().into(), "the same as f = ω/2π; the first column of a sweep that is given in Hz")
        .called("frequency", Some(Dimension::Frequency)),
    OfCase::new("drive_mean", |r| r.drive_mean.into(), "mean of the prescribed load (N) or approach (m)"),
    OfCase::new("drive_amplitude", |r| r.drive_amplitude.into(), "amplitude of the prescribed load (N) or approach (m)"),
    barred!(EnergyLoss, "energy loss per cycle",
        "area of the closed loop, ∮ W dδ over one cycle, from its Fourier coefficients")
        .in_cases("loss per cycle"),
    OfCase::new("energy_loss_material_error_j", |r| r.energy_loss_material_error_j().into(),
        "uncertainty (95 %, pointwise) of the loss that comes from the noise of the data which the material was fitted to: twice the root \
         mean square difference of the losses with the bootstrap samples of the material (`replicas`); no part of \
         `energy_loss_error_j`; empty for a material without them")
        .called("uncertainty of the loss from the material", Some(Energy))
        .in_cases("uncertainty from the material"),
    barred!(PhaseLag, "phase lag of the approach",
        "by how much the first harmonic of the approach lags behind that of the load, θ₁ − φ₁")
        .in_cases("phase lag"),
    barred!(StorageModulus, "storage modulus from the loop",
        "what instrumented indentation reads from the loop, (1 − ν²) W₁ cos(θ₁ − φ₁)/(2 a₀ δ₁), less what a deformable indenter yields; with a \
         bulk modulus K, Young's modulus 9KG/(3K + G) of the shear modulus G that belongs to W₁ exp(i(θ₁ − φ₁))/(2 a₀ δ₁); empty where the indenter leaves the surface")
        .in_cases("E′"),
    barred!(LossModulus, "loss modulus from the loop",
        "the same with the sine")
        .in_cases("E″"),
    barred!(ApproachMin, "smallest approach",
        "smallest approach of the cycle"),
    barred!(ApproachMax, "largest approach",
        "largest approach of the cycle")
        .in_cases("largest approach"),
    barred!(ContactRadiusMin, "smallest contact radius",
        "smallest contact radius of the cycle: that of the circle of the contact's area"),
    barred!(ContactRadiusMax, "largest contact radius",
        "largest contact radius of the cycle")
        .in_cases("largest radius"),
    OfCase::new("contact_duty", |r| of_result(r, |c| Some(c.contact_duty.part)),
        "part of the cycle in which the indenter touches the surface: below 1 where an amplitude above the mean lifts it off; exact \
         under a prescribed load, and to half a time step per lift-off or touch under a prescribed approach")
        .called("part of the cycle in contact", None)
        .with_error(|r| Some(r.result.as_ref()?.contact_duty.error))
        .compared(Absolutely),
    OfCase::new("tabor_parameter", |r| of_result(r, |c| c.tabor_parameter()),
        "(R w²/(E*² z₀³))^(1/3) of a sphere that is attracted, with |1/C*| at the frequency for E* and z₀ = 1.03 of the range; empty without `[adhesion]`")
        .called("Tabor's parameter", None).compared(Relatively),
    barred!(PeakPressureMin, "smallest peak pressure",
        "smallest over the cycle of the largest pressure in the contact; empty where that is unbounded, under a cone or a flat punch"),
    barred!(PeakPressureMax, "largest peak pressure",
        "the largest over the cycle")
        .in_cases("largest pressure"),
    barred!(Harmonic2, "second harmonic of the approach, relative",
        "amplitude of the second harmonic of the approach relative to the first, δ₂/δ₁"),
    barred!(Harmonic3, "third harmonic of the approach, relative", "δ₃/δ₁"),
    OfCase::of_branch("branch_{}_loss_j", |r, k| of_result(r, |c| Some(c.branches.get(k)?.energy_loss_j)),
        "what the dashpot of each branch of the creep compliance dissipates per cycle, from the memory alone, shortest \
         retardation time first (`summary.json` lists the times)")
        .called("dissipated by a branch", Some(Energy)).compared(Relatively),
    OfCase::new("dissipated_j", |r| of_result(r, |c| c.attracted().is_none().then(|| c.dissipated_j())), "the sum over the branches, which must be the loss: `energy_imbalance` says how far it is from it, and is a measure of its error \
         and of that of its parts, which have no error column")
        .called("dissipated by all branches", Some(Energy)).compared(Relatively),
    OfCase::new("dissipated_in_indenter_j", |r| of_result(r, CaseResult::dissipated_in_indenter_j),
        "the part of `dissipated_j` that is dissipated in the indenter, the rest in the half-space; empty where the indenter is rigid")
        .called("dissipated in the indenter", Some(Energy)).compared(Relatively),
    OfCase::new("energy_imbalance", |r| of_result(r, CaseResult::energy_imbalance),
        "`dissipated_j`/`energy_loss_j` − 1: an error of discretisation, not of physics"),
    OfCase::new("polygon_loss_j", |r| of_result(r, |c| Some(c.analysis.polygon_loss_j)),
        "area of the polygon through the N samples of the loop, a cross-check that is low by (N/2π) sin(2π/N) for an ellipse")
        .called("area of the polygon through the samples", Some(Energy)).compared(Relatively),
    OfCase::new(OfLoop::Harmonic4.column(), |r| of_result(r, |c| c.analysis.approach_harmonic(4)), "δ₄/δ₁")
        .called("fourth harmonic of the approach, relative", None).compared(Absolutely),
    OfCase::new(OfLoop::Harmonic5.column(), |r| of_result(r, |c| c.analysis.approach_harmonic(5)), "δ₅/δ₁")
        .called("fifth harmonic of the approach, relative", None).compared(Absolutely),
    OfCase::new("index", |r| r.index.into(), "the number in the names of its loop and its record"),
    OfCase::new("method", |r| r.method.name().into(), "how the stabilised cycle was reached"),
    OfCase::new("steps", |r| r.steps.into(), "time steps per cycle"),
    OfCase::new("nodes", |r| r.nodes.into(), "springs, or cells along the longer side"),
    OfCase::new("cycles", |r| r.cycles.into(), "cycles solved at this resolution").in_cases("cycles"),
    OfCase::new("steady_distance", |r| r.steady_distance.into(),
        "estimated distance of the recorded cycle to the stabilised one, relative"),
    OfCase::new("domain_half_width_m", |r| r.domain_half_width_m.into(), "half width of the computational domain")
        .called("half width of the domain", Some(Length)),
    OfCase::new("instants", |r| r.work.instants.into(), "instants solved, on coarser resolutions too, as in the next two columns"),
    OfCase::new("iterations", |r| r.work.iterations.into(), "iterations of the contact solver"),
    OfCase::new("convolutions", |r| r.work.convolutions.into(), "convolutions on cells"),
    OfCase::new("warnings", |r| codes(r).into(),
        "what lies outside the model, as [codes][validity] with blanks between them; empty where nothing does"),
    OfCase::new("status", |r| r.status.name().into(), "converged; transient: the cycle asked for by its number; not-converged or failed: no result"),
    OfCase::new("message", |r| r.message.clone().into(), "why there is no result, or what else is to be known"),
];

/// What a table has besides of contacts whose edge an attraction moves.
#[rustfmt::skip]
pub static ATTRACTED: &[OfCase] = &[
    barred!(BulkLoss, "lost in the bulk",
        "the part of the loss under the surface that is in contact all the time, which shares the approach: 2 a_min π Σ n δₙ² E″(nω)")
        .in_cases("in the bulk"),
    barred!(EdgeLoss, "lost at the edge", "the part of the loss where the contact comes and goes: the rest")
        .in_cases("at the edge"),
    barred!(JumpLoss, "lost in jumps",
        "the part of the loss in jumps of the contact, in which it passes states that are not stable: what drive and body have less afterwards"),
    barred!(ZoneRadiusMin, "smallest radius of the attracted zone", "smallest radius up to which the surfaces attract one another"),
    barred!(ZoneRadiusMax, "largest radius of the attracted zone", "the largest of the cycle"),
    barred!(LargestPull, "largest pull", "the largest pull on the indenter in the cycle, −W: the pull-off load where it comes off"),
    barred!(SnapInApproach, "approach before the snap in",
        "approach at the last time step before the surfaces jump into contact; empty where they do not, as in the next three"),
    barred!(SnapInLoad, "load before the snap in", "load at that time step"),
    barred!(SnapOffApproach, "approach before the snap off", "approach at the last time step before the surfaces jump out of contact"),
    barred!(SnapOffLoad, "load before the snap off", "load at that time step"),
];

/// What is to be kept in mind of a case, as codes.
fn codes(record: &CaseRecord) -> String {
    let codes = record.warnings.iter().map(|warning| warning.code());
    codes.collect::<Vec<_>>().join(" ")
}

/// A row of a history with its errors.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Moment {
    pub row: HistoryRow,
    pub errors: RowErrors,
}

impl Moment {
    /// Every moment of a history; without errors where there are none.
    pub fn all(outcome: &SimulationOutcome) -> impl Iterator<Item = Self> {
        let rows = outcome.rows.iter().enumerate();
        rows.map(|(place, row)| Self {
            row: *row,
            errors: outcome.errors.get(place).copied().unwrap_or_default(),
        })
    }
}

/// The columns of `history.csv`.
#[rustfmt::skip]
pub static HISTORY: &[OfMoment] = &[
    OfMoment::new("time_s", |m| m.row.time_s.into(), "time; twice the same at a jump")
        .called("time", Some(Dimension::Time)).read_into(|m| Number(&mut m.row.time_s)),
    OfMoment::new("load_n", |m| m.row.load_n.into(), "load W")
        .called("load", Some(Dimension::Force)).with_error(|m| m.errors.load_n)
        .read_into(|m| Number(&mut m.row.load_n)).error_into(|m| Optional(&mut m.errors.load_n)),
    OfMoment::new("approach_m", |m| m.row.approach_m.into(),
        "approach δ; empty where the indenter is clear of the surface under a prescribed load")
        .called("approach", Some(Length)).with_error(|m| m.errors.approach_m)
        .read_into(|m| Optional(&mut m.row.approach_m)).error_into(|m| Optional(&mut m.errors.approach_m)),
    OfMoment::new("contact_radius_m", |m| m.row.contact_radius_m.into(),
        "contact radius a: that of the circle of the contact's area")
        .called("radius", Some(Length)).with_error(|m| m.errors.contact_radius_m)
        .read_into(|m| Number(&mut m.row.contact_radius_m)).error_into(|m| Optional(&mut m.errors.contact_radius_m)),
    OfMoment::new("contact_area_m2", |m| m.row.contact_area_m2().into(), "contact area")
        .called("contact area", Some(Dimension::Area)),
    OfMoment::new("peak_pressure_pa", |m| m.row.peak_pressure_pa.into(),
        "largest pressure in the contact; empty where it is unbounded")
        .called("pressure", Some(Stress)).with_error(|m| m.errors.peak_pressure_pa)
        .read_into(|m| Optional(&mut m.row.peak_pressure_pa)).error_into(|m| Optional(&mut m.errors.peak_pressure_pa)),
    OfMoment::new("work_j", |m| m.row.work_j.into(),
        "work that the indenter has done on the body so far, ∫ W dδ; at a jump what the body takes up at once, elastically")
        .called("work", Some(Energy)).with_error(|m| m.errors.work_j)
        .read_into(|m| Optional(&mut m.row.work_j)).error_into(|m| Optional(&mut m.errors.work_j)).new_in_table(),
];

/// Of a cycle that has numbers.
fn of_cycle(cycle: &HistoryCycle, value: fn(&CycleNumbers) -> Option<f64>) -> Cell {
    cycle.numbers.as_ref().and_then(value).into()
}

/// The first harmonic of a cycle.
fn first(numbers: &CycleNumbers) -> Option<&Harmonic> {
    numbers.analysis.harmonics.first()
}

type OfCycle = Column<HistoryCycle>;

/// The columns of `cycles.csv`.
#[rustfmt::skip]
pub static CYCLES: &[OfCycle] = &[
    OfCycle::new("segment", |c| c.segment.into(), "the sine segment of the drive, from 1").read_into(|c| Count(&mut c.segment)),
    OfCycle::new("cycle", |c| c.number.into(), "the cycle within it, from 1").read_into(|c| Count(&mut c.number)),
    OfCycle::new("start_s", |c| c.start_s.into(), "when it begins").called("start", Some(Dimension::Time)),
    OfCycle::new("angular_frequency_rad_per_s", |c| c.angular_frequency_rad_per_s.into(), "angular frequency of the drive")
        .called("angular frequency", Some(Dimension::AngularFrequency)),
    OfCycle::new(OfLoop::EnergyLoss.column(), |c| of_cycle(c, |n| Some(n.analysis.energy_loss_j)),
        "area of the loop once a straight line has closed it; empty where the approach is undefined for a part of the cycle")
        .called("loss / cycle", Some(Dimension::Energy)).with_error(|c| c.errors.energy_loss_j)
        .error_into(|c| Optional(&mut c.errors.energy_loss_j)),
    OfCycle::new(OfLoop::PhaseLag.column(), |c| of_cycle(c, |n| Some(n.analysis.phase_lag_rad)), "lag of the approach behind the load, first harmonic")
        .called("phase lag", Some(Dimension::Angle)).with_error(|c| c.errors.phase_lag_rad)
        .error_into(|c| Optional(&mut c.errors.phase_lag_rad)),
    OfCycle::new(OfLoop::StorageModulus.column(), |c| of_cycle(c, |n| n.moduli_pa.map(|m| m.0)), "E′ read from the first harmonic and the mean contact radius")
        .called("E′", Some(Stress)).with_error(|c| c.errors.storage_modulus_pa)
        .error_into(|c| Optional(&mut c.errors.storage_modulus_pa)),
    OfCycle::new(OfLoop::LossModulus.column(), |c| of_cycle(c, |n| n.moduli_pa.map(|m| m.1)), "E″ likewise")
        .called("E″", Some(Stress)).with_error(|c| c.errors.loss_modulus_pa)
        .error_into(|c| Optional(&mut c.errors.loss_modulus_pa)),
    OfCycle::new(OfLoop::LoadMean.column(), |c| of_cycle(c, |n| Some(n.analysis.load_mean_n)), "mean load").called("mean load", Some(Dimension::Force)),
    OfCycle::new(OfLoop::LoadAmplitude.column(), |c| of_cycle(c, |n| Some(first(n)?.load_amplitude_n)), "amplitude of its first harmonic")
        .called("load amplitude", Some(Dimension::Force)),
    OfCycle::new("load_change_n", |c| of_cycle(c, |n| Some(n.load_change_n)), "load at the end less that at the beginning, which the straight line takes off")
        .called("change of load", Some(Dimension::Force)),
    OfCycle::new(OfLoop::ApproachMean.column(), |c| of_cycle(c, |n| Some(n.analysis.approach_mean_m)), "mean approach").called("mean approach", Some(Length)),
    OfCycle::new(OfLoop::ApproachAmplitude.column(), |c| of_cycle(c, |n| Some(first(n)?.approach_amplitude_m)), "amplitude of its first harmonic")
        .called("approach amplitude", Some(Length)),
    OfCycle::new("approach_change_m", |c| of_cycle(c, |n| Some(n.approach_change_m)), "approach at the end less that at the beginning")
        .called("change of approach", Some(Length)),
    OfCycle::new("contact_radius_mean_m", |c| of_cycle(c, |n| Some(n.mean_contact_radius_m)), "mean contact radius")
        .called("mean radius", Some(Length)),
    OfCycle::new(OfLoop::Harmonic2.column(), |c| of_cycle(c, |n| n.analysis.approach_harmonic(2)), "second harmonic of the approach over the first"),
    OfCycle::new(OfLoop::Harmonic3.column(), |c| of_cycle(c, |n| n.analysis.approach_harmonic(3)), "the third"),
    OfCycle::new(OfLoop::Harmonic4.column(), |c| of_cycle(c, |n| n.analysis.approach_harmonic(4)), "the fourth"),
    OfCycle::new(OfLoop::Harmonic5.column(), |c| of_cycle(c, |n| n.analysis.approach_harmonic(5)), "the fifth"),
];

/// The columns of `cycles.csv`, errors beside their values.
pub fn of_cycles() -> Vec<Named<HistoryCycle>> {
    with_errors(CYCLES.iter(), 0)
}

/// `cycles.csv`: one row per cycle of the sine segments of a history.
pub fn cycles(outcome: &SimulationOutcome) -> Vec<u8> {
    table(CYCLES, &outcome.cycles)
}

/// A table of these columns, errors beside their values.
pub(super) fn table<R: 'static>(
    columns: impl IntoIterator<Item = &'static Column<R>>,
    rows: &[R],
) -> Vec<u8> {
    named(&with_errors(columns.into_iter(), 0), rows)
}

/// The rows of these columns.
pub(super) fn named<R>(columns: &[Named<R>], rows: &[R]) -> Vec<u8> {
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
    let cells = |row| columns.iter().map(|column| (column.cell)(row)).collect();
    csv(&names, rows.iter().map(cells).collect::<Vec<Vec<Cell>>>())
}

/// `sweep.csv`: one row per case, in the order given. `of` is as of [`of_cases`], `unit` the one
/// in which frequencies come first.
pub fn sweep(
    records: &[CaseRecord],
    of: (usize, bool),
    unit: FrequencyUnit,
    axes: Option<&Axes>,
) -> Vec<u8> {
    named(&of_cases(of, unit, axes), records)
}

/// `history.csv`: one row per time step, two with the same time at a jump. Errors are absolute.
pub fn history(outcome: &SimulationOutcome) -> Vec<u8> {
    let moments: Vec<Moment> = Moment::all(outcome).collect();
    named(&of_moments(), &moments)
}

/// The reference of columns in `src/guide/results.md`: a row of a table for each.
pub fn reference<R>(columns: &[Column<R>]) -> String {
    let row = |column: &Column<R>| {
        let error = column.error_name();
        format!(
            "| `{}` | {} | {} | {} |\n",
            column.name.replace("{}", "k"),
            error.map_or(String::new(), |name| format!("`{name}`")),
            column.dimension.map_or("", Dimension::si_unit),
            column.meaning
        )
    };
    let rows: String = columns.iter().map(row).collect();
    format!("| column | its error | unit | meaning |\n|---|---|---|---|\n{rows}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_called_after_its_value_and_branches_are_counted_from_one() {
        let loss = of_name("energy_loss_j").unwrap();
        assert_eq!(loss.error_name().as_deref(), Some("energy_loss_error_j"));
        let second = of_name("harmonic_2").unwrap();
        assert_eq!(second.error_name().as_deref(), Some("harmonic_2_error"));
        assert_eq!(
            of_name("branch_12_loss_j").unwrap().name,
            "branch_{}_loss_j"
        );
        assert!(of_name("branch_x_loss_j").is_none());
        let names = |unit| {
            let named = of_cases((2, false), unit, None).into_iter();
            named.map(|column| column.name).collect::<Vec<_>>()
        };
        let columns = names(FrequencyUnit::RadPerS);
        assert!(columns.contains(&"branch_2_loss_j".to_owned()));
        assert_eq!(
            columns[..2],
            ["angular_frequency_rad_per_s", "frequency_hz"]
        );
        let in_hz = names(FrequencyUnit::Hz);
        assert_eq!(in_hz[..2], ["frequency_hz", "angular_frequency_rad_per_s"]);
        assert_eq!(columns[2..], in_hz[2..]);
    }

    #[test]
    fn every_quantity_with_an_error_bar_has_a_column() {
        let barred = all_of_cases(true).filter(|column| column.error_name().is_some());
        // The part of the cycle in contact knows its error without a coarser resolution.
        assert_eq!(barred.count(), Quantity::ALL.len() + 1);
    }
}
