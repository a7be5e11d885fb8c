//! Pictures on paper: their size, their forms and the memory that drawing them takes, from what the `[figures]` table asks for.

use crate::sweep::plan::figures::{FigurePlan, Format, SvgText};

/// How one picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Form {
    Svg(SvgText),
    Pdf,
    Eps,
    /// With this many pixels per inch on paper.
    PngOfDpi(usize),
    /// With this many pixels per px.
    PngOfScale(f32),
}

/// Text size (pt) where a size is asked for but none of the text.
const FONT_SIZE_PT: f64 = 8.0;
/// Resolution (pixels per inch) of a PNG whose size on paper is asked for.
const DPI: usize = 300;
/// A px of a figure of which nothing is asked, on paper (m), and its text (px).
const PX_M: f64 = 0.0254 / 96.0;
const WIDTH_PX: f64 = 800.0;
const TEXT_PX: f64 = 16.0;
const POINT_M: f64 = 0.0254 / 72.0;

/// Pictures of more pixels are drawn one after another, on however many threads.
pub const MANY_PIXELS: u64 = 1 << 24;
/// Memory (bytes) that drawing a picture takes, per pixel: its colours with transparency and without.
const PIXEL_BYTES: f64 = 7.0;
/// Height of a figure over its width, where none is given.
const HEIGHT: f64 = 0.75;

/// A figure on paper.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PaperSize {
    pub width_m: f64,
    /// `None`: as the figure asks for.
    pub height_m: Option<f64>,
    /// Length (m) of one px of the drawing: its text of 16 px has the size asked for.
    pub px_m: f64,
}

impl PaperSize {
    /// The size of its text (pt).
    pub fn text_pt(&self) -> f64 {
        self.px_m * TEXT_PX / POINT_M
    }
}

/// The size on paper, where any of it is asked for.
pub fn paper_size(plan: &FigurePlan) -> Option<PaperSize> {
    if plan.width_m.is_none() && plan.height_m.is_none() && plan.font_size_pt.is_none() {
        return None;
    }
    let font_size_pt = plan.font_size_pt.unwrap_or(FONT_SIZE_PT);
    Some(PaperSize {
        width_m: plan.width_m.unwrap_or(WIDTH_PX * PX_M),
        height_m: plan.height_m,
        px_m: font_size_pt * POINT_M / TEXT_PX,
    })
}

/// Resolution (pixels per inch) of a single PNG; `None` for the two of figures of which nothing is asked.
pub fn resolution(plan: &FigurePlan) -> Option<usize> {
    let of_paper = paper_size(plan).map(|_| DPI);
    plan.dpi.or(of_paper)
}

/// Memory (bytes) that drawing pictures takes on this number of threads.
pub fn drawing_bytes(plan: &FigurePlan, threads: usize) -> u64 {
    let (paper, pictures) = (paper_size(plan), pictures(plan));
    let width_m = paper.map_or(WIDTH_PX * PX_M, |paper| paper.width_m);
    let height_m = paper.and_then(|paper| paper.height_m);
    let area_m2 = width_m * height_m.unwrap_or(HEIGHT * width_m);
    let pixels = |form: &Form| match form {
        Form::Svg(_) | Form::Pdf | Form::Eps => 0.0,
        Form::PngOfDpi(dpi) => area_m2 * (*dpi as f64 / 0.0254).powi(2),
        Form::PngOfScale(scale) => area_m2 * (f64::from(*scale) / PX_M).powi(2),
    };
    let largest = pictures
        .iter()
        .map(|(_, form)| pixels(form))
        .fold(0.0, f64::max);
    let at_once = match largest > MANY_PIXELS as f64 {
        true => 1,
        false => threads,
    };
    (PIXEL_BYTES * largest) as u64 * at_once as u64
}

/// The pictures of a figure: the ending of each, and how it is drawn.
pub fn pictures(plan: &FigurePlan) -> Vec<(&'static str, Form)> {
    let of_format = |format: &Format| match (format, resolution(plan)) {
        (Format::Svg, _) => vec![(".svg", Form::Svg(plan.svg_text))],
        (Format::Pdf, _) => vec![(".pdf", Form::Pdf)],
        (Format::Eps, _) => vec![(".eps", Form::Eps)],
        (Format::Png, Some(dpi)) => vec![(".png", Form::PngOfDpi(dpi))],
        (Format::Png, None) => vec![
            (".png", Form::PngOfScale(1.0)),
            ("@2x.png", Form::PngOfScale(2.0)),
        ],
    };
    plan.formats.iter().flat_map(of_format).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn everything() -> FigurePlan {
        FigurePlan {
            width_m: Some(0.085),
            font_size_pt: Some(7.0),
            formats: vec![Format::Png, Format::Pdf, Format::Eps].into(),
            dpi: Some(600),
            ..FigurePlan::default()
        }
    }

    #[test]
    fn text_of_the_drawing_has_the_size_asked_for() {
        assert_eq!(paper_size(&FigurePlan::default()), None);
        let paper = paper_size(&everything()).unwrap();
        // 16 px are 7 pt.
        assert!((16.0 * paper.px_m / POINT_M - 7.0).abs() < 1e-12);
        let only_text = FigurePlan {
            font_size_pt: Some(12.0),
            ..FigurePlan::default()
        };
        let paper = paper_size(&only_text).unwrap();
        // As without the table: 800 px.
        assert!((paper.width_m / paper.px_m - 800.0).abs() < 1e-9);
    }

    #[test]
    fn two_resolutions_are_for_figures_of_which_nothing_is_asked() {
        let endings = |plan: &FigurePlan| -> Vec<&str> {
            let pictures = pictures(plan).into_iter();
            pictures.map(|(ending, _)| ending).collect()
        };
        let default = FigurePlan::default();
        assert_eq!(endings(&default), [".svg", ".png", "@2x.png"]);
        assert_eq!(endings(&everything()), [".png", ".pdf", ".eps"]);
        assert_eq!(resolution(&everything()), Some(600));
        let column = FigurePlan {
            width_m: Some(0.085),
            ..FigurePlan::default()
        };
        assert_eq!(resolution(&column), Some(300));
    }
}
