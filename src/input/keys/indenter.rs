//! Keys of `[indenter]`: the shape, and what each shape is made of.

use std::ops::RangeInclusive;

use super::{choice, material, rows};
use crate::indenter::{MapEdge, MapQuantity};
use crate::input::document::kind::{
    Array, Choice, Integer, Number, Table, Tables, Text, number, pair, quantity,
};
use crate::input::document::row::{Optional, Or, Others, Required, Row, Rows};
use crate::input::map_values::{HEIGHT_UNITS, MapLevel};
use crate::quantity::Dimension::{Angle, Length};

/// Cells per side of a rough surface.
const ROUGH_CELLS: RangeInclusive<usize> = 8..=4096;
/// TOML has signed integers of 64 bits.
const SEEDS: RangeInclusive<usize> = 0..=i64::MAX as usize;
const LENGTH: Number = quantity(Length).above_zero();
const POSITION: &str = "write one for x and one for y: [\"1 um\", \"0 um\"]";

choice! {
    /// The shape; what it needs is listed below.
    SHAPE = "shape", Shape, BY_SHAPE:
    /// A sphere, as the paraboloid of its radius.
    Sphere = "sphere": &[&RADIUS];
    /// A cone.
    Cone = "cone": &[&HALF_ANGLE];
    /// A flat cylindrical punch.
    FlatPunch = "flat-punch": &[&RADIUS];
    /// An elliptic paraboloid.
    Ellipsoid = "ellipsoid": &[&RADIUS_X, &RADIUS_Y];
    /// gap = height (r / radius)^exponent.
    PowerLaw = "power-law": &[&EXPONENT, &GAP_RADIUS, &GAP_HEIGHT];
    /// A profile of revolution: columns `r_m`, `gap_m`, from the axis outwards.
    Profile = "profile": FILE_KEYS;
    /// A measured surface: a matrix (CSV or `.npy`), or columns `x_m`, `y_m`, `z_m`.
    HeightMap = "height-map": &[&FILE, &SHA256, &MAP_SPACING, &MAP_QUANTITY, &HEIGHT_UNIT, &LEVEL, &EDGE];
    /// Paraboloids side by side.
    Asperities = "asperities": ASPERITIES_KEYS;
    /// A random self-affine surface.
    Rough = "rough": &[
        &ROUGH_SIDE,
        &ROUGH_SPACING,
        &HURST_EXPONENT,
        &RMS_HEIGHT,
        &ROLL_OFF_WAVELENGTH,
        &CUT_OFF_WAVELENGTH,
        &SEED,
        &SPHERE_RADIUS,
        &EDGE,
    ];
}

rows! { _:
    /// Moves the indenter along x and y.
    OFFSET: Row<Array<Number>, Optional> = "offset", pair(quantity(Length), POSITION), Optional;
    /// Material of the indenter; left out: rigid.
    INDENTER_MATERIAL: Row<Table, Optional> = "material", Table(&material::INDENTER_MATERIAL), Optional;
}

pub(super) static INDENTER: Rows = Rows {
    means: " The indenter. Shapes other than convex bodies of revolution need the half-space engine.",
    keys: &[&SHAPE, &OFFSET, &INDENTER_MATERIAL],
    block: &[],
    others: BY_SHAPE,
};

rows! { _:
    /// Name of the indenter in tables and figures.
    INDENTER_NAME: Row<Text, Required> = "name", Text, Required;
}

/// One of several indenters of a sweep.
pub(super) static LISTED_INDENTER: Rows = Rows {
    means: " One of several indenters.",
    keys: &[&INDENTER_NAME, &SHAPE, &OFFSET, &INDENTER_MATERIAL],
    block: &[],
    others: BY_SHAPE,
};

rows! { _:
    /// Radius.
    RADIUS: Row<Number, Required> = "radius", LENGTH, Required;
    /// Angle between axis and flank; 90 deg is a plane.
    HALF_ANGLE: Row<Number, Required> =
        "half_angle", quantity(Angle).above_zero().such_as("\"70 deg\""), Required;
    /// Principal radius of curvature along x.
    RADIUS_X: Row<Number, Required> = "radius_x", LENGTH, Required;
    /// Principal radius of curvature along y.
    RADIUS_Y: Row<Number, Required> = "radius_y", LENGTH, Required;
    /// Exponent of the gap; 2 is a paraboloid.
    EXPONENT: Row<Number, Required> = "exponent", number("4.0"), Required;
    /// Radius at which the gap is `height`.
    GAP_RADIUS: Row<Number, Required> = "radius", LENGTH, Required;
    /// Gap at `radius`.
    GAP_HEIGHT: Row<Number, Required> = "height", LENGTH, Required;
}

rows! { FILE_KEYS:
    /// Data file; its path is relative to this file, in a flag to the working folder.
    FILE: Row<Text, Required> = "file", Text, Required;
    /// SHA-256 of the data file, in hexadecimal, to make sure that it has not changed.
    SHA256: Row<Text, Optional> = "sha256", Text, Optional;
}

rows! { _:
    /// Distance between points of a matrix, or one for x and one for y; not for files with columns `x_m`, `y_m`, `z_m`.
    MAP_SPACING: Row<Array<Number>, Optional> =
        "spacing", Array { entries: 1..=2, ..pair(LENGTH, POSITION) }, Optional;
    /// Whether values are heights, positive towards the half-space, or gaps.
    MAP_QUANTITY: Row<Choice<MapQuantity>, Or<MapQuantity>> =
        "quantity", Choice(MapQuantity::NAMES), Or(MapQuantity::Height);
    /// Unit of the values of a matrix.
    HEIGHT_UNIT: Row<Choice<f64>, Or<f64>> =
        "height_unit", Choice(&HEIGHT_UNITS), Or(HEIGHT_UNITS[0].1);
    /// What is subtracted from the values first: nothing, their mean, or the best-fit plane.
    LEVEL: Row<Choice<MapLevel>, Or<MapLevel>> =
        "level", Choice(MapLevel::NAMES), Or(MapLevel::None);
    /// What lies outside the map: unknown, so the contact must stay within; nothing (`rim`); or periodic repetitions of the map
    /// (`periodic`), under a prescribed load.
    EDGE: Row<Choice<MapEdge>, Or<MapEdge>> =
        "edge", Choice(MapEdge::NAMES), Or(MapEdge::Unknown);
}

/// More asperities than this are a height map.
const MOST_ASPERITIES: usize = 10_000;

rows! { ASPERITIES_KEYS:
    /// The asperities.
    ASPERITY_LIST: Row<Tables, Required> =
        "asperities",
        Tables { rows: &ASPERITY, most: MOST_ASPERITIES, instead: ", or a height map" },
        Required;
}

rows! { ASPERITY_KEYS:
    /// Position of the summit along x and y.
    CENTER: Row<Array<Number>, Required> = "center", pair(quantity(Length), POSITION), Required;
    /// Radius of curvature at the summit.
    ASPERITY_RADIUS: Row<Number, Required> = "radius", LENGTH, Required;
    /// Height of the summit towards the half-space.
    ASPERITY_HEIGHT: Row<Number, Or<f64>> = "height", quantity(Length), Or(0.0);
}

static ASPERITY: Rows = super::table(" One asperity.", ASPERITY_KEYS);

rows! { _:
    /// Points per side.
    ROUGH_SIDE: Row<Integer, Required> = "cells", Integer(ROUGH_CELLS), Required;
    /// Distance between points.
    ROUGH_SPACING: Row<Number, Required> = "spacing", LENGTH, Required;
    /// Hurst exponent of the self-affine spectrum.
    HURST_EXPONENT: Row<Number, Required> = "hurst_exponent", number("0.8"), Required;
    /// Root mean square height.
    RMS_HEIGHT: Row<Number, Required> = "rms_height", LENGTH, Required;
    /// Wavelength above which the spectrum is flat; left out: no such limit.
    ROLL_OFF_WAVELENGTH: Row<Number, Optional> = "roll_off_wavelength", LENGTH, Optional;
    /// Shortest wavelength.
    CUT_OFF_WAVELENGTH: Row<Number, Required> = "cut_off_wavelength", LENGTH, Required;
    /// Seed of the random phases: the same seed gives the same surface.
    SEED: Row<Integer, Required> = "seed", Integer(SEEDS), Required;
    /// Radius of a sphere under the roughness; left out: the surface is nominally flat.
    SPHERE_RADIUS: Row<Number, Optional> = "sphere_radius", LENGTH, Optional;
}
