"""compile(): from a Model to a System that can be drawn and stepped."""

from __future__ import annotations

from mbs.compiler.assembly_modes import mode_arrays
from mbs.compiler.drawing import drawing
from mbs.compiler.model_to_system import to_system
from mbs.compiler.overconstrained import TOLERANCE, closed_loops
from mbs.compiler.ports import with_ports_of
from mbs.model.model import Model
from mbs.system.system import System


def compile(model: Model, *, tolerance: float = TOLERANCE) -> System:
    """Compile a model.

    Linear joint equations are eliminated, dependent rows removed, the elimination order and fronts of the tangent
    computed, and the start position and velocity solved. Overconstrained loops are closed by least squares before:
    points and axes of their joints are moved, by as little as possible, to where the loop moves; the System's report
    says by how much, joint by joint (`closed`: distance in m, angle in rad).

    Parameters
    ----------
    tolerance : float
        Largest correction of an overconstrained loop, parts of the size of its drawing (m/m) and rad; 0 takes every
        drawing as it is.

    Returns
    -------
    System
        What `Simulation` and `simulate` step, and what an FMU carries.

    Raises
    ------
    ArgumentTypeError
        `model` is no Model.
    ModelError
        If the assembly cannot be closed or the model is not possible; the message names the joints.
    """
    return to_system(model, closing=closed_loops(tolerance), drawing=drawing, watch=mode_arrays, ports=with_ports_of)
