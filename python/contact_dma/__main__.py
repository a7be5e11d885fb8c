"""The program ``contact-dma``, which the package has in it: ``python -m contact_dma``."""

from __future__ import annotations

import sys

from ._contact_dma import run_program


def main() -> int:
    """Runs the program with the arguments of the command line; its exit code."""
    # As the help names it, however it was started.
    return run_program(["contact-dma", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
