# Sourced by what needs packages of PyPI, all of which ends with 77 where these cannot be had.

# Ends where Python is older than 3.N: python_from N
python_from() {
    python3 -c "import sys, venv; sys.exit(sys.version_info < (3, $1))" 2> /dev/null ||
        { echo "There is no Python of version 3.$1 or later with venv."; exit 77; }
}

# A virtual environment with packages: environment FOLDER PACKAGE...
environment() {
    python3 -m venv "$1" || { echo "No virtual environment can be made."; exit 77; }
    "$1/bin/python" -m pip install --quiet --disable-pip-version-check --retries 1 "${@:2}" ||
        { echo "Packages cannot be installed from PyPI."; exit 77; }
}
