"""An FMU file under ALi3 names, as plain data that passes to another process."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Protocol, TypeVar

from hosts.common.numbers import Value
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.file import find_aliases
from hosts.fmu.fmu import Fmu
from hosts.fmu.named_fmu import NamedFmu, with_aliases
from hosts.fmu.named_row import NamedRow
from hosts.fmu.own_process import files_of, in_own_process
from hosts.fmu.variables import Variables

_Result = TypeVar("_Result")


class _OpenFmu(Protocol):
    path: Path


@dataclass(frozen=True)
class FmuSource:
    """The path of an FMU and the aliases of its variables; other rooms see only ALi3 names."""

    path: Path
    """Absolute."""
    names: Aliases = field(default_factory=Aliases)
    """Aliases of its variables."""

    @classmethod
    def named(cls, path: Path, variables: Variables, file: str | Path | None) -> FmuSource:
        """The source of an FMU with the aliases of a file; see `find_aliases`."""
        return cls(path.absolute(), Aliases() if file is None else find_aliases(file, variables))

    @classmethod
    def of(cls, fmu: _OpenFmu) -> FmuSource:
        """The source of an open FMU."""
        return cls(fmu.path.absolute(), fmu.aliases if isinstance(fmu, NamedFmu) else Aliases())

    def at(self, path: Path) -> FmuSource:
        """The source of a copy of the FMU."""
        return replace(self, path=path)

    @property
    def digest(self) -> str:
        """A hash of the aliases."""
        return hashlib.sha256(repr(self.names).encode()).hexdigest()

    @property
    def constants(self) -> Mapping[str, float]:
        """Constants of the alias file, by ALi3 names."""
        return self.names.constants

    @property
    def of_record(self) -> dict[str, tuple[str, float, float]]:
        """See `Aliases.of_record`."""
        return self.names.of_record

    @property
    def count(self) -> int:
        """Number of aliases and derived variables."""
        return len(self.names.aliases) + len(self.names.derived)

    def called(self, fmu_names: Sequence[str]) -> tuple[str, ...]:
        """ALi3 names of variables; a variable without an alias keeps its name."""
        return self.names.names(fmu_names)

    def outputs(self, fmu_names: Sequence[str]) -> tuple[str, ...]:
        """ALi3 names of outputs, then names of derived variables."""
        return (*self.called(fmu_names), *(d.name for d in self.names.derived))

    def row(self, fmu_names: Sequence[str]) -> NamedRow:
        """The conversion of rows of these variables to ALi3 names and units."""
        return NamedRow(self.names, fmu_names)

    def fmu_values(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Start values, converted from ALi3 names and units to those of the FMU."""
        return self.names.fmu_values(values)

    def ali3_values(self, values: Mapping[str, Value]) -> dict[str, Value]:
        """Start values, converted from names and units of the FMU to those of ALi3."""
        return self.names.ali3_values(values)

    def inputs(self, values: Mapping[str, tuple[float, float]]) -> dict[str, tuple[float, float]]:
        """Values and rates of inputs, converted from ALi3 names and units to those of the FMU."""
        return self.names.inputs(values)

    def why_missing(self, name: str) -> str:
        """A sentence on why the FMU lacks an ALi3 name; empty if the reason is not known."""
        return self.names.why_missing(name)

    def around(self, fmu: Fmu) -> NamedFmu:
        """An open FMU under ALi3 names, as a `NamedFmu` also without aliases."""
        return NamedFmu(fmu, self.names)

    def seen(self, fmu: Fmu) -> Fmu | NamedFmu:
        """An open FMU under ALi3 names; the FMU itself if there are no aliases."""
        return with_aliases(fmu, self.names)

    @contextmanager
    def opened(self) -> Iterator[Fmu | NamedFmu]:
        """A context with the opened FMU under ALi3 names. Raises `HostError` if it cannot be read."""
        with Fmu(self.path) as fmu:
            yield self.seen(fmu)

    def run_isolated(
        self,
        work: Callable[[Any, Callable[[float], None]], _Result],
        task: object,
        kind: Any,
        start: Mapping[str, Value],
    ) -> _Result:
        """The result of a function of (this source, task) in an isolated process, which the FMU may crash.

        `kind`: type of the result; `start`: start values, whose files the process may read.
        """
        result: _Result = in_own_process(work, (self, task), kind, [self.path, *files_of(start)])
        return result


class LoadedFmu:
    """An FMU under ALi3 names, loaded at its first use, so that it can be passed to another process before."""

    def __init__(self, source: FmuSource) -> None:
        self._source = source
        self._fmu: Fmu | None = None

    def close(self) -> None:
        """Unload the FMU."""
        if self._fmu is not None:
            fmu, self._fmu = self._fmu, None
            fmu.close()

    def fresh(self) -> Fmu | NamedFmu:
        """The FMU ready to be initialised: loaded at first, later reset."""
        if self._fmu is None:
            self._fmu = Fmu(self._source.path)
        else:
            self._fmu.reset()
            self._fmu.messages.clear()
        return self._source.seen(self._fmu)
