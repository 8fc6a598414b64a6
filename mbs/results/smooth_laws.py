"""Conditions for the nominal order of a method: no abrupt change of forces, and steps that resolve the motion."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from mbs.kernel.header.enumerations import DrivingFunctionType, ElementType, ParameterTarget
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
"""Elements with smooth forces; a spring-damper only without stops."""
STOPS = (6, 8)  # indices of the stiffnesses of the stops among the reals of a spring-damper


def unresolved_fraction(
    system: System, method: str, span: tuple[float, float], inputs: Mapping[str, Signal] | None = None
) -> float:
    """Missed fraction above which steps do not resolve the changes of the velocities, see `missed_fraction`.

    With h w = 1 a period has six steps; three are enough for a method of order above two without abrupt changes.

    `span`: first and last time of the run, s; `inputs`: inputs over time, by name.
    """
    smooth = METHOD_TABLE[method].order > 2 and is_smooth(system, span, inputs)
    return 2.0 * RESOLVED if smooth else RESOLVED


def is_smooth(system: System, span: tuple[float, float], inputs: Mapping[str, Signal] | None = None) -> bool:
    """Whether all forces, driving functions and inputs are smooth within a step."""
    # an input function may jump within a step
    without_functions = not any(callable(signal) for signal in (inputs or {}).values())
    return without_functions and _has_smooth_laws(system, span)


def is_open_tree(system: System) -> bool:
    """Whether the bodies form a tree on the ground, without closed loops."""
    return not system.report["no_tree"] and len(system.arrays["tree_cut_body"]) == 0


def _has_smooth_laws(system: System, span: tuple[float, float]) -> bool:
    """Whether no element has a stop, contact, friction or table, and driving functions are polynomials in `span`."""
    arrays = system.arrays
    reals = np.array(arrays["el_parameter"])
    # the stiffness of a stop may be a parameter
    reals[arrays["par_index"][np.asarray(arrays["par_target"]) == ParameterTarget.ELEMENT]] = np.inf
    element_reals = [
        reals[i:j] for i, j in zip(arrays["el_parameter_ptr"], arrays["el_parameter_ptr"][1:], strict=False)
    ]
    smooth_elements = all(
        int(kind) in SMOOTH and not (kind == ElementType.SPRING_DAMPER and any(real[i] > 0.0 for i in STOPS))
        for kind, real in zip(arrays["el_type"], element_reals, strict=True)
    )
    guides = zip(arrays["guide_parameter_ptr"], arrays["guide_type"], strict=False)
    return smooth_elements and all(
        kind == DrivingFunctionType.OF_TIME and _is_one_piece(arrays["guide_parameter"][start : start + 3], span)
        for start, kind in guides
    )


def _is_one_piece(head: NDArray[np.float64], span: tuple[float, float]) -> bool:
    """Whether a driving function is one piece in all of `span`; `head`: number of pieces and the first two breaks."""
    pieces, begin, end = head
    return bool(pieces == 1 and begin <= span[0] and span[1] <= end)
