//! Files of dynamic data and tables of shift factors. The first byte says what a file is taken for.

#![no_main]

#[path = "../../common/inputs.rs"]
mod inputs;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    inputs::dynamic_file(bytes);
});
