"""A scene that starts in static equilibrium does so with other parameters, too: the kernel finds it again."""

import numpy as np
import pytest

from mbs import Pose, Simulation, SimulationError, System, compile, simulate
from mbs.kernel.binding import LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.scenes import prototype_car

from .scenes_in_equilibrium import MASS, car, hanging

G = 9.81


@pytest.fixture(scope="module")
def cars() -> dict[float, System]:
    """The car with the stiffness of its front springs as a parameter, built with two values of it, N/m."""
    return {k: compile(car(k)) for k in (12360.0, 20000.0)}


def start(system: System, stiffness: float, pose: Pose | None = None) -> Simulation:
    return Simulation(system, parameters={"front.stiffness": stiffness, "drive.creep_torque": 0.0}, pose=pose)


def test_a_changed_spring_starts_at_rest_where_it_should() -> None:
    system = compile(hanging())
    for k in (500.0, 2000.0, 5000.0):
        simulation = Simulation(system, parameters={"k": k})
        assert simulation.sensors["z"] == pytest.approx(-1.0 - MASS * G / k, abs=1e-9)
        assert np.max(np.abs(simulation.state.qdd)) < 1e-7
    run = simulate(system, 0.2, 0.01, parameters={"k": 500.0})
    assert np.ptp(run["z"]) < 1e-9


def test_the_search_is_no_part_of_the_run() -> None:
    system = compile(hanging())
    sought, plain = (Simulation(system, parameters={"k": k}).instance.report() for k in (500.0, 1000.0))
    counts = ("steps", "iterations", "factorizations", "solves", "halvings", "max_iterations")
    assert sought["energy"] < plain["energy"]  # it hangs lower
    assert {name: sought[name] for name in counts} == {name: plain[name] for name in counts}


@pytest.mark.parametrize("pose", [None, Pose(x=100.0, y=-30.0, yaw=0.7, speed=10.0)], ids=str)
def test_the_car_starts_as_if_built_with_the_spring(cars: dict[float, System], pose: Pose | None) -> None:
    changed, built = (start(cars[k], 20000.0, pose) for k in (12360.0, 20000.0))
    assert np.max(np.abs(changed.state.q - built.state.q)) < 1e-9
    assert np.max(np.abs(changed.state.qd - built.state.qd)) < 1e-9
    assert np.max(np.abs(changed.state.qdd - built.state.qdd)) < 1e-6
    if pose is None:  # it was 2.9 m/s2 and fell by 35 mm
        assert np.max(np.abs(changed.state.qdd)) < 1e-9
        height = changed.sensors["chassis.z"]
        changed.step(0.01, 100)
        assert changed.sensors["chassis.z"] == pytest.approx(height, abs=1e-6)


def test_a_flexible_chassis_finds_it_too() -> None:
    simulation = start(compile(car(12360.0, fidelity=2)), 20000.0)
    assert np.max(np.abs(simulation.state.qdd)) < 1e-6


def test_the_built_in_road_extends_as_far_as_a_car_can_start(cars: dict[float, System]) -> None:
    near, far = (Simulation(cars[12360.0], pose=Pose(x=at)) for at in (0.0, 9e7))
    for simulation in (near, far):
        simulation.step(0.005, 40)
    for name in ("chassis.z", "wheel_FL.Fz", "wheel_RR.Fz"):
        assert far.sensors[name] == pytest.approx(near.sensors[name], rel=1e-6), name


def test_unchanged_parameters_keep_the_same_bits(cars: dict[float, System]) -> None:
    """Also where parameters change that do not move the equilibrium: a drive, the friction of the road, a kerb."""
    system = cars[12360.0]
    plain = Simulation(system).state
    for parameters in (
        {"front.stiffness": 12360.0},
        {"road.friction": 0.3, "road.kerb_x": 20.0},
        {"drive.creep_torque": 0.0},
        {"drive.creep_torque": 100.0},
    ):
        assert np.array_equal(Simulation(system, parameters=parameters).state.q, plain.q)


def test_a_parameter_set_back_starts_as_the_file_does(cars: dict[float, System]) -> None:
    system = cars[12360.0]
    number = [p["name"] for p in system.meta["parameters"]].index("front.stiffness")
    instance = Instance(LoadedSystem(system.to_bytes()))
    results = []
    for k in (12360.0, 20000.0, 12360.0):
        instance.set_parameter(number, k)
        instance.initialise(0.0)
        results.append(list(instance.get_state()[0]))
    assert results[0] == results[2] != results[1]


def test_a_parameter_set_in_motion_moves_nothing(cars: dict[float, System]) -> None:
    simulation = start(cars[12360.0], 12360.0)
    before = simulation.state.q
    simulation.set_parameter("front.stiffness", 20000.0)
    assert np.array_equal(simulation.state.q, before)
    simulation.step(0.01)
    assert np.max(np.abs(simulation.state.qdd)) > 1.0


def test_the_kerb_does_not_move_the_start(cars: dict[float, System]) -> None:
    """The equilibrium meant is the one on the road of the drawing; what a user does to the road comes after it."""
    system = cars[12360.0]
    parameters = {"front.stiffness": 20000.0, "drive.creep_torque": 0.0}
    on_level = Simulation(system, parameters=parameters).state.q
    before_a_kerb = Simulation(system, parameters={**parameters, "road.kerb_x": 0.05}).state.q
    assert np.array_equal(on_level, before_a_kerb)


def test_given_coordinates_stay(cars: dict[float, System]) -> None:
    system = cars[12360.0]
    instance = Instance(LoadedSystem(system.to_bytes()))
    instance.set_parameter([p["name"] for p in system.meta["parameters"]].index("front.stiffness"), 20000.0)
    instance.set_q(system.arrays["q0"].tolist())
    instance.initialise(0.0)
    assert list(instance.get_state()[0]) == pytest.approx(system.arrays["q0"].tolist(), abs=1e-12)


def test_a_system_without_equilibrium_is_refused() -> None:
    system = compile(hanging())
    with pytest.raises(SimulationError, match="no static equilibrium near the drawing") as refusal:
        Simulation(system, parameters={"k": 0.0, "payload": 1.0})
    assert refusal.value.time == 0.0
    assert (
        "'k' is 0 N/m instead of 1000; 'payload' is 1 N instead of 0. Set parameters nearer to the values that the "
        "model was compiled with." in str(refusal.value)
    )


def test_a_model_that_does_not_ask_for_it_starts_as_drawn() -> None:
    m = hanging()
    m.start_in_equilibrium = False
    assert Simulation(compile(m), parameters={"k": 500.0}).sensors["z"] == -1.0


def test_quasi_static_stresses_far_from_the_origin() -> None:
    """The rows of ports hold differences of positions no more: the same bits at any place."""
    system = compile(prototype_car.build(None, 1))
    runs = [simulate(system, 0.1, 0.005, pose=Pose(x=x, y=-x, z=0.02)) for x in (0.0, 9e5)]
    assert runs[0].report == runs[1].report
    for name in (n for n in runs[0] if n.startswith(("wheel_FL.Fz", "bending_moment", "stress"))):
        assert np.array_equal(runs[0][name], runs[1][name]), name
    assert runs[1]["wheel_FL.Fz"][0] == runs[0]["wheel_FL.Fz"][0]
