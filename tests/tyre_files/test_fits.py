"""Conversion of tyres between both formulas and to files: by the kernel's forces of both, with reported errors."""

from dataclasses import asdict, replace
from functools import cache
from math import atan
from pathlib import Path

import numpy as np
import pytest

from mbs.elements import MagicTyre, Tyre
from mbs.kernel.header.magic_coefficients import MAGIC_COEFFICIENTS
from mbs.tyre_files import read_tyre
from mbs.tyre_files.fit_magic_formula import magic_of_tmeasy
from mbs.tyre_files.fit_tmeasy import tmeasy_of_magic
from mbs.tyre_files.magic_file import asymmetric_coefficients
from mbs.tyre_files.property_writer import write_tyre
from mbs.tyre_files.pure_curves import magic_trail
from tests.elements.harness import Element
from tests.elements.test_magic_tyre import element_of, pose
from tests.elements.tyre_data import TYRE, tyre_element

DATA = Path(__file__).with_name("data")
FILES = [*sorted(DATA.glob("*.tir")), *sorted(DATA.glob("chrono/*.tir"))]
ids = [file.stem for file in FILES]


@cache
def magic(file: Path) -> MagicTyre:
    return replace(read_tyre(file).tyre(), pressure=0.0)


def steady(element: Element, height: float, speed: float, omega: float, across: float) -> dict[str, float]:
    """Outputs of an upright wheel after it has rolled for long."""
    y = np.zeros(len(element.element.states))
    u = np.array([0.0, 0.0, height, 0.0, 1.0, 0.0, 0.0])
    for _ in range(60):
        r = element(u, np.array([speed, across, 0.0, 0.0, 0.0, 0.0, omega]), y, 1.0)
        y = r.y
    return r.out


def force_of(tyre: Tyre | MagicTyre, load: float, kappa: float, tangent: float) -> tuple[float, float]:
    """Longitudinal and lateral force of the kernel at a slip that refers to the speed of travel."""
    speed = 20.0
    if isinstance(tyre, Tyre):
        deflection = load / tyre.stiffness
        omega = (1.0 + kappa) * speed / ((2.0 * tyre.radius + tyre.radius - deflection) / 3.0)
        element = tyre_element(tyre)
    else:
        u, ud = pose(tyre, load, kappa, 0.0, 0.0, speed)
        omega, deflection = ud[6], tyre.radius - u[2]
        if not tyre.coefficients.get("DREFF"):
            omega = (1.0 + kappa) * speed / (tyre.radius - deflection / 3.0)
        element = element_of(tyre, tyre.reference_friction)
    out = steady(element, tyre.radius - deflection, speed, omega, speed * tangent)
    assert out["vertical_force"] == pytest.approx(load, rel=1e-3)
    return out["longitudinal_force"], out["lateral_force"]


@pytest.mark.parametrize("q", [0.5, 2.0])
def test_the_magic_formula_of_a_tmeasy_tyre_has_its_forces_within_the_reported_errors(q: float) -> None:
    result, errors = magic_of_tmeasy(TYRE)
    load = q * TYRE.nominal_load
    assert errors["longitudinal"] < 0.17
    assert errors["lateral"] < 0.03
    peaks = [q * TYRE.reference_friction * 0.85 * TYRE.nominal_load] * 2
    for kappa in (-0.3, -0.05, 0.02, 0.1, 0.6):
        difference = force_of(result, load, kappa, 0.0)[0] - force_of(TYRE, load, kappa, 0.0)[0]
        assert abs(difference) < (errors["longitudinal"] + 0.005) * peaks[0] * 1.2
    for tangent in (0.02, 0.08, 0.3):
        difference = force_of(result, load, 0.0, tangent)[1] - force_of(TYRE, load, 0.0, tangent)[1]
        assert abs(difference) < (errors["lateral"] + 0.005) * peaks[1] * 1.2
    assert result.coefficients["PKX1"] * result.nominal_load == pytest.approx(TYRE.longitudinal.slope[0], rel=0.1)


@pytest.mark.parametrize("file", FILES, ids=ids)
def test_tmeasy_of_a_file_has_its_forces_within_the_reported_errors(file: Path) -> None:
    bare = replace(magic(file), combination="none")
    shifts = ("PHX1", "PHX2", "PVX1", "PVX2", "PEX4", "PHY1", "PHY2", "PVY1", "PVY2", "PEY3", "LMUV", "RVY1", "RVY2")
    bare = replace(bare, coefficients={**bare.coefficients, **dict.fromkeys(shifts, 0.0)})
    result, errors = tmeasy_of_magic(bare)
    c = {"QSY1": 0.0, "LMY": 1.0, "Q_RE0": 1.0} | bare.coefficients
    assert (result.radius, result.rolling_resistance) == (bare.radius * c["Q_RE0"], c["QSY1"] * c["LMY"])
    c |= {"LONGITUDINAL_STIFFNESS": 0.0, "LATERAL_STIFFNESS": 0.0} | bare.coefficients
    for stiffness, of_file in zip(
        result.carcass_stiffness, ("LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS"), strict=True
    ):
        assert (stiffness == c[of_file]) == (c[of_file] > 0.0)
    assert errors["lateral"] < 0.12
    if file.stem == "HMMWV_Pac02Tire":  # its longitudinal slip stiffness fades to nothing by PKX2: no curve of TMeasy
        assert errors["longitudinal"] > 0.3
        return
    assert errors["longitudinal"] < 0.22
    load = result.nominal_load
    for kappa in (-0.3, -0.03, 0.1):
        one, two = (force_of(tyre, load, kappa, 0.0)[0] for tyre in (bare, result))
        assert abs(one - two) < (errors["longitudinal"] + 0.02) * 1.3 * load
    for tangent in (0.02, 0.1, 0.3):
        one, two = (force_of(tyre, load, 0.0, tangent)[1] for tyre in (bare, result))
        assert abs(one - two) < (errors["lateral"] + 0.02) * 1.3 * load


@pytest.mark.parametrize("tangent", [0.05, 0.6])
@pytest.mark.parametrize("version", ["MF52", "MF61", "MF62"])
def test_the_trail_of_the_fit_is_that_of_the_kernel(version: str, tangent: float) -> None:
    """At tan(alpha) = 0.6 the cosine of the slip angle, 0.857, is 4 % above that of its tangent."""
    c = {**magic(FILES[0]).coefficients, "PDY1": 1.0, "PEY1": -1.0, "QBZ1": 3.0, "QCZ1": 1.1, "QDZ1": 0.1, "QEZ1": -1.0}
    shifts = ("PHX", "PVX", "PHY", "PVY", "QHZ", "QDZ6", "QDZ7", "QEZ4", "QEZ5", "SSZ", "LMUV")
    c |= {name: 0.0 for name in MAGIC_COEFFICIENTS if name.startswith(shifts)}
    tyre, load = replace(magic(FILES[0]), version=version, coefficients=c, combination="none"), 3000.0
    element, height, speed, omega, _ = _rolling(tyre, load, 0.0, 0.0)
    out = steady(element, height, speed, omega, speed * tangent)
    assert out["vertical_force"] == pytest.approx(load, rel=1e-9)
    trail = magic_trail(c, tyre.nominal_load, tyre.radius, load, tangent, version)
    assert -out["aligning_moment"] / out["lateral_force"] == pytest.approx(trail, rel=1e-6)


@pytest.mark.parametrize("file", FILES[:4], ids=ids[:4])
def test_a_written_file_is_read_as_the_same_tyre(tmp_path: Path, file: Path) -> None:
    tyre = replace(magic(file), lky=1.1)
    write_tyre(tmp_path / "again.tir", tyre, "LEFT", "written again")
    again = read_tyre(tmp_path / "again.tir").tyre()
    c = dict(tyre.coefficients)
    c["LKY"] = c.get("LKY", 1.0) * 1.1
    for name, value in asdict(replace(tyre, lky=1.0, coefficients={})).items():
        if name not in ("coefficients", "largest_load"):
            expected = value if isinstance(value, (str, bool, type(None))) else pytest.approx(value, rel=1e-12)
            assert getattr(again, name) == expected, name
    assert {n: v for n, v in c.items() if again.coefficients[n] != pytest.approx(v, rel=1e-12)} == {}
    assert (tmp_path / "again.tir").read_text(encoding="utf-8").startswith("$ written again\n")


def test_a_symmetric_tyre_is_written_and_read_as_it_is(tmp_path: Path) -> None:
    """Whatever a reader of a symmetric file sets to 0 is 0 in what may be written as one."""
    for file in FILES:
        tyre = magic(file)
        c = {n: v for n, v in tyre.coefficients.items() if n not in asymmetric_coefficients(tyre.version)}
        write_tyre(tmp_path / "even.tir", replace(tyre, coefficients=c))
        again = read_tyre(tmp_path / "even.tir").tyre().coefficients
        assert again == pytest.approx({n: c.get(n, MAGIC_COEFFICIENTS[n]) for n in again})


def test_a_written_tyre_keeps_grip_and_progression(tmp_path: Path) -> None:
    """LMUX and LMUY take the friction factor; VERTICAL_STIFFNESS, at FNOMIN, agrees with Q_FZ1 and Q_FZ2."""
    plain = replace(magic(FILES[0]), progression=2e5)
    tyre = replace(plain, friction_factor=0.8, reference_friction=1.25)
    write_tyre(tmp_path / "a.tir", tyre, "LEFT")
    read = read_tyre(tmp_path / "a.tir")
    again = read.tyre()
    assert [note for note in read.notes if "VERTICAL_STIFFNESS" in note] == []
    assert (again.stiffness, again.progression) == pytest.approx((tyre.stiffness, 2e5), rel=1e-12)
    for name in ("LMUX", "LMUY"):
        assert again.coefficients[name] == pytest.approx(0.64 * tyre.coefficients.get(name, 1.0), rel=1e-12)
    again = replace(again, largest_load=tyre.largest_load)
    for kappa, tangent in ((0.1, 0.0), (0.0, 0.2)):
        first, second = (
            steady(*_rolling(t, 3000.0, kappa, tangent))["longitudinal_force" if kappa else "lateral_force"]
            for t in (tyre, again)
        )
        assert first == pytest.approx(second, rel=1e-9)


def _rolling(tyre: MagicTyre, load: float, kappa: float, tangent: float) -> tuple[Element, float, float, float, float]:
    """What `steady` takes, on a road of friction 1."""
    u, ud = pose(tyre, load, kappa, 0.0, 0.0, 20.0)
    return element_of(tyre, 1.0), u[2], 20.0, ud[6], 20.0 * tangent


def test_files_that_cannot_be_written_or_made_are_reported(tmp_path: Path) -> None:
    tyre = magic(FILES[0])
    for change in ({"mirrored": True}, {"signs": "sae"}, {"pressure": 0.1}):
        with pytest.raises(ValueError, match="ISO axes, not mirrored, and at its nominal pressure"):
            write_tyre(tmp_path / "a.tir", replace(tyre, **change))
    with pytest.raises(ValueError, match=r"bore must be None and settling 0\.006 s"):
        write_tyre(tmp_path / "a.tir", replace(tyre, settling=0.01))
    with pytest.raises(ValueError, match="combination must not be 'none'"):
        write_tyre(tmp_path / "a.tir", replace(tyre, combination="none"))
    with pytest.raises(ValueError, match="friction factor of the tyre is 0"):
        write_tyre(tmp_path / "a.tir", replace(tyre, friction_factor=0.0))
    with pytest.raises(ValueError, match=r"not symmetric: .*PHY1.* as 0\. Give the side .*'LEFT' or 'RIGHT'"):
        write_tyre(tmp_path / "a.tir", tyre)
    assert not list(tmp_path.iterdir())
    with pytest.raises(ValueError, match=r"pressure of the tyre is 1\.1 times the nominal pressure"):
        tmeasy_of_magic(replace(tyre, pressure=0.1))


def test_slip_angles_of_the_fit_are_those_of_the_formula() -> None:
    """Up to 5.2 the formula has the angle, from 6.1 on its tangent: 0.5 rad are 9 % apart."""
    result, _ = magic_of_tmeasy(TYRE)
    assert force_of(result, 1500.0, 0.0, 0.5)[1] == pytest.approx(
        force_of(replace(result, version="MF61"), 1500.0, 0.0, atan(0.5))[1], rel=2e-2
    )
