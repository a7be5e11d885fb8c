//! What a sweep leaves at the top of its folder: known here, so that another sweep that takes the folder can clear it.

/// Every figure a sweep may have; which of them it has depends on its axes, its material and its results.
pub const FIGURES: [&str; 22] = [
    "energy-loss",
    "loops",
    "dissipation",
    "dissipation-profile",
    "dissipation-map",
    "moduli",
    "cole-cole",
    "van-gurp-palmen",
    "loss-tangent",
    "loss-map",
    "harmonic-2-map",
    "moduli-error",
    "peaks",
    "energy-loss-2",
    "loss-map-2",
    "peaks-2",
    "energy-loss-3",
    "loss-map-3",
    "peaks-3",
    "energy-loss-4",
    "loss-map-4",
    "peaks-4",
];

/// Where it comes from, table, summary and page.
const TABLES: [&str; 5] = [
    "run.json",
    "sweep.csv",
    "summary.json",
    "cycles.npz",
    "index.html",
];

/// What follows the name of a figure in those of its files: data, caption, and the picture in every form.
const ENDINGS: [&str; 6] = {
    let [svg, pdf, png, png_of_two] = PICTURES;
    [".csv", CAPTION, svg, pdf, png, png_of_two]
};
/// The endings of a picture in every form.
pub const PICTURES: [&str; 4] = [".svg", ".pdf", ".png", "@2x.png"];
/// The ending of a caption.
pub const CAPTION: &str = ".caption.txt";

/// The files that a figure may have.
pub fn of_figure(name: &str) -> [String; 6] {
    ENDINGS.map(|ending| format!("{name}{ending}"))
}

/// All files at the top of a sweep's folder that later runs replace.
pub fn of_sweep() -> impl Iterator<Item = String> {
    let tables = TABLES.into_iter().map(str::to_owned);
    tables.chain(FIGURES.into_iter().flat_map(of_figure))
}
