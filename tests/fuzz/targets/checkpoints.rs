//! Checkpoints with a right checksum. The first byte says of which method, and which of its files.

#![no_main]

#[path = "../../common/inputs.rs"]
mod inputs;

use inputs::CheckpointFiles;

thread_local! {
    static FILES: [CheckpointFiles; 2] = ["direct", "march"].map(CheckpointFiles::new);
}

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    FILES.with(|files| inputs::check_any_checkpoint(files, bytes));
});
