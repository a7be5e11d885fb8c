//! The `[indenter]` block: what each shape is made of, and how it is read.

use std::sync::Arc;

use super::data_file;
use super::diagnostic::{Diagnostics, Location};
use super::document::Located;
use super::document::block::read_from;
use super::document::kind::Describe;
use super::document::reader::TableReader;
use super::field_file;
use super::keys;
use super::keys::material::INDENTER_MATERIAL as INDENTER_MATERIAL_KEYS;
use super::map_values::MapReading;
use super::material_block;
use super::material_table::DirectSum;
use crate::indenter::asperities::{ASPERITY_HEIGHT, ASPERITY_LIST, ASPERITY_RADIUS, CENTER};
use crate::indenter::height_map::{
    EDGE, HEIGHT_UNIT, HEIGHT_UNITS, LEVEL, MAP_QUANTITY, MAP_SPACING,
};
use crate::indenter::shifted::OFFSET;
use crate::indenter::{
    Asperities, Asperity, Cone, ConeKeys, Ellipsoid, FILE, FlatPunch, HeightMap, Indenter,
    IndenterError, PowerLaw, PowerLawKeys, Profile, Roughness, SHA256, Setting, Shifted, Sphere,
    data_file, in_range,
};
use crate::material::Material;
use crate::quantity::block;
use crate::quantity::key::Kind;
use crate::quantity::rows::Rows;
use crate::sweep::plan::resolved;
use contact_dma_core::{choice, keys};

choice! {
    /// The shape; what it needs is listed below.
    SHAPE = "shape", Shape, BY_SHAPE:
    Sphere(Sphere);
    Cone(ConeKeys);
    FlatPunch(FlatPunch);
    Ellipsoid(Ellipsoid);
    PowerLaw(PowerLawKeys);
    /// A profile of revolution: columns `r_m`, `gap_m`, from the axis outwards.
    Profile = "profile": &[&[FILE, SHA256]];
    /// A measured surface: a matrix (CSV or `.npy`), or columns `x_m`, `y_m`, `z_m`.
    HeightMap = "height-map": &[&[FILE, SHA256, MAP_SPACING, MAP_QUANTITY, HEIGHT_UNIT, LEVEL, EDGE]];
    /// Paraboloids side by side.
    Asperities = "asperities": &[&[ASPERITY_LIST]];
    Rough(Roughness);
}

keys! {
    /// Material of the indenter; left out: rigid.
    INDENTER_MATERIAL = "material", Kind::Table(&INDENTER_MATERIAL_KEYS), optional;
    /// Name of the indenter in tables and figures.
    INDENTER_NAME = "name", Kind::Text;
}

pub(super) static INDENTER: Rows = Rows {
    means: " The indenter. Shapes other than convex bodies of revolution need the half-space engine.",
    keys: &[&[SHAPE, OFFSET, INDENTER_MATERIAL]],
    others: BY_SHAPE,
};

/// One of several indenters of a sweep.
pub(super) static LISTED_INDENTER: Rows = Rows {
    means: " One of several indenters.",
    keys: &[&[INDENTER_NAME, SHAPE, OFFSET, INDENTER_MATERIAL]],
    others: BY_SHAPE,
};

/// A shape, or nothing where a problem was reported.
type Made = Option<Arc<dyn Indenter>>;

/// Reads the block; `None` where a problem was reported.
pub(super) fn read(table: TableReader<'_>) -> Made {
    let mut block = Block(table);
    let shape: Located<Shape> = block.0.read(&SHAPE)?;
    let offset: Option<Option<Vec<f64>>> = block.0.value(&OFFSET);
    // Read by itself, with the material that it is pressed against.
    block.0.has(&INDENTER_MATERIAL);
    let made = match shape.value {
        Shape::Sphere => block.of_keys(&shape, in_range::<Sphere>),
        Shape::Cone => block.of_keys(&shape, Cone::of),
        Shape::FlatPunch => block.of_keys(&shape, in_range::<FlatPunch>),
        Shape::Ellipsoid => block.of_keys(&shape, in_range::<Ellipsoid>),
        Shape::PowerLaw => block.of_keys(&shape, PowerLaw::of),
        Shape::Profile => block.profile(),
        Shape::HeightMap => block.height_map(),
        Shape::Asperities => block.asperities(),
        Shape::Rough => block.of_keys(&shape, |roughness: Roughness| roughness.map()),
    };
    let problems = block.0.problems();
    block.0.finish();
    let (made, offset) = (made?, offset?);
    match offset.as_deref() {
        Some(&[x_m, y_m]) => {
            let shifted = problems.accept(&shape, Shifted::new(made, x_m, y_m))?;
            Some(Arc::new(shifted))
        }
        _ => Some(made),
    }
}

/// What the indenter of a document is made of, where it is not rigid; `None` where a problem was reported.
pub(super) fn material(root: &mut TableReader<'_>) -> Option<Option<Located<Material>>> {
    match root.parsed(&keys::INDENTER) {
        Some(_) => material_of(root.table(&keys::INDENTER)?),
        None => Some(None),
    }
}

/// The same of such a block.
pub(super) fn material_of(mut table: TableReader<'_>) -> Option<Option<Located<Material>>> {
    let problems = table.problems();
    table.table_or(&INDENTER_MATERIAL, None, |block| {
        let read = material_block::read_over(block, DirectSum::Refused, None);
        let material = material_block::series_of(read?.0)?;
        let checked = problems.accept(&material, material.value.contact_compliance());
        if !(material.value.origin.replicas.is_empty()
            && material.value.origin.alternatives.is_empty())
        {
            problems
                .at(
                    &material,
                    "what the data of an indenter's material leave open is not carried through",
                )
                .help("leave out `replicas` and `alternative`");
            return None;
        }
        checked.map(|_| Some(material))
    })
}

/// The block of a shape.
struct Block<'a>(TableReader<'a>);

impl Block<'_> {
    /// A shape made of the keys of a block; where one of them is refused, that is told at its place.
    fn of_keys<B: block::Block, S: Indenter + 'static>(
        &mut self,
        shape: &Located<Shape>,
        make: fn(B) -> Result<S, IndenterError>,
    ) -> Made {
        let made = make(read_from(&mut self.0, None)?);
        let refused = made.as_ref().err().and_then(IndenterError::key);
        let key = refused.and_then(|name| B::KEYS.iter().find(|key| key.name == name));
        let place = key.and_then(|key| self.0.value_place(key.name));
        let (Err(error), Some(key), Some(place)) = (&made, key, place) else {
            return self.made(shape, made);
        };
        let report = self.0.problems().at(&place, error.to_string());
        report.help(format!("for example {} = {}", key.name, key.kind.example()));
        None
    }

    /// A shape, or its refusal reported at this place.
    fn made<S: Indenter + 'static>(
        &self,
        place: &impl AsRef<Location>,
        shape: Result<S, IndenterError>,
    ) -> Made {
        Some(Arc::new(self.0.problems().accept(place, shape)?))
    }

    fn asperities(&mut self) -> Made {
        let all = self.0.tables(&ASPERITY_LIST, |mut table| {
            let center: Option<Vec<f64>> = table.value(&CENTER);
            let radius_m = table.value(&ASPERITY_RADIUS);
            let height_m = table.value(&ASPERITY_HEIGHT);
            table.finish();
            let [center_x_m, center_y_m] = center?.try_into().ok()?;
            Some(Asperity {
                center_x_m,
                center_y_m,
                radius_m: radius_m?,
                height_m: height_m?,
            })
        })?;
        let asperities = Asperities::new(all.value.clone());
        self.made(&all, asperities)
    }

    /// What is made of the bytes under `file`, once they are known to be those of `sha256`.
    fn of_file<T>(
        &mut self,
        make: impl FnOnce(&str, &[u8]) -> Result<T, Diagnostics>,
    ) -> Option<(T, Named)> {
        let file: Option<Located<String>> = self.0.read(&FILE);
        let sha256: Option<Option<Located<String>>> = self.0.read_if(&SHA256);
        let (place, sha256) = (file?, sha256?);
        let problems = self.0.problems();
        let (name, bytes) = data_file::named(&place, self.0.folder(), problems)?;
        let hash = resolved::hash_of_bytes(&bytes);
        if let Some(expected) = sha256
            && !expected.value.eq_ignore_ascii_case(&hash)
        {
            let message = format!("`{name}` is not the file it was");
            problems
                .at(&expected, message)
                .because(format!("its SHA-256 now is {hash}"))
                .label(&place, "the file")
                .help("bring the old file back, or remove `sha256` to use the new one");
            return None;
        }
        let Some(absolute) = place.absolute_from(self.0.folder()) else {
            let message = format!("the path of `{name}` is not UTF-8, and cannot be written down");
            problems.at(&place, message).help("rename the folder");
            return None;
        };
        let source = data_file(&absolute, &hash);
        let made = data_file::accepted(make(&name, &bytes), &place, problems)?;
        let named = Named {
            place,
            name,
            source,
        };
        Some((made, named))
    }

    fn profile(&mut self) -> Made {
        let (points, file) = self.of_file(field_file::profile)?;
        let profile = Profile::new(&points).map(|profile| profile.made_from(file.source));
        self.made(&file.place, profile)
    }

    fn height_map(&mut self) -> Made {
        let problems = self.0.problems();
        let quantity = self.0.value(&MAP_QUANTITY);
        let unit = self.0.chosen(&HEIGHT_UNIT, &HEIGHT_UNITS);
        let level = self.0.value(&LEVEL);
        let edge = self.0.value(&EDGE);
        let given = self.0.key_location(&MAP_SPACING);
        let unit_given = self.0.key_location(&HEIGHT_UNIT);
        let spacing: Option<Option<Vec<f64>>> = self.0.value(&MAP_SPACING);
        let data = self.of_file(field_file::field);
        let (mut field, named) = data?;
        let spacing_m = match (field.spacing_m, spacing?) {
            (Some(spacing_m), None) => spacing_m,
            (None, Some(each)) => (*each.first()?, *each.last()?),
            (None, None) => {
                self.0.report_absent(&MAP_SPACING);
                return None;
            }
            (Some(_), Some(_)) => {
                let message = "the file gives the place of every point, and with it the spacing";
                problems.at(&given?, message).help("remove `spacing`");
                return None;
            }
        };
        let reading = MapReading {
            gives_places: field.spacing_m.is_some(),
            unit_per_m: unit??,
            level: level?,
        };
        if let (true, Some(unit)) = (reading.gives_places, unit_given) {
            let message = "the file names its columns, and with them their unit";
            problems.at(&unit, message).help("remove `height_unit`");
            return None;
        }
        let values_m = &mut field.values_m;
        values_m.iter_mut().for_each(|z| *z /= reading.unit_per_m);
        reading.level.subtract(field.cells_x, values_m);
        let (cells, quantity, edge) = ((field.cells_x, field.cells_y), quantity?, edge?);
        let map = HeightMap::new(cells, spacing_m, field.values_m, quantity, edge);
        if let Ok(map) = &map
            && let Some((message, because, help)) = reading.refusal(map, &named.name)
        {
            let report = problems.at(&named.place, message);
            report.because(because).help(help);
            return None;
        }
        let map = map.map(|map| {
            let mut parameters = named.source;
            let own = map.parameters().into_iter();
            parameters.extend(own.filter_map(|own| reading.parameter(own)));
            map.made_from(HeightMap::SHAPE, parameters)
        });
        self.made(&named.place, map)
    }
}

/// Where data come from.
struct Named {
    /// Where the sweep file names them.
    place: Located<String>,
    /// What messages call them.
    name: String,
    /// The settings that name the file.
    source: Vec<Setting>,
}
