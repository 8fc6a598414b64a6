"""Cars far from the origin: the same bits as at the origin, at every fidelity."""

import numpy as np
import pytest

from mbs import Pose, Simulation, compile
from mbs.vehicle import car_names, load
from mbs.vehicle.fidelity import Fidelity
from tests.quick import quick

PLACE = (1e8, -1e8)  # m
INPUTS = {"steering": ([0.0, 0.1, 0.3], [0.0, 0.0, 0.2]), "throttle": 0.2}
POSITIONS = (".x", ".y", ".contact_x", ".contact_y")
MORE = {"prototype": (Fidelity.MANY_MODES, Fidelity.TABLE)}
"""What some cars have beside the fidelities that they offer in an FMU."""


def drive(system, x, y):
    """0.3 s in a turn that has settled, then steered on."""
    simulation = Simulation(system, pose=Pose(x=x, y=y, yaw=0.3, speed=15.0, yaw_rate=0.1))
    simulation.settle(0.1, 0.005)
    return simulation.run(0.3, 0.005, inputs=INPUTS)


def away(near, far):
    """Signals but positions that differ, and by how much positions differ beside the shift, m."""
    places = [name for name in near if name.endswith(POSITIONS)]
    assert len(places) == 18  # of the chassis, of four wheels and their contacts
    shift = {axis: far[f"chassis.{axis}"][0] - near[f"chassis.{axis}"][0] for axis in "xy"}
    off = max(np.abs(far[name] - near[name] - shift[name[-1]]).max() for name in places)
    return [name for name in near if name not in places and not np.array_equal(near[name], far[name])], off


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("prototype", "saloon"), car_names(), "proof"))
def test_cars_have_the_bits_of_the_origin(name):
    car = load(name)
    for fidelity in (*car.offered, *MORE.get(name, ())):
        system = compile(car.model(fidelity=fidelity))
        other, off = away(drive(system, 0.0, 0.0), drive(system, *PLACE))
        assert not other, fidelity
        assert off < 1e-14 * max(map(abs, PLACE)), fidelity
