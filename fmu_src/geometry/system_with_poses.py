"""Systems of an FMU with sensors for drawing: amplitudes of flexible bodies, and poses of all bodies if needed."""

from collections.abc import Callable, Mapping
from typing import Any

import mbs
from fmu_src.geometry.geometry import lost_frames
from mbs.shapes.pose_outputs import bending_outputs, pose_outputs

POSES = ("wheels", "all")
"""What `--poses` may be: of the wheels of a car only, which are always there, or of all bodies and what bends."""

Maker = Callable[[], "mbs.Model"] | Callable[[], "mbs.Model | mbs.System"]
Outputs = Callable[["mbs.Model"], None]


class PosesError(ValueError):
    """Poses that cannot be outputs; the message is for the user."""


def posed_systems(
    makers: Mapping[Any, Maker], default: int, poses: str | None, tell: Callable[[str], object] = str
) -> dict[int, mbs.System]:
    """Compile the models of an FMU.

    Parameters
    ----------
    makers : mapping of int to callable
        Of a model, by fidelity. A System stays as it is: outputs are part of a model.
    default : int
        The fidelity that is drawn.
    poses : {"wheels", "all"} or None
        After all other outputs, "all": the pose of every body and the amplitudes of what bends; None: these
        amplitudes, and poses where something would not be drawn without them.
    tell : callable
        Hears what was understood of the flexible bodies of the most flexible model, where it has some.

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
    outputs: Outputs | None = {"wheels": None, None: bending_outputs, "all": pose_outputs}[poses]
    needed = poses == "all"
    most_flexible = max(makers)

    def compiled(k: Any, outputs: Outputs | None, needed: bool) -> mbs.System:
        model = makers[k]()
        if k == most_flexible and isinstance(model, mbs.Model) and (table := model.summary()):
            tell(table)
        return _compiled(model, outputs, needed)

    default_system = compiled(default, outputs, needed)
    if poses is None and lost_frames(default_system):
        posed = _compiled(makers[default](), pose_outputs, needed=False)
        needed = len(posed.meta["sensors"]) > len(default_system.meta["sensors"])
        outputs, default_system = pose_outputs, posed
    return {k: default_system if k == default else compiled(k, outputs, needed) for k in makers}


def _compiled(model: mbs.Model | mbs.System, outputs: Outputs | None, needed: bool) -> mbs.System:
    if isinstance(model, mbs.System):
        if needed:
            raise PosesError(
                "The scene returns a System, to which no outputs can be added; for --poses all it must "
                "return the Model."
            )
        return model
    if outputs is not None:
        outputs(model)
    return mbs.compile(model)
