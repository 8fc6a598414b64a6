"""The part `flexible` of a car's scene: its frame, deformed and coloured by stress at any fidelity."""

import math
from typing import Any

import numpy as np

from mbs.compiler.model_to_system import compiled
from mbs.flexible.recovery import peak_tube_stress, section_force_field
from mbs.flexible.scene_part import flexible_parts
from mbs.model.model import Model
from mbs.simulation.unstepped_system import StandingSystem
from mbs.vehicle.chassis.flexible_chassis import COMPUTED, amplitude_names
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.gauges.reading import STRESS
from mbs.vehicle.side import Point

ROUND = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
"""Colours end at the largest stress of the standing car, rounded up to one of these times a power of ten: so the tubes
of a car that cruises differ. What is beyond has the last colour."""


def flexible_part(flexible: FlexibleFrame, model: Model, reference_point: Point) -> list[dict[str, Any]]:
    """The list `flexible` of a scene of a car, for the outputs of `amplitude_outputs`.

    `model`: the car with fidelity `Fidelity.DYNAMIC`; `reference_point`: origin of the frame "chassis" of the scene,
    which has the axes of the car, m. Raises `ModelError`: the frame does not fit the car.
    """
    body, start, full_scale = flexible.drawn, _standing(flexible, model), None
    if body.frame is not None:
        largest = float(peak_tube_stress(body.frame, body.recovery(section_force_field(body.frame)) @ start).max())
        full_scale = _rounded_up(largest) if largest > 0.0 else None
    return flexible_parts(
        body,
        "chassis",
        amplitude_names(flexible),
        origin=body.origin - np.array(reference_point),
        start=start,
        computed=COMPUTED,
        full_scale=full_scale,
        gauges=[
            {"name": r.gauge, "value": r.name, "unit": r.unit, "nodes": r.between, "along": r.along}
            for r in flexible.structure.readings
            if r.quantity == STRESS and r.between is not None
        ],
    )


def _standing(flexible: FlexibleFrame, model: Model) -> np.ndarray:
    """Amplitudes of the car as it stands at the start."""
    system = compiled(model)
    names = list(system.meta["coordinates"])
    q = StandingSystem(system).q
    return np.array([q[names.index(f"chassis.{mode}")] for mode in flexible.drawn.mode_names])


def _rounded_up(value: float) -> float:
    power = 10.0 ** math.floor(math.log10(value))
    return next(k for k in ROUND if k * power >= value * (1.0 - 1e-9)) * power
