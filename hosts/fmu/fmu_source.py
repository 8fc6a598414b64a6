"""An FMU file under our names, as plain data that passes to another process."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol, TypeVar

from hosts.common.numbers import Value
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.alias_option import aliases_of
from hosts.fmu.fmu import Fmu
from hosts.fmu.named_fmu import NamedFmu, seen_through
from hosts.fmu.named_row import NamedRow
from hosts.fmu.own_process import files_of, in_own_process
from hosts.fmu.variables import Variables

_Made = TypeVar("_Made")


class _Opened(Protocol):
    path: Path


@dataclass(frozen=True)
class FmuSource:
    """Where an FMU is, and what its variables are called: all that others know of names of other programs."""

    path: Path
    """Absolute."""
    names: Aliases = field(default_factory=Aliases)
    """Ours for its variables."""

    @classmethod
    def named(cls, path: Path, variables: Variables, file: str | Path | None) -> FmuSource:
        """That of an FMU whose variables an alias file names; see `aliases_of`."""
        return cls(path.absolute(), aliases_of(file, variables))

    @classmethod
    def of(cls, fmu: _Opened) -> FmuSource:
        """The source of an open FMU."""
        return cls(fmu.path.absolute(), fmu.aliases if isinstance(fmu, NamedFmu) else Aliases())

    def at(self, path: Path) -> FmuSource:
        """The source of a copy of the FMU."""
        return replace(self, path=path)

    @property
    def digest(self) -> str:
        """A hash of the names."""
        return hashlib.sha256(repr(self.names).encode()).hexdigest()

    @property
    def constants(self) -> Mapping[str, float]:
        """Constants of the alias file, by our names."""
        return self.names.constants

    @property
    def of_record(self) -> dict[str, tuple[str, float, float]]:
        """See `Aliases.of_record`."""
        return self.names.of_record

    @property
    def count(self) -> int:
        """Number of variables with a name of ours."""
        return len(self.names.aliases) + len(self.names.derived)

    def called(self, theirs: Sequence[str]) -> tuple[str, ...]:
        """Our names of variables; those without an alias keep theirs."""
        return self.names.names(theirs)

    def outputs(self, theirs: Sequence[str]) -> tuple[str, ...]:
        """The same of outputs, with those that are derived."""
        return (*self.called(theirs), *(d.ours for d in self.names.derived))

    def row(self, theirs: Sequence[str]) -> NamedRow:
        """What makes rows under our names from values of these variables."""
        return NamedRow(self.names, theirs)

    def theirs(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Start values under our names as the FMU has them."""
        return self.names.values(values)

    def ours(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Start values of the FMU under our names, in our units."""
        return self.names.own_values(values)

    def inputs(self, values: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Values and rates under our names as the FMU has them."""
        return self.names.inputs(values)

    def why_missing(self, name: str) -> str:
        """Why the FMU does not have one of our names, in a sentence; empty where nothing is known."""
        return self.names.why_missing(name)

    def around(self, fmu: Fmu) -> NamedFmu:
        """The FMU, which is open, under our names, whether it has other ones or not."""
        return NamedFmu(fmu, self.names)

    def seen(self, fmu: Fmu) -> Fmu | NamedFmu:
        """The same; itself where it has no other names."""
        return seen_through(fmu, self.names)

    @contextmanager
    def opened(self) -> Iterator[Fmu | NamedFmu]:
        """The FMU under our names. Raises `HostError`: it cannot be loaded."""
        with Fmu(self.path) as fmu:
            yield self.seen(fmu)

    def done_apart(
        self, work: Callable[[Any, Callable[[float], None]], _Made], task: object, kind: Any, start: Mapping[str, Value]
    ) -> _Made:
        """What a function makes of (this source, task) in a process of its own, which the FMU may take down.

        `kind`: of what it makes; `start`: start values, whose files the process may read.
        """
        result: _Made = in_own_process(work, (self, task), kind, [self.path, *files_of(start)])
        return result


class LoadedFmu:
    """An FMU under our names; it is loaded by the first drive, so that it passes to another process before."""

    def __init__(self, source: FmuSource) -> None:
        self._source = source
        self._fmu: Fmu | None = None

    def close(self) -> None:
        """Unload the FMU."""
        if self._fmu is not None:
            fmu, self._fmu = self._fmu, None
            fmu.close()

    def fresh(self) -> Fmu | NamedFmu:
        """An instance that is as new: loaded, or reset where there is one."""
        if self._fmu is None:
            self._fmu = Fmu(self._source.path)
        else:
            self._fmu.reset()
            self._fmu.messages.clear()
        return self._source.seen(self._fmu)
