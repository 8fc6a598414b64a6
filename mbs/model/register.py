"""The register of a model: names, coordinates, and what undoes a call that is refused."""

from __future__ import annotations

import functools
import weakref
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from typing import Any, NoReturn, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from mbs.common.affine import Affine, AffineVector
from mbs.common.checks import Vector, named, positive, shown, vector, whole
from mbs.common.errors import ModelError
from mbs.model.coordinate import Coordinate, CoordinateInfo


class Named(Protocol):
    """What is registered by a name."""

    @property
    def name(self) -> str:
        """Unique in its family."""


N = TypeVar("N", bound=Named)
TIME = "time"
"""First column of tables of runs, and a variable of FMI 3.0."""


def _whole_or_not(method: Callable[..., Any]) -> Callable[..., Any]:
    """A method of a model that leaves the model as it was when it raises."""

    @functools.wraps(method)
    def call(self: Register, *args: Any, **kwargs: Any) -> Any:
        if self._undo is not None:  # part of another one
            return method(self, *args, **kwargs)
        with self.together():
            return method(self, *args, **kwargs)

    return call


class Register:
    """Names and coordinates of a `Model`, which describes the arguments.

    A public method of a model either does all it says or raises and changes nothing: every class of the vocabulary is
    made so when it is defined.
    """

    def __init__(self, name: str, dimension: int, gravity: ArrayLike | None, length: float | None) -> None:
        self.name = named(name, "a model")
        what = f"model '{self.name}'"
        self.dimension = whole(dimension, f"The dimension of {what}", 2, 3)
        fall = np.array([0.0, -9.81]) if self.dimension == 2 else np.array([0.0, 0.0, -9.81])
        self.gravity = fall if gravity is None else gravity
        self.length = None if length is None else positive(length, f"The length of {what}")
        self.coordinates: list[CoordinateInfo] = []
        self._names: set[tuple[str, str]] = set()
        self._undo: list[Callable[[], None]] | None = None
        self._looks: list[Callable[[], None]] = []
        self._drawings: list[weakref.ref[Callable[[], object]]] = []

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        # Functions in joints and looks would go on writing into the model they were made for.
        raise TypeError(
            f"Model '{self.name}' cannot be copied or pickled: its parts hold functions of this one model. Build it "
            "again by the function that made it, or copy the System that compile(model) gives."
        )

    @property
    def gravity(self) -> Vector:
        """Acceleration of gravity, shape (dimension,), m/s2."""
        return self._gravity

    @gravity.setter
    def gravity(self, given: ArrayLike) -> None:
        self._gravity: Vector = vector(given, self.dimension, f"the gravity of model '{self.name}'")

    def __init_subclass__(cls, **kwargs: Any) -> None:
        super().__init_subclass__(**kwargs)
        for name, method in list(vars(cls).items()):
            if callable(method) and not name.startswith("_"):
                setattr(cls, name, _whole_or_not(method))

    @contextmanager
    def together(self) -> Iterator[None]:
        """Calls inside are parts of one: an exception leaves the model as it was before the first of them."""
        if self._undo is not None:
            yield
            return
        drawings, self._drawings = self._drawings, []
        for reference in drawings:  # of the model as it still is
            drawing = reference()
            if drawing is not None:
                drawing()
        self.look()
        self._undo = []
        self.remember(self)
        try:
            yield
        except BaseException:
            undo, self._undo = self._undo, None
            for restore in reversed(undo or []):
                restore()
            raise
        finally:
            self._undo = None

    def put_off(self, looks: Callable[[], None]) -> None:
        """Defer shapes until the model is drawn or changes. `looks`: adds the shapes to this model."""
        self._looks.append(looks)

    def look(self) -> None:
        """Add the deferred shapes."""
        if not self._looks:
            return
        looks, self._looks = self._looks, []
        try:
            with self.together():
                for add in looks:
                    add()
        except BaseException:
            self._looks = looks
            raise

    def draw_before_change(self, drawing: Callable[[], object]) -> None:
        """Run the deferred drawing before the model changes, if its result is still referenced; immediately where no
        shapes were deferred.
        """
        if not self._looks:
            drawing()
        self._drawings = [r for r in (*self._drawings, weakref.ref(drawing)) if r() is not None]

    def remember(self, thing: object) -> None:
        """Note the attributes of what is about to change, so that a refused call can restore them.

        `thing`: the model, or a body or a joint of it.
        """
        if self._undo is None:
            return
        attributes = vars(thing)
        before = attributes.copy()
        before.update([(name, value.copy()) for name, value in attributes.items() if type(value) is dict])
        # Lists of a register only grow: their lengths say what they were, at a cost that does not grow with them.
        lengths = [(value, len(value)) for value in attributes.values() if type(value) is list]

        def restore() -> None:
            for name in attributes.keys() - before.keys():
                del attributes[name]
            attributes.update(before)
            for value, length in lengths:
                del value[length:]

        self._undo.append(restore)

    def unique(self, family: str, name: str) -> str:
        """Claim a name among the things of a family, such as body, joint, element or sensor.

        Raises
        ------
        ModelError
            The name is empty, cannot be written to a file, is that of the time, or is taken.
        """
        key = family, named(name, f"a {family}")
        if name == TIME and family in ("sensor", "input", "parameter", "constant"):
            raise ModelError(f"The name of a {family} is '{TIME}', which tables of runs and FMUs have for their time.")
        if key in self._names:
            raise ModelError(f"The model '{self.name}' already has a {family} named '{name}'; names must be unique.")
        self._names.add(key)
        if self._undo is not None:
            self._undo.append(lambda: self._names.discard(key))
        return key[1]

    def enter(self, family: str, things: list[N], thing: N) -> N:
        """Add to the `things` of a family one whose name is new there."""
        self.unique(family, thing.name)
        things.append(thing)
        return thing

    @staticmethod
    def place_of(things: Sequence[Named], name: object) -> int | None:
        """Index of a named thing in the list of its family, or None."""
        return next((k for k, thing in enumerate(things) if isinstance(name, str) and thing.name == name), None)

    def new_coordinate(self, name: str, kind: str, reference: float, component: int = 0) -> int:
        """Register a scalar full coordinate.

        Parameters
        ----------
        name, kind, reference, component
            See `CoordinateInfo`.
        """
        self.coordinates.append(CoordinateInfo(name, kind, component, reference))
        return len(self.coordinates) - 1

    def drawn(self) -> Vector:
        """Full coordinates in the reference configuration, shape (n,), in the order of `coordinates`."""
        return np.array([c.reference for c in self.coordinates])

    def owned_coordinate(self, coordinate: Coordinate, what: str) -> Coordinate:
        """A relative angle or a spin, if it is one of this model."""
        if not isinstance(coordinate, Coordinate):
            raise ModelError(f"{what} needs a relative angle or a spin, got {shown(coordinate)}.")
        i = coordinate.index
        if i >= len(self.coordinates) or self.coordinates[i].name != coordinate.name:
            raise ModelError(f"{what}: the coordinate '{coordinate.name}' is not one of model '{self.name}'.")
        return coordinate

    def expression(self, given: Coordinate | Affine, what: str) -> Affine:
        """A coordinate or an expression of coordinates, as an expression."""
        if isinstance(given, Coordinate):
            return self.owned_coordinate(given, what).affine
        if not isinstance(given, Affine):
            raise ModelError(f"{what} needs a coordinate or an expression, got {shown(given)}.")
        if max(given.terms, default=0) >= max(len(self.coordinates), 1):
            raise ModelError(f"{what} has an expression of coordinates that model '{self.name}' does not have.")
        return given

    def expressions(self, given: AffineVector, what: str) -> AffineVector:
        """A point or vector of bodies, such as ``body.point((0, 0, 1))``, if its coordinates are those of this
        model.
        """
        if not isinstance(given, AffineVector):
            raise ModelError(
                f"{what} needs a point or a vector of a body, such as body.point(...), got {shown(given)}."
            )
        if len(given) != self.dimension:
            raise ModelError(f"{what} has a point or a vector of {len(given)} components; it needs {self.dimension}.")
        for component in given.components:
            self.expression(component, what)
        return given
