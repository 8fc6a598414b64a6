"""Systems of an FMU with the poses of all their bodies as outputs, where these are asked for or needed to draw them."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import mbs
from fmu_src.geometry.geometry import lost_frames
from mbs.shapes.pose_outputs import pose_outputs

POSES = ("wheels", "all")
"""What `--poses` may be: of the wheels of a car only, which are always there, or of all bodies."""

Maker = Callable[[], "mbs.Model"] | Callable[[], "mbs.Model | mbs.System"]


class PosesError(ValueError):
    """Poses that cannot be outputs; the message is for the user."""


def posed_systems(makers: Mapping[Any, Maker], default: int, poses: str | None) -> dict[int, mbs.System]:
    """Compile the models of an FMU.

    Parameters
    ----------
    makers : mapping of int to callable
        Of a model, by fidelity. A System stays as it is: outputs are part of a model.
    default : int
        The fidelity that is drawn.
    poses : {"wheels", "all"} or None
        "all": with the pose of every body, after all other outputs; None: where something would not be drawn
        without them.

    Returns
    -------
    dict of int to mbs.System
        By fidelity.

    Raises
    ------
    PosesError
        There is no such choice of poses, or all are asked of a System.
    """
    if poses is not None and poses not in POSES:
        raise PosesError(f"There are no poses '{poses}'; they are {' or '.join(POSES)}.")
    everything = poses == "all"
    first = _compiled(makers[default](), everything, needed=poses is not None)
    if poses is None and lost_frames(first):
        posed = _compiled(makers[default](), True, needed=False)
        everything, first = len(posed.meta["sensors"]) > len(first.meta["sensors"]), posed
    return {
        k: first if k == default else _compiled(make(), everything, needed=everything) for k, make in makers.items()
    }


def _compiled(made: mbs.Model | mbs.System, everything: bool, needed: bool) -> mbs.System:
    if isinstance(made, mbs.System):
        if everything and needed:
            raise PosesError(
                "The scene returns a System, whose outputs are what they are; for --poses all it must return the Model."
            )
        return made
    if everything:
        pose_outputs(made)
    return mbs.compile(made)
