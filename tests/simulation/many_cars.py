"""Cars with different initial states and inputs."""

from functools import cache

import numpy as np

from mbs import Pose, Settings, Simulation, System, Variant, compile
from mbs.scenes import prototype_car
from mbs.settings.input_signals import InputSignals, Signal
from mbs.simulation.prepared_system import prepared

T_END = 10.0  # s: until then inputs are checked


def _wild() -> dict[str, Signal]:
    """Held values that jump every 0.2 s."""
    random, n = np.random.default_rng(1), 50
    t = np.repeat(0.2 * np.arange(n), 2)[1:]
    brake = (random.uniform(size=n) > 0.7) * random.uniform(size=n)
    values = {"steering": random.uniform(-1.0, 1.0, n), "throttle": random.uniform(size=n), "brake": brake}
    return {name: (t, np.repeat(v, 2)[:-1]) for name, v in values.items()}


WILD = _wild()
SLALOM: dict[str, Signal] = {"steering": (0.05 * np.arange(200), 0.3 * np.sin(0.15 * np.arange(200)))}
LANE_CHANGE: dict[str, Signal] = {"steering": ([0.0, 0.2, 0.4, 0.8, 1.0], [0.0, 0.4, 0.0, -0.4, 0.0])}
CARS: dict[str, Variant] = {
    "wild": Variant(inputs=WILD, pose=Pose(speed=25.0)),
    "slalom with luggage": Variant({"payload.luggage.mass": 80.0}, SLALOM, Pose(speed=15.0)),
    "high kerb": Variant({"road.kerb_x": 20.0, "road.kerb_height": 0.3}, WILD, Pose(speed=35.0)),
    "fall": Variant(pose=Pose(z=1.5, speed=20.0)),
    "stiff tyre at a kerb": Variant({"rear.tyre.stiffness": 2e6, "road.kerb_x": 12.0}, WILD, Pose(speed=30.0)),
    "lane change": Variant({"front.tyre.grip": 0.9}, LANE_CHANGE, Pose(speed=20.0)),
    "stiff spring at a kerb": Variant(
        {"front.spring.stiffness": 9e5, "road.kerb_x": 10.0, "road.kerb_height": 0.5}, {}, Pose(speed=60.0)
    ),
    "launch": Variant(inputs={"throttle": 1.0}),
}


@cache
def system(fidelity: int = 0) -> System:
    """The rigid car, or another one of the prototype's."""
    return compile(prototype_car.build(fidelity=fidelity))


def car(name: str, settings: Settings, fidelity: int = 0) -> Simulation:
    """One of the cars at its start."""
    variant = CARS[name]
    compiled = system(fidelity) if fidelity else system()
    meta = prepared(compiled).meta["inputs"]
    signals = InputSignals(variant.inputs, meta)
    first = signals.at(np.zeros(1), 1e-9, after_jump=True)[0].tolist()
    inputs = {meta[i]["name"]: value for i, value in zip(signals.columns(), first, strict=True)}
    return Simulation(compiled, settings=settings, inputs=inputs, parameters=variant.parameters, pose=variant.pose)


def attach(name: str, simulation: Simulation) -> None:
    """The inputs of one of the cars over time."""
    InputSignals(CARS[name].inputs, prepared(system())[1]["inputs"]).attach(simulation.instance, 0.0, T_END, 1e-9)
