"""The angle of a wheel on its carrier, step by step: against closed forms of carriers that turn about several axes."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mbs.elements import SpinAngle
from tests.elements.harness import Array, Element, vectors

H = 0.01
ROUND_OFF = 1e-12


def element() -> Element:
    f, g, chi = vectors(3, 3, 1)
    return Element(SpinAngle().record("angle", f, g, chi[0]))


def signals(carrier: Rotation, chi: float) -> Array:
    """f along z, g along x: the axis along y."""
    return np.concatenate([carrier.apply([0.0, 0.0, 1.0]), carrier.apply([1.0, 0.0, 0.0]), [chi]])


def angle_at_the_end(carriers: list[Rotation], chis: Array) -> float:
    """After a start at the first of them."""
    one, rest = element(), np.zeros(7)
    y = one(signals(carriers[0], chis[0]), rest, accept=True).y
    out = one(signals(carriers[0], chis[0]), rest, y).out["angle"]
    assert out == 0.0
    for carrier, chi in zip(carriers[1:], chis[1:], strict=True):
        result = one(signals(carrier, chi), rest, y, H)
        y, out = result.y, result.out["angle"]
    return float(out)


def test_on_a_carrier_at_rest_it_is_the_coordinate_since_the_start() -> None:
    still = [Rotation.from_euler("xyz", [0.3, -0.2, 0.9])] * 4
    assert angle_at_the_end(still, np.array([7.0, 9.0, 12.0, 250.0])) == pytest.approx(243.0, abs=1e-12)


@pytest.mark.parametrize("turn", [0.4, -2.5, 3.0])
def test_a_carrier_that_turns_about_the_axis_takes_its_angle_away(turn: float) -> None:
    """One step is exact, however far it goes, as long as it is less than half a turn."""
    at = Rotation.from_euler("xyz", [0.3, -0.2, 0.9])
    carriers = [at, at * Rotation.from_euler("y", turn)]
    assert angle_at_the_end(carriers, np.array([1.0, 6.0])) == pytest.approx(5.0 - turn, abs=ROUND_OFF)


def cone(tilt: float, n: int) -> list[Rotation]:
    """Carriers turned once about the vertical by `n` steps, with the axis up by `tilt` from the horizontal."""
    return [Rotation.from_euler("z", psi) * Rotation.from_euler("x", tilt) for psi in np.linspace(0.0, 2.0 * np.pi, n)]


def test_an_axis_around_a_cone_gives_the_angle_that_no_position_shows() -> None:
    """Once about the vertical: e . w = psi' sin(tilt), so -2 pi sin(tilt), and the error of steps falls with h^2."""
    for tilt in (0.5, -0.9):
        error = [abs(angle_at_the_end(cone(tilt, n), np.zeros(n)) + 2.0 * np.pi * np.sin(tilt)) for n in (201, 401)]
        assert error[-1] < 1e-4
        assert error[0] / error[1] == pytest.approx(4.0, rel=0.01)


def test_evaluated_without_a_step_nothing_changes() -> None:
    one, at = element(), Rotation.from_euler("xyz", [0.3, -0.2, 0.9])
    y = one(signals(at, 2.0), np.zeros(7), accept=True).y
    other = one(signals(Rotation.identity(), 5.0), np.zeros(7), y)
    assert np.array_equal(other.y, y)
    assert other.out["angle"] == 3.0
    assert not np.any(other.f)
