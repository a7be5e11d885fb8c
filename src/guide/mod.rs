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
//! | [`validation`] | the two engines, and what they were held against |
//! | [`validity`] | what the model leaves out, and how to see that it matters |
//!
//! In the guides a block that follows a sentence with a file's name in it is that file; commands are for a shell in the folder
//! that holds these files.

pub mod first_sweep {
    #![doc = include_str!("first_sweep.md")]
}

pub mod input_files {
    #![doc = include_str!("input_files.md")]
}

pub mod own_material {
    #![doc = include_str!("own_material.md")]
}

pub mod measured_material {
    #![doc = include_str!("measured_material.md")]
}

pub mod identify {
    #![doc = include_str!("identify.md")]
}

pub mod measured_loop {
    #![doc = include_str!("measured_loop.md")]
}

pub mod own_indenter {
    #![doc = include_str!("own_indenter.md")]
}

pub mod own_loading {
    #![doc = include_str!("own_loading.md")]
}

pub mod python {
    #![doc = include_str!("python.md")]
}

pub mod cluster {
    #![doc = include_str!("cluster.md")]
}

pub mod results {
    #![doc = include_str!("results.md")]
}

pub mod figures {
    #![doc = include_str!("figures.md")]
}

pub mod validation {
    #![doc = include_str!("validation.md")]
}

pub mod validity {
    #![doc = include_str!("validity.md")]
}
