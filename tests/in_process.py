"""Commands run inside the process of the tests, without a start of Python for each; their output."""

import io
from collections.abc import Callable, Sequence
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from subprocess import CompletedProcess

from fmu_src.build.command import main as build


def run(main: Callable[[Sequence[str]], int], *arguments: object) -> CompletedProcess[str]:
    """What a command's `main` gives back and prints."""
    typed = [*map(str, arguments)]
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as error:
        try:
            status = main(typed)
        except SystemExit as end:  # of argparse
            status = int(end.code or 0)
    return CompletedProcess(typed, status, out.getvalue(), error.getvalue())


def build_fmu(folder: Path, *options: str) -> Path:
    """The native FMU that ``ali3 build`` makes for this machine."""
    done = run(build, "--kind", "native", "--platforms", "this", *options, "--out", folder)
    assert done.returncode == 0, done.stderr
    (file,) = folder.glob("*.fmu")
    return file
