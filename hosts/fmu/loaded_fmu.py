"""An FMU that is loaded once and driven as often as wanted."""

from __future__ import annotations

from pathlib import Path

from hosts.fmu.aliased_fmu import AliasedFmu, seen_through
from hosts.fmu.aliases.alias import Aliases
from hosts.fmu.fmu import Fmu


class LoadedFmu:
    """An FMU under our names; it is loaded by the first drive, so that it passes to another process before.

    `path`: absolute; `aliases`: our names for its variables.
    """

    def __init__(self, path: Path, aliases: Aliases | None = None) -> None:
        self._path, self._aliases = path, aliases or Aliases()
        self._fmu: Fmu | None = None

    def close(self) -> None:
        """Unload it."""
        if self._fmu is not None:
            fmu, self._fmu = self._fmu, None
            fmu.close()

    def fresh(self) -> Fmu | AliasedFmu:
        """An instance that is as new: loaded, or reset where there is one."""
        if self._fmu is None:
            self._fmu = Fmu(self._path)
        else:
            self._fmu.reset()
            self._fmu.messages.clear()
        return seen_through(self._fmu, self._aliases)
