"""Confines processes to the files that they need, by bubblewrap on Linux (option ``--confined``)."""

import os
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from functools import cache
from pathlib import Path

import ali3
from ali3.errors import UserError
from ali3.limits import VARIABLE

_SWITCH = "ALI3_CONFINED"  # programs that this one starts, such as workers of a study, know it by their environment
_SYSTEM = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/ld.so.conf.d")
_KEPT = ("PATH", "LANG", "LC_ALL", "LC_CTYPE", "LD_LIBRARY_PATH", "OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", VARIABLE)
_APART = ("--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts", "--new-session")
_PATIENCE = 20.0  # s


def confine() -> None:
    """Processes of `ali3.isolated_processes` started from now on are confined. Raises `UserError`."""
    _bubblewrap()
    os.environ[_SWITCH] = "1"


def is_confined() -> bool:
    """Whether processes of `ali3.isolated_processes` are confined."""
    return _SWITCH in os.environ


def confined(command: Sequence[str], readable: Iterable[Path], writable: Sequence[Path]) -> list[str]:
    """The command of a process that sees these files and folders of the user's alone, and begins in the last."""
    return [
        *_bubblewrap(),
        *("--proc", "/proc", "--dev", "/dev", "--tmpfs", "/tmp"),
        *(word for place in _places() for word in ("--ro-bind", place, place)),
        *(word for file in readable for word in ("--ro-bind-try", str(file), str(file))),
        *(word for file in writable for word in ("--bind", str(file), str(file))),
        *("--chdir", str(writable[-1])),
        "--",
        *command,
    ]


def environment(variables: dict[str, str], folder: Path) -> dict[str, str]:
    """Environment variables that a confined process gets."""
    temporary = dict.fromkeys(("HOME", "TMPDIR", "TEMP", "TMP"), str(folder))
    return {name: value for name, value in variables.items() if name in _KEPT} | temporary


@cache
def _bubblewrap() -> tuple[str, ...]:
    """The command that confines, as far as it is the same for all. Raises `UserError`: there is none that works."""
    program = shutil.which("bwrap") if sys.platform == "linux" else None
    if program is None:
        why = "install bubblewrap (bwrap)" if sys.platform == "linux" else "it needs Linux"
        raise UserError(f"--confined is not possible here, and nothing was run: {why}.")
    system = tuple(word for place in _SYSTEM for word in ("--ro-bind-try", place, place))
    errors_text = ""
    for options in ((), ("--unshare-user",)):
        command = (program, *_APART, *options, *system)
        probe_command = [*command, "--proc", "/proc", "--dev", "/dev", "--", "/usr/bin/env", "true"]
        try:
            process = subprocess.run(probe_command, capture_output=True, text=True, check=False, timeout=_PATIENCE)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise UserError(f"--confined is not possible here, and nothing was run: {error}.") from None
        if process.returncode == 0:
            return command
        errors_text = (process.stderr.strip().splitlines() or [f"exit code {process.returncode}"])[-1]
    raise UserError(f"--confined is not possible here, and nothing was run: {program} says: {errors_text}.")


@cache
def _places() -> tuple[str, ...]:
    """Folders of Python and of this program; those that `_SYSTEM` has are left out."""
    root = Path(ali3.__file__).resolve().parents[1]
    results = [Path(sys.prefix), Path(sys.base_prefix), Path(sys.executable).resolve().parents[1]]
    if not any(root.is_relative_to(place) for place in results):  # a clone: its packages alone
        results += [file.parent for file in root.glob("*/__init__.py")]
    return tuple(dict.fromkeys(str(place) for place in results if not place.is_relative_to("/usr")))
