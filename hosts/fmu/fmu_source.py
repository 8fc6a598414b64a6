"""An FMU file under our names, as plain data that passes to another process."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol, TypeVar

from hosts.common.numbers import Value
from hosts.fmu.aliased_fmu import AliasedFmu, seen_through
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.aliases.of_file import aliases_of
from hosts.fmu.fmu import Fmu
from hosts.fmu.own_process import files_of, in_own_process

_Made = TypeVar("_Made")


class _Opened(Protocol):
    path: Path
    aliases: Aliases | None


@dataclass(frozen=True)
class FmuSource:
    """Where an FMU is, and what its variables are called."""

    path: Path
    """Absolute."""
    names: Aliases = field(default_factory=Aliases)
    """Ours for its variables."""

    @classmethod
    def named(cls, fmu: Fmu, file: str | Path | None) -> FmuSource:
        """That of an FMU that is open, whose variables an alias file names; see `aliases_of`."""
        return cls(fmu.path.absolute(), aliases_of(file, fmu.table))

    @classmethod
    def of(cls, fmu: _Opened) -> FmuSource:
        """That of an FMU that is open."""
        return cls(fmu.path.absolute(), fmu.aliases or Aliases())

    @contextmanager
    def opened(self) -> Iterator[Fmu | AliasedFmu]:
        """The FMU under our names. Raises `HostError`: it cannot be loaded."""
        with Fmu(self.path) as fmu:
            yield seen_through(fmu, self.names)

    def done_apart(
        self, work: Callable[[Any, Callable[[float], None]], _Made], task: object, kind: Any, start: Mapping[str, Value]
    ) -> _Made:
        """What a function makes of (this source, task) in a process of its own, which the FMU may take down.

        `kind`: of what it makes; `start`: start values, whose files the process may read.
        """
        made: _Made = in_own_process(work, (self, task), kind, [self.path, *files_of(start)])
        return made


class LoadedFmu:
    """An FMU under our names; it is loaded by the first drive, so that it passes to another process before."""

    def __init__(self, source: FmuSource) -> None:
        self._source = source
        self._fmu: Fmu | None = None

    def close(self) -> None:
        """Unload it."""
        if self._fmu is not None:
            fmu, self._fmu = self._fmu, None
            fmu.close()

    def fresh(self) -> Fmu | AliasedFmu:
        """An instance that is as new: loaded, or reset where there is one."""
        if self._fmu is None:
            self._fmu = Fmu(self._source.path)
        else:
            self._fmu.reset()
            self._fmu.messages.clear()
        return seen_through(self._fmu, self._source.names)
