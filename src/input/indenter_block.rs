//! The `[indenter]` block of a sweep file.
//!
//! ```text
//! shape = "sphere"        radius
//!         "cone"          half_angle
//!         "flat-punch"    radius
//!         "ellipsoid"     radius_x, radius_y                      principal radii of curvature
//!         "power-law"     exponent, radius, height                gap = height (r / radius)^exponent
//!         "profile"       file                                    columns r_m, gap_m, from the axis outwards
//!         "height-map"    file, spacing                           a matrix (CSV or .npy), or columns x_m, y_m, z_m without
//!                         quantity = "height" | "gap"             spacing; heights are positive towards the half-space
//!                         height_unit = "m" | "um" | ...          of a matrix
//!                         level = "none" | "mean" | "plane"       what is taken off the values
//!                         edge = "unknown" | "rim"
//!         "asperities"    asperities = [{ center, radius, height }, ...]
//!         "rough"         cells, spacing, hurst_exponent, rms_height, cut_off_wavelength, roll_off_wavelength, seed,
//!                         sphere_radius, edge
//! offset = ["1 um", "0 um"]                                       moves any of them
//! ```
//!
//! Paths start from the folder of the sweep file, in a flag from the working folder. `sha256` beside a `file` makes sure that it is still the same one.

use std::path::Path;
use std::sync::Arc;

use super::data_file;
use super::diagnostic::Problems;
use super::document::{Form, Located, TableReader};
use super::field_file;
use crate::indenter::{
    Asperities, Asperity, Cone, DataFile, Ellipsoid, FlatPunch, HEIGHT_UNITS, HeightMap,
    HeightUnit, Indenter, IndenterError, MapEdge, MapLevel, MapQuantity, MapSource, PowerLaw,
    Profile, Rough, Roughness, Shifted, Sphere,
};
use crate::quantity::Dimension;
use crate::sweep::plan::resolved;

#[derive(Debug, Clone, Copy)]
enum Shape {
    Sphere,
    Cone,
    FlatPunch,
    Ellipsoid,
    PowerLaw,
    Profile,
    HeightMap,
    Asperities,
    Rough,
}

const SHAPES: [(&str, Shape); 9] = [
    ("sphere", Shape::Sphere),
    ("cone", Shape::Cone),
    ("flat-punch", Shape::FlatPunch),
    ("ellipsoid", Shape::Ellipsoid),
    ("power-law", Shape::PowerLaw),
    ("profile", Shape::Profile),
    ("height-map", Shape::HeightMap),
    ("asperities", Shape::Asperities),
    ("rough", Shape::Rough),
];

/// More asperities than this are a height map.
const MAX_ASPERITIES: usize = 10_000;
/// The median slope of a map above which it is no surface in contact. Of rough surfaces, paraboloids, punches with walls and maps
/// with 5 % of bad points the median was at most 0.6 (a cone 30 degrees from flat); the same heights in micrometres read as metres
/// gave 2e4 and more. The root mean square is above 1 for walls and bad points, too.
const STEEPEST_MAP: f64 = 1.0;
/// Cells per side of a rough surface.
const ROUGH_CELLS: std::ops::RangeInclusive<usize> = 8..=4096;
/// TOML has signed integers of 64 bits.
const SEEDS: std::ops::RangeInclusive<usize> = 0..=i64::MAX as usize;

/// A shape, or nothing where a problem was reported.
type Made = Option<Arc<dyn Indenter>>;

/// Reads the block; files are looked for in `folder`. `None` where a problem was reported.
pub(super) fn read(table: TableReader<'_>, folder: &Path, problems: &Problems) -> Made {
    let mut block = Block {
        table,
        folder,
        problems,
    };
    let shape = block.table.choice_of("shape", &SHAPES)?;
    let offset = block.offset();
    let made = match shape.value {
        Shape::Sphere => block.single("radius", Dimension::Length, "10 mm", Sphere::new),
        Shape::Cone => block.single("half_angle", Dimension::Angle, "70 deg", Cone::new),
        Shape::FlatPunch => block.single("radius", Dimension::Length, "10 mm", FlatPunch::new),
        Shape::Ellipsoid => block.ellipsoid(&shape),
        Shape::PowerLaw => block.power_law(&shape),
        Shape::Profile => block.profile(),
        Shape::HeightMap => block.height_map(),
        Shape::Asperities => block.asperities(),
        Shape::Rough => block.rough(&shape),
    };
    block.table.finish();
    let (made, offset) = (made?, offset?);
    match offset {
        Some((x_m, y_m)) => {
            let shifted = Shifted::new(made, x_m, y_m);
            let shifted = shifted.map_err(|error| problems.at(&shape, error.to_string()));
            Some(Arc::new(shifted.ok()?))
        }
        None => Some(made),
    }
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
        key: &str,
        dimension: Dimension,
        example: &str,
        make: fn(f64) -> Result<S, IndenterError>,
    ) -> Made {
        let size = self.table.quantity(key, dimension)?;
        let made = make(size.value).map_err(|error| {
            let report = self.problems.at(&size, error.to_string());
            report.help(format!("for example {key} = \"{example}\""));
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

    /// A length above zero.
    fn length(&mut self, key: &str) -> Option<f64> {
        let length = self.table.quantity(key, Dimension::Length)?;
        self.positive(&length)
    }

    /// A length above zero that may be absent: `None` is a problem, `Some(None)` an absent key.
    fn optional_length(&mut self, key: &str) -> Option<Option<f64>> {
        if !self.table.has(key) {
            return Some(None);
        }
        self.length(key).map(Some)
    }

    fn positive(&self, length: &Located<f64>) -> Option<f64> {
        if length.value > 0.0 {
            return Some(length.value);
        }
        self.problems
            .at(length, format!("`{}` must be above zero", length.path));
        None
    }

    /// Two lengths, x and y.
    fn pair(&mut self, key: &str) -> Option<[Located<f64>; 2]> {
        let list = self.table.quantities(key, Dimension::Length)?;
        let count = list.value.len();
        let place = list.location.clone();
        match <[Located<f64>; 2]>::try_from(list.value) {
            Ok(pair) => Some(pair),
            Err(_) => {
                let message = format!("`{}` has {count} entries, not 2", list.path);
                let help = format!("write one for x and one for y: {key} = [\"1 um\", \"0 um\"]");
                self.problems.at(&place, message).help(help);
                None
            }
        }
    }

    /// The offset, where there is one.
    fn offset(&mut self) -> Option<Option<(f64, f64)>> {
        if !self.table.has("offset") {
            return Some(None);
        }
        let [x, y] = self.pair("offset")?;
        Some(Some((x.value, y.value)))
    }

    fn ellipsoid(&mut self, shape: &Located<Shape>) -> Made {
        let (x_m, y_m) = (self.length("radius_x"), self.length("radius_y"));
        self.made(shape, Ellipsoid::new(x_m?, y_m?))
    }

    fn power_law(&mut self, shape: &Located<Shape>) -> Made {
        let exponent = self.table.number("exponent");
        let (radius_m, height_m) = (self.length("radius"), self.length("height"));
        let (exponent, radius_m, height_m) = (exponent?, radius_m?, height_m?);
        match PowerLaw::new(exponent.value, radius_m, height_m) {
            refused @ Err(IndenterError::Exponent { .. }) => self.made(&exponent, refused),
            other => self.made(shape, other),
        }
    }

    fn asperities(&mut self) -> Made {
        let tables = self.table.tables("asperities")?;
        let Located {
            value: tables,
            path,
            location,
        } = tables;
        let place = Located {
            value: (),
            path,
            location,
        };
        if tables.len() > MAX_ASPERITIES {
            let message = format!("{} asperities are too many", tables.len());
            let help = format!("give at most {MAX_ASPERITIES}, or a height map");
            self.problems.at(&place, message).help(help);
            return None;
        }
        let asperity = |table| {
            let mut block = Block {
                table,
                folder: self.folder,
                problems: self.problems,
            };
            let (center, radius_m) = (block.pair("center"), block.length("radius"));
            let height = block.table.quantity_or("height", Dimension::Length, 0.0);
            block.table.finish();
            let [x, y] = center?;
            Some(Asperity {
                center_x_m: x.value,
                center_y_m: y.value,
                radius_m: radius_m?,
                height_m: height?.value,
            })
        };
        // All are read, so that all problems are reported.
        let all: Vec<_> = tables.into_iter().map(asperity).collect();
        let all: Option<Vec<Asperity>> = all.into_iter().collect();
        self.made(&place, Asperities::new(all?))
    }

    fn rough(&mut self, shape: &Located<Shape>) -> Made {
        let cells = self.table.positive_integer("cells", ROUGH_CELLS);
        let spacing_m = self.length("spacing");
        let hurst = self.table.number("hurst_exponent");
        let rms_height_m = self.length("rms_height");
        let roll_off = self.optional_length("roll_off_wavelength");
        let cut_off = self.length("cut_off_wavelength");
        let seed = self.table.positive_integer("seed", SEEDS);
        let sphere = self.optional_length("sphere_radius");
        let edge = self.edge();
        let hurst = hurst?;
        let made = Rough::new(Roughness {
            cells: cells?.value,
            spacing_m: spacing_m?,
            hurst_exponent: hurst.value,
            rms_height_m: rms_height_m?,
            roll_off_wavelength_m: roll_off?,
            cut_off_wavelength_m: cut_off?,
            seed: seed?.value as u64,
            sphere_radius_m: sphere?,
            edge: edge?,
        });
        match made {
            refused @ Err(IndenterError::Hurst { .. }) => self.made(&hurst, refused),
            other => self.made(shape, other),
        }
    }

    fn edge(&mut self) -> Option<MapEdge> {
        let edge = self
            .table
            .choice_of_or("edge", &MapEdge::NAMES, MapEdge::Unknown);
        edge.map(|edge| edge.value)
    }

    /// The bytes under `file`, once they are known to be those of `sha256`.
    fn file(&mut self) -> Option<DataOf<Vec<u8>>> {
        let file = self.table.string("file");
        let sha256 = match self.table.has("sha256") {
            true => Some(self.table.string("sha256")?),
            false => None,
        };
        let file = file?;
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
            source: DataFile {
                file: absolute.to_owned(),
                sha256: hash,
            },
            place: file,
            name,
            data: bytes,
        })
    }

    fn profile(&mut self) -> Made {
        let file = self.file()?;
        let points = field_file::profile(&file.name, &file.data);
        let points = data_file::accepted(points, &file.place, self.problems)?;
        let profile = Profile::new(&points).map(|profile| profile.with_source(file.source));
        self.made(&file.place, profile)
    }

    fn height_map(&mut self) -> Made {
        let quantity =
            self.table
                .choice_of_or("quantity", &MapQuantity::NAMES, MapQuantity::Height);
        let unit = self
            .table
            .choice_of_or("height_unit", &HEIGHT_UNITS, HEIGHT_UNITS[0].1);
        let level = self
            .table
            .choice_of_or("level", &MapLevel::NAMES, MapLevel::None);
        let edge = self.edge();
        let given = self.table.key_location("spacing");
        let unit_given = self.table.key_location("height_unit");
        let file = self.file();
        // Without the file it is not known whether there must be a spacing; one that is there is read all the same.
        let spacing = given.is_some().then(|| self.spacing());
        let file = file?;
        let field = field_file::field(&file.name, &file.data);
        let mut field = data_file::accepted(field, &file.place, self.problems)?;
        let spacing_m = match (field.spacing_m, spacing) {
            (Some(spacing_m), None) => spacing_m,
            (None, Some(spacing_m)) => spacing_m?,
            (None, None) => {
                // Asks for the key, which reports it as missing.
                self.table.quantity("spacing", Dimension::Length);
                return None;
            }
            (Some(_), Some(_)) => {
                let message = "the file gives the place of every point, and with it the spacing";
                let report = self.problems.at(&given?, message);
                report.help("remove `spacing`");
                return None;
            }
        };
        let source = MapSource {
            data: file.source,
            gives_places: field.spacing_m.is_some(),
            height_unit: unit?.value,
            level: level?.value,
        };
        if let (true, Some(place)) = (source.gives_places, unit_given) {
            let message = "the file names its columns, and with them their unit";
            let report = self.problems.at(&place, message);
            report.help("remove `height_unit`");
            return None;
        }
        let per_m = source.height_unit.per_m;
        field.values_m.iter_mut().for_each(|z| *z /= per_m);
        source.level.take_off(field.cells_x, &mut field.values_m);
        let cells = (field.cells_x, field.cells_y);
        let map = HeightMap::new(cells, spacing_m, field.values_m, quantity?.value, edge?);
        if let Ok(map) = &map {
            self.check_slopes(map, &source, &file.place, &file.name)?;
            self.check_border(map, &source, &file.place, &file.name)?;
        }
        self.made(&file.place, map.map(|map| map.with_source(source)))
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

    /// One spacing for both directions, or two.
    fn spacing(&mut self) -> Option<(f64, f64)> {
        if self.table.form("spacing") != Some(Form::Array) {
            return self.length("spacing").map(|both_m| (both_m, both_m));
        }
        let [x, y] = self.pair("spacing")?;
        Some((self.positive(&x)?, self.positive(&y)?))
    }
}

/// Data with the file they came from.
struct DataOf<T> {
    data: T,
    source: DataFile,
    /// Where the sweep file names it.
    place: Located<String>,
    /// What messages call it.
    name: String,
}
