"""Base class of force elements: fields with their checks, from which record, parameters and a C header follow."""

from collections.abc import Mapping, Sequence
from typing import ClassVar, TypeAlias

from mbs.common.affine import Affine
from mbs.elements.integers import Integer
from mbs.elements.reals import Reals, each_real, reals_of
from mbs.elements.record import ElementRecord, Output, columns
from mbs.kernel.header.enumerations import ElementType

SPACE_OR_PLANE = (3, 2)
"""Components of a signal in space and in the plane."""
Signals: TypeAlias = tuple[tuple[str, int | tuple[int, int]], ...] | None


class Element:
    """A force element whose numbers are fields; a subclass is a frozen dataclass in a file of its type's name.

    A field is a number of the kernel, in the order of the kernel: its check stands in its type, its unit and meaning
    below it (`reals`).
    """

    _words: ClassVar[str]
    """What sentences call it, with its article."""
    _signals: ClassVar[Signals]
    """Its local variables in the order of the kernel, with the components of each, a pair where an element in the plane
    has others; None: any number."""
    _integers: ClassVar[tuple[Integer, ...]] = ()
    """Its inputs, roads, choices and counts."""
    _states: ClassVar[tuple[float, ...]] = ()
    """Initial values of its slots."""
    _outputs: ClassVar[tuple[Output, ...]] = ()
    """Outputs besides the force."""
    _behind: ClassVar[int | None] = 0
    """Count of further numbers behind its fields, without those that its integers count; None: any."""
    _more: ClassVar[str] = ""
    """First of the numbers that may be missing, behind all others: they are there with the optional integers, where it
    has some."""
    _more_states: ClassVar[tuple[float, ...]] = ()
    """States that it has with optional integers."""
    _prefix: ClassVar[str] = ""
    """Of its names in C, where other laws that are compiled with it have the same."""
    _tangent: ClassVar[bool] = True
    """Whether its force depends on the signals or their rates."""
    _elastic: ClassVar[bool] = False
    """Whether a spring in it holds the bodies it acts on."""

    @classmethod
    def _type(cls) -> ElementType:
        """Number of the element type, by the name of its file."""
        return ElementType[cls.__module__.rpartition(".")[2].upper()]

    @classmethod
    def _what(cls, name: str) -> str:
        """The element in a sentence."""
        return f"the {cls._words.removeprefix('a ').removeprefix('an ')} '{name}'"

    @classmethod
    def _numbers(cls) -> tuple[list[str], list[str]]:
        """Names of its numbers, and of those that may be missing."""
        names = [name for name, _, _ in each_real(cls)]
        first = names.index(cls._more) if cls._more else len(names)
        return names[:first], names[first:]

    def _record(
        self,
        name: str,
        signals: Sequence[Affine],
        integer: Sequence[int | None] = (),
        *,
        values: Mapping[str, object] | None = None,
        behind: Reals | Sequence[float] = (),
        more: bool = True,
        states: Sequence[float] | None = None,
        outputs: Sequence[Output] | None = None,
    ) -> ElementRecord:
        """The record.

        `integer`: the declared ones, None for missing ones. `values`, `states`, `outputs`: in place of those
        of the fields and of the class. `behind`: numbers between its own and those that may be missing. `more`: whether
        it has these, where no optional integer says it.
        """
        what = self._what(name)
        present = list(integer)
        while present and present[-1] is None and self._integers[len(present) - 1].optional:
            present.pop()
        integers = [of.checked(value, what) for of, value in zip(self._integers, present, strict=False)]
        extended = len(integers) > sum(not of.optional for of in self._integers)
        if any(of.optional for of in self._integers):
            more = extended
        reals, optional_names = reals_of(self, what, values), self._numbers()[1]
        named, plain = (behind, ()) if isinstance(behind, dict) else ({}, behind)
        last = {key: real for key, real in reals.items() if key in optional_names} if more else {}
        counted = sum(of.states * n for of, n in zip(self._integers, integers, strict=False))
        slots = (*self._states, *(self._more_states if extended else ()), *([0.0] * counted))
        return ElementRecord(
            name,
            self._type(),
            signals,
            *columns({k: r for k, r in reals.items() if k not in optional_names} | named | last, *plain),
            tuple(integers),
            slots if states is None else states,
            self._outputs if outputs is None else outputs,
            self._tangent,
            self._elastic,
        )
