"""What is told of the package holds: notebooks run and draw, the README's lines run, and stubs are true."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import matplotlib
import nbclient
import nbformat
import pytest
from conftest import ROOT

import contact_dma

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.ipynb"))


def printed(notebook: nbformat.NotebookNode) -> list[str]:
    """What its cells print, in order; of a warning, not in which folder the cell was a file."""
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", []) if output.output_type == "stream"]
    for output in outputs:
        output.text = re.sub(r"\S*/ipykernel_\d+/\d+\.py:", "cell, line ", output.text)
    return [output.text for output in outputs]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_draws_and_prints_what_it_shows(path: Path) -> None:
    """``RENEW=1`` writes the outputs into the notebook."""
    notebook = nbformat.read(path, as_version=4)  # type: ignore[no-untyped-call]
    shown = printed(notebook)
    nbclient.NotebookClient(notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": path.parent}}).execute()
    pictures = [output for cell in notebook.cells for output in cell.get("outputs", []) if "image/png" in output.get("data", {})]
    assert pictures, "it draws nothing"
    for cell in notebook.cells:
        # When a cell ran is of no use to a reader.
        cell.metadata.pop("execution", None)
    prints = printed(notebook)
    if os.environ.get("RENEW"):
        notebook.metadata.pop("language_info", None)
        nbformat.write(notebook, path)  # type: ignore[no-untyped-call]
    else:
        assert shown == prints, "its outputs are stale: RENEW=1 writes them anew"


@pytest.mark.parametrize("page", ["README.md", "python/README.md", "src/guide/python.md"])
def test_the_python_of_a_page_runs(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "sweeps").symlink_to(ROOT / "sweeps")
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / page).read_text(encoding="utf-8"), re.S)
    assert blocks
    shared: dict[str, object] = {}
    for block in blocks:
        exec(compile(block, page, "exec"), shared)


def test_types_are_strict_and_stubs_true() -> None:
    package = Path(str(contact_dma.__file__)).parent
    for arguments in (
        ["mypy", "--strict", "-p", "contact_dma"],
        ["mypy", "--strict", str(Path(__file__).parent)],
        ["mypy.stubtest", "contact_dma", "--ignore-missing-stub"],
    ):
        made = subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, cwd="/")
        assert made.returncode == 0, made.stdout + made.stderr
    assert (package / "py.typed").is_file()
