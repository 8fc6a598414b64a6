"""Conditions for the nominal order of a method: no abrupt change of forces, and steps that resolve the motion."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.enumerations import ElementType, GuideType, ParameterTarget
from mbs.kernel.header.limits import RESOLVED
from mbs.settings.input_signals import Signal
from mbs.settings.methods import METHOD_TABLE
from mbs.system.system import System

SMOOTH = {
    ElementType.SPRING_DAMPER,
    ElementType.SCALAR_SPRING_DAMPER,
    ElementType.INPUT_FORCE,
    ElementType.BODY_FORCE,
    ElementType.BODY_TORQUE,
    ElementType.GYROSCOPIC_SPIN,
    ElementType.SPIN_TORQUE,
    ElementType.TORSION_BAR,
    ElementType.SPIN_ANGLE,
}
"""Elements whose forces are smooth; a spring-damper is where it has no stops."""
STOPS = (6, 8)  # of the numbers of a spring-damper: the stiffnesses of its stops


def unresolved_share(
    system: System, method: str, span: tuple[float, float], inputs: Mapping[str, Signal] | None = None
) -> float:
    """The missed share above which steps do not resolve what changes the velocities.

    `span`: first and last time of the run, s; `inputs`: that follow time. A period of h w = 1 has six steps; three are
    enough of a method of order above two where nothing abrupt can happen.
    """
    smooth = METHOD_TABLE[method].order > 2 and nothing_abrupt(system, span, inputs)
    return 2.0 * RESOLVED if smooth else RESOLVED


def nothing_abrupt(system: System, span: tuple[float, float], inputs: Mapping[str, Signal] | None = None) -> bool:
    """Whether no force, guide or input can change within a step in another way than smoothly."""
    free = not any(callable(signal) for signal in (inputs or {}).values())  # a function may jump within a step
    return free and _has_smooth_laws(system, span)


def is_open_tree(system: System) -> bool:
    """Whether bodies form a tree on the ground, without closed loops."""
    return not system.report["no_tree"] and len(system.arrays["tree_cut_body"]) == 0


def _has_smooth_laws(system: System, span: tuple[float, float]) -> bool:
    """Whether no element has a stop, a contact, friction or a table, and each guide is one polynomial of time there."""
    a = system.arrays
    reals = np.array(a["el_real"])
    reals[a["par_index"][np.asarray(a["par_target"]) == ParameterTarget.ELEMENT]] = np.inf  # a stop may be set
    numbers = [reals[i:j] for i, j in zip(a["el_real_ptr"], a["el_real_ptr"][1:], strict=False)]
    free = all(
        int(kind) in SMOOTH and not (kind == ElementType.SPRING_DAMPER and any(real[i] > 0.0 for i in STOPS))
        for kind, real in zip(a["el_type"], numbers, strict=True)
    )
    guides = zip(a["guide_real_ptr"], a["guide_type"], strict=False)
    return free and all(
        kind == GuideType.OF_TIME and _is_whole(a["guide_real"][at : at + 3], span) for at, kind in guides
    )


def _is_whole(head: NDArray[np.float64], span: tuple[float, float]) -> bool:
    """Whether the number of pieces and the first two breaks say that one piece holds in all of a run."""
    pieces, begin, end = head
    return bool(pieces == 1 and begin <= span[0] and span[1] <= end)
