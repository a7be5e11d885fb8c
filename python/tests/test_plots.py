"""Results drawn with Matplotlib, the program's figures by name, and the program in the package."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import matplotlib
import numpy as np
import pytest
from conftest import ROOT

import contact_dma as cd

matplotlib.use("Agg")

PMMA, SPHERE = cd.Material.library("pmma"), cd.Sphere("10 mm")


@pytest.fixture(scope="module")
def swept() -> cd.SweepResult:
    return cd.sweep(PMMA, SPHERE, mean="10 N", amplitude="5 N", angular_frequency=np.logspace(-3, -1, 7), springs=32, steps=32)


def test_a_curve_has_the_points_of_the_table_and_its_peak(swept: cd.SweepResult) -> None:
    ax = swept.plot()
    curve, *_, peak = ax.get_lines()
    assert np.array_equal(curve.get_xdata(), swept["angular_frequency_rad_per_s"])
    assert np.array_equal(curve.get_ydata(), swept["energy_loss_j"])
    assert (*np.asarray(peak.get_xdata()), *np.asarray(peak.get_ydata())) == (swept.peaks[0].angular_frequency, swept.peaks[0].energy_loss)
    assert (ax.get_xlabel(), ax.get_ylabel(), ax.get_xscale()) == ("angular frequency (rad/s)", "energy loss (J)", "log")


def test_another_column_goes_into_axes_that_are_there(swept: cd.SweepResult) -> None:
    import matplotlib.pyplot as plt

    _, given = plt.subplots()
    assert swept.plot("loss_modulus_pa", ax=given, color="red") is given
    (curve, *_) = given.get_lines()
    assert np.array_equal(curve.get_ydata(), swept["loss_modulus_pa"]) and curve.get_color() == "red"
    with pytest.raises(ValueError, match="status has no numbers"):
        swept.plot("status")
    with pytest.raises(KeyError):
        swept.plot("loss")


def test_a_study_has_a_curve_for_each_of_the_other_axes() -> None:
    study = cd.sweep(PMMA, SPHERE, mean="10 N", axes={"drive.amplitude": ["1 N", "5 N"]}, angular_frequency=[1e-3, 1e-2, 1e-1], springs=32, steps=32)
    legend = study.plot().get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["drive amplitude: 1", "drive amplitude: 5"]


def test_loops_are_those_of_the_cycles(swept: cd.SweepResult) -> None:
    ax = swept.plot_loops([0, 3])
    for line, k in zip(ax.get_lines(), [0, 3], strict=True):
        assert np.array_equal(line.get_xdata(), swept.cycles[k].approach) and np.array_equal(line.get_ydata(), swept.cycles[k].load)
    assert swept.plot_loops().get_lines()


def test_figures_have_names(swept: cd.SweepResult, tmp_path: Path) -> None:
    for name in ("loss.svg", "loss.pdf", "loss.png", "loss.eps"):
        swept.figure("energy-loss").save(tmp_path / name)
        assert (tmp_path / name).stat().st_size > 1000
    with pytest.raises(KeyError, match="there are: energy-loss"):
        swept.figure("loss")


def program(*arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "contact_dma", *arguments], capture_output=True, text=True)


def test_the_package_has_the_program_in_it(tmp_path: Path) -> None:
    made = program("sweep", str(ROOT / "sweeps/pmma.toml"), "--quiet", "--out", str(tmp_path / "pmma"))
    assert (made.returncode, made.stdout, made.stderr) == (0, "", "")
    read = cd.read(tmp_path / "pmma", cd.SweepResult)
    assert abs(read.peaks[0].angular_frequency / 0.00844 - 1) < 1e-3
    assert (tmp_path / "pmma/figures/energy-loss.png").is_file()
    script = Path(sys.executable).with_name("contact-dma")
    said = subprocess.run([script, "--version"], capture_output=True, text=True)
    assert said.stdout == f"contact-dma {cd.__version__}\n" == program("--version").stdout


def test_the_program_ends_with_its_own_exit_codes() -> None:
    missing = program("sweep", "nowhere.toml")
    assert missing.returncode == 2 and "nowhere.toml" in missing.stderr
    assert program().returncode == 2
    assert "Usage: contact-dma" in program("--help").stdout
