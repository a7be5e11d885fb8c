//! Guides for those who use the program: each is a file beside this one, and every command, input file and piece of code in them
//! is run by the tests.
//!
//! | guide | what it answers |
//! |---|---|
//! | [`first_sweep`] | from nothing to a curve of the energy loss, in five minutes |
//! | [`input_files`] | every key of a sweep file and of a file of one drive history |
//! | [`own_material`] | how a material is given: series, tables of measured data, code |
//! | [`measured_material`] | from the file of a DMA instrument to a master curve, a series and a loss curve with its uncertainty |
//! | [`identify`] | from cycles measured with an indenter to moduli and times, with confidence bands |
//! | [`measured_loop`] | from an instrument's record of load and depth to loss, phase and moduli with their uncertainties |
//! | [`own_indenter`] | how a shape is given: profile, height map, code |
//! | [`own_loading`] | what drives the contact: oscillations about a mean, histories, records |
//! | [`python`] | the same from Python: arrays, notebooks, studies over many processes |
//! | [`cluster`] | sweeps on several machines: shards, Slurm; what a folder remembers, how results are compared |
//! | [`results`] | what is written, what every number means, and how far it can be trusted |
//! | [`figures`] | figures in the size and look of a journal |
//! | [`theory`] | what is computed, by which method, and where each comes from |
//! | [`validation`] | the two engines, and what they were held against |
//! | [`validity`] | what the model leaves out, and how to see that it matters |
//!
//! In the guides a block that follows a sentence with a file's name in it is that file; commands are for a shell in the folder
//! that holds these files.

/// The module of a guide. Where a guide names a page, its last lines have the file, for whoever reads it as a file; here they are
/// preceded by what the page is in this documentation, and the first of two definitions counts.
macro_rules! guide {
    ($name:ident, $file:literal) => {
        pub mod $name {
            #![doc = include_str!("links.txt")]
            #![doc = include_str!($file)]
        }
    };
}

guide!(first_sweep, "first_sweep.md");
guide!(input_files, "input_files.md");
guide!(own_material, "own_material.md");
guide!(measured_material, "measured_material.md");
guide!(identify, "identify.md");
guide!(measured_loop, "measured_loop.md");
guide!(own_indenter, "own_indenter.md");
guide!(own_loading, "own_loading.md");
guide!(python, "python.md");
guide!(cluster, "cluster.md");
guide!(results, "results.md");
guide!(figures, "figures.md");
guide!(theory, "theory.md");
guide!(validation, "validation.md");
guide!(validity, "validity.md");
