//! A record as the content of a frame: its numbers as deflated JSON, and its cycle and profiles packed, which are read only where they
//! are asked for.

use std::cell::RefCell;
use std::io::{self, Write};

use flate2::write::DeflateEncoder;
use flate2::{Compression, Decompress, FlushDecompress, Status};
use serde::{Deserialize, Serialize};

use super::packed;
use crate::contact::surface::{Along, PressureLine};
use crate::cycle::Loop;
use crate::sweep::record::{
    CaseRecord, CellLoss, PressureProfile, Quarter, RecordedCycle, SurfaceLoss,
};

/// The numbers of a record without its cycle, at most (bytes); what claims to be longer is damaged.
const LONGEST: usize = 64 << 20;

/// Packs a record: its numbers, and its cycle where it has one.
pub fn pack(record: &CaseRecord) -> Result<Vec<u8>, String> {
    let numbers = serde_json::to_vec(&record.without_cycle()).map_err(|error| error.to_string())?;
    let deflated = deflated(&numbers).map_err(|error| error.to_string())?;
    let cycle = record.result.as_ref().and_then(|result| result.cycle());
    postcard::to_stdvec(&(deflated, cycle.map(packed_cycle))).map_err(|error| error.to_string())
}

thread_local! {
    /// The state of an encoder takes 270 kB, that of a decoder 50 kB: new ones for every record would leave holes in the heap that
    /// nothing else fills.
    static ENCODER: RefCell<DeflateEncoder<Vec<u8>>> =
        RefCell::new(DeflateEncoder::new(Vec::new(), Compression::default()));
    static DECODER: RefCell<Decompress> = RefCell::new(Decompress::new(false));
}

fn deflated(bytes: &[u8]) -> io::Result<Vec<u8>> {
    ENCODER.with_borrow_mut(|encoder| {
        encoder.write_all(bytes)?;
        encoder.reset(Vec::new())
    })
}

/// `None` of bytes that are not deflated, or would be longer than any record.
fn inflated(deflated: &[u8]) -> Option<Vec<u8>> {
    DECODER.with_borrow_mut(|decoder| {
        decoder.reset(false);
        let mut bytes = Vec::with_capacity(8 * deflated.len() + 64);
        loop {
            let rest = deflated.get(decoder.total_in() as usize..)?;
            let ended = decoder.decompress_vec(rest, &mut bytes, FlushDecompress::None);
            match ended.ok()? {
                Status::StreamEnd => return Some(bytes),
                _ if bytes.len() < bytes.capacity() || bytes.len() > LONGEST => return None,
                Status::Ok | Status::BufError => bytes.reserve(bytes.len()),
            }
        }
    })
}

/// The numbers of a packed record; `None` of anything else.
pub fn numbers(packed: &[u8]) -> Option<CaseRecord> {
    let (deflated, _) = postcard::take_from_bytes::<&[u8]>(packed).ok()?;
    serde_json::from_slice(&inflated(deflated)?).ok()
}

/// Gives the numbers of a packed record their cycle, where there is one.
pub fn add_cycle(record: &mut CaseRecord, packed: &[u8]) {
    let cycle = || {
        let (_, cycle) = postcard::take_from_bytes::<&[u8]>(packed).ok()?;
        unpacked_cycle(postcard::from_bytes::<Option<Packed>>(cycle).ok()??)
    };
    if let (Some(result), Some(cycle)) = (&mut record.result, cycle()) {
        result.cycle = cycle;
    }
}

/// A cycle, every series packed: time, load, approach, radius and peak pressure of its samples, profiles, and surface.
type Packed = ([Vec<u8>; 5], Vec<PackedProfile>, PackedSurface);

/// The quarter; time, load, approach and radius; positions and pressures along lines.
type PackedProfile = (Quarter, [f64; 4], Vec<(Along, Values, Values)>);

#[derive(Serialize, Deserialize)]
enum PackedSurface {
    /// Radius and density.
    Radial(Values, Values),
    /// The first cell and the spacing along x and y, cells along x, density.
    Cells([f64; 2], [f64; 2], u64, Vec<u8>),
}

fn packed_cycle(cycle: &RecordedCycle) -> Packed {
    let samples = &cycle.samples;
    let line = |line: &PressureLine| {
        let pressure = Values::of(&line.pressure_pa);
        (line.along, Values::all(&line.position_m), pressure)
    };
    let profile = |profile: &PressureProfile| {
        let instant = [
            profile.time_s,
            profile.load_n,
            profile.approach_m,
            profile.contact_radius_m,
        ];
        (
            profile.quarter,
            instant,
            profile.lines.iter().map(line).collect(),
        )
    };
    (
        [
            packed::doubles(&samples.time_s),
            packed::doubles(&samples.load_n),
            packed::doubles(&samples.approach_m),
            packed::doubles(&samples.contact_radius_m),
            packed::optional_doubles(&samples.peak_pressure_pa),
        ],
        cycle.pressures.iter().map(profile).collect(),
        match &cycle.surface_loss {
            SurfaceLoss::Radial {
                radius_m,
                density_j_per_m2,
            } => PackedSurface::Radial(Values::all(radius_m), Values::of(density_j_per_m2)),
            SurfaceLoss::Cells(cells) => PackedSurface::Cells(
                [cells.first_x_m, cells.first_y_m],
                [cells.spacing_x_m, cells.spacing_y_m],
                cells.cells_x as u64,
                packed::optional_singles(cells.density_j_per_m2.iter().copied().map(Some)),
            ),
        },
    )
}

fn unpacked_cycle((samples, profiles, surface): Packed) -> Option<RecordedCycle> {
    let [
        time_s,
        load_n,
        approach_m,
        contact_radius_m,
        peak_pressure_pa,
    ] = &samples;
    let line = |(along, position, pressure): (Along, Values, Values)| {
        Some(PressureLine {
            along,
            position_m: position.all_unpacked()?,
            pressure_pa: pressure.unpacked()?,
        })
    };
    let profile = |(quarter, instant, lines): PackedProfile| {
        let [time_s, load_n, approach_m, contact_radius_m] = instant;
        Some(PressureProfile {
            quarter,
            time_s,
            load_n,
            approach_m,
            contact_radius_m,
            lines: lines.into_iter().map(line).collect::<Option<_>>()?,
        })
    };
    Some(RecordedCycle {
        samples: Loop {
            time_s: packed::to_doubles(time_s)?,
            load_n: packed::to_doubles(load_n)?,
            approach_m: packed::to_doubles(approach_m)?,
            contact_radius_m: packed::to_doubles(contact_radius_m)?,
            peak_pressure_pa: packed::to_optional_doubles(peak_pressure_pa)?,
        },
        pressures: profiles.into_iter().map(profile).collect::<Option<_>>()?,
        surface_loss: match surface {
            PackedSurface::Radial(radius, density) => SurfaceLoss::Radial {
                radius_m: radius.all_unpacked()?,
                density_j_per_m2: density.unpacked()?,
            },
            PackedSurface::Cells(first_m, spacing_m, cells_x, density) => {
                let density = packed::to_optional_singles(&density)?;
                SurfaceLoss::Cells(CellLoss {
                    first_x_m: first_m[0],
                    first_y_m: first_m[1],
                    spacing_x_m: spacing_m[0],
                    spacing_y_m: spacing_m[1],
                    cells_x: usize::try_from(cells_x).ok()?,
                    density_j_per_m2: density.into_iter().collect::<Option<_>>()?,
                })
            }
        },
    })
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

    fn all_unpacked(&self) -> Option<Vec<f64>> {
        self.unpacked()?.into_iter().collect()
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
