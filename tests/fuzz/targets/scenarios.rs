//! Files of one drive history.

#![no_main]

#[path = "../../common/inputs.rs"]
mod inputs;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    inputs::scenario_file(bytes);
});
