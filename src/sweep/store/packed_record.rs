//! A record as the content of a frame: its numbers as deflated JSON, and its cycle and profiles packed, which are read only where they
//! are asked for.

use std::io::{Read, Write};

use flate2::Compression;
use flate2::read::DeflateDecoder;
use flate2::write::DeflateEncoder;
use serde::{Deserialize, Serialize};

use super::packed;
use crate::contact::surface::{Along, PressureLine};
use crate::cycle::Loop;
use crate::sweep::record::{
    CaseRecord, CellLoss, PressureProfile, Quarter, RecordedCycle, SurfaceLoss,
};

/// The numbers of a record without its cycle, at most (bytes); what claims to be longer is damaged.
const LONGEST: u64 = 64 << 20;

/// Packs a record: its numbers, and its cycle where it has one.
pub fn pack(record: &CaseRecord) -> Result<Vec<u8>, String> {
    let numbers = serde_json::to_vec(&record.without_cycle()).map_err(|error| error.to_string())?;
    let mut deflate = DeflateEncoder::new(Vec::new(), Compression::default());
    let deflated = deflate.write_all(&numbers).and_then(|()| deflate.finish());
    let deflated = deflated.map_err(|error| error.to_string())?;
    let cycle = record.result.as_ref().and_then(|result| result.cycle());
    postcard::to_stdvec(&(deflated, cycle.map(Packed::of))).map_err(|error| error.to_string())
}

/// The numbers of a packed record; `None` of anything else.
pub fn numbers(packed: &[u8]) -> Option<CaseRecord> {
    let (deflated, _) = postcard::take_from_bytes::<&[u8]>(packed).ok()?;
    let mut json = Vec::new();
    let mut inflate = DeflateDecoder::new(deflated).take(LONGEST);
    inflate.read_to_end(&mut json).ok()?;
    serde_json::from_slice(&json).ok()
}

/// The cycle of a packed record; `None` where it has none.
pub fn cycle(packed: &[u8]) -> Option<RecordedCycle> {
    let (_, cycle) = postcard::take_from_bytes::<&[u8]>(packed).ok()?;
    postcard::from_bytes::<Option<Packed>>(cycle)
        .ok()??
        .unpacked()
}

/// A cycle, every series packed.
#[derive(Serialize, Deserialize)]
struct Packed {
    /// Time, load, approach, radius, peak pressure.
    samples: [Vec<u8>; 5],
    pressures: Vec<PackedProfile>,
    surface: PackedSurface,
}

#[derive(Serialize, Deserialize)]
struct PackedProfile {
    quarter: Quarter,
    /// Time, load, approach, radius.
    instant: [f64; 4],
    lines: Vec<(Along, Values, Values)>,
}

#[derive(Serialize, Deserialize)]
enum PackedSurface {
    Radial(Values, Values),
    Cells {
        first_m: [f64; 2],
        spacing_m: [f64; 2],
        cells_x: u64,
        density: Vec<u8>,
    },
}

impl Packed {
    fn of(cycle: &RecordedCycle) -> Self {
        let samples = &cycle.samples;
        Self {
            samples: [
                packed::doubles(&samples.time_s),
                packed::doubles(&samples.load_n),
                packed::doubles(&samples.approach_m),
                packed::doubles(&samples.contact_radius_m),
                packed::optional_doubles(&samples.peak_pressure_pa),
            ],
            pressures: cycle.pressures.iter().map(PackedProfile::of).collect(),
            surface: PackedSurface::of(&cycle.surface_loss),
        }
    }

    fn unpacked(self) -> Option<RecordedCycle> {
        let [
            time_s,
            load_n,
            approach_m,
            contact_radius_m,
            peak_pressure_pa,
        ] = &self.samples;
        let pressures = self.pressures.into_iter();
        Some(RecordedCycle {
            samples: Loop {
                time_s: packed::to_doubles(time_s)?,
                load_n: packed::to_doubles(load_n)?,
                approach_m: packed::to_doubles(approach_m)?,
                contact_radius_m: packed::to_doubles(contact_radius_m)?,
                peak_pressure_pa: packed::to_optional_doubles(peak_pressure_pa)?,
            },
            pressures: pressures
                .map(PackedProfile::unpacked)
                .collect::<Option<_>>()?,
            surface_loss: self.surface.unpacked()?,
        })
    }
}

impl PackedProfile {
    fn of(profile: &PressureProfile) -> Self {
        let line = |line: &PressureLine| {
            let pressure = Values::of(&line.pressure_pa);
            (line.along, Values::all(&line.position_m), pressure)
        };
        Self {
            quarter: profile.quarter,
            instant: [
                profile.time_s,
                profile.load_n,
                profile.approach_m,
                profile.contact_radius_m,
            ],
            lines: profile.lines.iter().map(line).collect(),
        }
    }

    fn unpacked(self) -> Option<PressureProfile> {
        let [time_s, load_n, approach_m, contact_radius_m] = self.instant;
        let line = |(along, position, pressure): &(Along, Values, Values)| {
            Some(PressureLine {
                along: *along,
                position_m: position.unpacked()?.into_iter().collect::<Option<_>>()?,
                pressure_pa: pressure.unpacked()?,
            })
        };
        Some(PressureProfile {
            quarter: self.quarter,
            time_s,
            load_n,
            approach_m,
            contact_radius_m,
            lines: self.lines.iter().map(line).collect::<Option<_>>()?,
        })
    }
}

impl PackedSurface {
    fn of(surface: &SurfaceLoss) -> Self {
        match surface {
            SurfaceLoss::Radial {
                radius_m,
                density_j_per_m2,
            } => Self::Radial(Values::all(radius_m), Values::of(density_j_per_m2)),
            SurfaceLoss::Cells(cells) => Self::Cells {
                first_m: [cells.first_x_m, cells.first_y_m],
                spacing_m: [cells.spacing_x_m, cells.spacing_y_m],
                cells_x: cells.cells_x as u64,
                density: packed::optional_singles(cells.density_j_per_m2.iter().copied().map(Some)),
            },
        }
    }

    fn unpacked(self) -> Option<SurfaceLoss> {
        Some(match self {
            Self::Radial(radius, density) => SurfaceLoss::Radial {
                radius_m: radius.unpacked()?.into_iter().collect::<Option<_>>()?,
                density_j_per_m2: density.unpacked()?,
            },
            Self::Cells {
                first_m: [first_x_m, first_y_m],
                spacing_m: [spacing_x_m, spacing_y_m],
                cells_x,
                density,
            } => SurfaceLoss::Cells(CellLoss {
                first_x_m,
                first_y_m,
                spacing_x_m,
                spacing_y_m,
                cells_x: usize::try_from(cells_x).ok()?,
                density_j_per_m2: packed::to_optional_singles(&density)?
                    .into_iter()
                    .collect::<Option<_>>()?,
            }),
        })
    }
}

/// Numbers of a profile, in as much precision as they have.
#[derive(Serialize, Deserialize)]
enum Values {
    Singles(Vec<u8>),
    Doubles(Vec<u8>),
}

impl Values {
    fn of(values: &[Option<f64>]) -> Self {
        let is_single = |value: &f64| f64::from(*value as f32).to_bits() == value.to_bits();
        match values.iter().flatten().all(is_single) {
            true => {
                let singles = values.iter().map(|value| value.map(|value| value as f32));
                Self::Singles(packed::optional_singles(singles))
            }
            false => Self::Doubles(packed::optional_doubles(values)),
        }
    }

    fn all(values: &[f64]) -> Self {
        Self::of(&values.iter().copied().map(Some).collect::<Vec<_>>())
    }

    fn unpacked(&self) -> Option<Vec<Option<f64>>> {
        match self {
            Self::Doubles(bytes) => packed::to_optional_doubles(bytes),
            Self::Singles(bytes) => {
                let values = packed::to_optional_singles(bytes)?.into_iter();
                Some(values.map(|value| value.map(f64::from)).collect())
            }
        }
    }
}
