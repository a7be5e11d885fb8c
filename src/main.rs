//! The `contact-dma` program: parse, plan, run, exit code.

#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(contact_dma::cli::run(std::env::args_os()))
}
