"""Groups of parameters that affect an initial state in one way, so that the trials of many cost no more than of few.

A start in static equilibrium is where forces at rest balance: parameters that change a force at rest or a driving
function move it, all of them in the same way as far as declared dependencies go. Those of roads move it where a start
is put on the road. The others move nothing: what they reach at a start are forces.
"""

import random
from collections.abc import Callable

import mbs
from mbs.kernel.binding import KernelError
from mbs.kernel.binding.instance import Instance
from mbs.kernel.header.enumerations import ParameterTarget

_DISPLACEMENTS = (0.0, 0.01, 0.05, 0.2, 0.5, 1.0, 2.0)  # m, of coordinates beside the start: all stops act


def parameter_groups(
    system: mbs.System, kernel: Instance, value: Callable[[int], float], rng: random.Random
) -> list[list[int]]:
    """Sort the parameters of a System.

    `kernel`: of it; it is reset; `value`: a value in the range of a parameter, by its number; another one at each call;
    `rng`: for the places where forces are compared. Returns numbers of parameters that move a start, of those of roads,
    of the others; empty groups are left out.
    """
    arrays = system.arrays
    moving: list[int] = []
    roads: list[int] = []
    other_parameters: list[int] = []
    static = {int(p) for p in arrays["static_par"]}  # without effect in the search of the equilibrium
    settles = len(arrays["static_start"]) > 0
    configurations = [
        configuration
        for d in _DISPLACEMENTS
        for configuration in _opposite_configurations(arrays["q0"].tolist(), d, rng)
    ]
    forces = [_force(kernel, q) for q in configurations]
    for p in range(len(arrays["par_value"])):
        targets = set(arrays["par_target"][arrays["par_ptr"][p] : arrays["par_ptr"][p + 1]].tolist())
        if ParameterTarget.DRIVING in targets:
            moving.append(p)
        elif ParameterTarget.ROAD in targets:
            roads.append(p)
        elif settles and p not in static and _changes_force(kernel, p, value, configurations, forces):
            moving.append(p)
        else:
            other_parameters.append(p)
    kernel.reset()
    return [group for group in (moving, roads, other_parameters) if group]


def _opposite_configurations(q0: list[float], size: float, rng: random.Random) -> list[list[float]]:
    """Two configurations on opposite sides of `q0`, so that stops at both ends act."""
    offsets = [rng.choice((-size, size)) * rng.uniform(0.5, 1.0) for _ in q0]
    return [[q + sign * d for q, d in zip(q0, offsets, strict=True)] for sign in (1.0, -1.0)]


def _changes_force(
    kernel: Instance, p: int, value: Callable[[int], float], places: list[list[float]], forces: list[bytes]
) -> bool:
    """Whether a parameter changes a force at rest; also true if the kernel takes none of its values."""
    is_compared = False
    for q, force in zip(places, forces, strict=True):
        kernel.reset()
        try:
            kernel.set_parameter(p, value(p))
        except KernelError:
            continue
        is_compared = True
        if _force(kernel, q) != force:
            return True
    return not is_compared


def _force(kernel: Instance, q: list[float]) -> bytes:
    """Generalised forces at rest, as bytes."""
    try:
        return bytes(kernel.evaluate(q, [0.0] * len(q), None, 0.0)["force"])
    except KernelError:  # such as a road that has no height there
        return b""
