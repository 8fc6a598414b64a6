"""Formulas of derived variables against SciPy's rotations and closed forms, and what is refused of them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from hosts.common.errors import HostError
from hosts.fmu.aliases.derivation import Derivation
from hosts.fmu.aliases.derived_variable import parse_derived
from hosts.fmu.aliases.file import read_aliases
from hosts.fmu.aliases.formulas import FORMULAS

TIME = np.linspace(0.0, 2.0, 2001)
YAW, PITCH, ROLL = 3.0 * TIME, 0.3 * np.sin(2.0 * TIME), 0.2 * np.cos(3.0 * TIME)
TURNS = Rotation.from_euler("ZYX", np.column_stack([YAW, PITCH, ROLL]))
Q = TURNS.as_quat()[:, [3, 0, 1, 2]].T
POSITION = np.array([20.0 * np.sin(TIME), 15.0 * np.cos(0.7 * TIME), 0.1 * np.sin(5.0 * TIME)])
VELOCITY = np.array([20.0 * np.cos(TIME), -10.5 * np.sin(0.7 * TIME), 0.5 * np.cos(5.0 * TIME)])
ACCELERATION = np.array([-20.0 * np.sin(TIME), -7.35 * np.cos(0.7 * TIME), -2.5 * np.sin(5.0 * TIME)])
R = np.array([1.2, -0.4, 0.3])
INNER = slice(2, -2)


def of(name, *arguments):
    return FORMULAS[name].compute(TIME, *arguments)


def in_vehicle(vectors):
    return TURNS.inv().apply(vectors.T).T


def angular_velocity():
    """In vehicle axes, by the closed form of these angles' rates."""
    yaw, pitch, roll = 3.0 + 0.0 * TIME, 0.6 * np.cos(2.0 * TIME), -0.6 * np.sin(3.0 * TIME)
    return np.array(
        [
            roll - yaw * np.sin(PITCH),
            pitch * np.cos(ROLL) + yaw * np.cos(PITCH) * np.sin(ROLL),
            yaw * np.cos(PITCH) * np.cos(ROLL) - pitch * np.sin(ROLL),
        ]
    )


def test_angles_of_a_quaternion():
    signs = np.where(np.arange(len(TIME)) % 7 < 3, -1.0, 1.0)  # both signs are the same turn
    assert of("yaw", *(signs * Q)) == pytest.approx(YAW, abs=1e-12)
    assert of("pitch", *Q) == pytest.approx(PITCH, abs=1e-12)
    assert of("roll", *Q) == pytest.approx(ROLL, abs=1e-12)


@pytest.mark.parametrize("axis", range(3))
def test_vectors_in_vehicle_axes(axis):
    result = of(f"vehicle_{'xyz'[axis]}", *VELOCITY, ROLL, PITCH, YAW)
    assert result == pytest.approx(in_vehicle(VELOCITY)[axis], abs=1e-12)


@pytest.mark.parametrize("axis", range(3))
def test_another_point_of_the_car(axis):
    name = "xyz"[axis]
    place = POSITION + TURNS.apply(R).T
    assert of(f"point_{name}", *POSITION, ROLL, PITCH, YAW, *R) == pytest.approx(place[axis], abs=1e-12)
    w = angular_velocity()
    exact = in_vehicle(np.gradient(place, TIME, axis=1))[axis]
    result = of(f"point_v{name}", *in_vehicle(VELOCITY), *w, *R)
    assert result[INNER] == pytest.approx(exact[INNER], abs=2e-4)
    moved = VELOCITY + TURNS.apply(np.cross(w.T, R)).T
    exact = in_vehicle(np.gradient(moved, TIME, axis=1))[axis]
    result = of(f"point_a{name}", *in_vehicle(ACCELERATION), *w, *R)
    assert result[INNER] == pytest.approx(exact[INNER], abs=2e-4)


@pytest.mark.parametrize("axis", range(3))
def test_rates(axis):
    name = "xyz"[axis]
    w = angular_velocity()
    result = of(f"angular_velocity_{name}", *Q, *np.gradient(Q, TIME, axis=1, edge_order=2))
    assert result[INNER] == pytest.approx(w[axis][INNER], abs=2e-5)
    result = of(f"acceleration_{name}", *in_vehicle(VELOCITY), *w)
    assert result[INNER] == pytest.approx(in_vehicle(ACCELERATION)[axis][INNER], abs=2e-3)


def test_the_others():
    assert of("sideslip", np.array([10.0, 0.05, -5.0]), np.array([1.0, 0.05, 0.0])) == pytest.approx(
        [np.arctan2(1, 10), 0.0, np.pi]
    )
    assert of("length", np.array([3.0]), np.array([4.0]), 12.0) == pytest.approx([13.0])
    assert of("product", np.array([3.0, 1.0]), 2.0, -1.0) == pytest.approx([-6.0, -2.0])
    wrapped = np.angle(np.exp(1j * YAW))
    assert of("unwrapped", wrapped) == pytest.approx(YAW, abs=1e-9)
    assert np.isnan(FORMULAS["rate"].compute(np.zeros(1), np.ones(1))).all()


def test_rows_that_come_one_by_one():
    """Angles count turns across the rows that are remembered, rates are of second order, a jump back forgets."""
    derived = [
        parse_derived("yaw", "yaw(w, x, y, z)", {}, "f"),
        parse_derived("rate", "rate(yaw)", {}, "f"),
        parse_derived("twice", "product(rate, 2)", {}, "f"),
        parse_derived("lost", "rate(nothing)", {}, "f"),
    ]
    derivation = Derivation(derived[::-1], ("w", "x", "y", "z"))
    assert set(derivation.names) == {"yaw", "rate", "twice"}
    rows = np.array([derivation.update(t, q) for t, q in zip(TIME, Q.T, strict=True)])
    columns = dict(zip(derivation.names, rows.T, strict=True))
    assert columns["yaw"] == pytest.approx(YAW, abs=1e-9)
    assert np.isnan(columns["rate"][0])
    assert columns["rate"][1:] == pytest.approx(3.0, abs=1e-6)
    assert columns["twice"][1:] == pytest.approx(6.0, abs=1e-6)
    again = dict(zip(derivation.names, derivation.update(TIME[-1], Q[:, -1]), strict=True))
    assert again["rate"] == pytest.approx(3.0, abs=1e-6)
    first = dict(zip(derivation.names, derivation.update(0.0, Q[:, 0]), strict=True))
    assert first["yaw"] == pytest.approx(0.0, abs=1e-12)
    assert np.isnan(first["rate"])


NAMES = ("vx", "vy", "qw", "Throttle")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('sideslip = { from = "sideslip vx, vy" }', "it must be a formula such as sideslip(chassis.vx, chassis.vy)"),
        ('sideslip = { from = "sidesslip(vx, vy)" }', "there is no formula 'sidesslip'; did you mean 'sideslip'"),
        ('sideslip = { from = "sideslip(vx)" }', "sideslip takes (vx, vy), 2 in number; it is given 1"),
        ('sideslip = { from = "sideslip(vx, )" }', "an argument of the formula is empty"),
        ('sideslip = { from = "sideslip(vx, vz)" }', "'vz' is neither an input or output of the FMU nor another name"),
        ('a = { from = "rate(b)" }\nb = { from = "rate(a)" }', "'b' is neither"),
        ('sideslip = { from = "sideslip(vx, vy)", factor = 2 }', "'from' must stand alone"),
        ('throttle = { name = "Throttle", unit = "furlong" }', "the unit 'furlong' is not known (such as m, km/h"),
        ('throttle = { name = "Throttle", unit = "degC" }', "the unit 'degC' has another zero than the SI unit"),
        ('throttle = { name = "Throttle", factor = "big" }', "factor is 'big'; it must be a number, or a constant"),
        ('extends = "carsin"', "extends is 'carsin': there is neither a file"),
        ("needs = 3", "[needs] must be a table of texts"),
        ('partial = true\nthrottle = "Gas"', "of its 1 names this FMU has none, such as 'Gas'; is it an FMU of that"),
    ],
)
def test_each_error_is_one_sentence(text, message, tmp_path):
    file = tmp_path / "a.toml"
    file.write_text(text)
    with pytest.raises(HostError) as refusal:
        read_aliases(file, NAMES)
    assert message in str(refusal.value)
    assert "\n" not in str(refusal.value)


def test_files_that_extend_one_another(tmp_path):
    (tmp_path / "base.toml").write_text(
        'partial = true\nthrottle = "Gas"\nspeed = { name = "vx", factor = "k" }\nnone = "no"\n[needs]\nk = "a number"'
    )
    (tmp_path / "mine.toml").write_text('extends = "base.toml"\nthrottle = "Throttle"\n[constants]\nk = 3.6')
    aliases = read_aliases(tmp_path / "mine.toml", NAMES)
    assert {a.name: (a.fmu_name, a.factor) for a in aliases.aliases} == {
        "throttle": ("Throttle", 1.0),
        "speed": ("vx", 3.6),
    }
    assert list(aliases.missing) == ["none"]
    (tmp_path / "ring.toml").write_text('extends = "ring.toml"')
    with pytest.raises(HostError, match="does one extend itself"):
        read_aliases(tmp_path / "ring.toml", NAMES)
