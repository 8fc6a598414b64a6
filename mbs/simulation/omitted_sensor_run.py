"""Sensors that a run left out: it is made again when one of them is first read."""

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from numpy.typing import NDArray

from mbs.results.omitted_sensors import OmittedSensors
from mbs.settings.input_signals import InputSignals, Signal
from mbs.simulation.omitted_sensor_system import NO_PORTS, OmittedSensorSystem, omitted_names
from mbs.simulation.prepared_system import prepared
from mbs.simulation.restored_run import restored
from mbs.simulation.stepped_system import SteppedSystem
from mbs.system.system import System

Array = NDArray[np.float64]
TO_TOLERANCE = (
    "a run to a tolerance keeps no states to find it of. Take steps of a length h, or a model that computes it; of a "
    "car, fidelity=1"
)


def omitted_to_tolerance(system: System) -> OmittedSensors | None:
    """Sensors that a run to a tolerance left out."""
    names = omitted_names(system)
    return OmittedSensors(names, None, TO_TOLERANCE) if names else None


def omitted_of_run(
    simulation: SteppedSystem, inputs: Mapping[str, Signal], h: float, every: int
) -> Callable[[int], OmittedSensors | None]:
    """What makes of the number of samples the sensors that a run leaves out; made at its start.

    `every`: steps from one sample to the next.
    """
    names = omitted_names(simulation.system)
    if not names:
        return lambda samples: None
    system, settings, roads = simulation.system, simulation.settings, dict(simulation.road_paths)
    if system.ported is None:
        return lambda samples: OmittedSensors(names, None, NO_PORTS)
    state = simulation.instance.save()

    def compute(samples: int, stride: int) -> dict[str, Array]:
        follower, again = OmittedSensorSystem(system), restored(system, settings, roads, state)
        rows, t0 = [follower.values(again.instance)], again.time
        signals = InputSignals(inputs, prepared(system)[1]["inputs"])
        signals.attach_to_steps(again.instance, t0, t0 + (samples - 1) * every * h, h)
        for _ in range((samples - 1) // stride):
            again.instance.run(h, every * stride)
            rows.append(follower.values(again.instance))
        return dict(zip(names, np.array(rows).T, strict=True))

    return lambda samples: OmittedSensors(names, partial(compute, samples))
