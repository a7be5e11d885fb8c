//! What the program and the library answer: input and its messages, outputs, figures, pages, guides, the rules of the code.

#![cfg(feature = "cli")]

#[macro_use]
#[path = "../common/near.rs"]
mod near;
#[path = "../common/mod.rs"]
mod common;
#[path = "../common/page.rs"]
mod html;
#[path = "../common/inputs.rs"]
mod inputs;
#[path = "../common/program.rs"]
mod program;
#[path = "../common/segments.rs"]
mod segments;

mod adhesion;
mod analyse;
mod architecture;
mod axes;
mod build_identity;
mod bulk_modulus;
mod cite;
mod command_line;
mod compare;
mod cycles_by_number;
mod data_files;
mod direct_sum;
mod every_figure;
mod examples;
mod fields;
mod figures;
mod folders;
mod force_curves;
mod fuzz_inputs;
mod guides;
mod identify;
mod input_keys;
mod large_sweep;
mod layer;
mod library;
mod listed_blocks;
mod machine_output;
mod measured_material;
mod names_and_figures;
mod older_folders;
mod page;
mod paths;
mod periodic;
mod plans;
mod prelude;
mod redrawn;
mod refined_sweep;
mod refused;
mod renew;
mod reproduce;
mod simulate;
mod sweep_figures;
mod tabulated_material;
mod two_bodies;
mod warnings;
