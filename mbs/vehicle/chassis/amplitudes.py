"""Amplitudes of a car's frame as outputs, the same ones at every fidelity."""

from __future__ import annotations

from mbs.model import Model
from mbs.model.flexible import FlexibleBody
from mbs.model.ports import PortedBody
from mbs.vehicle.chassis.flexible_frame import FlexibleFrame
from mbs.vehicle.chassis.mount import Mount

COMPUTED = "stress.computed"


def amplitude_names(flexible: FlexibleFrame) -> list[str]:
    """Names of the outputs, one per mode."""
    return [f"chassis.mode_{k + 1}" for k in range(flexible.drawn.n_modes)]


def amplitude_outputs(m: Model, mount: Mount, flexible: FlexibleFrame) -> None:
    """Amplitudes of the modes of fidelity 3, with which `stress_scene` draws the chassis at any fidelity.

    A flexible chassis with other modes gives the amplitudes that are nearest in the energy norm, the quasi-static one
    those of the static deformation; the rigid chassis has none, they read 0.
    """
    drawn, body = flexible.drawn, mount.body
    rows = flexible.drawn_amplitudes(body.reduced) if isinstance(body, FlexibleBody) else None
    for k, (name, mode) in enumerate(zip(amplitude_names(flexible), drawn.mode_names, strict=True)):
        unit = "m" if k < drawn.n_static else "1"
        text = f"amplitude of mode '{mode}' of the chassis, for pictures; zero where {COMPUTED} is 0"
        if isinstance(body, FlexibleBody):
            assert rows is not None
            m.sense_coordinate(name, body.combination(rows[k]), unit=unit, description=text)
        elif isinstance(body, PortedBody):
            m.sense_quasi_static(
                name, body, flexible.quasi_static_amplitudes, k, mount.origin, unit=unit, description=text
            )
        else:
            m.sense_constant(name, 0.0, unit=unit, description=text, computed=False)
