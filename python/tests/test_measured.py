"""Measured loops and identification."""

from __future__ import annotations

import pickle
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT

import contact_dma as cd

LOOPS = sorted((ROOT / "sweeps/measured-loops").glob("*.csv"))


def drawn_by(program: str, folder: Path, figure: str) -> None:
    """The program draws what Python has saved."""
    subprocess.run([program, "report", str(folder)], check=True, capture_output=True)
    assert (folder / "index.html").is_file() and (folder / f"figures/{figure}.svg").is_file()


def test_files_give_what_the_program_writes(program: str, tmp_path: Path) -> None:
    out = tmp_path / "program"
    arguments = [program, "analyse", *map(str, LOOPS), "--quiet", "--no-figures", "--out", str(out)]
    subprocess.run(arguments, check=True, capture_output=True)
    result = cd.analyse(LOOPS)
    result.save(tmp_path / "python")
    for file in sorted(path.relative_to(out) for path in out.rglob("*.*")):
        assert (tmp_path / "python" / file).read_bytes() == (out / file).read_bytes(), file
    drawn_by(program, tmp_path / "python", "energy-loss")
    assert cd.read(out) == cd.read(tmp_path / "python") == result == pickle.loads(pickle.dumps(result))
    assert len(result.cycles) == len(LOOPS) and result.cycles[0].load.shape == (201,)
    assert result["file"][0].endswith(".csv") and "<title>load" in result._repr_html_()
    # Of a smooth loop of 200 samples the polygon is low by 0.02 %.
    area = [0.5 * abs(np.dot(c.load[:-1], np.roll(c.approach[:-1], -1)) - np.dot(c.approach[:-1], np.roll(c.load[:-1], -1)))
            for c in result.cycles]
    assert area == pytest.approx(result["energy_loss_j"], rel=1e-2)


def test_a_setup_gives_moduli_and_a_bad_record_says_why() -> None:
    t = np.linspace(0.0, 20.0, 2001)
    good = {"time": t, "load": 1 + 0.5 * np.sin(3 * t), "approach": 1e-5 + 2e-6 * np.sin(3 * t - 0.2)}
    flat = {"time": t, "load": np.ones_like(t), "approach": np.zeros_like(t)}
    setup = {"contact": {"poisson_ratio": 0.4}, "indenter": cd.Sphere("1 mm")}
    with pytest.warns(cd.ContactDmaWarning, match="1 of 2 records"):
        result = cd.analyse([good, flat], frequency="3 rad/s", setup=setup)
    with pytest.raises(RuntimeError, match="record 1 is failed"):
        result.raise_for_status()
    assert result["storage_modulus_pa"][0] > 0 and np.isnan(result["energy_loss_j"][1])
    assert result.status[0].converged and "same in all samples" in str(result.status[1])


def test_a_solid_is_found_through_what_else_is_in_the_contact() -> None:
    solid = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], poisson_ratio=0.45)
    sphere, rubber = cd.Sphere("2 mm"), cd.Material.elastic("20 MPa", poisson_ratio=0.5)
    drive: dict[str, Any] = {"mean": "0.2 N", "amplitude": "0.1 N"}
    for bodies in ({"indenter_material": rubber}, {"adhesion": {"work": "5 J/m^2", "model": "dmt"}}):
        cycles = cd.sweep(solid, sphere, angular_frequency=[0.1, 0.3, 1.0, 3.0, 10.0], **drive, **bodies)
        columns = ["angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m"]
        found = cd.identify({name: cycles[name] for name in columns}, sphere, poisson_ratio=0.45, branches=1, **drive, **bodies)
        assert abs(found.prony.equilibrium / 10e6 - 1) < 1e-3, bodies
    segments = [{"kind": "ramp", "to": "0.2 N", "duration": "0.1 s"}, {"kind": "ramp", "to": "0.2 N", "duration": "20 s"}]
    crept = cd.simulate(solid, sphere, segments=segments, indenter_material=rubber)
    later = crept["time_s"] > 0.1
    columns = ["time_s", "approach_m"]
    data = {name: crept[name][later][::5] for name in columns}
    found = cd.identify(data, sphere, poisson_ratio=0.45, branches=1, segments=segments, indenter_material=rubber)
    assert abs(found.prony.equilibrium / 10e6 - 1) < 1e-3


SOLID = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], poisson_ratio=0.45)
DRIVE: dict[str, Any] = {"mean": "0.2 N", "amplitude": "0.1 N"}


def measured() -> tuple[dict[str, Any], dict[str, Any]]:
    """Cycles of a solid as lists, and what `identify` is given beside."""
    cycles = cd.sweep(SOLID, cd.Sphere("2 mm"), angular_frequency=[0.1, 0.3, 1.0, 3.0, 10.0], **DRIVE)
    columns = ["angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m"]
    return {name: cycles[name].tolist() for name in columns}, {"poisson_ratio": 0.45, "branches": 1, **DRIVE}


def test_none_is_a_number_that_was_not_measured_and_its_column_stays() -> None:
    data, options = measured()
    data["energy_loss_j"][1] = None
    found = cd.identify(data, cd.Sphere("2 mm"), **options)
    assert len(found.fit["column"]) == 9 and set(found.fit["column"]) == {"energy_loss_j", "approach_max_m"}
    assert found.prony.equilibrium == pytest.approx(10e6, rel=0.01)
    assert found.fit.to_pandas().shape[0] == 9
    data["energy_loss_j"][1] = float("nan")
    assert cd.identify(pd.DataFrame(data), cd.Sphere("2 mm"), **options).fit == found.fit


def test_what_is_no_number_is_an_error_and_an_unknown_column_is_named() -> None:
    data, options = measured()
    for wrong in ["-", object(), "3 N"]:
        data["energy_loss_j"][1] = wrong
        with pytest.raises(ValueError, match="energy_loss_j, entry 1"):
            cd.identify(data, cd.Sphere("2 mm"), **options)
    data["enery_loss_j"] = [1e-9] * 5
    del data["energy_loss_j"]
    with pytest.warns(cd.ContactDmaWarning, match="enery_loss_j"):
        cd.identify(data, cd.Sphere("2 mm"), **options)


def test_an_identification_that_misses_its_data_warns() -> None:
    data, options = measured()
    data["energy_loss_j"][2] *= 1.2
    data["energy_loss_error_j"] = [1e-3 * loss for loss in data["energy_loss_j"]]
    data["approach_max_error_m"] = [1e-3 * approach for approach in data["approach_max_m"]]
    with pytest.warns(cd.ContactDmaWarning, match="identify: .*the data") as seen:
        cd.identify(data, cd.Sphere("2 mm"), **options)
    assert seen[0].filename == __file__


def test_a_data_frame_is_a_record() -> None:
    t = np.linspace(0.0, 20.0, 2001)
    record = {"time": t, "load": 1 + 0.5 * np.sin(3 * t), "approach": 1e-5 + 2e-6 * np.sin(3 * t - 0.2)}
    expected = cd.analyse(record)
    frame = pd.DataFrame(record)
    assert cd.analyse(frame) == expected == cd.analyse([frame.rename(columns={"time": "time_s", "load": "load_n", "approach": "approach_m"})])


def test_a_bulk_modulus_is_known_in_place_of_the_poisson_ratio() -> None:
    solid = cd.Material.relaxation("10 MPa", [("30 MPa", "1 s")], bulk_modulus="60 MPa")
    sphere = cd.Sphere("2 mm")
    drive: dict[str, Any] = {"mean": 0.2, "amplitude": 0.1}
    cycles = cd.sweep(solid, sphere, angular_frequency=[0.1, 0.3, 1.0, 3.0, 10.0], **drive)
    data = {name: cycles[name] for name in ["angular_frequency_rad_per_s", "energy_loss_j", "approach_max_m"]}
    found = cd.identify(data, sphere, bulk_modulus="60 MPa", branches=1, **drive)
    assert found.prony.equilibrium == pytest.approx(10e6, rel=0.005)
    with pytest.raises(ValueError, match="takes the place of"):
        cd.identify(data, sphere, poisson_ratio=0.4, bulk_modulus="60 MPa", **drive)


def test_an_identification_file_gives_what_the_program_writes(program: str, tmp_path: Path) -> None:
    file, out = ROOT / "sweeps/identify-polymer.toml", tmp_path / "program"
    arguments = [program, "identify", str(file), "--set", "identify.branches=3", "--quiet", "--no-figures", "--out", str(out)]
    subprocess.run(arguments, check=True, capture_output=True)
    found = cd.identify(file=file, overrides={"identify.branches": 3})
    found.save(tmp_path / "python")
    for name in sorted(path.relative_to(out) for path in out.rglob("*") if path.is_file()):
        assert (tmp_path / "python" / name).read_bytes() == (out / name).read_bytes(), name
    drawn_by(program, tmp_path / "python", "moduli")
    again = pickle.loads(pickle.dumps(found))
    assert again.material == found.material and again.summary == found.summary
    for folder in (out, tmp_path / "python"):
        read = cd.read(folder)
        assert isinstance(read, cd.IdentifiedMaterial) and read.material == found.material and read.report == found.report
    assert found.moduli["angular_frequency_rad_per_s"].dtype == float and found.fit["column"].dtype.kind == "U"


def test_approaches_whose_zero_is_unknown_are_no_data() -> None:
    data, options = measured()
    cycles = cd.sweep(SOLID, cd.Sphere("2 mm"), angular_frequency=data["angular_frequency_rad_per_s"], **DRIVE)
    data["approach_max_m"] = [3e-6 + approach for approach in data["approach_max_m"]]
    data["phase_lag_rad"] = cycles["phase_lag_rad"].tolist()
    found = cd.identify(data, cd.Sphere("2 mm"), approach_zero="unknown", **options)
    assert set(found.fit["column"]) == {"energy_loss_j", "phase_lag_rad"}
    assert found.prony.equilibrium == pytest.approx(10e6, rel=0.02)


class ForceCurve:
    """What afmformats gives of a force curve: columns by name, in SI units, with heights that fall as the probe comes nearer."""

    def __init__(self, columns: dict[str, Any], spring: float) -> None:
        self._columns, self.columns, self.metadata = columns, list(columns), {"spring constant": spring}

    def __getitem__(self, name: str) -> Any:
        return self._columns[name]


def test_force_curves_of_afmformats_are_identified_as_files_are(tmp_path: Path) -> None:
    gel = cd.Material.fractional(
        model="springpot", modulus="longitudinal", stiffness="1 kPa", time="1 s", exponent=0.2, band=["0.05 rad/s", "1e4 rad/s"], poisson_ratio=0.5
    )
    sphere = cd.Sphere("5 um")
    ramp = [{"kind": "ramp", "to": "0.5 um", "duration": "0.5 s"}, {"kind": "step", "to": "0.5 um", "duration": "1 s"}]
    history = cd.simulate(gel, sphere, control="approach", segments=ramp)
    noise = np.random.default_rng(1).normal(size=len(history["load_n"]))
    force = np.asarray(history["load_n"]) * (1.0 + 1e-3 * noise)
    indentation = np.asarray(history["approach_m"])
    curve = ForceCurve({"time": history["time_s"], "force": force, "height (measured)": 1e-5 - indentation - force / 0.05}, 0.05)
    of_object = cd.identify(curve, sphere, poisson_ratio=0.5, law=["power-law", "standard-solid"])
    assert of_object.summary["law"] == "power-law"
    assert of_object.summary["parameters"]["exponent"]["value"] == pytest.approx(0.2, abs=0.01)
    columns = {"time_s": history["time_s"], "force_n": force, "indentation_m": indentation - 1e-5}
    pd.DataFrame(columns).to_csv(tmp_path / "curve.csv", index=False)
    of_file = cd.identify(curve=[str(tmp_path / "curve.csv")], indenter=sphere, poisson_ratio=0.5, law=["power-law", "standard-solid"])
    value = of_file.summary["parameters"]["modulus_pa"]["value"]
    assert of_object.summary["parameters"]["modulus_pa"]["value"] == pytest.approx(value, rel=1e-6)
    with pytest.raises(ValueError, match="spring constant"):
        cd.identify(ForceCurve({"time": [0.0], "force": [0.0], "height (measured)": [0.0]}, float("nan")), sphere, poisson_ratio=0.5)


class Topography:
    """What SurfaceTopography gives of a map: heights with the first axis along x, in a unit."""

    unit, pixel_size = "um", (0.1, 0.2)

    def heights(self) -> Any:
        return -0.01 * (np.linspace(-1, 1, 16)[:, None] ** 2 + np.linspace(-1, 1, 12)[None, :] ** 2)


def test_a_topography_is_the_map_of_its_heights() -> None:
    own = cd.HeightMap(Topography())
    assert own == cd.HeightMap(1e-6 * Topography().heights().T, spacing=["1e-07 m", "2e-07 m"])
    assert own.gaps.shape == (12, 16)
