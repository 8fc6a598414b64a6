"""Sensors that a System does not compute, such as stresses of a rigid car, evaluated by a second System.

Of a recorded run the run is repeated when one of them is first read.
"""

from collections.abc import Callable, Mapping
from functools import partial
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.results.omitted_sensors import OmittedSensors, not_computed_text
from mbs.results.simulation_error import SimulationError
from mbs.settings.input_signals import InputSignals, Signal
from mbs.simulation.prepared_system import prepared
from mbs.simulation.stepped_system import SteppedSystem, restore_system
from mbs.system.system import System

Array = NDArray[np.float64]
_WITH_PORTS: WeakKeyDictionary[System, tuple[LoadedSystem, dict[str, int]] | None] = WeakKeyDictionary()
NO_PORTS = "there is no model with ports that follows it. Compile one that computes it; of a car, fidelity=1, 2 or 3"
TO_TOLERANCE = (
    "a run to a tolerance keeps no states to find it of. Take steps of a length h, or a model that computes it; of a "
    "car, fidelity=1"
)


def omitted_names(system: System) -> list[str]:
    """Names of the sensors that the System does not compute."""
    return [s["name"] for s in prepared(system).meta["sensors"] if not s.get("computed", True)]


def _loaded_with_ports(system: System) -> tuple[LoadedSystem, dict[str, int]] | None:
    """System with ports in the kernel's memory and indices of its sensors by name, made once; None: there is none."""
    if system not in _WITH_PORTS:
        ported = system.ported(system) if system.ported is not None else None
        index_of = {} if ported is None else {s["name"]: k for k, s in enumerate(ported.meta["sensors"])}
        loaded = None if ported is None else (LoadedSystem(ported.kernel_bytes()), index_of)
        _WITH_PORTS[system] = loaded if loaded is not None and set(omitted_names(system)) <= set(index_of) else None
    return _WITH_PORTS[system]


class OmittedSensorSystem:
    """A second System with ports that follows the states of a simulation.

    `sensor`: name of the requested sensor, for the error. Raises `KeyError` if there is no System with ports.
    """

    def __init__(self, system: System, sensor: str = "") -> None:
        loaded, self._names = _loaded_with_ports(system), omitted_names(system)
        if loaded is None:
            raise KeyError(not_computed_text(sensor or self._names[0], NO_PORTS))
        self._instance = Instance(loaded[0])
        self._columns = [loaded[1][name] for name in self._names]

    def values(self, instance: Instance) -> list[float]:
        """Values of the omitted sensors at the state of `instance`, which is not changed.

        Raises `SimulationError` if the forces at the ports cannot be computed.
        """
        try:
            self._instance.follow(instance)
        except KernelError as error:
            message = f"The forces at the ports could not be found: {error.message}"
            raise SimulationError(message, instance.time, error.status) from error
        values = self._instance.sensors()
        return [values[k] for k in self._columns]


class Readings(dict[str, float]):
    """Sensor values of a state by name; omitted ones are computed when one is first read.

    `values`: values of the sensors that the System computes; `instance`: instance at the state, may be advanced later.
    """

    def __init__(self, values: Mapping[str, float], system: System, instance: Instance) -> None:
        super().__init__(values)
        self._system, self._instance, self._state = system, instance, instance.snapshot()

    def __missing__(self, name: str) -> float:
        names = omitted_names(self._system)
        if name not in names:
            raise KeyError(name)
        with self._instance.at(self._state):
            self.update(zip(names, OmittedSensorSystem(self._system, name).values(self._instance), strict=True))
        return self[name]


def omitted_to_tolerance(system: System) -> OmittedSensors | None:
    """Sensors that a run to a tolerance omits; None if there are none."""
    names = omitted_names(system)
    return OmittedSensors(names, None, TO_TOLERANCE) if names else None


def omitted_of_run(
    simulation: SteppedSystem, inputs: Mapping[str, Signal], h: float, every: int
) -> Callable[[int], OmittedSensors | None]:
    """Function of the number of samples that returns the omitted sensors of a run, made at its start.

    `h`: step, s; `every`: steps between two samples.
    """
    names = omitted_names(simulation.system)
    if not names:
        return lambda samples: None
    system, settings, roads = simulation.system, simulation.settings, dict(simulation.road_paths)
    if system.ported is None:
        return lambda samples: OmittedSensors(names, None, NO_PORTS)
    state = simulation.instance.save()

    def compute(samples: int, stride: int) -> dict[str, Array]:
        omitted, rerun = OmittedSensorSystem(system), restore_system(system, settings, roads, state)
        rows, t0 = [omitted.values(rerun.instance)], rerun.time
        signals = InputSignals(inputs, prepared(system).meta["inputs"])
        signals.attach_to_steps(rerun.instance, t0, t0 + (samples - 1) * every * h, h)
        for _ in range((samples - 1) // stride):
            rerun.instance.run(h, every * stride)
            rows.append(omitted.values(rerun.instance))
        return dict(zip(names, np.array(rows).T, strict=True))

    return lambda samples: OmittedSensors(names, partial(compute, samples))
