//! Height maps: matrices and points in CSV, NumPy arrays.

#![no_main]

#[path = "../../common/inputs.rs"]
mod inputs;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    inputs::height_map(bytes);
});
