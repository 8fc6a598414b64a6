"""Which steps resolve a motion: methods of high order have their order only where nothing abrupt can happen."""

from __future__ import annotations

import numpy as np

from mbs.kernel.header.enumerations import ElementType, GuideType
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
UNRESOLVED, LOOPS, OPEN = 0.5, 1.0, 2.0
"""Missed shares: h w is twice as much, so that a period has six steps, three, one and a half."""
STOPS = (4, 6)  # of the numbers of a spring-damper: the stiffnesses of its stops


def unresolved_share(system: System, method: str) -> float:
    """The missed share above which steps do not resolve what changes the velocities.

    Of a method of order above two where nothing abrupt can happen three steps in a period are enough, and fewer where
    no closed loop can come near a dead centre.
    """
    if METHOD_TABLE[method].order <= 2 or not _has_smooth_laws(system):
        return UNRESOLVED
    return OPEN if is_open_tree(system) else LOOPS


def is_open_tree(system: System) -> bool:
    """Whether bodies form a tree on the ground, without closed loops."""
    return not system.report["no_tree"] and len(system.arrays["tree_cut_body"]) == 0


def _has_smooth_laws(system: System) -> bool:
    """Whether no element has a stop, a contact, friction or a table, and all guides are single polynomials of time."""
    a = system.arrays
    numbers = [np.asarray(a["el_real"])[i:j] for i, j in zip(a["el_real_ptr"], a["el_real_ptr"][1:], strict=False)]
    free = all(
        int(kind) in SMOOTH and not (kind == ElementType.SPRING_DAMPER and any(real[i] > 0.0 for i in STOPS))
        for kind, real in zip(a["el_type"], numbers, strict=True)
    )
    of_time = zip(a["guide_real_ptr"], a["guide_type"], strict=False)
    guided = all(kind == GuideType.OF_TIME and a["guide_real"][first] == 1 for first, kind in of_time)
    return free and guided
