//! What was found: the series, its unknowns with their intervals, and what is known of it.

use nalgebra::DMatrix;

use crate::identify::candidate::Candidate;
use crate::identify::data::Number;
use crate::identify::laws::{Drawn, Laws};
use crate::identify::model::Model;
use crate::identify::noise::Knowledge;
use crate::identify::selection::Linearised;
use crate::identify::series::{Point, name};
use crate::identify::uncertainty::{Directions, moduli};
use crate::identify::{IdentifyError, UNDETERMINED};
use crate::material::Relaxation;
use crate::numerics::levenberg_marquardt::Solution;
use crate::sweep::plan::adhesion::AdhesionPlan;

/// The unknowns of an attraction.
const ATTRACTION: [&str; 2] = ["work", "range"];

/// The largest exponent of a confidence factor that is written as a number.
const WIDEST: f64 = 60.0;

/// An unknown with its 95 % interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    /// `g_inf`, `g_1`, `tau_1` and so on; `work` and `range` of an attraction.
    pub name: String,
    /// Pa, s, J/m^2 or m.
    pub value: f64,
    /// The interval goes from `value / factor` to `value * factor`.
    pub factor: f64,
    /// Whether the factor is below [`UNDETERMINED`].
    pub is_determined: bool,
}

/// A combination of the unknowns that the data leave open: the product of the powers of its parts.
#[derive(Debug, Clone, PartialEq)]
pub struct Undetermined {
    /// By what factor it may be off, at 95 %.
    pub factor: f64,
    /// Unknowns and their powers, the largest first.
    pub parts: Vec<(String, f64)>,
}

/// Storage and loss modulus (Pa) at one frequency, with their 95 % bands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModulusBand {
    pub storage_pa: f64,
    pub loss_pa: f64,
    /// The bands go from the modulus over this factor to the modulus times it.
    pub storage_factor: f64,
    pub loss_factor: f64,
}

/// A number as measured and as computed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// Angular frequency (rad/s) of the cycle, or time (s) of the instant of a history.
    pub place: f64,
    /// Its row in the table, from 1 below the header.
    pub row: usize,
    pub number: Number,
    pub measured: f64,
    /// Standard deviation: as given, or estimated.
    pub error: f64,
    pub computed: f64,
    /// Factor of the 95 % band of the computed number.
    pub factor: f64,
}

/// What is known of the error that the number of cells leaves in the computed numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CellError {
    /// Twice as many cells change a computed number by this part of it at most. All numbers are corrected by this change, and all
    /// intervals include it.
    Included(f64),
    /// The same, which is too little beside the noise to matter.
    Negligible(f64),
    /// Nothing: the indenter is a map, which is solved on its own points, or the contact was not found on twice as many cells. The
    /// intervals do not include it.
    Unknown,
}

/// What was found.
#[derive(Debug, Clone)]
pub struct Identified {
    pub relaxation: Relaxation,
    pub unknowns: Vec<Unknown>,
    /// Between the unknowns, row by row.
    pub correlations: Vec<Vec<f64>>,
    pub singular_values: Vec<f64>,
    pub undetermined: Vec<Undetermined>,
    /// Every number of branches tried, fewest first.
    pub candidates: Vec<Candidate>,
    pub compared: Vec<Compared>,
    /// Which of these is an outlier: all others are met without it, and it does not count in the fit.
    pub left_out: Option<usize>,
    /// What was known of the errors of the data.
    pub knowledge: Knowledge,
    pub degrees_of_freedom: usize,
    /// Sum of squares over degrees of freedom, with errors as given; where none is given, one by definition.
    pub reduced_chi_squared: f64,
    /// By what factor all intervals are wider than the errors of the data say: 1, or where the series misses the data by more than
    /// chance the root of the reduced chi squared.
    pub inflation: f64,
    /// Lowest and highest angular frequency of the data.
    pub window_rad_per_s: (f64, f64),
    /// Of a contact on cells; `None` on springs.
    pub cell_error: Option<CellError>,
    /// The attraction that was found beside the series, where it was sought.
    pub adhesion: Option<AdhesionPlan>,
    /// Laws that were tried beside series, where they were asked for: the material is the best of them.
    pub laws: Option<Laws>,
    /// What is found where the noise falls otherwise, each alike in probability; empty where none was asked for.
    pub ensemble: Vec<Drawn>,
    pub(super) is_by_law: bool,
    pub(super) point: Point,
    directions: Directions,
    half_width: f64,
    /// The series on the linearised contact, with which the candidates are compared.
    pub(super) linearised: Point,
}

/// The result with all that is known of it; behind the unknowns of the series, the derivatives are by those of the attraction, where that is
/// sought.
pub(super) fn judged(
    model: &Model<'_>,
    linearised: &Linearised<'_>,
    candidates: Vec<Candidate>,
    start: Point,
    found: Solution<Point>,
    (derivatives, attraction): (&DMatrix<f64>, &[f64]),
) -> Result<Identified, IdentifyError> {
    let measured = &linearised.plan.measurements;
    let point = found.unknowns.clone();
    let names: Vec<String> = (0..point.0.len())
        .map(name)
        .chain(ATTRACTION.map(str::to_owned))
        .collect();
    let count = point.0.len() + attraction.len();
    let degrees_of_freedom = measured.data().len().saturating_sub(count);
    let noise = &linearised.noise;
    let scatter = noise.scatter(&found.residuals, degrees_of_freedom);
    let half_width = scatter.half_width;
    let directions = Directions::new(derivatives, scatter.deviation);
    let mut directions =
        directions.ok_or(IdentifyError::NoFit("its derivatives are not finite"))?;
    let cell_error = model.cell_error();
    if let Some(CellError::Included(_)) = cell_error {
        let changes = model.ln_corrections().zip(&noise.relative);
        let changes: Vec<f64> = changes.map(|(change, error)| change / error).collect();
        directions.include(derivatives, &changes, half_width);
    }
    let covariance = directions.covariance();
    let deviation = |k: usize| covariance[(k, k)].sqrt();
    let factor = |deviation: f64| (half_width * deviation).min(WIDEST).exp();
    let all = point.0.iter().chain(attraction).enumerate();
    let unknowns = all.map(|(k, ln)| Unknown {
        name: names[k].clone(),
        value: ln.exp(),
        factor: factor(deviation(k)),
        is_determined: factor(deviation(k)) < UNDETERMINED,
    });
    let correlation = |i: usize, j: usize| covariance[(i, j)] / (deviation(i) * deviation(j));
    let compared = measured.data().iter().enumerate().map(|(k, datum)| {
        let error = linearised.noise.relative[k];
        // A row of derivatives is in standard deviations of its datum.
        let gradient = derivatives.row(k).transpose() * error;
        Compared {
            place: datum.place,
            row: datum.row,
            number: datum.number,
            measured: datum.value,
            error: noise.own(k) * scatter.of_data * datum.value,
            computed: datum.value * (found.residuals[k] * error).exp(),
            factor: factor(directions.variance(&gradient).sqrt()),
        }
    });
    Ok(Identified {
        left_out: noise.left_out(),
        relaxation: point.relaxation()?,
        unknowns: unknowns.collect(),
        correlations: (0..count)
            .map(|i| (0..count).map(|j| correlation(i, j)).collect())
            .collect(),
        singular_values: directions.singular_values.clone(),
        undetermined: undetermined(&directions, half_width, &names),
        candidates,
        compared: compared.collect(),
        knowledge: noise.knowledge,
        degrees_of_freedom,
        reduced_chi_squared: scatter.reduced_chi_squared,
        inflation: scatter.deviation / scatter.of_data,
        window_rad_per_s: measured.window_rad_per_s(),
        cell_error,
        adhesion: None,
        laws: None,
        ensemble: Vec::new(),
        is_by_law: false,
        point,
        directions,
        half_width,
        linearised: start,
    })
}

/// Directions along which the unknowns may move by more than the factor that counts as determined.
fn undetermined(directions: &Directions, half_width: f64, names: &[String]) -> Vec<Undetermined> {
    let all = directions.deviations.iter().enumerate();
    let open = all.filter(|(_, deviation)| half_width * **deviation > UNDETERMINED.ln());
    open.map(|(place, deviation)| {
        let row = directions.vectors.row(place);
        let larger = |a: f64, v: &f64| if v.abs() > a.abs() { *v } else { a };
        let largest = row.iter().fold(0.0, larger);
        // The largest power is one; what hardly takes part is left out.
        let powers = row
            .iter()
            .enumerate()
            .map(|(k, v)| (names[k].clone(), v / largest));
        let mut parts: Vec<(String, f64)> = powers.filter(|(_, power)| power.abs() > 0.2).collect();
        parts.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        Undetermined {
            factor: (half_width * deviation).min(WIDEST).exp(),
            parts,
        }
    })
    .collect()
}

impl Identified {
    /// The number that the series misses by the most of its errors, and by how many.
    pub fn worst(&self) -> Option<(&Compared, f64)> {
        let each = self.compared.iter();
        let off = |c: &Compared| (c.computed / c.measured).ln() * c.measured / c.error;
        each.map(|c| (c, off(c)))
            .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }

    /// The series of a number of branches at a share of the sum of all weights: the one that was found, or another on the linearised contact.
    pub(super) fn drawn(&self, share: f64) -> &Point {
        let chosen = self.point.branches();
        let mut left = share;
        let others = self
            .candidates
            .iter()
            .filter(|c| c.branches != chosen && !c.has_close_times);
        let other = others.into_iter().find(|candidate| {
            left -= candidate.weight;
            left < 0.0
        });
        other.map_or(&self.point, |candidate| &candidate.point)
    }

    /// The computed numbers, as the exact model gives them to the linearised contact.
    pub(super) fn computed(&self) -> Vec<Option<f64>> {
        self.compared.iter().map(|c| Some(c.computed)).collect()
    }

    /// Logarithms of computed over measured numbers.
    pub(super) fn missed(&self) -> Vec<f64> {
        let compared = self.compared.iter();
        compared.map(|c| (c.computed / c.measured).ln()).collect()
    }

    /// The root mean square of relative differences between measured and computed numbers, times what more unknowns gain by chance.
    pub(super) fn misfit(&self) -> f64 {
        let squares: f64 = self.missed().iter().map(|off| off * off).sum();
        (squares / self.degrees_of_freedom.max(1) as f64).sqrt()
    }

    /// The moduli at a frequency, with bands. Beyond the data they are an extrapolation.
    pub fn band(&self, angular_frequency_rad_per_s: f64) -> ModulusBand {
        let of_laws = self.laws.as_ref();
        let of_laws = of_laws.and_then(|laws| laws.band(angular_frequency_rad_per_s));
        match (of_laws, self.law()) {
            (Some(band), Some(_)) => band,
            // A series is refined on the exact model; the laws tell how wide its band is.
            (Some(band), None) => self
                .band_of_series(angular_frequency_rad_per_s)
                .widened(&band),
            (None, _) => self.band_of_series(angular_frequency_rad_per_s),
        }
    }

    fn band_of_series(&self, angular_frequency_rad_per_s: f64) -> ModulusBand {
        let own = moduli(&self.point, angular_frequency_rad_per_s);
        let compared = moduli(&self.linearised, angular_frequency_rad_per_s);
        let mut variances = own
            .each_ref()
            .map(|(_, gradient)| self.directions.variance(gradient));
        let chosen = self.point.branches();
        let others = self.candidates.iter();
        for other in others.filter(|c| c.branches != chosen && c.weight > 0.0) {
            let theirs = moduli(&other.point, angular_frequency_rad_per_s);
            for part in 0..2 {
                let apart = theirs[part].0 - compared[part].0;
                variances[part] += other.weight * apart * apart;
            }
        }
        let ln_moduli = own.map(|(ln, _)| ln);
        ModulusBand::of(ln_moduli, variances, self.half_width)
    }
}

impl ModulusBand {
    /// The same moduli with bands at least as wide as those of another.
    fn widened(self, other: &Self) -> Self {
        Self {
            storage_factor: self.storage_factor.max(other.storage_factor),
            loss_factor: self.loss_factor.max(other.loss_factor),
            ..self
        }
    }

    /// Of the logarithms of storage and loss modulus (Pa) and their variances, this many standard deviations to either side.
    pub(crate) fn of(ln_moduli: [f64; 2], variances: [f64; 2], half_width: f64) -> Self {
        let factor = |variance: f64| (half_width * variance.sqrt()).min(WIDEST).exp();
        Self {
            storage_pa: ln_moduli[0].exp(),
            loss_pa: ln_moduli[1].exp(),
            storage_factor: factor(variances[0]),
            loss_factor: factor(variances[1]),
        }
    }
}
