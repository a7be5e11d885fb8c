"""What is told of the package holds: notebooks run and draw, the README's lines run, and stubs are true."""

from __future__ import annotations

import os
import re
import runpy
import subprocess
import sys
from pathlib import Path

import matplotlib
import matplotlib.image
import pytest
from conftest import ROOT

import contact_dma

NOTEBOOKS = sorted((ROOT / "python/notebooks").glob("*.py"))


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_draws_its_figure(notebook: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(notebook))
    (figure,) = tmp_path.glob("*.png")
    assert (matplotlib.image.imread(figure)[..., :3] < 0.9).any()
    # A notebook has no file, and the folder that it is in.
    monkeypatch.chdir(notebook.parent)
    monkeypatch.setattr(matplotlib.figure.Figure, "savefig", lambda *_, **__: None)
    exec(compile(notebook.read_text(encoding="utf-8"), notebook.name, "exec"), {"__name__": "__main__"})
    if keep := os.environ.get("CONTACT_DMA_FIGURES"):
        (Path(keep) / figure.name).write_bytes(figure.read_bytes())


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
