"""The angle of a reduced wheel on its carrier: against the same wheel as a full body on a bearing."""

import numpy as np
from scipy.spatial.transform import Rotation

from mbs import Model, Simulation, compile
from tests.model.test_spin import AXIS, CENTRE
from tests.model.test_spin import gyroscope as spinning

RIM = CENTRE + 0.2 * np.array([0.0, 0.0, 1.0])


def gyroscope(reduced: bool) -> Model:
    m, wheel = spinning(reduced)
    if reduced:
        m.sense_angle("angle", wheel)
        for c in "xyzw":
            m.sense_rotation(f"q{c}", wheel.carrier, c)
    else:
        for c in "xyz":
            m.sense_position(f"rim.{c}", wheel, RIM, c)
    return m


def rim(reduced: bool, h: float) -> np.ndarray:
    t = Simulation(compile(gyroscope(reduced))).run(0.8, h)
    every = round(0.016 / h)
    if not reduced:
        return np.array([t[f"rim.{c}"][::every] for c in "xyz"]).T
    centre = np.array([t[f"tip.{c}"][::every] for c in "xyz"]).T
    carrier = Rotation.from_quat(np.array([t[f"q{c}"][::every] for c in "xyzw"]).T)
    turned = Rotation.from_rotvec(t["angle"][::every, None] * AXIS)
    return centre + (carrier * turned).apply(RIM - CENTRE)


def test_carrier_axis_and_angle_draw_the_wheel_where_a_full_one_is() -> None:
    errors = [float(np.max(np.abs(rim(True, h) - rim(False, h)))) for h in (0.002, 0.001, 0.0005)]
    ratios = np.array(errors[:-1]) / errors[1:]
    assert np.all((ratios > 3.4) & (ratios < 4.6)), errors
    assert errors[-1] < 1e-3


def test_a_state_is_restored_with_its_angle_and_a_new_start_begins_at_zero() -> None:
    simulation = Simulation(compile(gyroscope(True)))
    simulation.run(0.1, 0.001)
    saved = simulation.save()
    ahead = simulation.run(0.15, 0.001)["angle"][-1]
    simulation.restore(saved)
    assert simulation.run(0.15, 0.001)["angle"][-1] == ahead
    assert Simulation(compile(gyroscope(True))).run(0.01, 0.001)["angle"][0] == 0.0
