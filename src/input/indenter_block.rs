//! The `[indenter]` block of a sweep file.

use std::path::Path;
use std::sync::Arc;

use super::data_file;
use super::diagnostic::Problems;
use super::document::kind::{Describe, Scalar};
use super::document::reader::TableReader;
use super::document::row::{Required, Row};
use super::document::{Located, plain};
use super::field_file;
use super::field_file::Field;
use super::keys;
use super::keys::indenter::{
    ASPERITY_HEIGHT, ASPERITY_LIST, ASPERITY_RADIUS, CENTER, CUT_OFF_WAVELENGTH, EDGE, EXPONENT,
    FILE, GAP_HEIGHT, GAP_RADIUS, HALF_ANGLE, HEIGHT_UNIT, HURST_EXPONENT, INDENTER_MATERIAL,
    LEVEL, MAP_QUANTITY, MAP_SPACING, OFFSET, RADIUS, RADIUS_X, RADIUS_Y, RMS_HEIGHT,
    ROLL_OFF_WAVELENGTH, ROUGH_SIDE, ROUGH_SPACING, SEED, SHA256, SHAPE, SPHERE_RADIUS, Shape,
};
use super::material_block;
use super::material_table::DirectSum;
use crate::indenter::{
    Asperities, Asperity, Cone, DataFile, Ellipsoid, FlatPunch, HEIGHT_UNITS, HeightMap,
    HeightUnit, Indenter, IndenterError, MapEdge, MapLevel, MapSource, PowerLaw, Profile, Rough,
    Roughness, Shifted, Sphere,
};
use crate::material::Material;
use crate::sweep::plan::resolved;

/// The median slope of a map above which it is no surface in contact. Of rough surfaces, paraboloids, punches with walls and maps
/// with 5 % of bad points the median was at most 0.6 (a cone 30 degrees from flat); the same heights in micrometres read as metres
/// gave 2e4 and more. The root mean square is above 1 for walls and bad points, too.
const STEEPEST_MAP: f64 = 1.0;

/// A shape, or nothing where a problem was reported.
type Made = Option<Arc<dyn Indenter>>;

/// Reads the block; files are looked for in `folder`. `None` where a problem was reported.
pub(super) fn read(table: TableReader<'_>, folder: &Path, problems: &Problems) -> Made {
    let mut block = Block {
        table,
        folder,
        problems,
    };
    let shape = block.table.read(&SHAPE)?;
    let offset = block.table.value(&OFFSET);
    // Read by itself, with the material that it is pressed against.
    block.table.has(&INDENTER_MATERIAL);
    let made = match shape.value {
        Shape::Sphere => block.single(&RADIUS, Sphere::new),
        Shape::Cone => block.single(&HALF_ANGLE, Cone::new),
        Shape::FlatPunch => block.single(&RADIUS, FlatPunch::new),
        Shape::Ellipsoid => block.ellipsoid(&shape),
        Shape::PowerLaw => block.power_law(&shape),
        Shape::Profile => block.profile(),
        Shape::HeightMap => block.height_map(),
        Shape::Asperities => block.asperities(),
        Shape::Rough => block.rough(&shape),
    };
    block.table.finish();
    let (made, offset) = (made?, offset?);
    match offset.map(plain).as_deref() {
        Some(&[x_m, y_m]) => {
            let shifted = Shifted::new(made, x_m, y_m);
            let shifted = shifted.map_err(|error| problems.at(&shape, error.to_string()));
            Some(Arc::new(shifted.ok()?))
        }
        _ => Some(made),
    }
}

/// A height map of values in memory, which are called by their place; the table has the other keys of the block.
pub(super) fn map_of(
    table: TableReader<'_>,
    folder: &Path,
    problems: &Problems,
    (place, field): (Located<String>, Field),
) -> Option<HeightMap> {
    let mut block = Block {
        table,
        folder,
        problems,
    };
    block.table.read(&SHAPE)?;
    let data = DataOf {
        data: field,
        source: None,
        place,
        name: "array".to_owned(),
    };
    let (place, map) = block.map(|_| Some(data))?;
    block.table.finish();
    let refused = |error: IndenterError| {
        problems.at(&place, error.to_string());
    };
    map.map_err(refused).ok()
}

/// What the indenter of a document is made of, where it is not rigid; `None` where a problem was reported.
pub(super) fn material(
    root: &mut TableReader<'_>,
    folder: &Path,
    problems: &Problems,
) -> Option<Option<Located<Material>>> {
    match root.parsed(&keys::INDENTER) {
        Some(_) => material_of(root.table(&keys::INDENTER)?, folder, problems),
        None => Some(None),
    }
}

/// The same of such a block.
pub(super) fn material_of(
    mut table: TableReader<'_>,
    folder: &Path,
    problems: &Problems,
) -> Option<Option<Located<Material>>> {
    table.table_or(&INDENTER_MATERIAL, None, |block| {
        let read = material_block::read_over(block, folder, DirectSum::Refused, None, problems);
        let material = material_block::series_of(read?.0)?;
        let checked = material.value.contact_compliance().map_err(|error| {
            problems.at(&material, error.to_string());
        });
        if !(material.value.replicas().is_empty() && material.value.alternatives().is_empty()) {
            problems
                .at(
                    &material,
                    "what the data of an indenter's material leave open is not carried through",
                )
                .help("leave out `replicas` and `alternative`");
            return None;
        }
        checked.ok().map(|_| Some(material))
    })
}

struct Block<'a> {
    table: TableReader<'a>,
    folder: &'a Path,
    problems: &'a Problems,
}

impl Block<'_> {
    /// A shape made of one number.
    fn single<S: Indenter + 'static>(
        &mut self,
        row: &Row<Scalar, Required>,
        make: fn(f64) -> Result<S, IndenterError>,
    ) -> Made {
        let size = self.table.read(row)?;
        let made = make(size.value).map_err(|error| {
            let report = self.problems.at(&size, error.to_string());
            report.help(format!("for example {} = {}", row.name, row.kind.example()));
        });
        Some(Arc::new(made.ok()?))
    }

    /// A shape, or its refusal reported at this place.
    fn made<S: Indenter + 'static, P>(
        &self,
        place: &Located<P>,
        shape: Result<S, IndenterError>,
    ) -> Made {
        match shape {
            Ok(shape) => Some(Arc::new(shape)),
            Err(error) => {
                self.problems.at(place, error.to_string());
                None
            }
        }
    }

    fn ellipsoid(&mut self, shape: &Located<Shape>) -> Made {
        let (x_m, y_m) = (self.table.value(&RADIUS_X), self.table.value(&RADIUS_Y));
        self.made(shape, Ellipsoid::new(x_m?, y_m?))
    }

    fn power_law(&mut self, shape: &Located<Shape>) -> Made {
        let exponent = self.table.read(&EXPONENT);
        let (radius_m, height_m) = (self.table.value(&GAP_RADIUS), self.table.value(&GAP_HEIGHT));
        let (exponent, radius_m, height_m) = (exponent?, radius_m?, height_m?);
        match PowerLaw::new(exponent.value, radius_m, height_m) {
            refused @ Err(IndenterError::Exponent { .. }) => self.made(&exponent, refused),
            other => self.made(shape, other),
        }
    }

    fn asperities(&mut self) -> Made {
        let all = self.table.tables(&ASPERITY_LIST, |mut table| {
            let (center, radius_m) = (table.value(&CENTER), table.value(&ASPERITY_RADIUS));
            let height_m = table.value(&ASPERITY_HEIGHT);
            table.finish();
            let [center_x_m, center_y_m] = plain(center?).try_into().ok()?;
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

    fn rough(&mut self, shape: &Located<Shape>) -> Made {
        let table = &mut self.table;
        let (cells, spacing_m) = (table.value(&ROUGH_SIDE), table.value(&ROUGH_SPACING));
        let (hurst, rms_height_m) = (table.read(&HURST_EXPONENT), table.value(&RMS_HEIGHT));
        let roll_off = table.value(&ROLL_OFF_WAVELENGTH);
        let cut_off = table.value(&CUT_OFF_WAVELENGTH);
        let (seed, sphere) = (table.value(&SEED), table.value(&SPHERE_RADIUS));
        let edge = table.value(&EDGE);
        let hurst = hurst?;
        let made = Rough::new(Roughness {
            cells: cells?,
            spacing_m: spacing_m?,
            hurst_exponent: hurst.value,
            rms_height_m: rms_height_m?,
            roll_off_wavelength_m: roll_off?,
            cut_off_wavelength_m: cut_off?,
            seed: seed? as u64,
            sphere_radius_m: sphere?,
            edge: edge?,
        });
        match made {
            refused @ Err(IndenterError::Hurst { .. }) => self.made(&hurst, refused),
            other => self.made(shape, other),
        }
    }

    /// The bytes under `file`, once they are known to be those of `sha256`.
    fn file(&mut self) -> Option<DataOf<Vec<u8>>> {
        let (file, sha256) = (self.table.read(&FILE), self.table.read(&SHA256));
        let (file, sha256) = (file?, sha256?);
        let path = file.path_from(self.folder);
        let (name, bytes) = data_file::named(&file, self.folder, self.problems)?;
        let hash = resolved::hash_of_bytes(&bytes);
        if let Some(expected) = sha256
            && !expected.value.eq_ignore_ascii_case(&hash)
        {
            let message = format!("`{name}` is not the file it was");
            self.problems
                .at(&expected, message)
                .because(format!("its SHA-256 now is {hash}"))
                .label(&file, "the file")
                .help("bring the old file back, or remove `sha256` to use the new one");
            return None;
        }
        let absolute = std::path::absolute(&path).ok();
        let Some(absolute) = absolute.as_deref().and_then(Path::to_str) else {
            let message = format!("the path of `{name}` is not UTF-8, and cannot be written down");
            self.problems.at(&file, message).help("rename the folder");
            return None;
        };
        Some(DataOf {
            source: Some(DataFile {
                file: absolute.to_owned(),
                sha256: hash,
            }),
            place: file,
            name,
            data: bytes,
        })
    }

    fn profile(&mut self) -> Made {
        let file = self.file()?;
        let points = field_file::profile(&file.name, &file.data);
        let points = data_file::accepted(points, &file.place, self.problems)?;
        let profile = Profile::new(&points).map(|profile| match file.source {
            Some(source) => profile.with_source(source),
            None => profile,
        });
        self.made(&file.place, profile)
    }

    fn height_map(&mut self) -> Made {
        let (place, map) = self.map(|block| {
            let file = block.file()?;
            let field = field_file::field(&file.name, &file.data);
            let data = data_file::accepted(field, &file.place, block.problems)?;
            Some(DataOf {
                data,
                source: file.source,
                place: file.place,
                name: file.name,
            })
        })?;
        self.made(&place, map)
    }

    /// A map of these data, and where they are named.
    fn map(
        &mut self,
        data: impl FnOnce(&mut Self) -> Option<DataOf<Field>>,
    ) -> Option<(Located<String>, Result<HeightMap, IndenterError>)> {
        let quantity = self.table.value(&MAP_QUANTITY);
        let (unit, level) = (self.table.value(&HEIGHT_UNIT), self.table.value(&LEVEL));
        let edge = self.table.value(&EDGE);
        let given = self.table.key_location(&MAP_SPACING);
        let unit_given = self.table.key_location(&HEIGHT_UNIT);
        let (spacing, data) = (self.table.value(&MAP_SPACING), data(self));
        let DataOf {
            data: mut field,
            source: file,
            place,
            name,
        } = data?;
        let spacing_m = match (field.spacing_m, spacing?) {
            (Some(spacing_m), None) => spacing_m,
            (None, Some(each)) => (each.first()?.value, each.last()?.value),
            (None, None) => {
                self.table.report_absent(&MAP_SPACING);
                return None;
            }
            (Some(_), Some(_)) => {
                let message = "the file gives the place of every point, and with it the spacing";
                let report = self.problems.at(&given?, message);
                report.help("remove `spacing`");
                return None;
            }
        };
        let is_file = file.is_some();
        let source = MapSource {
            data: file.unwrap_or_else(|| DataFile {
                file: String::new(),
                sha256: String::new(),
            }),
            gives_places: field.spacing_m.is_some(),
            height_unit: unit?,
            level: level?,
        };
        if let (true, Some(unit)) = (source.gives_places, unit_given) {
            let message = "the file names its columns, and with them their unit";
            let report = self.problems.at(&unit, message);
            report.help("remove `height_unit`");
            return None;
        }
        let per_m = source.height_unit.per_m;
        field.values_m.iter_mut().for_each(|z| *z /= per_m);
        source.level.take_off(field.cells_x, &mut field.values_m);
        let cells = (field.cells_x, field.cells_y);
        let map = HeightMap::new(cells, spacing_m, field.values_m, quantity?, edge?);
        if let Ok(map) = &map {
            self.check_slopes(map, &source, &place, &name)?;
            self.check_border(map, &source, &place, &name)?;
        }
        let map = match is_file {
            true => map.map(|map| map.with_source(source)),
            false => map,
        };
        Some((place, map))
    }

    /// Refuses a map that is steep all over: its heights are in another unit than they are read in, or it is tilted.
    fn check_slopes(
        &self,
        map: &HeightMap,
        source: &MapSource,
        place: &Located<String>,
        name: &str,
    ) -> Option<()> {
        let slope = map.median_slope();
        if slope <= STEEPEST_MAP {
            return Some(());
        }
        let message = format!("`{name}`: half of the map is steeper than {slope:.1e}");
        let read_in = source.height_unit;
        let because = format!(
            "contact is computed for slopes far below 1; heights are read in {}",
            read_in.name
        );
        let is_cure = |unit: &HeightUnit| slope * read_in.per_m / unit.per_m <= STEEPEST_MAP;
        let named = HEIGHT_UNITS.iter().filter(|(key, unit)| *key == unit.name);
        let units: Vec<String> = named
            .filter(|(_, unit)| is_cure(unit))
            .map(|(key, _)| format!("height_unit = \"{key}\""))
            .collect();
        let tilted = map.without_plane().median_slope() <= STEEPEST_MAP;
        let help = match (tilted, source.gives_places) {
            (true, _) => "if the map is tilted, write level = \"plane\"".to_owned(),
            (_, true) => "convert the column z_m to metres".to_owned(),
            _ if units.is_empty() => "check heights and `spacing`".to_owned(),
            _ => format!(
                "write the unit that the heights are in, {}, and check `spacing`",
                units.join(" or ")
            ),
        };
        self.problems.at(place, message).because(because).help(help);
        None
    }

    /// Refuses a map whose contact begins where its data end.
    fn check_border(
        &self,
        map: &HeightMap,
        source: &MapSource,
        place: &Located<String>,
        name: &str,
    ) -> Option<()> {
        let (MapEdge::Unknown, Some((column, row))) = (map.edge(), map.touches_at_border()) else {
            return Some(());
        };
        let message =
            format!("`{name}`: the map touches first on its border, at column {column}, row {row}");
        let tilted =
            source.level != MapLevel::Plane && map.without_plane().touches_at_border().is_none();
        let help = match tilted {
            true => "if the map is tilted, write level = \"plane\"",
            false => {
                "give a map that reaches further, or edge = \"rim\" where the indenter ends there"
            }
        };
        let because = "beyond the border the shape is not known";
        self.problems.at(place, message).because(because).help(help);
        None
    }
}

/// Data with the file they came from, where there is one.
struct DataOf<T> {
    data: T,
    source: Option<DataFile>,
    /// Where the sweep file names it.
    place: Located<String>,
    /// What messages call it.
    name: String,
}
