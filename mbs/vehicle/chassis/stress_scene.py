"""Entry `flexible` of a car's scene: its frame, deformed and coloured by stress at any fidelity."""

import math
from typing import Any

import numpy as np

from mbs.compiler.model_to_system import compiled
from mbs.flexible.recovery import peak_tube_stress, section_force_field
from mbs.flexible.scene_part import flexible_parts
from mbs.model.model import Model
from mbs.simulation.unstepped_system import StandingSystem
from mbs.vehicle.chassis.flexible_chassis import COMPUTED_OUTPUT, amplitude_names
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.gauges.reading import drawn_gauges
from mbs.vehicle.side import Point

SCALE_ENDS = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
"""Mantissas of the end of the colour scale, the rounded largest stress of the standing car; larger stresses have the
last colour."""


def flexible_part(flexible: FlexibleFrame, model: Model, reference_point: Point) -> list[dict[str, Any]]:
    """Make the list `flexible` of a car's scene for the outputs of `amplitude_outputs`.

    `model`: the car with fidelity `Fidelity.DYNAMIC`; `reference_point`: origin of the frame "chassis" of the scene,
    which has the axes of the car, m. Raises `ModelError` if the frame does not fit the car.
    """
    body, start, full_scale = flexible.drawn, _amplitudes_at_rest(flexible, model), None
    if body.frame is not None:
        largest = float(peak_tube_stress(body.frame, body.recovery(section_force_field(body.frame)) @ start).max())
        full_scale = _rounded_up(largest) if largest > 0.0 else None
    return flexible_parts(
        body,
        "chassis",
        amplitude_names(flexible),
        origin=body.origin - np.array(reference_point),
        start=start,
        computed=COMPUTED_OUTPUT,
        full_scale=full_scale,
        gauges=drawn_gauges(flexible.structure.readings),
    )


def _amplitudes_at_rest(flexible: FlexibleFrame, model: Model) -> np.ndarray:
    """Amplitudes of the frame in the equilibrium of the car."""
    system = compiled(model)
    names = list(system.meta["coordinates"])
    q = StandingSystem(system).q
    return np.array([q[names.index(f"chassis.{mode}")] for mode in flexible.drawn.mode_names])


def _rounded_up(value: float) -> float:
    """Value rounded up to a mantissa of `SCALE_ENDS`."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(k for k in SCALE_ENDS if k * power >= value * (1.0 - 1e-9)) * power
