"""What a force element declares of itself: its record, its checks and the header of its law in C follow from it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import ClassVar

from mbs.common.affine import Affine
from mbs.elements.reals import Reals, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.kernel.header.enumerations import ElementType


class Element:
    """A force element whose numbers are fields; a subclass is a frozen dataclass in a file of its type's name.

    A field is a number of the kernel, in the order of the kernel: its check stands in its type, its unit and meaning
    below it (`reals`).
    """

    _words: ClassVar[str]
    """What sentences call it, with its article."""
    _signals: ClassVar[tuple[tuple[str, int], ...]]
    """Its local variables in the order of the kernel, with the components of each; 0: two or three."""
    _states: ClassVar[tuple[float, ...] | None] = ()
    """Initial values of its slots; None: `record` has them."""
    _outputs: ClassVar[tuple[Output, ...]] = ()
    """What it computes beside its force."""
    _open: ClassVar[bool] = False
    """Whether other numbers follow its fields."""
    _tangent: ClassVar[bool] = True
    """Whether its force depends on the signals or their rates."""
    _elastic: ClassVar[bool] = False
    """Whether a spring in it holds the bodies it acts on."""

    @classmethod
    def _type(cls) -> ElementType:
        """Its type, by the name of its file."""
        return ElementType[cls.__module__.rpartition(".")[2].upper()]

    @classmethod
    def _what(cls, name: str) -> str:
        """The element in a sentence."""
        return f"the {cls._words.partition(' ')[2]} '{name}'"

    def _record(
        self,
        name: str,
        signals: Sequence[Affine],
        integer: Sequence[int] = (),
        states: Sequence[float] = (),
        outputs: Sequence[Output] = (),
        more: Reals | None = None,
    ) -> ElementRecord:
        """The record. `states`, `outputs`: in place of those that are declared; `more`: numbers behind its fields."""
        return ElementRecord(
            name,
            self._type(),
            signals,
            *columns(reals_of(self, self._what(name)) | (more or {})),
            integer,
            states or self._states or (),
            outputs or self._outputs,
            self._tangent,
            self._elastic,
        )
