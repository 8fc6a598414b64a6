"""Compiles in advance: fills the cache of the compilers while the model is compiled and probed.

All C files but the table of variables are independent of the model. A build starts their compilation for each platform
in the background. The compiler stores each object under a hash of its source, headers and options; the later build of
the FMU finds them there or waits for them. Nothing that is made here becomes part of an FMU.

A successful build leaves a file beside that cache, so that the same sources are not compiled in advance again.
"""

import subprocess
import threading
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path

from ali3.cores import available_cores
from ali3.temporary_folder import temporary_folder
from fmu_src.native.compilation import library_command
from fmu_src.native.platforms import TARGETS
from fmu_src.native.table import c_arrays, c_table
from fmu_src.variables.arrays import scalars
from fmu_src.variables.variables import Variable
from mbs.kernel import build

_NOWHERE = Path("table.c"), Path("library")
# A table of one variable, which stands for that of the model.
_VARIABLE = Variable("nothing", "local", "constant", "1", "", "constant", 0, 0.0)


@contextmanager
def compiled_ahead(work: Sequence[tuple[str, str]]) -> Iterator[None]:
    """A context in whose background libraries are compiled.

    `work`: faces, see `compile_library`, and platforms, in the order in which they are needed. When the context ends,
    running compilers are terminated and the others are not started.
    """
    with temporary_folder() as folder:
        table = Path(folder, "table.c")
        names: dict[str, list[list[str]]] = {"row": [[]], "element": [[]], "coordinate": [[]], "notice": [[]]}
        table.write_text(c_table([_VARIABLE], names, "0" * 32, "") + c_arrays(scalars([_VARIABLE])), encoding="utf-8")
        uncompiled = {}
        for library in ((face, target) for face, platform in work for target in TARGETS[platform]):
            mark = build.cache_directory() / "ahead" / build.digest_of(library_command(*library, *_NOWHERE))
            if not mark.is_file():
                uncompiled[mark] = library
        commands = [
            library_command(*library, table, Path(folder, "-".join(library))) for library in uncompiled.values()
        ]
        if commands:  # two compilers at the ends of the list that is wanted first share its objects
            commands.insert(1, _backwards(commands[0]))
        with _compilers(commands):
            yield
    with suppress(OSError):  # the next build begins the same again
        for mark in uncompiled:
            mark.parent.mkdir(exist_ok=True)
            mark.touch()


def _backwards(command: Sequence[str]) -> list[str]:
    """The command with its C files in reverse order and an output library of its own."""
    files = [k for k, argument in enumerate(command) if argument.endswith(".c")]
    reversed_command, output_index = list(command), command.index("-o") + 1
    reversed_command[output_index] += ".2"
    for index, mirrored_index in zip(files, reversed(files), strict=True):
        reversed_command[index] = command[mirrored_index]
    return reversed_command


@contextmanager
def _compilers(commands: Sequence[Sequence[str]]) -> Iterator[None]:
    """Run as many compilers at once as there are processors. Errors are ignored here; the build itself reports them."""
    environment, lock, ended = build.compiler_environment(), threading.Lock(), threading.Event()
    running: list[subprocess.Popen[bytes]] = []

    def compile(command: Sequence[str]) -> None:
        with lock:
            if ended.is_set():
                return
            process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            running.append(process)
        process.wait()

    with ThreadPoolExecutor(available_cores()) as pool:
        try:
            for command in commands:
                pool.submit(compile, command)
            yield
        finally:
            with lock:
                ended.set()
                for process in running:
                    process.terminate()
