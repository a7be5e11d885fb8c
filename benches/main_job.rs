//! The main job as a user runs it, the whole program from start to the last figure: `sweep sweeps/pmma.toml`.

use std::process::{Command, Stdio};

use criterion::{Criterion, criterion_group, criterion_main};

fn main_job(criterion: &mut Criterion) {
    let folder = tempfile::TempDir::new().expect("a temporary folder");
    let mut group = criterion.benchmark_group("sweep sweeps/pmma.toml");
    group.sample_size(10);
    for threads in ["1", "2"] {
        group.bench_function(format!("{threads} threads"), |bencher| {
            bencher.iter(|| {
                let status = Command::new(env!("CARGO_BIN_EXE_contact-dma"))
                    .current_dir(env!("CARGO_MANIFEST_DIR"))
                    .args([
                        "sweep",
                        "sweeps/pmma.toml",
                        "--quiet",
                        "--threads",
                        threads,
                        "--out",
                    ])
                    .arg(folder.path())
                    .stdout(Stdio::null())
                    .status()
                    .expect("the program starts");
                assert!(status.success());
            });
        });
    }
    group.finish();
}

criterion_group!(benches, main_job);
criterion_main!(benches);
