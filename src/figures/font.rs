//! The typefaces of figures: three families that the program brings, and one that a file holds.

use std::fmt;
use std::sync::{Arc, LazyLock};

use harfrust::{GlyphBuffer, ShapeOptions, Shaper, ShaperData, UnicodeBuffer};
use skrifa::raw::TableProvider as _;
use skrifa::string::StringId;
use skrifa::{FontRef, MetadataProvider as _};

use crate::sweep::plan::figures::FontChoice;

/// The bytes of a font, which whoever embeds it shares.
pub type FontBytes = Arc<dyn AsRef<[u8]> + Send + Sync>;

/// One font: its outlines are in `units_per_em`.
pub struct Font {
    pub family: String,
    pub units_per_em: f32,
    pub bytes: FontBytes,
    shaping: ShaperData,
}

/// Why a file is no font for figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FontError {
    #[error("it holds no TrueType or OpenType font")]
    NoFont,
    #[error("the font has no outline of the digit {0}")]
    NoDigit(char),
}

impl Font {
    /// Reads a font, and of a collection the first.
    ///
    /// # Errors
    /// [`FontError`] where figures could not show a number in it.
    pub fn new(bytes: FontBytes) -> Result<Self, FontError> {
        let data = (*bytes).as_ref();
        let font = FontRef::from_index(data, 0).map_err(|_| FontError::NoFont)?;
        let (characters, outlines) = (font.charmap(), font.outline_glyphs());
        let is_drawn = |digit| {
            characters
                .map(digit)
                .is_some_and(|id| outlines.get(id).is_some())
        };
        if let Some(digit) = ('0'..='9').find(|&digit| !is_drawn(digit)) {
            return Err(FontError::NoDigit(digit));
        }
        let family = font
            .localized_strings(StringId::FAMILY_NAME)
            .english_or_first();
        let family = family.map_or_else(String::new, |name| name.chars().collect());
        let units_per_em = font.head().map_or(0, |head| head.units_per_em());
        Ok(Self {
            family,
            units_per_em: f32::from(units_per_em.max(1)),
            shaping: ShaperData::new(&font),
            bytes,
        })
    }

    /// The tables of the font; `None` never, since they were read before.
    pub fn tables(&self) -> Option<FontRef<'_>> {
        FontRef::from_index((*self.bytes).as_ref(), 0).ok()
    }

    /// Whether it has this character.
    fn has(&self, character: char) -> bool {
        let tables = self.tables();
        tables.is_some_and(|font| font.charmap().map(character).is_some())
    }

    /// The glyphs of a text that runs in one direction, from left to right as they stand.
    pub fn shaped(&self, text: UnicodeBuffer) -> Option<GlyphBuffer> {
        let font = self.tables()?;
        let shaper: Shaper<'_> = self.shaping.shaper(&font).build();
        Some(shaper.shape(text, ShapeOptions::new()))
    }
}

impl fmt::Debug for Font {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Font({})", self.family)
    }
}

/// A family that the program brings.
struct Bundled {
    font: Arc<Font>,
    /// Families of the same widths, and the kind of family, as a style sheet names them.
    stand_ins: &'static str,
}

/// DejaVu Sans has ω, δ, τ, ′, superscripts and subscripts. The other two have the widths of Arial and of Times, in which journals set;
/// they were reduced to Latin, Greek, signs and arrows. Their licences lie beside them.
static BUNDLED: LazyLock<Option<[Bundled; 3]>> = LazyLock::new(|| {
    let read = |bytes: &'static [u8], stand_ins| {
        let font = Arc::new(Font::new(Arc::new(bytes)).ok()?);
        Some(Bundled { font, stand_ins })
    };
    Some([
        read(
            include_bytes!("../report/fonts/DejaVuSans.ttf"),
            "Verdana, sans-serif",
        )?,
        read(
            include_bytes!("../report/fonts/Arimo-Regular.ttf"),
            "Arial, 'Liberation Sans', Helvetica, sans-serif",
        )?,
        read(
            include_bytes!("../report/fonts/Tinos-Regular.ttf"),
            "'Times New Roman', 'Liberation Serif', Times, serif",
        )?,
    ])
});

/// What texts of figures are set in: a font, and for letters that it lacks DejaVu Sans.
#[derive(Debug, Clone)]
pub struct Typeface {
    fonts: Vec<Arc<Font>>,
    stand_ins: &'static str,
}

impl Typeface {
    /// The one asked for.
    ///
    /// # Errors
    /// [`FontError`] where the file holds no font for figures.
    pub fn of(choice: &FontChoice) -> Result<Self, FontError> {
        let [dejavu, sans, serif] = BUNDLED.as_ref().ok_or(FontError::NoFont)?;
        let fallback = Arc::clone(&dejavu.font);
        let (font, stand_ins) = match choice {
            FontChoice::Dejavu => (None, dejavu.stand_ins),
            FontChoice::Sans => (Some(Arc::clone(&sans.font)), sans.stand_ins),
            FontChoice::Serif => (Some(Arc::clone(&serif.font)), serif.stand_ins),
            FontChoice::File { bytes, .. } => {
                let font = Font::new(Arc::clone(bytes) as FontBytes)?;
                (Some(Arc::new(font)), dejavu.stand_ins)
            }
        };
        let fonts = font.into_iter().chain([fallback]).collect();
        Ok(Self { fonts, stand_ins })
    }

    /// Its families for a style sheet, of which the first is taken that is there.
    pub fn families(&self) -> String {
        let first = self.fonts.first().map_or("", |font| &font.family);
        let first = first.replace(['\'', '"', '\\', '<', '&'], "");
        format!("'{first}', {}", self.stand_ins)
    }

    /// The first font that has this character, else the last.
    pub fn font_of(&self, character: char) -> Option<&Arc<Font>> {
        let has = |font: &&Arc<Font>| font.has(character);
        self.fonts.iter().find(has).or(self.fonts.last())
    }
}

impl Default for Typeface {
    fn default() -> Self {
        Self::of(&FontChoice::Dejavu).unwrap_or(Self {
            fonts: Vec::new(),
            stand_ins: "sans-serif",
        })
    }
}

impl PartialEq for Typeface {
    fn eq(&self, other: &Self) -> bool {
        let bytes = |font: &Arc<Font>| Arc::clone(&font.bytes);
        let (own, others) = (self.fonts.iter().map(bytes), other.fonts.iter().map(bytes));
        own.zip(others)
            .all(|(own, other)| (*own).as_ref() == (*other).as_ref())
            && self.fonts.len() == other.fonts.len()
    }
}
