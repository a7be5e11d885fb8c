//! Tables that a file names. The first byte says what the table is taken for.

#![no_main]

#[path = "../../common/inputs.rs"]
mod inputs;

use inputs::Tables;

thread_local! {
    static TABLES: Tables = Tables::new();
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    TABLES.with(|tables| tables.check_any(bytes));
});
