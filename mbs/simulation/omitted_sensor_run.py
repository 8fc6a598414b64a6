"""Sensors that a run omits: the run is repeated when one of them is first read."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from mbs.results.omitted_sensors import OmittedSensors
from mbs.settings.input_signals import InputSignals, Signal
from mbs.simulation.omitted_sensor_system import NO_PORTS, OmittedSensorSystem, omitted_names
from mbs.simulation.prepared_system import prepared
from mbs.simulation.restored_run import restore_system
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System

Array = NDArray[np.float64]
TO_TOLERANCE = (
    "a run to a tolerance keeps no states to find it of. Take steps of a length h, or a model that computes it; of a "
    "car, fidelity=1"
)


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
