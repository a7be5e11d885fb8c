"""Materials fitted to data: how well, by what shifts, and what warns."""

from __future__ import annotations

import pickle
import warnings
from typing import Any

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT

import contact_dma as cd

SOLID = cd.Material.relaxation("10 MPa", [("200 MPa", "0.01 s"), ("90 MPa", "1 s")], poisson_ratio=0.45)
OMEGA = np.logspace(-1, 2, 16)
C1, C2 = 10.0, 60.0


def isotherms() -> dict[str, Any]:
    """The solid at 10, 20 and 30 °C, shifted by a WLF law about 20 °C."""
    parts = []
    for celsius in (10.0, 20.0, 30.0):
        a_t = 10 ** (-C1 * (celsius - 20) / (C2 + celsius - 20))
        modulus = SOLID.complex_modulus(OMEGA * a_t)
        parts.append(np.array([OMEGA, modulus.real, modulus.imag, np.full_like(OMEGA, celsius + 273.15)]))
    names = ["angular_frequency", "storage_modulus", "loss_modulus", "temperature"]
    return dict(zip(names, np.concatenate(parts, axis=1)))


def test_misfit_shift_factors_and_master_curve_of_a_fit_are_at_hand() -> None:
    material = cd.Material.from_dynamic(**isotherms(), poisson_ratio=0.45)
    fit = material.fit
    assert fit is not None and fit.misfit < 1e-3 and fit.summary["isotherms"] == 3
    assert fit.shift_factors is not None and fit.master_curve is not None
    expected = [C1 * 10 / (C2 - 10), 0.0, -C1 * 10 / (C2 + 10)]
    assert fit.shift_factors["log10_a_t"] == pytest.approx(expected, abs=0.02)
    assert fit.summary["wlf"]["c2_k"] == pytest.approx(C2, rel=0.1)
    master = fit.master_curve
    exact = SOLID.complex_modulus(master["angular_frequency_rad_per_s"])
    assert master["storage_modulus_pa"] == pytest.approx(exact.real, rel=0.02) and len(master.to_pandas()) == 48
    assert "misfit" in repr(material) and "misfit" in material._repr_html_() and any("WLF" in line for line in fit.report)
    again = pickle.loads(pickle.dumps(material))
    assert again == material and again.fit == fit
    assert SOLID.fit is None


def test_the_fit_of_a_file_is_what_the_program_prints() -> None:
    fit = cd.Material.from_dynamic(ROOT / "sweeps/pyvisco-freq-user-raw.csv", poisson_ratio=0.38).fit
    assert fit is not None and fit.summary["format"] == "pyvisco" and 0 < fit.misfit < 0.2
    assert any("misfit relative to the data" in line for line in fit.report)


def test_a_fit_that_misses_its_data_warns_and_a_good_one_does_not() -> None:
    data = isotherms()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cd.Material.from_dynamic(**data, poisson_ratio=0.45)
    # A quarter to and fro: poor, and short of the half at which a series is refused.
    noise = np.tile(np.where(np.arange(16) % 2, 1.3, 0.75), (2, 1))
    one = SOLID.complex_modulus(OMEGA)
    with pytest.warns(cd.ContactDmaWarning, match="misses the data by") as seen:
        noisy = cd.Material.from_dynamic(
            angular_frequency=OMEGA, storage_modulus=one.real * noise[0], loss_modulus=one.imag * noise[1], poisson_ratio=0.45
        )
    assert noisy.fit is not None and noisy.fit.misfit > 0.2
    assert seen[0].filename == __file__


def test_a_fit_to_a_table_has_a_misfit_and_its_remarks() -> None:
    t = np.logspace(-1, 3, 60)
    good = cd.Material.table(t, 1e9 + 2e9 * np.exp(-t / 10), quantity="relaxation", poisson_ratio=0.4)
    assert good.fit is not None and good.fit.misfit < 1e-3 and good.fit.shift_factors is None
    early = t < 3
    with pytest.warns(cd.ContactDmaWarning, match="before the relaxation modulus comes to rest"):
        cd.Material.table(t[early], (1e9 + 2e9 * np.exp(-t / 10))[early], quantity="relaxation", poisson_ratio=0.4)


def test_data_frames_frequencies_loss_factors_and_temperatures_in_celsius_are_taken() -> None:
    data = isotherms()
    expected = cd.Material.from_dynamic(**data, poisson_ratio=0.45)
    others: dict[str, Any] = {
        "frequency": data["angular_frequency"] / (2 * np.pi),
        "storage_modulus": data["storage_modulus"],
        "tan_delta": data["loss_modulus"] / data["storage_modulus"],
        "temperature": [f"{kelvin - 273.15:.6f} °C" for kelvin in data["temperature"]],
    }
    export = pd.DataFrame({
        "Frequency (Hz)": others["frequency"],
        "Storage modulus (MPa)": data["storage_modulus"] / 1e6,
        "Loss modulus (MPa)": data["loss_modulus"] / 1e6,
        "Temperature (°C)": data["temperature"] - 273.15,
    })
    for made in (
        cd.Material.from_dynamic(pd.DataFrame(data), poisson_ratio=0.45),
        cd.Material.from_dynamic(**others, poisson_ratio=0.45),
        cd.Material.from_dynamic(others, poisson_ratio=0.45),
        cd.Material.from_dynamic(export, poisson_ratio=0.45),
    ):
        assert made.temperature == pytest.approx(293.15)
        assert np.allclose(made.complex_modulus(OMEGA), expected.complex_modulus(OMEGA), rtol=1e-3)


def test_degrees_that_were_taken_for_kelvin_warn() -> None:
    data = isotherms()
    with pytest.warns(cd.ContactDmaWarning, match="10 to 30 K"):
        cd.Material.from_dynamic(**{**data, "temperature": data["temperature"] - 273.15}, poisson_ratio=0.45)
    with pytest.warns(cd.ContactDmaWarning, match="temperature is 30"), pytest.raises(ValueError):
        cd.Material.library("pvb", temperature=30)
    del data["temperature"]
    # Isotherms taken for one are no data of any series.
    with pytest.warns(cd.ContactDmaWarning, match="given more than once"), pytest.raises(ValueError, match="no series of these data"):
        cd.Material.from_dynamic(**data, poisson_ratio=0.45)


def test_a_column_that_is_not_read_and_a_loss_factor_that_contradicts_warn() -> None:
    omega = np.logspace(-2, 2, 25)
    solid = cd.Material.relaxation("10 MPa", [("90 MPa", "1 s")], poisson_ratio=0.45)
    e = solid.complex_modulus(omega)
    data: dict[str, Any] = {"angular_frequency": omega, "storage_modulus": e.real, "loss_modulus": e.imag}
    with pytest.warns(cd.ContactDmaWarning, match="not read: temprature"):
        cd.Material.from_dynamic({**data, "temprature": np.full(25, 300.0)}, poisson_ratio=0.45)
    with pytest.warns(cd.ContactDmaWarning, match="the loss modulus is taken"):
        cd.Material.from_dynamic(**data, tan_delta=2 * e.imag / e.real, poisson_ratio=0.45)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        cd.Material.from_dynamic({**data, "tan_delta": e.imag / e.real, "temperature": np.full(25, 300.0)}, poisson_ratio=0.45)
