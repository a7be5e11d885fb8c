//! A chart for a print in black and white: what colours tell apart, greys as far apart as they can be tell apart, with line styles.

use super::{Chart, Color, LineStyle, Series};

/// The lightest grey of a curve, how far two curves are apart at most, and the greys between which areas are, of 255: thin lines and areas
/// that are lighter vanish on white, areas that are darker hide what is drawn over them.
const LIGHTEST: f64 = 176.0;
const APART: f64 = 100.0;
const AREAS: (f64, f64) = (70.0, 230.0);

impl Chart {
    /// The same with greys in the places of colours. Those of a colour scale stay for [`Drawing::in_grey`](super::Drawing::in_grey),
    /// which makes them, those of maps and everything else as light as they were.
    #[must_use]
    pub fn in_grey(mut self) -> Self {
        self.grey_areas();
        if self.color_scale.is_none() {
            self.grey_curves();
        }
        self
    }

    /// Areas one above another: neighbours are far apart, and a white line parts them.
    fn grey_areas(&mut self) {
        let of = self.series.iter().filter(|s| s.area_to.is_some()).count();
        let mut areas = 0;
        for series in std::mem::take(&mut self.series) {
            let points = series.area_to.map(|_| series.points.clone());
            let Some(points) = points else {
                self.series.push(series);
                continue;
            };
            self.series.push(series.color(area(areas, of)));
            let edge = Series::line(points).color(Color::Rgb(255, 255, 255));
            self.series.push(edge);
            areas += 1;
        }
    }

    /// Curves and marks, those of one colour in one grey; lines that are all solid get styles.
    fn grey_curves(&mut self) {
        let mut colors: Vec<Color> = Vec::new();
        for color in self.series.iter().map(|series| series.color) {
            if !matches!(color, Color::Rgb(..)) && !colors.contains(&color) {
                colors.push(color);
            }
        }
        let of = colors.len();
        let place = |color: Color| colors.iter().position(|other| *other == color);
        let mut lines = self.series.iter().filter(|s| place(s.color).is_some());
        let are_solid = lines.all(|s| matches!(s.line, None | Some(LineStyle::Solid)));
        for series in &mut self.series {
            let Some(step) = place(series.color) else {
                continue;
            };
            series.color = curve(step, of);
            if are_solid && series.line.is_some() && series.marker.is_none() {
                series.line = Some(LineStyle::nth(step));
            }
        }
        for mark in &mut self.marks {
            if let Some(step) = place(mark.color) {
                mark.color = curve(step, of);
            }
        }
    }
}

fn grey(luma: f64) -> Color {
    let luma = luma.round() as u8;
    Color::Rgb(luma, luma, luma)
}

/// The grey of a curve, of so many.
fn curve(step: usize, of: usize) -> Color {
    let last = of.saturating_sub(1).max(1) as f64;
    grey(APART.min(LIGHTEST / last) * step as f64)
}

/// The grey of an area in a stack of so many: the darker half and the lighter half in turn, each from its light end, so that neighbours
/// are half the greys apart.
fn area(step: usize, of: usize) -> Color {
    let lightest = match step.is_multiple_of(2) {
        true => of.div_ceil(2),
        false => of,
    };
    let rank = lightest.saturating_sub(1 + step / 2);
    let last = of.saturating_sub(1).max(1);
    grey(AREAS.0 + (AREAS.1 - AREAS.0) * rank as f64 / last as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::chart::{Axis, ColorScale, Mark};

    fn luma(color: Color) -> f64 {
        let [red, green, blue] = color.rgb().map(f64::from);
        0.299 * red + 0.587 * green + 0.114 * blue
    }

    fn least_distance(colors: &[Color]) -> f64 {
        let pairs = colors.iter().enumerate().flat_map(|(place, first)| {
            let others = colors[..place].iter();
            others.map(|other| (luma(*first) - luma(*other)).abs())
        });
        pairs.fold(f64::INFINITY, f64::min)
    }

    fn family(of: usize, series: impl Fn(usize) -> Series) -> Chart {
        Chart::new(Axis::linear("x"), Axis::linear("y")).all_series((0..of).map(series))
    }

    fn line(step: usize) -> Series {
        Series::line([(0.0, 0.0), (1.0, 1.0 + step as f64)])
    }

    #[test]
    fn two_to_eight_curves_are_as_far_apart_as_greys_can_be() {
        for of in 2..=8 {
            let ramp = |step| line(step).color(Color::Ramp { step, of });
            for chart in [
                family(of, ramp),
                family(of.min(7), |step| line(step).color(step)),
            ] {
                let grey = chart.in_grey();
                let colors: Vec<Color> = grey.series.iter().map(|s| s.color).collect();
                let even = APART.min(LIGHTEST / (colors.len() - 1) as f64);
                // Rounding to whole levels. The palette of colours comes to 19 for seven.
                assert!(least_distance(&colors) > even - 1.0 && even > 25.0, "{of}");
                let looks: Vec<_> = grey.series.iter().map(|s| (s.line, s.color)).collect();
                for (place, (style, color)) in looks.iter().enumerate() {
                    let alike = looks[..place].iter().filter(|(other, _)| other == style);
                    for (_, other) in alike {
                        assert!((luma(*color) - luma(*other)).abs() > 100.0 - 1.0);
                    }
                }
            }
        }
    }

    #[test]
    fn neighbours_in_a_stack_are_far_apart_and_a_white_line_parts_them() {
        for of in 2..=8 {
            let stacked = family(of, |step| line(of - step).area_to(0.0)).in_grey();
            let areas: Vec<Color> = stacked.series.iter().step_by(2).map(|s| s.color).collect();
            assert!(areas.iter().all(|color| luma(*color) < 231.0));
            for pair in areas.windows(2) {
                assert!((luma(pair[0]) - luma(pair[1])).abs() > 75.0, "{of}");
            }
            assert!(least_distance(&areas) > 21.9, "{of}");
            for edge in stacked.series.iter().skip(1).step_by(2) {
                assert_eq!((edge.color.rgb(), edge.area_to), ([255; 3], None));
            }
        }
    }

    #[test]
    fn one_colour_stays_one_grey_and_meaning_stays() {
        let mut chart =
            family(2, |step| line(step).color(step)).series(line(2).style(LineStyle::Dashed));
        chart = chart.mark(Mark::vertical(0.5, "peak").color(1));
        let grey = chart.clone().in_grey();
        assert_eq!(grey.series[0].color, grey.series[2].color);
        assert_eq!(grey.marks[0].color, grey.series[1].color);
        // A dashed line means something: no other becomes one.
        assert_eq!(grey.series[1].line, Some(LineStyle::Solid));
        let scale = ColorScale::over("T", [0.0, 1.0]).unwrap();
        let scaled = chart.color_scale(scale);
        assert_eq!(scaled.clone().in_grey(), scaled);
    }
}
