//! `contact-dma material fit`: from a table of measured data to a material block.

use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::builder::TypedValueParser;
use clap::{Args, ValueEnum};

use super::failure::{Ended, Failure};
use super::flags::{OutFlags, named};
use super::folders::{in_folder, write_result};
use super::output::{OutputFormat, tell};
use crate::identify::laws::Laws;
use crate::identify::material_laws::of_table;
use crate::identify::resolved::{LAWS, forms};
use crate::input::dynamic::DynamicFormat;
use crate::input::table_file;
use crate::material::continuous::{self, Spectrum};
use crate::material::dynamic::{MOST_BRANCHES, MOST_REPLICAS};
use crate::material::fit;
use crate::material::law::Form;
use crate::material::{Material, MaterialFunction, ModulusKind};
use crate::quantity::{Dimension, parse};
use crate::report::caption::Setting;
use crate::report::dynamic::tables;
use crate::report::laws::{Beside, extended, spectrum_csv};
use crate::report::material::{fit_json, to_json};
use crate::report::page::{self, material::About};
use crate::report::text::Text;
use crate::report::{self, figure};
use crate::sweep::plan::resolved;
use crate::sweep::store::manifest::{Kind, Target};

#[derive(Debug, Args)]
pub(super) struct FitFlags {
    /// The table (CSV); files of dynamic data
    #[arg(required = true, value_name = "FILE")]
    pub(super) data: Vec<PathBuf>,
    /// What the table holds
    #[arg(long, value_name = "QUANTITY")]
    pub(super) quantity: FitQuantity,
    /// Which modulus, or which modulus the compliance belongs to
    #[arg(long, value_name = "KIND", value_parser = modulus())]
    pub(super) modulus: ModulusKind,
    /// Poisson ratio of the material; dynamic data are fitted without one too, and the block then says where it is to be written
    #[arg(
        long, value_name = "NU", allow_negative_numbers = true,
        required_if_eq_any([("quantity", "creep"), ("quantity", "relaxation")])
    )]
    pub(super) poisson_ratio: Option<f64>,
    /// Whether the material flows without end; without this flag the data decide
    #[arg(long, value_name = "true|false")]
    pub(super) flow: Option<bool>,
    /// Laws of a few parameters beside the series: auto for all, a name, or several with commas; the block is then that of the law that the
    /// data choose
    #[arg(long, value_name = "auto|LAW,...", value_delimiter = ',', value_parser = law())]
    pub(super) law: Vec<&'static str>,
    /// The continuous relaxation spectrum with its band (spectrum.csv and a figure); the block is then the series of it, five branches per
    /// decade, without the ripple of a few
    #[arg(long, conflicts_with = "law")]
    pub(super) spectrum: bool,
    #[command(flatten)]
    pub(super) dynamic: DynamicFlags,
    #[command(flatten)]
    pub(super) to: OutFlags,
}

/// What is made of dynamic data, and how.
#[derive(Debug, Default, Args, PartialEq)]
#[command(next_help_heading = "Dynamic data")]
pub(super) struct DynamicFlags {
    /// Temperature of the master curve, for example '25 °C' [default: that of the middle isotherm]
    #[arg(long, value_name = "T", value_parser = temperature, allow_hyphen_values = true)]
    pub(super) reference_temperature: Option<f64>,
    /// How isotherms are shifted: free, each for itself; wlf or arrhenius, by a law; none; or a file of shift factors
    /// (temperature_c,log10_a_t) [default: free]
    #[arg(long, value_name = "free|wlf|arrhenius|none|FILE")]
    pub(super) shift: Option<PathBuf>,
    /// Shift isotherms along the moduli too
    #[arg(long)]
    pub(super) vertical_shift: bool,
    /// Number of branches [default: auto, as many as the data resolve]
    #[arg(long, value_name = "auto|N", value_parser = branches)]
    pub(super) branches: Option<Branches>,
    /// Replicas of the series that carry the noise of the data on [default: 0]
    #[arg(long, value_name = "N", value_parser = replicas)]
    pub(super) replicas: Option<usize>,
    /// Format of the files [default: found from what they hold]
    #[arg(long, value_name = "FORMAT", value_parser = data_format())]
    pub(super) data_format: Option<DynamicFormat>,
}

/// Branches of a series.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Branches {
    Auto,
    Number(NonZeroUsize),
}

fn branches(text: &str) -> Result<Branches, String> {
    let number = text
        .parse()
        .ok()
        .filter(|number: &NonZeroUsize| number.get() <= MOST_BRANCHES);
    match (text, number) {
        ("auto", _) => Ok(Branches::Auto),
        (_, Some(number)) => Ok(Branches::Number(number)),
        _ => Err(format!(
            "`{text}` is no number of branches: write auto, or a whole number from 1 to {MOST_BRANCHES}"
        )),
    }
}

fn replicas(text: &str) -> Result<usize, String> {
    let number = text.parse().ok().filter(|number| *number <= MOST_REPLICAS);
    number.ok_or_else(|| {
        format!("`{text}` is no number of replicas: write a whole number from 0 to {MOST_REPLICAS}")
    })
}

fn temperature(text: &str) -> Result<f64, String> {
    let bare: Result<f64, _> = text.trim().parse();
    if bare.is_ok() {
        return Err(format!(
            "`{text}` has no unit: write '{text} °C' or '{text} K'"
        ));
    }
    let temperature_k = parse(text, Dimension::Temperature).map_err(|error| error.to_string())?;
    match temperature_k > 0.0 {
        true => Ok(temperature_k),
        false => Err(format!(
            "`{text}` is not above absolute zero: write a temperature above -273.15 °C"
        )),
    }
}

fn data_format() -> impl TypedValueParser<Value = DynamicFormat> {
    let names = DynamicFormat::NAMES.iter();
    named(names.map(|(name, format)| (*format, *name, "")))
}

/// What a file of measured data holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum FitQuantity {
    /// Creep compliance
    Creep,
    /// Relaxation modulus
    Relaxation,
    /// Storage and loss modulus over frequency, at one temperature or at several
    Dynamic,
}

fn law() -> impl TypedValueParser<Value = &'static str> {
    named(LAWS.iter().map(|law| (*law, *law, "")))
}

impl FitFlags {
    /// The laws or the spectrum that are asked for.
    pub(super) fn beside(
        &self,
        laws: impl Fn(&[Form]) -> Option<Laws>,
        spectrum: impl Fn() -> Option<Spectrum>,
    ) -> Result<Option<Beside>, Failure> {
        let names: Vec<String> = self.law.iter().map(|law| (*law).to_owned()).collect();
        let found = match (names.is_empty(), self.spectrum) {
            (true, false) => return Ok(None),
            (true, true) => spectrum().map(Beside::Spectrum),
            (false, _) => laws(&forms(&names, None, 2)).map(Beside::Laws),
        };
        let found =
            found.ok_or_else(|| Failure::run("none of the laws, or no spectrum, could be fitted"));
        found.map(Some)
    }
}

fn modulus() -> impl TypedValueParser<Value = ModulusKind> {
    named([ModulusKind::Longitudinal, ModulusKind::Shear].map(|kind| {
        let help = match kind {
            ModulusKind::Longitudinal => "Uniaxial: E, D",
            ModulusKind::Shear => "Shear: G, J",
        };
        (kind, kind.name(), help)
    }))
}

/// A creep compliance or relaxation modulus over time.
pub(super) fn run(
    flags: &FitFlags,
    function: MaterialFunction,
    format: OutputFormat,
) -> Result<Ended, Failure> {
    if flags.dynamic != DynamicFlags::default() {
        return Err(Failure::input(
            "--reference-temperature, --shift, --vertical-shift, --branches, --replicas and --data-format are for --quantity dynamic",
        ));
    }
    let ([data], Some(poisson_ratio)) = (&flags.data[..], flags.poisson_ratio) else {
        return Err(Failure::input(
            "creep and relaxation are fitted to one table: name one file, and --poisson-ratio",
        ));
    };
    let target = flags.to.target(Kind::MaterialFit, &flags.data)?;
    let table = table_file::read(data, function, flags.modulus)?;
    let fit = fit::fit(&table, flags.flow).map_err(Failure::input)?;
    let beside = flags.beside(
        |forms| of_table(&table, &fit, forms),
        || continuous::of_table(&table, &fit),
    )?;
    let mut material = fit.material(poisson_ratio).map_err(Failure::input)?;
    let mut about_fit = report::fit::text(fit.report());
    if let Some(beside) = &beside {
        about_fit.append(beside.lines(flags.modulus).into_iter().collect::<Text>());
        let placed = beside.in_place_of(material, flags.modulus, poisson_ratio);
        material = placed.map_err(Failure::input)?;
    }
    let spectrum = beside.as_ref().and_then(Beside::spectrum);
    let block = block(data, &about_fit, &material);
    if let Some(target) = &target {
        let prony = material.relaxation().map(tables::prony);
        let files = [
            ("material.toml", Some(block.clone().into_bytes())),
            ("prony.csv", prony),
            ("spectrum.csv", spectrum.map(spectrum_csv)),
        ];
        let files = files
            .into_iter()
            .filter_map(|(name, bytes)| Some((name, bytes?)));
        let figures = figure::fit::figures(&table, &fit, spectrum);
        let setting = Setting::of_material(&material);
        let drawn = (&figures[..], &setting, true);
        write_result(target, files, drawn, |pictures, figure| {
            let name = data.file_name().unwrap_or_default();
            let about = About {
                title: &format!("Fit to {}", name.display()),
                text: &about_fit.to_string(),
                block: &block,
                pictures,
                figure,
                fit: Some((&table, &fit)),
            };
            page::material::page(&material, &about)
        })?;
    }
    let found = || {
        let mut value = to_json(&material).map_err(Failure::input)?;
        value["fit"] = fit_json(fit.report());
        Ok(extended(value, beside.as_ref().map(Beside::summary)))
    };
    let parameters = beside.as_ref().and_then(Beside::parameters);
    let parameters = parameters.map_or_else(|| report::fit::branches(&fit), Into::into);
    let text = [about_fit.clone(), parameters];
    tell(format, false, found, || {
        Ok(fit_text(text, &block, target.as_ref()))
    })
}

/// What is printed of a fit, and where its files are; where there are none, the block to paste.
pub(super) fn fit_text(
    parts: impl IntoIterator<Item = Text>,
    block: &str,
    target: Option<&Target<'_>>,
) -> Text {
    let mut text = Text::default();
    for part in parts {
        match text.is_empty() {
            true => text = part,
            false => text.append_apart(part),
        }
    }
    match target {
        Some(_) => text.append(in_folder("Material and figures", target)),
        None => {
            text.blank();
            text.verbatim(block);
        }
    }
    text
}

/// The material block of a sweep file, ready to paste, every number exact.
fn block(data: &Path, fit: &Text, material: &Material) -> String {
    format!(
        "# From {}\n{}{}",
        data.display().to_string().escape_debug(),
        fit.as_comments(),
        resolved::material_text(material)
    )
}
