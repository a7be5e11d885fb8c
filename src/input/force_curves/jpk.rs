//! Force curves and maps of JPK (`.jpk-force`, `.jpk-force-map`): a ZIP archive with a folder for every curve, in it one for every segment,
//! in that the raw numbers of every channel; properties say what makes numbers of them.
//!
//! A channel is big-endian integers or floats. Its encoder makes volts or metres of them, and a chain of conversions, each linear, what
//! else the instrument was calibrated for: `distance`, `force`.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::io::{Cursor, Read as _};

use zip::ZipArchive;

use super::{of_cantilever, stem};
use crate::force_curve::ForceCurve;
use crate::force_curve::resolved::Probe;
use crate::input::diagnostic::Diagnostic;

/// Most bytes that a file in the archive may have, unpacked, and most curves.
const MOST_BYTES: u64 = 64_000_000;
const MOST_CURVES: usize = 100_000;

/// Channels of the height, the best first: what was measured before what was asked for.
const HEIGHTS: [&str; 4] = [
    "capacitiveSensorHeight",
    "strainGaugeHeight",
    "measuredHeight",
    "height",
];

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

/// The archive, where the bytes are one of JPK.
pub(super) fn archive(bytes: &[u8]) -> Option<Archive<'_>> {
    let archive = ZipArchive::new(Cursor::new(bytes)).ok()?;
    let is_jpk = archive.index_for_name("header.properties").is_some();
    is_jpk.then_some(archive)
}

/// Keys and values, as Java writes them.
#[derive(Default)]
struct Properties(HashMap<String, String>);

impl Properties {
    fn of(text: &str) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let pairs = lines.filter_map(|line| line.split_once('='));
        Self(
            pairs
                .map(|(key, value)| (key.to_owned(), value.trim().to_owned()))
                .collect(),
        )
    }

    fn text(&self, key: &str) -> Option<&str> {
        self.0.get(key).map(String::as_str)
    }

    fn number(&self, key: &str) -> Option<f64> {
        self.text(key)?
            .parse()
            .ok()
            .filter(|number: &f64| number.is_finite())
    }

    /// Offset and multiplier of a linear scaling.
    fn scaling(&self, key: &str) -> Option<(f64, f64)> {
        let part = |name: &str| self.number(&format!("{key}.scaling.{name}"));
        Some((part("offset")?, part("multiplier")?))
    }
}

/// What makes numbers of the raw ones of a channel.
struct Channel<'a> {
    properties: &'a Properties,
    /// What its keys begin with.
    prefix: String,
}

impl Channel<'_> {
    /// Offset and multiplier from raw numbers to a conversion, or to the encoder's own unit where there is no such conversion below it.
    fn scaling(&self, conversion: &str) -> Option<(f64, f64)> {
        let set = format!("{}.conversion-set.conversion", self.prefix);
        let mut chain = Vec::new();
        let mut slot = conversion.to_owned();
        while let Some(scaling) = self.properties.scaling(&format!("{set}.{slot}")) {
            chain.push(scaling);
            let base = self
                .properties
                .text(&format!("{set}.{slot}.base-calibration-slot"))?;
            // A chain that comes back to itself is broken.
            if base == slot || chain.len() > 10 {
                return None;
            }
            slot = base.to_owned();
        }
        let encoder = self.properties.scaling(&format!("{}.encoder", self.prefix));
        let first = encoder.unwrap_or((0.0, 1.0));
        Some(
            chain
                .iter()
                .rev()
                .fold(first, |(offset, factor), (more, times)| {
                    (more + times * offset, times * factor)
                }),
        )
    }

    /// Whether the instrument was calibrated for a conversion.
    fn has(&self, conversion: &str) -> bool {
        let set = format!("{}.conversion-set.conversion.{conversion}", self.prefix);
        self.properties.scaling(&set).is_some()
    }

    /// The conversion that the instrument shows.
    fn shown(&self) -> &str {
        let key = format!("{}.conversion-set.conversions.default", self.prefix);
        self.properties.text(&key).unwrap_or("")
    }

    /// Numbers of the bytes of its file.
    fn raw(&self, bytes: &[u8]) -> Option<Vec<f64>> {
        let kind = |key: &str| self.properties.text(&format!("{}.{key}", self.prefix));
        let numbers: Vec<f64> = match (kind("type")?, kind("encoder.type").unwrap_or("")) {
            ("float-data", _) => words(bytes, f32::from_be_bytes).map(f64::from).collect(),
            ("double-data", _) => words(bytes, f64::from_be_bytes).collect(),
            ("short-data", "unsignedshort" | "unsignedshort-limited") => {
                words(bytes, u16::from_be_bytes).map(f64::from).collect()
            }
            ("short-data", _) => words(bytes, i16::from_be_bytes).map(f64::from).collect(),
            ("integer-data", "unsignedinteger" | "unsignedinteger-limited") => {
                words(bytes, u32::from_be_bytes).map(f64::from).collect()
            }
            ("integer-data", _) => words(bytes, i32::from_be_bytes).map(f64::from).collect(),
            _ => return None,
        };
        Some(numbers)
    }
}

fn words<const N: usize, T>(bytes: &[u8], of: fn([u8; N]) -> T) -> impl Iterator<Item = T> {
    bytes.as_chunks::<N>().0.iter().map(move |word| of(*word))
}

/// A file of the archive, as far as it is not larger than any that instruments write.
fn bytes(archive: &mut Archive<'_>, name: &str) -> Option<Vec<u8>> {
    let mut file = archive.by_name(name).ok()?;
    let mut bytes = Vec::new();
    file.by_ref()
        .take(MOST_BYTES)
        .read_to_end(&mut bytes)
        .ok()?;
    Some(bytes)
}

fn properties(archive: &mut Archive<'_>, name: &str) -> Option<Properties> {
    let bytes = bytes(archive, name)?;
    Some(Properties::of(&String::from_utf8_lossy(&bytes)))
}

/// All curves of an archive that messages call `name`.
///
/// # Errors
/// No curves; a curve without height or deflection, or without a calibration.
pub(super) fn parse(
    name: &str,
    mut archive: Archive<'_>,
    probe: &Probe,
) -> Result<Vec<ForceCurve>, Diagnostic> {
    let shared = properties(&mut archive, "shared-data/header.properties").unwrap_or_default();
    // Segments by their curve: `index/3/` in a map, nothing otherwise.
    let mut curves: BTreeMap<(u64, String), BTreeSet<u64>> = BTreeMap::new();
    for file in archive.file_names().flatten() {
        let Some((curve, rest)) = file.split_once("segments/") else {
            continue;
        };
        let segment = rest
            .split('/')
            .next()
            .and_then(|number| number.parse().ok());
        let number = curve.trim_end_matches('/').rsplit('/').next();
        let number = number.and_then(|number| number.parse().ok()).unwrap_or(0);
        if let Some(segment) = segment {
            let curve = curves.entry((number, curve.to_owned())).or_default();
            curve.insert(segment);
        }
    }
    let refused =
        |why: String, help: &str| Diagnostic::new(format!("`{name}`: {why}")).help(help.to_owned());
    if curves.is_empty() || curves.len() > MOST_CURVES {
        let why = format!("{} force curves in it", curves.len());
        return Err(refused(why, "name an archive of force curves of JPK"));
    }
    let many = curves.len() > 1;
    let mut all = Vec::with_capacity(curves.len());
    for ((number, folder), segments) in curves {
        let called = match many {
            true => format!("{}-{number}", stem(name)),
            false => stem(name),
        };
        let mut curve = segments_of(&mut archive, &shared, &folder, &segments)
            .and_then(|raw| raw.curve(called, probe))
            .map_err(|(why, help)| refused(format!("{why} in {folder}segments"), help))?;
        let header = properties(&mut archive, &format!("{folder}header.properties"));
        let place = |axis: &str| {
            let header = header.as_ref()?;
            header.number(&format!("force-scan-series.header.position.{axis}"))
        };
        curve.place_m = place("x").zip(place("y"));
        all.push(curve);
    }
    Ok(all)
}

/// What is wrong with a curve, and what to do about it.
type Wrong = (&'static str, &'static str);

const EXPORT: &str = "open it in the JPK software and export it as text, or leave this file out";

/// Channels of all segments of a curve.
#[derive(Default)]
struct Raw {
    time_s: Vec<f64>,
    height_m: Vec<f64>,
    deflection_m: Vec<f64>,
    spring_n_per_m: Option<f64>,
}

fn segments_of(
    archive: &mut Archive<'_>,
    shared: &Properties,
    folder: &str,
    segments: &BTreeSet<u64>,
) -> Result<Raw, Wrong> {
    let mut headers = Vec::new();
    for segment in segments {
        let folder = format!("{folder}segments/{segment}/");
        let header = properties(archive, &format!("{folder}segment-header.properties"));
        headers.push((
            folder,
            header.ok_or(("a segment without a header", EXPORT))?,
        ));
    }
    let has = |channel: &str| {
        let list = |header: &Properties| header.text("channels.list").unwrap_or("").to_owned();
        let is_in = |list: String| list.split_whitespace().any(|name| name == channel);
        headers.iter().all(|(_, header)| is_in(list(header)))
    };
    let height = HEIGHTS.into_iter().find(|height| has(height));
    let height = height.ok_or(("no channel of the height", EXPORT))?;
    let mut raw = Raw::default();
    for (folder, header) in &headers {
        let mut channel = |name: &str| {
            let key = format!("channel.{name}");
            let channel = match header.text(&format!("{key}.lcd-info.*")) {
                Some(number) => Channel {
                    properties: shared,
                    prefix: format!("lcd-info.{number}"),
                },
                None => Channel {
                    properties: header,
                    prefix: key.clone(),
                },
            };
            let file = header.text(&format!("{key}.data.file.name"))?;
            let bytes = bytes(archive, &format!("{folder}{file}"))?;
            Some((channel.raw(&bytes)?, channel))
        };
        let heights = channel(height).ok_or(("a height that is not understood", EXPORT))?;
        let bent = channel("vDeflection").ok_or(("no channel of the deflection", EXPORT))?;
        raw.append(header, heights, bent)?;
    }
    Ok(raw)
}

impl Raw {
    fn append(
        &mut self,
        header: &Properties,
        (heights, of_height): (Vec<f64>, Channel<'_>),
        (bent, of_deflection): (Vec<f64>, Channel<'_>),
    ) -> Result<(), Wrong> {
        const NO_CALIBRATION: Wrong = (
            "no calibration of the deflection",
            "calibrate the sensitivity in the JPK software, and save the curve again",
        );
        let scaled = |(offset, factor): (f64, f64), raw: &[f64]| -> Vec<f64> {
            raw.iter().map(|value| offset + factor * value).collect()
        };
        let duration_s = header.number("force-segment-header.duration");
        let duration_s = duration_s
            .filter(|duration| *duration > 0.0)
            .ok_or(("a segment without its duration", EXPORT))?;
        if !of_deflection.has("distance") {
            return Err(NO_CALIBRATION);
        }
        let height = of_height.scaling(of_height.shown());
        let height = height.ok_or(("a height without its scale", EXPORT))?;
        let distance = of_deflection.scaling("distance").ok_or(NO_CALIBRATION)?;
        let force = of_deflection
            .scaling("force")
            .filter(|_| of_deflection.has("force"));
        self.spring_n_per_m = force.map(|(_, factor)| factor / distance.1);
        let count = heights.len().min(bent.len());
        let begun_s = self.time_s.last().map_or(0.0, |last| *last);
        let step_s = duration_s / count.max(1) as f64;
        self.time_s
            .extend((1..=count).map(|k| begun_s + step_s * k as f64));
        self.height_m.extend(scaled(height, &heights[..count]));
        self.deflection_m.extend(scaled(distance, &bent[..count]));
        Ok(())
    }

    fn curve(self, name: String, probe: &Probe) -> Result<ForceCurve, Wrong> {
        let spring = probe.spring_constant_n_per_m.or(self.spring_n_per_m);
        let spring = spring.filter(|spring| *spring > 0.0).ok_or((
            "no spring constant",
            "add `[instrument]` with `spring_constant = \"0.1 N/m\"`",
        ))?;
        // The height falls on the way to the specimen.
        let travel_m = self.height_m.iter().map(|height| -height).collect();
        Ok(of_cantilever(
            name,
            [self.time_s, travel_m, self.deflection_m],
            spring,
            probe,
        ))
    }
}
