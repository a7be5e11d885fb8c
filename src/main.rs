//! The `contact-dma` program.

fn main() {}
