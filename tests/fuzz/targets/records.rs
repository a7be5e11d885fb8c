//! Records of cases: the bytes of a log, and the same as what is packed under a right checksum.

#![no_main]

#[path = "../../common/inputs.rs"]
mod inputs;

use inputs::Records;

thread_local! {
    static RECORDS: Records = Records::new();
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    RECORDS.with(|records| {
        records.bytes(bytes);
        records.packed(bytes);
    });
});
