"""Recording intervals of the columns of a drive; values between are computed by repeating the drive."""

from collections.abc import Sequence
from pathlib import Path

from ali3.scene.scene_columns import all_columns
from hosts.driving.run_checks import steps_of
from hosts.fmu.geometry import scene_of

# Approximate times between recorded values of an output, at least a communication step.
DRAWN_INTERVAL = 0.025  # s, of outputs that are drawn
OTHER_INTERVAL = 0.1  # s


def recorded_columns(
    fmu: Path, inputs: Sequence[str], outputs: Sequence[str], step: float, interval: float | None = None
) -> dict[str, int]:
    """Columns of a recording, with the number of steps between their values.

    Inputs are recorded at every step, so that a drive can be repeated; drawn outputs, including amplitudes of flexible
    parts, about every 25 ms; others at every fourth of these rows.

    `step`: communication step, s; `interval`: of all outputs, s, a whole multiple of the step. Raises `HostError`: the
    interval is not a whole multiple of the step.
    """
    intervals = dict.fromkeys(inputs, 1)
    if interval is not None:
        return intervals | dict.fromkeys(outputs, steps_of(interval, step, "The interval"))
    scene = scene_of(fmu)
    drawn_outputs = set(all_columns(scene)) if scene else set()
    drawn_steps = max(1, round(DRAWN_INTERVAL / step))
    other_steps = drawn_steps * max(1, round(OTHER_INTERVAL / (drawn_steps * step)))
    return intervals | {name: drawn_steps if name in drawn_outputs else other_steps for name in outputs}
