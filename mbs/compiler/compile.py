"""compile(): from a Model to a System that can be drawn and stepped."""

from collections.abc import Callable
from contextlib import AbstractContextManager

from mbs.common.checks import flag
from mbs.common.lazy_value import LazyValue
from mbs.common.one_thread import in_one_thread
from mbs.compiler.assembly_modes import mode_arrays
from mbs.compiler.generated.library import library_of
from mbs.compiler.model_to_system import check_model, compiled
from mbs.compiler.overconstrained import TOLERANCE, closed_loops
from mbs.compiler.ports import with_ports_of
from mbs.compiler.tree import tree_arrays
from mbs.model.model import Model
from mbs.shapes.frames import FrameNames, places_of
from mbs.shapes.scene import drawing_of
from mbs.system.compiled_model import CompiledModel
from mbs.system.drawing import Drawing
from mbs.system.system import System

Correction = Callable[[], AbstractContextManager[dict[str, tuple[float, float]]]]
"""Returns a context in which the loops of a model are drawn closed, with the correction of each joint, m and rad."""


def compile(model: Model, *, tolerance: float = TOLERANCE, native: bool = False) -> System:
    """Compile a model.

    Linear joint equations are eliminated, dependent rows removed, the elimination order and fronts of the tangent
    computed, and the start position and velocity solved. Overconstrained loops are closed by least squares beforehand:
    points and axes of their joints are moved, by as little as possible, to where the loop moves; the System's report
    says by how much, joint by joint (`closed`: distance in m, angle in rad).

    Parameters
    ----------
    tolerance : float
        Largest correction of an overconstrained loop, parts of the size of its drawing (m/m) and rad; 0 takes every
        drawing as it is.
    native : bool
        Compile the sums of a step for this System alone into C and for this processor: some seconds the first time,
        then from a cache. Runs have the same bits and take less time ([cost of a step](speed.md)); an FMU does not
        have this code.

    Returns
    -------
    System
        The compiled model, for `Simulation`, `simulate` and an FMU.

    Raises
    ------
    ArgumentTypeError
        `model` is not a Model.
    ModelError
        The assembly cannot be closed or the model is not possible; the message names the joints. With `native`: there
        is no C compiler.
    """
    correct = closed_loops(tolerance)
    correction, compiled_loops = _compile_closed(model, correct)
    frames, start, make_ported = compiled_loops.frames, compiled_loops.arrays["q0"], model.with_ports
    assert frames is not None

    @in_one_thread
    def draw() -> Drawing:
        with correction():
            names = FrameNames.of(model)
            return drawing_of(model, places_of(model, frames.T.tocsr(), frames.constant, names), names, start)

    @in_one_thread
    def compile_with_ports(system: System) -> System | None:
        if make_ported is None:
            return None
        return with_ports_of(System.of(_compile_closed(make_ported(), correct)[1]), system)

    lazy_drawing = LazyValue(draw)
    model.draw_before_change(lazy_drawing)
    system = System.of(compiled_loops, lazy_drawing, None if make_ported is None else compile_with_ports)
    if flag(native, "The native of compile"):
        system.native = library_of(system)
    return system


@in_one_thread
def _compile_closed(model: Model, correct: Callable[[Model], Correction]) -> tuple[Correction, CompiledModel]:
    """The correction that closes the loops of a model, and the compiled model with closed loops."""
    correction = correct(check_model(model))
    with correction() as corrections:
        return correction, compiled(model, corrections, make_modes=mode_arrays, make_tree=tree_arrays)
