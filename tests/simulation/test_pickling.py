"""Systems and runs go to other processes and back, and give the same bits there."""

import copy
import pickle
from collections.abc import Callable

import numpy as np
import pytest

from mbs import Pose, Simulation, System, Trajectory, compile, simulate
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.kernel.binding.many import Many
from mbs.vehicle import load

RUN = (0.2, 0.005, {"steering": 0.3, "throttle": 0.5})


@pytest.fixture(scope="module")
def car() -> System:
    return compile(load("prototype").model())


def driven(system: System) -> Trajectory:
    return simulate(system, *RUN, pose=Pose(yaw=0.3, speed=10.0), estimate_error=False, progress=False)


def test_a_pickled_system_is_its_file_and_can_be_placed(car: System) -> None:
    again = pickle.loads(pickle.dumps(car))
    assert again.to_bytes() == car.to_bytes()
    assert again.meta == car.meta
    assert again.scene == car.scene
    assert again.ported is None
    assert copy.deepcopy(car) is car
    assert copy.copy(car).arrays is car.arrays


def test_what_a_run_leaves_out_is_pickled_where_it_was_read(car: System) -> None:
    run = driven(car)
    with pytest.raises(KeyError, match=r"'stress\.SG1' is not computed .* Read the sensor before the run is pickled"):
        pickle.loads(pickle.dumps(run))["stress.SG1"]
    stress = run["stress.SG1"]
    again = pickle.loads(pickle.dumps(run))
    np.testing.assert_array_equal(again["stress.SG1"], stress)
    np.testing.assert_array_equal(again.thinned(4)["stress.SG1"], stress[::4])
    assert np.ptp(stress) > 1e4


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, pickle.dumps])
def test_what_owns_memory_of_the_kernel_is_no_value(car: System, copied: Callable[[object], object]) -> None:
    """The end of a copy freed the memory of the original, and ended the process."""
    loaded = LoadedSystem(car.kernel_bytes())
    for owner in (loaded, Instance(loaded), Many(loaded, 2)):
        with pytest.raises(TypeError, match="memory is the kernel's"):
            copied(owner)


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, pickle.dumps])
def test_a_simulation_is_no_value(car: System, copied: Callable[[Simulation], object]) -> None:
    """A copy moved the original with it; what the message says instead gives the same bits."""
    one = Simulation(car)
    one.step(0.005)
    with pytest.raises(TypeError, match=r"restore\(\) what save\(\) gave"):
        copied(one)
    other = Simulation(car)
    other.restore(one.save())
    one.step(0.005)
    other.step(0.005)
    assert other.sensors == one.sensors
