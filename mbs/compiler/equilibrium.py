"""Static equilibrium near the reference position, for models that start in it."""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mbs.common.checks import number
from mbs.common.errors import ModelError
from mbs.kernel.binding import KernelError, LoadedSystem, open_row
from mbs.kernel.binding.standing_instance import StandingInstance
from mbs.results.equilibrium_warning import warn_if_unstable
from mbs.system.compiled_model import CompiledModel

TOLERANCE = 1e-8  # N
MAX_ITERATIONS = 400


def start_arrays(
    system: CompiledModel | None, parameters: Mapping[str, float], y: NDArray[np.float64] | None = None
) -> dict[str, Any]:
    """The `static_` arrays: whether a System starts in equilibrium, parameters that hold during its solution, and the
    initial guess: coordinates of `system`, and its states if the states `y` of the equilibrium differ.
    """
    if system is None:
        return {"static_start": [], "static_par": [], "static_value": [], "static_q": []}
    names = [entry["name"] for entry in system.meta["parameters"]]
    q0, y0 = system.arrays["q0"], system.arrays["y0"]
    return {
        "static_start": [1],
        "static_par": [names.index(name) for name in parameters],
        "static_value": list(parameters.values()),
        "static_q": q0 if y is None or np.array_equal(y0, y) else np.r_[q0, y0],
    }


def equilibrium(
    system: CompiledModel, parameters: Mapping[str, float]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Coordinates, shape (nq,), and states of elements, shape (ny,), of the static equilibrium at the start inputs.

    `parameters` hold only during its solution: a model with a driving torque has no equilibrium. Raises `ModelError`:
    a parameter is unknown or outside its limits, or there is no equilibrium.
    """
    _check_parameters(system, parameters)
    instance = StandingInstance(LoadedSystem(system.kernel_bytes(modes=False)))
    names = [entry["name"] for entry in system.meta["parameters"]]
    try:
        for name, value in parameters.items():
            instance.set_parameter(names.index(name), value)
        instance.static_equilibrium(0.0, TOLERANCE, MAX_ITERATIONS)
    except KernelError as error:
        text = f"The model '{system.meta['name']}' has no static equilibrium near its drawing: "
        raise ModelError(text + _failure_text(instance.report(), system.meta, error)) from None
    name = system.meta["name"]
    warn_if_unstable(instance.report()["negative_pivots"], f"The static equilibrium of '{name}'", stacklevel=6)
    q, _, _, _, y = instance.get_state()
    return np.array(q, float), np.array(y, float)


def _check_parameters(system: CompiledModel, parameters: Mapping[str, float]) -> None:
    """Raise `ModelError` for a parameter that is unknown or outside its limits."""
    entries = {entry["name"]: entry for entry in system.meta["parameters"]}
    for name in parameters:
        if name not in entries:
            raise ModelError(
                f"The equilibrium of '{system.meta['name']}' sets '{name}', which is not a parameter of it."
            )
    for name, value in parameters.items():
        entry, subject = entries[name], f"The parameter '{name}' of the equilibrium"
        if not entry["min"] <= number(value, subject) <= entry["max"]:
            raise ModelError(f"{subject} is {value:g}; it must lie between {entry['min']:g} and {entry['max']:g}.")


def _failure_text(report: Mapping[str, Any], meta: Mapping[str, Any], error: KernelError) -> str:
    """The reason why an equilibrium was not found, as the end of a sentence."""
    if not report["factorizations"]:
        return error.message
    if not math.isfinite(report["residual"]):
        return "the search for it became infinite."
    text = f"'{meta['coordinates'][report['worst_coordinate']]}' stays out of balance by {report['residual']:.3g} N"
    worst = open_row(report, [row["name"] for row in meta["rows"]])
    return f"{text}; {worst}." if worst else f"{text}."
