//! Fields of the axisymmetric engine: its radius revolved onto cells, against the half-space engine and closed forms.

use crate::common::engines::distance_m;
use crate::prelude::*;
use contact_dma::contact::surface::{CellSurface, Surface};
use contact_dma::reference::elastic::Hertz;
use contact_dma::simulation::{SimulationOutcome, SurfaceRecord};

const ZENER: &str = "title = \"fields\"\n[material]\npoisson_ratio = 0.5\n[material.zener]\nspring = \"1 MPa\"\n\
                     kelvin_spring = \"1 MPa\"\ntime = \"10 s\"\n";
const SPHERE: &str = "[indenter]\nshape = \"sphere\"\nradius = \"10 mm\"\n";
const DRIVE: &str = "[drive]\nsegments = [{ kind = \"step\", to = \"1 N\", duration = \"20 s\" }, { kind = \"ramp\", to = \
                     \"0.3 N\", duration = \"10 s\" }]\n[time]\nstep = \"0.5 s\"\n";

/// Of the first moment, which is elastic.
const HERTZ: Hertz = Hertz {
    radius_m: 0.01,
    load_n: 1.0,
    compliance_per_pa: 2.5e-7,
};

fn run(text: &str) -> SimulationOutcome {
    followed(&plans::history(text))
}

/// A drive of one load.
fn step(duration: &str) -> String {
    let step = format!("{{ kind = \"step\", to = \"1 N\", duration = \"{duration}\" }}");
    format!("[drive]\nsegments = [{step}]\n")
}

fn cells(record: &SurfaceRecord) -> &CellSurface {
    match &record.surface {
        Surface::Cells(cells) => cells,
        Surface::Radial(_) => panic!("no field"),
    }
}

/// Both engines on the same cells: (axisymmetric, half-space) at every time asked for.
fn both(indenter: &str, drive: &str, times: &str, cells: usize) -> [SimulationOutcome; 2] {
    let fields = format!("[output]\nfields_at = {times}\n");
    let springs = format!("{ZENER}{indenter}{drive}{fields}field_cells = {cells}\n");
    let solver = format!("[solver]\nengine = \"half-space\"\ncells = {cells}\n");
    [
        run(&springs),
        run(&format!("{ZENER}{indenter}{drive}{fields}{solver}")),
    ]
}

/// Root mean square difference of two fields over the root mean square of the second.
fn apart(one: &[f64], other: &[f64]) -> f64 {
    let pairs = one.iter().zip(other).map(|(a, b)| a - b);
    root_mean_square(pairs) / root_mean_square(other.iter().copied())
}

#[test]
fn the_fields_of_a_sphere_are_those_of_the_half_space_engine_on_the_same_cells() {
    let times = "[\"0 s\", \"20 s\", \"30 s\"]";
    let [springs, grid] = both(SPHERE, DRIVE, times, 64);
    assert_eq!(springs.fields.len(), 3);
    for (a, b) in springs.fields.iter().zip(&grid.fields) {
        let approach_m = b.row.approach_m.unwrap();
        let (gap_a, gap_b) = (a.gap_m.as_ref().unwrap(), b.gap_m.as_ref().unwrap());
        let (a, b) = (cells(a), cells(b));
        assert_eq!(a.grid, b.grid);
        // Forty to sixty cells across the contact. The pressure of the cells that straddle the edge is of first order.
        below!(apart(&a.pressure_pa, &b.pressure_pa), 0.02, "pressure");
        below!(apart(&a.displacement_m, &b.displacement_m), 3e-4);
        let off_m = largest_difference(&a.displacement_m, &b.displacement_m);
        below!(off_m, 5e-4 * approach_m, "displacement");
        below!(largest_difference(gap_a, gap_b), 1e-3 * approach_m, "gap");
    }
}

#[test]
fn the_first_field_of_a_sphere_is_that_of_hertz_at_every_cell() {
    let output = "[output]\nfields_at = [0]\nfield_cells = 31\n";
    let outcome = run(&format!("{ZENER}{SPHERE}{}{output}", step("1 s")));
    let field = cells(&outcome.fields[0]);
    assert_eq!(field.grid.cells(), 31 * 31);
    let (mut outside, mut inside) = (0, 0);
    for (cell, u_m) in field.displacement_m.iter().enumerate() {
        let r_m = distance_m(&field.grid, cell);
        // Springs of second order in 1/400.
        near!(*u_m, HERTZ.displacement_m(r_m), 2e-5, "{r_m:e}");
        let (found, exact) = (field.pressure_pa[cell], HERTZ.pressure_pa(r_m));
        if exact == 0.0 {
            assert_eq!(found, 0.0);
            outside += 1;
        } else {
            // Of second order but at the very edge.
            assert!((found - exact).abs() < 2e-3 * HERTZ.peak_pressure_pa());
            inside += 1;
        }
    }
    assert!(inside > 100 && outside > 100, "{inside} {outside}");
}

#[test]
fn the_cell_about_an_apex_has_its_mean_pressure_and_the_others_that_of_the_half_space_engine() {
    let cone = "[indenter]\nshape = \"cone\"\nhalf_angle = \"80 deg\"\n";
    // An odd number of cells puts one on the apex.
    let [springs, grid] = both(cone, &step("5 s"), "[0]", 49);
    let (a, b) = (cells(&springs.fields[0]), cells(&grid.fields[0]));
    assert_eq!(a.grid, b.grid);
    // Cells of a singular pressure: the apex of the half-space engine is 14 % too high.
    below!(apart(&a.pressure_pa, &b.pressure_pa), 0.04);
    // Sneddon: p = cot(alpha) acosh(a/r) / (2 C), over a cell by a midpoint rule that does not meet r = 0.
    let radius_m = springs.fields[0].row.contact_radius_m;
    let factor = 1.0 / 80_f64.to_radians().tan() / 2.0 / 2.5e-7;
    let points = 200;
    let side_m = a.grid.spacing_x_m();
    let at = |k: usize| side_m * ((k as f64 + 0.5) / points as f64 - 0.5);
    let values = (0..points * points).map(|k| {
        let r_m = at(k / points).hypot(at(k % points));
        factor * (radius_m / r_m).acosh()
    });
    let mean = values.sum::<f64>() / (points * points) as f64;
    // A square for a disc: 0.3 %.
    near!(a.pressure_pa[a.grid.cells() / 2], mean, 5e-3);
}

#[test]
fn under_a_flat_punch_the_revolved_pressure_is_finite_and_that_of_the_half_space_engine_away_from_the_rim()
 {
    let punch = "[indenter]\nshape = \"flat-punch\"\nradius = \"1 mm\"\n";
    let [springs, grid] = both(punch, &step("5 s"), "[\"5 s\"]", 48);
    let (a, b) = (cells(&springs.fields[0]), cells(&grid.fields[0]));
    assert_eq!(a.grid, b.grid);
    for (cell, p) in a.pressure_pa.iter().enumerate() {
        assert!(p.is_finite());
        if distance_m(&a.grid, cell) < 0.8e-3 {
            // The staircase of the rim makes the punch of cells wider or narrower by a part of a cell, 1/22 of the radius.
            near!(*p, b.pressure_pa[cell], 0.03);
        }
    }
}

#[test]
fn a_field_out_of_contact_is_the_recovering_surface_and_an_infinite_gap_is_one_without_indenter() {
    let drive = "[drive]\nsegments = [{ kind = \"step\", to = \"1 N\", duration = \"20 s\" }, { kind = \"step\", to = 0, \
                 duration = \"20 s\" }]\n";
    let [springs, grid] = both(SPHERE, drive, "[\"30 s\"]", 48);
    let (a, b) = (&springs.fields[0], &grid.fields[0]);
    assert!(a.gap_m.is_none() && b.gap_m.is_none());
    let (a, b) = (cells(a), cells(b));
    assert!(a.pressure_pa.iter().all(|&p| p == 0.0));
    // Forty-four cells across the dent.
    below!(apart(&a.displacement_m, &b.displacement_m), 1e-3);
    assert!(a.displacement_m.iter().all(|&u| u > 0.0));
}

#[test]
fn the_program_writes_revolved_fields_as_it_does_cells() {
    let output = "[output]\nfields_at = [\"0 s\", \"30 s\"]\nprofiles_at = [\"30 s\"]\n";
    let place = Place::with("fields.toml", &format!("{ZENER}{SPHERE}{DRIVE}{output}"));
    let simulate = "simulate fields.toml --quiet --force --out out";
    place.done(simulate);
    // 128 cells per side unless asked otherwise.
    let read = || npy(&place.bytes("out/cases/fields/0-pressure_pa.npy"));
    let (shape, pressure) = read();
    assert_eq!(shape, [128, 128]);
    let spacing = place
        .table("out/cases/fields/index.csv")
        .number(0, "spacing_x_m");
    let load_n = pressure.iter().sum::<f64>() * spacing * spacing;
    // The sum over 116 cells across the contact.
    assert!((load_n - 1.0).abs() < 1e-3, "{load_n}");
    place.has_all("out/cases/fields", "1.vti 1-gap_m.npy 1-displacement_m.npy");
    assert!(place.has("out/figures/pressure-map.svg"));
    // Profiles stay along the radius.
    assert!(
        place
            .text("out/cases/profiles/0.csv")
            .starts_with("radius_m,")
    );
    says(&place.text("out/resolved.toml"), &["field_cells = 128"]);
    place.done(&format!("{simulate} --set output.field_cells=20"));
    assert_eq!(read().0, [20, 20]);
}

#[test]
fn profiles_hold_pressure_gap_and_displacement_along_a_radius_or_lines_at_the_times_asked_for() {
    let output = "[output]\nprofiles_at = [\"20 s\", 0, \"25 s\"]\n";
    let place = Place::with("profiles.toml", &format!("{ZENER}{SPHERE}{DRIVE}{output}"));
    let peak_pa = HERTZ.peak_pressure_pa();
    // 64 cells: the pressure next to the edge is of first order.
    for (engine, column, at_edge) in [
        ("axisymmetric", "radius_m", 0.02),
        ("half-space", "position_m", 0.1),
    ] {
        place.done(&format!(
            "simulate profiles.toml --quiet --set solver.cells=64 --set solver.engine={engine} --out {engine}"
        ));
        let read = |name: &str| place.table(&format!("{engine}/cases/profiles/{name}"));
        let index = read("index.csv");
        assert_eq!(index.numbers("time_s"), [20.0, 0.0, 25.0]);
        // At the first moment the contact is elastic.
        let approach_m = index.number(1, "approach_m");
        near!(approach_m, HERTZ.approach_m(), 1e-3);
        let rows = read("1.csv");
        assert!(rows.len() > 100);
        for row in 0..rows.len() {
            let value = |name: &str| rows.number(row, name);
            // Lines of an even grid run half a cell beside the centre: along two rows whose mean is given.
            let r_m = value(column).abs();
            let near_edge = (r_m / HERTZ.contact_radius_m() - 1.0).abs() < 0.07;
            let off_pa = (value("pressure_pa") - HERTZ.pressure_pa(r_m)).abs() / peak_pa;
            below!(off_pa, if near_edge { at_edge } else { 5e-3 }, "{r_m:e}");
            let off_m = value("displacement_m") - HERTZ.displacement_m(r_m);
            below!(off_m.abs(), 2e-3 * approach_m, "{r_m:e}");
            let gap_m = r_m * r_m / 0.02 + HERTZ.displacement_m(r_m) - HERTZ.approach_m();
            let off_m = value("gap_m") - gap_m;
            below!(off_m.abs(), 3e-3 * approach_m, "{r_m:e}");
        }
        // Held, the contact has crept; unloading, it presses less.
        let middle = |name: &str| {
            let rows = read(name);
            let displacement_m = rows.numbers("displacement_m");
            let places = rows.numbers(column).into_iter().zip(displacement_m);
            let nearest = places.min_by(|a, b| a.0.abs().total_cmp(&b.0.abs()));
            nearest.unwrap().1
        };
        assert!(middle("0.csv") > 1.3 * middle("1.csv") && middle("2.csv") < middle("0.csv"));
    }
}
