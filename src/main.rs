//! The `contact-dma` program: parse, plan, run, exit code.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    contact_dma::cli::run(std::env::args_os())
}
