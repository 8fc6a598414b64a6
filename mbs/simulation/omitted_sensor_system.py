"""Sensors that a System does not compute, such as the stresses of a rigid car: by a second System, when read."""

from collections.abc import Mapping
from weakref import WeakKeyDictionary

from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.kernel.binding.instance import Instance
from mbs.results.omitted_sensors import refused
from mbs.results.simulation_error import SimulationError
from mbs.simulation.prepared_system import prepared
from mbs.system.system import System

_PORTED: WeakKeyDictionary[System, tuple[LoadedSystem, dict[str, int]] | None] = WeakKeyDictionary()
NO_PORTS = "there is no model with ports that follows it. Compile one that computes it; of a car, fidelity=1, 2 or 3"


def omitted_names(system: System) -> list[str]:
    """Names of the sensors that the System does not compute."""
    return [s["name"] for s in prepared(system)[1]["sensors"] if not s.get("computed", True)]


def _ported(system: System) -> tuple[LoadedSystem, dict[str, int]] | None:
    """The System with ports in the kernel's memory and the places of its sensors, made once; None: there is none."""
    if system not in _PORTED:
        ported = system.ported(system) if system.ported is not None else None
        index_of = {} if ported is None else {s["name"]: k for k, s in enumerate(ported.meta["sensors"])}
        loaded = None if ported is None else (LoadedSystem(ported.kernel_bytes()), index_of)
        _PORTED[system] = loaded if loaded is not None and set(omitted_names(system)) <= set(index_of) else None
    return _PORTED[system]


class OmittedSensorSystem:
    """A second System with ports that is moved to the states of a simulation.

    `asked`: name of the requested sensor. Raises `KeyError`: there is none; the sentence names the sensor.
    """

    def __init__(self, system: System, asked: str = "") -> None:
        loaded, self._names = _ported(system), omitted_names(system)
        if loaded is None:
            raise KeyError(refused(asked or self._names[0], NO_PORTS))
        self._instance = Instance(loaded[0])
        self._columns = [loaded[1][name] for name in self._names]

    def values(self, instance: Instance) -> list[float]:
        """Of the sensors that the System leaves out, at the state of its instance, which stays.

        Raises `SimulationError`: the forces at the ports cannot be found.
        """
        try:
            self._instance.follow(instance)
        except KernelError as error:
            what = f"The forces at the ports could not be found: {error.message}"
            raise SimulationError(what, instance.time, error.status) from error
        values = self._instance.sensors()
        return [values[k] for k in self._columns]


class Readings(dict[str, float]):
    """Sensor values of a state by name; those that the System leaves out are found when one is first read.

    `values`: those that the System computes; `instance`: at the state; it may go on.
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
