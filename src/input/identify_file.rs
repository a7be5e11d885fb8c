//! Identification files: from a document, and the table that it names, to what an identification needs to know.

use std::path::Path;

use super::bodies_block::Bodies;
use super::data_file;
use super::diagnostic::{Diagnostics, Location, Problems};
use super::document::reader::TableReader;
use super::document::{Document, Located, block};
use super::given::Given;
use super::harmonic_block::Pressed;
use super::keys;
use super::keys::identify::{IDENTIFY, KNOWN_MATERIAL, MEASURED_DRIVE, MODEL_CYCLE, PROBE};
use super::keys::material::BULK_MODULUS;
use super::{
    bodies_block, force_curves, harmonic_block, material_block, measured_history, measured_table,
    segments_block, solver_block,
};
use crate::drive::segments::SEGMENTS;
use crate::force_curve::resolved::{CURVE, CurvesPlan, MOST_CHOSEN, Probe};
use crate::force_curve::{self, CurvePlan};
use crate::identify::data::{Measurements, TableColumns};
use crate::identify::resolved::{
    APPROACH_ZERO, ATTRACTION, DATA, IDENTIFY_BRANCHES, LAW, SAMPLES, forms, resolved_text,
};
use crate::identify::{
    ApproachZero, Driven, IdentifyPlan, MOST_BRANCHES, Sought, SoughtAttraction,
};
use crate::indenter::{Axisymmetric, Indenter};
use crate::material::law::Form;
use crate::material::{Compressibility, Relaxation};
use crate::quantity::key::Key;
use crate::sweep::plan::adhesion::AdhesionModel;
use crate::sweep::plan::contact::ContactPlan;

/// The table of results in a folder of a sweep or of an analysis.
const TABLE: &str = "sweep.csv";

/// What an identification file asks for.
#[derive(Debug, Clone)]
pub enum Asked {
    /// A series from cycles or a history under a drive.
    Driven(Box<IdentifyPlan>),
    /// A law from force curves.
    Curves(Box<CurvesPlan>),
}

impl Asked {
    /// The plan as the text of an identification file.
    pub fn resolved_text(&self) -> String {
        match self {
            Self::Driven(plan) => resolved_text(plan),
            Self::Curves(plan) => force_curve::resolved::resolved_text(plan),
        }
    }
}

/// The plan that an identification file asks for, with an indenter for the block that the file leaves out.
///
/// # Errors
/// Everything that is wrong with the file, at once, each problem with its place and what to write instead.
pub fn plan(document: &Document, given: &Given) -> Result<Asked, Diagnostics> {
    document.read_whole(|root| {
        let mut measured = root.table(&IDENTIFY);
        match measured.as_mut().is_some_and(|table| table.has(&CURVE)) {
            true => curves_plan(root, measured?, given).map(|plan| Asked::Curves(plan.into())),
            false => driven_plan(root, measured, given).map(|plan| Asked::Driven(plan.into())),
        }
    })
}

/// Force curves: they prescribe their indentation themselves.
fn curves_plan(
    root: &mut TableReader<'_>,
    mut table: TableReader<'_>,
    given: &Given,
) -> Option<CurvesPlan> {
    let title = root.value(&keys::TITLE);
    let compressibility = root.table(&KNOWN_MATERIAL).and_then(known_material);
    let bodies = bodies_block::read(root);
    let indenter = given.indenter(root);
    let probe = root.table_or(&PROBE, Probe::default(), |t| block::read(t, None));
    refuse_beside_curves(root);
    let problems = root.problems();
    let place_of_indenter = root.key_location(&keys::INDENTER);
    if let (Some(place), Some(indenter)) = (place_of_indenter, &indenter)
        && indenter.axisymmetric().is_none()
    {
        let because = indenter.not_axisymmetric_because();
        problems
            .at(&place, "force curves are of bodies of revolution")
            .because(format!("the {} {because}", indenter.shape()))
            .help("give a sphere, a cone, a flat punch or a power law");
        return None;
    }
    if let (Some(probe), Some(indenter), Some(place)) =
        (&probe, &indenter, root.key_location(&PROBE))
        && probe.radius_uncertainty > 0.0
        && !["sphere", "flat-punch"].contains(&indenter.shape())
    {
        let message = format!("`radius_uncertainty` of a {}", indenter.shape());
        let report = problems.at(&place, message);
        report.help("leave it out: it is for spheres and flat punches");
        return None;
    }
    let (folder, branches) = (table.folder(), table.value(&IDENTIFY_BRANCHES));
    let files: Option<Located<Vec<String>>> = table.read(&CURVE);
    let places = table.places_in(CURVE.name);
    let laws: Option<Option<Vec<String>>> = table.value(&LAW);
    let samples = table.value(&SAMPLES);
    let adhesion = bodies.as_ref().and_then(Bodies::adhesion);
    let attraction = sought_attraction(&mut table, adhesion.is_some(), &[]);
    table.finish();
    let (bodies, indenter, compressibility) = (bodies?, indenter?, compressibility?);
    let contact = ContactPlan {
        layer: bodies.layer,
        adhesion,
        indenter,
        material: Sought {
            compressibility,
            indenter_material: bodies.indenter_material,
        },
    };
    can_be_fitted(root, &contact)?;
    let (probe, files, branches) = (probe?, files?, branches?);
    let laws = laws?.unwrap_or_else(|| vec!["auto".to_owned()]);
    let (mut curves, mut names) = (Vec::new(), Vec::new());
    for (name, location) in files.value.iter().zip(places) {
        let file = Located {
            value: name.clone(),
            path: files.path.clone(),
            location,
        };
        let (name, bytes) = data_file::named(&file, folder, problems)?;
        let read = force_curves::parse(&name, &bytes, &probe);
        curves.extend(data_file::accepted(read, &file, problems)?);
        names.push(name);
    }
    Some(CurvesPlan {
        title: title?,
        fit: CurvePlan {
            contact,
            attraction: attraction?,
            forms: forms(&laws, branches, MOST_CHOSEN),
            probe,
            samples: samples?,
        },
        laws,
        branches,
        files: names,
        curves,
    })
}

/// Refuses contacts whose force curves are not computed; `None` where one was.
fn can_be_fitted(root: &mut TableReader<'_>, contact: &ContactPlan<Sought>) -> Option<()> {
    let problems = root.problems();
    let mut refused = |key: &Key, what: &str, because: &str, help: &str| {
        let place = root.key_location(key)?;
        problems.at(&place, what).because(because).help(help);
        None
    };
    let of_poisson_ratio = contact.material.compressibility.poisson_ratio().is_some();
    let profile = contact.indenter.axisymmetric();
    match (&contact.layer, &contact.adhesion) {
        (Some(_), Some(_)) => refused(
            &keys::ADHESION,
            "an attraction beside a layer",
            "the springs of an attraction are those of a half-space",
            "remove `[adhesion]`, or `[layer]` where the contact is far smaller than the layer is thick",
        ),
        (Some(_), None) if !of_poisson_ratio => refused(
            &keys::LAYER,
            "a layer of a material with a bulk modulus",
            "a layer is computed with a Poisson ratio that does not depend on time",
            "write `poisson_ratio` in place of `bulk_modulus`",
        ),
        (None, Some(adhesion)) if adhesion.model == AdhesionModel::Dmt => refused(
            &keys::ADHESION,
            "a constant pull beside force curves",
            "it is a limit of `maugis`, which costs no more here",
            "leave out `model`, and give the range of the attraction",
        ),
        (None, Some(_)) if profile.and_then(Axisymmetric::contact_limit_m).is_some() => refused(
            &keys::ADHESION,
            "an attraction under an indenter with a rim",
            "an attraction moves the edge of the contact, and that of this indenter stays where it is",
            "remove `[adhesion]`",
        ),
        _ => Some(()),
    }
}

/// Refuses tables that say nothing of force curves.
fn refuse_beside_curves(root: &mut TableReader<'_>) {
    for (key, because) in [
        (
            &MEASURED_DRIVE,
            "a force curve prescribes its own indentation",
        ),
        (&MODEL_CYCLE, "a force curve has no cycles"),
        (&keys::SOLVER, "springs and steps follow from the curve"),
    ] {
        if let Some(place) = root.key_location(key) {
            let message = format!("`[{}]` beside force curves", key.name);
            let report = root.problems().at(&place, message);
            report.because(because).help("remove this table");
        }
    }
}

fn driven_plan(
    root: &mut TableReader<'_>,
    measured: Option<TableReader<'_>>,
    given: &Given,
) -> Option<IdentifyPlan> {
    let title = root.value(&keys::TITLE);
    let compressibility = root.table(&KNOWN_MATERIAL).and_then(known_material);
    let bodies = bodies_block::read(root);
    let indenter = given.indenter(root);
    if let Some(place) = root.key_location(&PROBE) {
        root.problems()
            .at(&place, "`[instrument]` without force curves")
            .because("tables of cycles and histories are corrected for it already")
            .help("remove this table, or name force curves with `identify.curve`");
    }
    if !root.has(&MEASURED_DRIVE) {
        root.report_absent(&MEASURED_DRIVE);
    }
    let drive = root.table_or(&MEASURED_DRIVE, None, |t| {
        driven(t, bodies.as_ref(), indenter.as_deref()).map(Some)
    });
    let drive = drive.flatten();
    let adhesion = bodies.as_ref().and_then(Bodies::adhesion);
    let is_attracted = adhesion.is_some_and(|plan| plan.model != AdhesionModel::Dmt);
    let measured = measured.and_then(|t| measured_block(t, drive.as_ref(), is_attracted));
    let cycle = root.table_or(&MODEL_CYCLE, IdentifyPlan::CYCLE, |t| block::read(t, None));
    let layer = bodies.as_ref().and_then(|bodies| bodies.layer);
    let default = indenter.as_deref();
    let default = default.map(|indenter| IdentifyPlan::solver(indenter, layer.is_some()));
    let solver = solver_block::read(root, layer.is_some(), default.unwrap_or_default());
    let measured = measured?;
    let bodies = bodies?;
    Some(IdentifyPlan {
        title: title?,
        contact: ContactPlan {
            layer,
            indenter: indenter?,
            adhesion: bodies.adhesion(),
            material: Sought {
                compressibility: compressibility?,
                indenter_material: bodies.indenter_material,
            },
        },
        solver: solver?,
        drive: drive?,
        branches: measured.branches,
        laws: measured.laws,
        samples: measured.samples,
        measurements: measured.measurements,
        data: measured.file,
        approach_zero: measured.approach_zero,
        attraction: measured.attraction,
        columns: measured.columns,
        cycle: cycle?,
    })
}

/// The `[drive]` block: a history where it has segments, an oscillation where not.
fn driven(
    mut table: TableReader<'_>,
    bodies: Option<&Bodies<'_>>,
    indenter: Option<&dyn Indenter>,
) -> Option<Driven> {
    let area_m2 = indenter.and_then(Indenter::period_area_m2);
    if table.has(&SEGMENTS) {
        let pull_off_n = |control| bodies?.pull_off_n(indenter, control);
        return segments_block::read(table, pull_off_n, area_m2).map(Driven::History);
    }
    let attraction = bodies.and_then(|bodies| bodies.attraction.as_ref());
    let pressed = Pressed {
        area_m2,
        is_attracted: attraction.is_some(),
    };
    let own = harmonic_block::read(table, pressed)?;
    let drive = match attraction {
        Some(attraction) => attraction.drive(indenter?, &own)?,
        None => own,
    };
    Some(Driven::Cycles(drive))
}

fn known_material(mut table: TableReader<'_>) -> Option<Compressibility> {
    let problems = table.problems();
    let known = material_block::compressibility(&mut table);
    let place = table.key_location(&BULK_MODULUS);
    table.finish();
    let is_relaxing = |bulk: &Relaxation| !bulk.branches().is_empty();
    match (place, known?) {
        (Some(place), Compressibility::BulkModulus(bulk)) if is_relaxing(&bulk) => {
            problems
                .at(&place, "an unknown material has a bulk modulus that is constant in time")
                .because("what is sought is its modulus in tension, which says nothing beside one that relaxes too")
                .help("write `bulk_modulus = \"3 GPa\"`");
            None
        }
        (_, known) => Some(known),
    }
}

/// What the `[identify]` block says.
struct Measured {
    /// The name of the table.
    file: String,
    measurements: Measurements,
    columns: TableColumns,
    approach_zero: Option<ApproachZero>,
    attraction: SoughtAttraction,
    branches: Option<usize>,
    laws: Option<Vec<Form>>,
    samples: usize,
}

/// The laws of these names that a drive can tell; `None` where a problem was reported.
fn laws_of(
    names: &[String],
    branches: Option<usize>,
    drive: Option<&Driven>,
    (problems, place): (&Problems, &Location),
) -> Option<Vec<Form>> {
    let all = forms(names, branches, MOST_BRANCHES).into_iter();
    // Without an equilibrium modulus the mean load creeps or relaxes without end: no cycle settles.
    let is_history = matches!(drive, Some(Driven::History(_)));
    let all = all.filter(|form| is_history || form.is_solid());
    let all: Vec<Form> = all.collect();
    if all.is_empty() {
        let report = problems.at(place, "this law has no equilibrium modulus");
        report
            .because("under a mean load it creeps without end, and no cycle settles")
            .help("write `kelvin-voigt`, `fractional-zener` or `auto`; a history or a force curve tells such a law");
        return None;
    }
    Some(all)
}

/// What of the attraction is sought; `None` where a problem was reported: without an attraction within a range, or beside keys that it leaves
/// no room for.
fn sought_attraction(
    table: &mut TableReader<'_>,
    is_attracted: bool,
    beside: &[(Option<Location>, &str)],
) -> Option<SoughtAttraction> {
    let problems = table.problems();
    let place = table.key_location(&ATTRACTION);
    let sought: SoughtAttraction = table.value(&ATTRACTION)?;
    if sought == SoughtAttraction::Known {
        return Some(sought);
    }
    let mut beside = (beside.iter()).filter_map(|(place, what)| Some((place.as_ref()?, *what)));
    if let Some((place, what)) = beside.next() {
        let report = problems.at(place, what);
        report.help("leave this key out, or write `attraction = \"known\"`");
        return None;
    }
    if let (Some(place), false) = (place, is_attracted) {
        problems
            .at(&place, "there is no attraction within a range to look for")
            .because("the search goes from the work and the range of [adhesion] on")
            .help("add `[adhesion]` with `work = \"50 mJ/m^2\"` and `range = \"10 nm\"`, or leave this key out");
        return None;
    }
    Some(sought)
}

/// The `[identify]` block: measurements, and how many branches.
fn measured_block(
    mut table: TableReader<'_>,
    drive: Option<&Driven>,
    is_attracted: bool,
) -> Option<Measured> {
    let (folder, problems) = (table.folder(), table.problems());
    let data: Option<Located<String>> = table.read(&DATA);
    let branches = table.value(&IDENTIFY_BRANCHES);
    let approach_zero = table.value(&APPROACH_ZERO);
    let place_of_zero = table.key_location(&APPROACH_ZERO);
    let samples: Option<usize> = table.value(&SAMPLES);
    let draws = samples.is_some_and(|samples| samples > 0);
    let beside = [
        (
            table.key_location(&SAMPLES).filter(|_| draws),
            "no samples are drawn while the attraction is sought",
        ),
        (
            table.key_location(&LAW),
            "laws are not told apart while the attraction is sought",
        ),
    ];
    let attraction = sought_attraction(&mut table, is_attracted, &beside);
    let place_of_laws = table.key_location(&LAW);
    let laws: Option<Option<Vec<String>>> = table.value(&LAW);
    table.finish();
    let (approach_zero, attraction, branches) = (approach_zero?, attraction?, branches?);
    let laws = match (laws?, place_of_laws) {
        (Some(names), Some(place)) => Some(laws_of(&names, branches, drive, (problems, &place))?),
        _ => None,
    };
    if let (Some(place), Some(ApproachZero::Unknown), Some(Driven::History(_))) =
        (place_of_zero, approach_zero, drive)
    {
        let report = problems.at(
            &place,
            "the approach of a history is counted from first touch",
        );
        report.help("subtract its value at first touch, and leave this key out");
        return None;
    }
    let data = data?;
    let file = match data.path_from(folder).is_dir() {
        true => data.map(|folder| Path::new(&folder).join(TABLE).display().to_string()),
        false => data,
    };
    let (name, bytes) = data_file::named(&file, folder, problems)?;
    // Without a drive, which was reported, rows without one of their own mean nothing.
    let (found, columns) = match drive? {
        Driven::Cycles(drive) => {
            let rows = measured_table::parse(&name, &bytes, (*drive, approach_zero));
            let (data, columns) = data_file::accepted(rows, &file, problems)?;
            (Measurements::new(data), columns)
        }
        Driven::History(drive) => {
            let rows = measured_history::parse(&name, &bytes, drive);
            let (rows, columns) = data_file::accepted(rows, &file, problems)?;
            (Measurements::of_history(drive, &rows), columns)
        }
    };
    let measurements = problems.accept(&file, found.map_err(|error| format!("{name}: {error}")))?;
    Some(Measured {
        file: name,
        measurements,
        columns,
        approach_zero,
        attraction,
        branches,
        laws,
        samples: samples?,
    })
}
