"""Undoing of a refused call, and shapes that are deferred until they are needed."""

import functools
import weakref
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Concatenate, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")
C = TypeVar("C", bound="Changes")


def atomic_call(method: Callable[Concatenate[C, P], R]) -> Callable[Concatenate[C, P], R]:
    """The method, changed so that the model is restored if it raises."""

    @functools.wraps(method)
    def call(self: C, /, *args: P.args, **kwargs: P.kwargs) -> R:
        if self._undo is not None:  # inside another call
            return method(self, *args, **kwargs)
        with self.together():
            return method(self, *args, **kwargs)

    return call


class Changes:
    """Calls that change a `Model` and can be undone, and shapes that are deferred."""

    def __init__(self) -> None:
        self._undo: list[Callable[[], None]] | None = None
        self._looks: list[Callable[[], None]] = []
        self._drawings: list[weakref.ref[Callable[[], object]]] = []

    @contextmanager
    def together(self) -> Iterator[None]:
        """Context of calls of which an exception undoes all."""
        if self._undo is not None:
            yield
            return
        drawings, self._drawings = self._drawings, []
        for reference in drawings:  # of the model before the change
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
        """Defer shapes until the model is drawn or changes; `looks`: adds the shapes to this model."""
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

    def remember(self, owner: object) -> None:
        """Store the attributes of an object before a change, to restore them if the call raises.

        `owner`: the model, or a body or a joint of it.
        """
        if self._undo is None:
            return
        attributes = vars(owner)
        previous = attributes.copy()
        previous.update([(name, value.copy()) for name, value in attributes.items() if type(value) is dict])
        # lists of a register only grow, so their lengths restore them, and a copy is not needed
        lengths = [(value, len(value)) for value in attributes.values() if type(value) is list]

        def restore() -> None:
            for name in attributes.keys() - previous.keys():
                del attributes[name]
            attributes.update(previous)
            for value, length in lengths:
                del value[length:]

        self._undo.append(restore)
