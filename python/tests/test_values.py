"""Materials and indenters: functions of the material against closed forms, values compare and pickle."""

from __future__ import annotations

import inspect
import pickle
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from conftest import ROOT

import contact_dma as cd

MATERIALS = [
    cd.Material.library("pmma"),
    cd.Material.relaxation("2 MPa", [("8 MPa", "1 ms"), (5e6, 0.1)], poisson_ratio=0.5, name="rubber", measured=(1e-3, 10.0)),
    cd.Material.creep(1e-9, [(5e-10, 10.0)], poisson_ratio=0.3, compliance="shear"),
    cd.Material.zener("1 MPa", "2 MPa", "1 s", poisson_ratio=0.5),
    cd.Material.relaxation("2 MPa", [("8 MPa", "1 s")], bulk_modulus="30 MPa", modulus="shear"),
    cd.Material.zener("1 MPa", "2 MPa", "1 s", bulk_modulus="30 MPa", measured=("1 ms", "10 s"), name="standard"),
    cd.Material.maxwell("1 MPa", "1 s", bulk_modulus="30 MPa", measured=("1 ms", "10 s")),
    cd.Material.relaxation("2 MPa", [("8 MPa", "1 s")], bulk_modulus=(30e6, [("10 MPa", "3 s")]), modulus="shear"),
]
INDENTERS = [
    cd.Sphere("10 mm"),
    cd.Sphere(0.01, offset=("1 um", "0 um")),
    cd.Cone(1.2),
    cd.FlatPunch("1 mm"),
    cd.Ellipsoid(0.01, 0.02),
    cd.PowerLaw(4.0, radius=1e-3, height=1e-5),
    cd.Asperities([(0, 0, 1e-3), (2e-3, 0, 1e-3, -1e-6)]),
    cd.HeightMap(-np.add.outer(np.arange(-4, 5) ** 2, np.arange(-3, 4) ** 2) * 1e-9, spacing=("1 um", "2 um"), edge="rim"),
    cd.HeightMap(ROOT / "sweeps/height-map.csv", spacing="0.1 mm"),
    cd.HeightMap(np.zeros((8, 9)), spacing="1 um", edge="rim", offset=("1 um", "0 um")),
    cd.Profile(np.linspace(0.0, 1e-3, 9), np.linspace(0.0, 1e-3, 9) ** 2 / 0.02),
]


def test_functions_of_a_prony_series_are_its_closed_forms() -> None:
    rubber = MATERIALS[1]
    omega = np.logspace(-2, 4, 7).reshape(7, 1)
    expected = 2e6 + sum(m * 1j * omega * t / (1 + 1j * omega * t) for m, t in [(8e6, 1e-3), (5e6, 0.1)])
    assert rubber.complex_modulus(omega).shape == (7, 1)
    assert np.allclose(rubber.complex_modulus(omega), expected, rtol=1e-13)
    # E = 2 (1 + nu) G.
    assert np.allclose(rubber.complex_modulus(omega, modulus="shear") * 3.0, expected, rtol=1e-13)
    t = np.array([0.0, 1e-3, 1.0])
    assert np.allclose(rubber.relaxation_modulus(t), 2e6 + 8e6 * np.exp(-t / 1e-3) + 5e6 * np.exp(-t / 0.1), rtol=1e-13)
    assert rubber.creep_compliance(0.0) == pytest.approx(1 / 15e6, rel=1e-12)
    assert isinstance(rubber.complex_modulus(1.0), complex)
    assert rubber.prony.equilibrium == 2e6 and rubber.prony.times.tolist() == [1e-3, 0.1]
    j = MATERIALS[2].creep_compliance(t, modulus="shear")
    assert np.allclose(j, 1e-9 + 5e-10 * (1 - np.exp(-t / 10)), rtol=1e-13)


def test_a_kelvin_voigt_body_is_its_spring_and_dashpot() -> None:
    # G* = G (1 + i omega t), and E = 2 (1 + nu) G; without instantaneous compliance it has no series of its modulus.
    voigt = cd.Material.kelvin_voigt("1 MPa", "2 s", poisson_ratio=0.4)
    assert voigt.complex_modulus(3.0) == pytest.approx(2 * 1.4 * 1e6 * (1 + 6j), rel=1e-12)
    with pytest.raises(ValueError):
        voigt.prony
    with pytest.raises(TypeError, match="Material.kelvin_voigt, .*Material.from_toml"):
        cd.Material()


def test_samples_go_with_a_bulk_modulus() -> None:
    t = np.logspace(-1, 3, 60)
    solid = cd.Material.table(t, 1e6 + 2e6 * np.exp(-t / 10), quantity="relaxation", modulus="shear", bulk_modulus="30 MPa")
    assert solid.bulk_modulus == 30e6 and solid.poisson_ratio is None


@pytest.mark.parametrize("material", MATERIALS, ids=repr)
def test_a_material_pickles_and_compares_by_value(material: cd.Material) -> None:
    again = pickle.loads(pickle.dumps(material))
    assert again == material and hash(again) == hash(material) and again is not material
    assert cd.Material.from_toml(material.text).text == material.text
    assert again.complex_modulus(0.3) == material.complex_modulus(0.3)


@pytest.mark.parametrize("indenter", INDENTERS, ids=repr)
def test_an_indenter_pickles(indenter: cd.Indenter) -> None:
    again = pickle.loads(pickle.dumps(indenter))
    assert type(again) is type(indenter) and repr(again) == repr(indenter)
    assert again == indenter and hash(again) == hash(indenter) and [again == other for other in INDENTERS].count(True) == 1
    x, y = np.meshgrid(np.linspace(-3e-6, 3e-6, 5), np.linspace(-2e-6, 2e-6, 3))
    assert np.array_equal(again.gap(x, y), indenter.gap(x, y)) and indenter.gap(x, y).shape == (3, 5)


def test_indenters_compare_by_value() -> None:
    assert cd.Sphere("10 mm") == cd.Sphere(0.01) != cd.Sphere(0.02)
    assert cd.FlatPunch(0.01) != cd.Sphere(0.01) and cd.Sphere(0.01) != "Sphere(0.01)"
    heights = -np.add.outer(np.arange(-4, 5) ** 2, np.arange(-4, 5) ** 2) * 1e-9
    one, other = cd.HeightMap(heights, spacing=1e-6), cd.HeightMap(2 * heights, spacing=1e-6)
    assert one == cd.HeightMap(heights.tolist(), spacing="1 um") and one != other and one != cd.HeightMap(heights, spacing=2e-6)


def test_an_indenter_has_what_it_was_given_in_si_units() -> None:
    assert cd.Sphere("10 mm").radius == 0.01 and cd.Sphere("10 mm").offset is None
    assert cd.Cone("80 deg", offset=("1 um", 0)).offset == (1e-6, 0.0) and cd.Cone("45 deg").half_angle == pytest.approx(np.pi / 4)
    assert cd.Asperities([("1 mm", 0, 1e-3)]).asperities == ({"center": (1e-3, 0.0), "radius": 1e-3, "height": 0.0},)
    map = cd.HeightMap(np.zeros((8, 8)), spacing="1 um", edge="rim")
    assert map.spacing == (1e-6, 1e-6) and map.edge == "rim" and map.level == "none"
    with pytest.raises(AttributeError):
        cd.Sphere("10 mm").radius = 0.02  # type: ignore[misc]


def test_the_classes_of_indenters_are_complete() -> None:
    """As classes that are written by hand: in the package, with their documentation, signature, and a module that pickles find."""
    kinds = [kind for kind in vars(cd).values() if isinstance(kind, type) and issubclass(kind, cd.Indenter) and kind is not cd.Indenter]
    assert {type(indenter) for indenter in INDENTERS} <= set(kinds)
    for kind in kinds:
        assert kind.__name__ in cd.__all__ and kind.__module__ == "contact_dma" and kind.__doc__
        assert "offset" in inspect.signature(kind).parameters and "offset:" in str(kind.__init__.__doc__)


def test_a_profile_is_a_file_a_table_or_arrays() -> None:
    r = np.linspace(0.0, 2e-3, 21)
    profile = cd.Profile(r, r**2 / 0.02)
    assert profile == cd.Profile({"r": r, "gap": r**2 / 0.02}) == cd.Profile(pd.DataFrame({"r_m": r, "gap_m": r**2 / 0.02}))
    assert profile == cd.Profile([f"{1e3 * x!r} mm" for x in r.tolist()], r**2 / 0.02) or profile.gap(1e-3) == pytest.approx(5e-5)
    assert profile != cd.Profile(r, r**2 / 0.03) and profile.gap(1e-3) == pytest.approx(5e-5) and profile.gap(3e-3) == np.inf


def test_a_material_goes_to_a_finite_element_program() -> None:
    text = MATERIALS[0].export("abaqus")
    assert "*VISCOELASTIC, TIME=PRONY" in text and "contact-dma" in text
    rows = np.array([line.split(",") for line in MATERIALS[0].export("csv").splitlines()[1:]])
    assert rows[0, 0].astype(float) == pytest.approx(MATERIALS[0].prony.equilibrium)


def test_build_and_schema_are_known() -> None:
    assert cd.build and (cd.commit is None or len(cd.commit) > 6)
    assert "material" in cd.schema()["properties"]


def test_a_material_shows_its_moduli() -> None:
    assert repr(MATERIALS[1]) == "Material('rubber', instantaneous=1.5e+07, equilibrium=2e+06, poisson_ratio=0.5)"
    assert "instantaneous=1e+07" in repr(MATERIALS[4]) or "bulk_modulus" in repr(MATERIALS[4])


def test_an_array_in_any_memory_order_is_the_same_map() -> None:
    heights = -np.add.outer(np.arange(-4, 5) ** 2, np.arange(-3, 4) ** 2) * 1e-9
    one = cd.HeightMap(heights, spacing=1e-6)
    for other in (np.asfortranarray(heights), heights[::-1][::-1], heights.astype(np.float32).astype(float), heights.tolist()):
        assert np.allclose(cd.HeightMap(other, spacing=1e-6).gaps, one.gaps, rtol=1e-6, atol=1e-16)
    # Rows are along y: the map is wider in y.
    assert one.gap(3e-6, 0.0) == pytest.approx(9e-9) and one.gap(0.0, 4e-6) == pytest.approx(16e-9)


def test_measured_moduli_of_a_file_make_a_material() -> None:
    material = cd.Material.from_dynamic(
        ROOT / "sweeps/pyvisco-freq-user-raw.csv", poisson_ratio=0.38, temperature_of_sweep="40 °C", name="measured"
    )
    assert material.temperature == pytest.approx(313.15) and len(material.prony.moduli) > 3
    assert pickle.loads(pickle.dumps(material)) == material


def test_a_path_stays_right_in_another_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "profile.csv").write_text("r_m,gap_m\n0,0\n1e-3,5e-5\n2e-3,2e-4\n")
    monkeypatch.chdir(tmp_path)
    profile = cd.Profile("profile.csv")
    packed = pickle.dumps(profile)
    monkeypatch.chdir("/")
    assert pickle.loads(packed).gap(1e-3) == pytest.approx(5e-5)
