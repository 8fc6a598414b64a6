"""Compiles ahead: the compilers fill their cache while the model is compiled and probed.

What takes a compiler long does not depend on the model: all C files but the table of variables. A build starts their
compilation for each platform in the background, several at a time. The compiler keeps each object under a hash of its
source, its headers and the options; the build of the FMU, which comes later with the table, finds them there, or waits
for the one that is being made. Nothing that is made here goes into an FMU.
"""

from __future__ import annotations

import subprocess
import tempfile
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from ali3.cores import available_cores
from fmu_src.native.compile import library_command
from fmu_src.native.platforms import TARGETS
from fmu_src.native.table import c_arrays, c_table
from fmu_src.variables.arrays import scalars
from fmu_src.variables.variables import Variable
from mbs.kernel import build

# A table of one variable, which stands for that of the model.
_VARIABLE = Variable("nothing", "local", "constant", "1", "", "constant", 0, 0.0)


@contextmanager
def compiled_ahead(work: Sequence[tuple[str, str]]) -> Iterator[None]:
    """A context in whose background libraries are compiled.

    `work`: faces, see `compile_library`, and platforms; the first is wanted first. What has not been begun when the
    context is left is left out, what has is ended.
    """
    with tempfile.TemporaryDirectory(prefix="ali3-ahead-", ignore_cleanup_errors=True) as folder:
        table = Path(folder, "table.c")
        names: dict[str, list[list[str]]] = {"row": [[]], "element": [[]]}
        table.write_text(c_table([_VARIABLE], names, "0" * 32, "") + c_arrays(scalars([_VARIABLE])), encoding="utf-8")
        commands = [
            library_command(face, target, table, Path(folder, f"{face}-{target}"))
            for face, platform in work
            for target in TARGETS[platform]
        ]
        if commands:  # two compilers at the ends of the list that is wanted first share its objects
            commands.insert(1, _backwards(commands[0]))
        compilers = _Compilers(commands, build.compiler_environment())
        try:
            yield
        finally:
            compilers.end()


def _backwards(command: Sequence[str]) -> list[str]:
    """The same command with its C files in reverse order, and a library of its own."""
    files = [k for k, part in enumerate(command) if part.endswith(".c")]
    turned, out = list(command), command.index("-o") + 1
    turned[out] += ".2"
    for place, other in zip(files, reversed(files), strict=True):
        turned[place] = command[other]
    return turned


class _Compilers:
    """As many compilers at once as there are processors. What goes wrong is for the build to find, and to say."""

    def __init__(self, commands: Sequence[Sequence[str]], environment: dict[str, str]) -> None:
        self._commands, self._environment = iter(commands), environment
        self._lock, self._ended = threading.Lock(), False
        self._running: set[subprocess.Popen[bytes]] = set()
        count = min(len(commands), available_cores())
        self._threads = [threading.Thread(target=self._work, daemon=True) for _ in range(count)]
        for thread in self._threads:
            thread.start()

    def end(self) -> None:
        """End what runs and begin nothing more."""
        with self._lock:
            self._ended = True
            for process in self._running:
                process.terminate()
        for thread in self._threads:
            thread.join()

    def _work(self) -> None:
        while (process := self._next()) is not None:
            process.wait()
            with self._lock:
                self._running.discard(process)

    def _next(self) -> subprocess.Popen[bytes] | None:
        with self._lock:
            command = None if self._ended else next(self._commands, None)
            if command is None:
                return None
            try:
                process = subprocess.Popen(
                    command, env=self._environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
                )
            except OSError:
                return None
            self._running.add(process)
            return process
