//! Gives the program an identity: a hash of everything that its numbers come from, and of a release the commit, where there is
//! a repository.
//!
//! Hashed are the sources of the modules that make numbers, without comments, blank lines and unit tests and whatever their line
//! ends, and the versions of the crates whose arithmetic they rest on. Two builds with the same hash compute the same records,
//! so that a change of tables, figures, documentation or command line throws no record away. What flags and files mean is in
//! the resolved sweep, which has a hash of its own.

#![allow(dead_code)] // A test shares it.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// The modules that make numbers.
const MODULES: [&str; 13] = [
    "transforms",
    "numerics",
    "quantity",
    "material",
    "indenter",
    "drive",
    "contact",
    "history",
    "cycle",
    "steady",
    "engine",
    "sweep",
    "simulation",
];

/// Parts of them that make none: what keeps, finds, compares and shares out, and how figures look.
const ASIDE: [&str; 3] = ["sweep/plan/figures.rs", "sweep/share/", "sweep/store/"];

/// Crates whose arithmetic they rest on.
const CRATES: [&str; 8] = [
    "matrixmultiply",
    "nalgebra",
    "num-complex",
    "num-traits",
    "realfft",
    "rustfft",
    "simba",
    "transpose",
];

fn main() -> io::Result<()> {
    let sources = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let root = sources.join("../..");
    // A published package has a lock file of its own, beside its manifest.
    let locks = [&sources, &root].map(|folder| folder.join("Cargo.lock"));
    let lock = locks.into_iter().find(|lock| lock.exists());
    let lock = lock.unwrap_or_default();
    println!(
        "cargo::rustc-env=CONTACT_DMA_BUILD={}",
        identity(&sources, &lock)?
    );
    // A file that is not there would count as changed in every build.
    if lock.exists() {
        println!("cargo::rerun-if-changed={}", lock.display());
    }
    println!("cargo::rerun-if-changed=.");
    println!("cargo::rerun-if-env-changed=CONTACT_DMA_COMMIT");
    // In other profiles every commit would mean building everything anew.
    let is_release = env::var("PROFILE").is_ok_and(|profile| profile == "release");
    if is_release
        && env::var_os("CONTACT_DMA_COMMIT").is_none()
        && let Some(commit) = commit(&root)
    {
        println!("cargo::rustc-env=CONTACT_DMA_COMMIT={commit}");
    }
    Ok(())
}

/// The commit of the repository that this is, with `+changed` where the sources are not as committed.
fn commit(root: &Path) -> Option<String> {
    let log = root.join(".git/logs/HEAD");
    // A package that was unpacked inside another repository is not part of that.
    if !root.join(".git").exists() {
        return None;
    }
    if log.exists() {
        println!("cargo::rerun-if-changed={}", log.display());
    }
    let described = Command::new("git")
        .args([
            "describe",
            "--always",
            "--abbrev=40",
            "--exclude=*",
            "--dirty=+changed",
        ])
        .current_dir(root)
        .output()
        .ok()?;
    let commit = String::from_utf8(described.stdout).ok()?;
    described.status.success().then(|| commit.trim().to_owned())
}

/// The hash (64 hexadecimal digits) of what numbers come from: modules in the folder `sources`, versions in the lock file; the
/// same on every machine.
///
/// # Errors
/// Where a source cannot be read.
pub fn identity(sources: &Path, lock: &Path) -> io::Result<String> {
    let mut files = Vec::new();
    for module in MODULES {
        collect(&sources.join(module), module, &mut files)?;
        let file = sources.join(module).with_extension("rs");
        if file.exists() {
            files.push((format!("{module}.rs"), file));
        }
    }
    files.retain(|(name, _)| !ASIDE.iter().any(|folder| name.starts_with(folder)));
    files.sort();
    let mut hash = Sha256::new();
    for (name, path) in files {
        hash.update(format!("{name}\n{}", code(&fs::read_to_string(path)?)));
    }
    // Not there in a folder that is neither a package nor in the repository.
    let lock = fs::read_to_string(lock).unwrap_or_default();
    hash.update(versions(&lock));
    Ok(format!("{:x}", hash.finalize()))
}

/// Sources in a folder and those below it, by their names with slashes from the module on.
fn collect(folder: &Path, name: &str, files: &mut Vec<(String, PathBuf)>) -> io::Result<()> {
    if !folder.is_dir() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        let file = path.file_name().unwrap_or_default().to_string_lossy();
        let name = format!("{name}/{file}");
        if path.is_dir() {
            collect(&path, &name, files)?;
        } else if name.ends_with(".rs") {
            files.push((name, path));
        }
    }
    Ok(())
}

/// The lines of a source that are compiled into the program.
fn code(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(str::trim_end).collect();
    let is_test = |pair: &[&str]| pair[0] == "#[cfg(test)]" && pair[1].starts_with("mod tests");
    let end = lines.windows(2).position(is_test).unwrap_or(lines.len());
    let code = lines[..end].iter().filter(|line| {
        let line = line.trim_start();
        !line.is_empty() && !line.starts_with("//")
    });
    code.map(|line| format!("{line}\n")).collect()
}

/// Names and versions of the crates that count, as the lock file has them.
fn versions(lock: &str) -> String {
    let mut versions = String::new();
    let mut name = "";
    for line in lock.lines().map(str::trim_end) {
        let value = |key: &str| Some(line.strip_prefix(key)?.trim_matches(['=', ' ', '"']));
        if let Some(found) = value("name = ") {
            name = found;
        } else if let Some(version) = value("version = ")
            && CRATES.contains(&name)
        {
            versions.push_str(&format!("{name} {version}\n"));
        }
    }
    versions
}
