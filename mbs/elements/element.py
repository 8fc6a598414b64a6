"""Base class of force elements: fields with checks, from which the record, parameters and a C header are made."""

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
    """Force element whose numbers are fields; a subclass is a frozen dataclass in a file with the name of its type.

    Fields are numbers of the kernel, in its order, with the check in the type and the unit and meaning in the docstring
    (see `reals`). `record` of a class makes the record for the kernel from the signals.
    """

    _noun: ClassVar[str]
    """Noun for messages, with its article."""
    _signals: ClassVar[Signals]
    """Names of the local variables in the order of the kernel, with their numbers of components: in space, or a pair in
    space and in the plane. None: any number of variables."""
    _integers: ClassVar[tuple[Integer, ...]] = ()
    """Numbers of inputs and roads, choices and counts."""
    _states: ClassVar[tuple[float, ...]] = ()
    """Initial values of the slots (internal variables)."""
    _outputs: ClassVar[tuple[Output, ...]] = ()
    """Outputs besides the force."""
    _appended: ClassVar[int | None] = 0
    """Number of further reals after the fields, without those that integers count; None: any."""
    _first_optional: ClassVar[str] = ""
    """First of the optional reals, which follow all others; they are present with the optional integers, if there are
    any."""
    _optional_states: ClassVar[tuple[float, ...]] = ()
    """Further slots with optional integers."""
    _c_prefix: ClassVar[str] = ""
    """Prefix of names in C, if other laws in the same compilation have these names."""
    _tangent: ClassVar[bool] = True
    """Whether the force depends on the signals or their rates."""
    _elastic: ClassVar[bool] = False
    """Whether a spring in the element holds the bodies on which it acts."""

    @classmethod
    def _type(cls) -> ElementType:
        """Element type, by the name of the file."""
        return ElementType[cls.__module__.rpartition(".")[2].upper()]

    @classmethod
    def _label(cls, name: str) -> str:
        """Noun and name of the element for messages."""
        return f"the {cls._noun.removeprefix('a ').removeprefix('an ')} '{name}'"

    @classmethod
    def _real_names(cls) -> tuple[list[str], list[str]]:
        """Names of the required and of the optional reals."""
        names = [name for name, _, _ in each_real(cls)]
        first = names.index(cls._first_optional) if cls._first_optional else len(names)
        return names[:first], names[first:]

    def _record(
        self,
        name: str,
        signals: Sequence[Affine],
        integer: Sequence[int | None] = (),
        *,
        values: Mapping[str, object] | None = None,
        appended: Reals | Sequence[float] = (),
        has_optional: bool = True,
        states: Sequence[float] | None = None,
        outputs: Sequence[Output] | None = None,
    ) -> ElementRecord:
        """Make the record of the element from the checked fields.

        `integer`: values of the declared integers, None if missing; `values`, `states`, `outputs`: replace those of the
        fields and the class; `appended`: reals between the required and the optional ones; `has_optional`: whether
        there are optional reals, if no integer is optional.
        """
        label = self._label(name)
        present = list(integer)
        while present and present[-1] is None and self._integers[len(present) - 1].optional:
            present.pop()
        integers = [declared.checked(value, label) for declared, value in zip(self._integers, present, strict=False)]
        extended = len(integers) > sum(not declared.optional for declared in self._integers)
        if any(declared.optional for declared in self._integers):
            has_optional = extended
        reals, optional_names = reals_of(self, label, values), self._real_names()[1]
        named, plain = (appended, ()) if isinstance(appended, dict) else ({}, appended)
        last = {key: real for key, real in reals.items() if key in optional_names} if has_optional else {}
        counted = sum(len(declared.states) * n for declared, n in zip(self._integers, integers, strict=False))
        slots = (*self._states, *(self._optional_states if extended else ()), *([0.0] * counted))
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
