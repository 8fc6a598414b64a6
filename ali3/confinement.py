"""Restricts processes to the files that they need, by bubblewrap on Linux (option ``--confined``)."""

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

_CONFINED_VARIABLE = "ALI3_CONFINED"  # environment variable, which child processes inherit
_SYSTEM_PATHS = ("/usr", "/bin", "/sbin", "/lib", "/lib32", "/lib64", "/etc/ld.so.cache", "/etc/ld.so.conf.d")
_PASSED_VARIABLES = (
    "PATH",
    "LANG",
    "LC_ALL",
    "LC_CTYPE",
    "LD_LIBRARY_PATH",
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    VARIABLE,
)
_ISOLATION_OPTIONS = ("--unshare-pid", "--unshare-net", "--unshare-ipc", "--unshare-uts", "--new-session")
_TIMEOUT = 20.0  # s


def confine() -> None:
    """Confine the processes of `ali3.isolated_processes` that start after this call. Raises `UserError`."""
    _bubblewrap()
    os.environ[_CONFINED_VARIABLE] = "1"


def is_confined() -> bool:
    """Whether processes of `ali3.isolated_processes` are confined."""
    return _CONFINED_VARIABLE in os.environ


def confined(command: Sequence[str], readable: Iterable[Path], writable: Sequence[Path]) -> list[str]:
    """Command line of a process that sees only these files and folders of the user and runs in the last folder."""
    return [
        *_bubblewrap(),
        *("--proc", "/proc", "--dev", "/dev", "--tmpfs", "/tmp"),
        *(word for path in _python_folders() for word in ("--ro-bind", path, path)),
        *(word for file in readable for word in ("--ro-bind-try", str(file), str(file))),
        *(word for file in writable for word in ("--bind", str(file), str(file))),
        *("--chdir", str(writable[-1])),
        "--",
        *command,
    ]


def environment(variables: dict[str, str], folder: Path) -> dict[str, str]:
    """Environment variables of a confined process, whose home and temporary folder is `folder`."""
    temporary = dict.fromkeys(("HOME", "TMPDIR", "TEMP", "TMP"), str(folder))
    return {name: value for name, value in variables.items() if name in _PASSED_VARIABLES} | temporary


@cache
def _bubblewrap() -> tuple[str, ...]:
    """Common part of the command lines of confined processes. Raises `UserError` if bubblewrap is not usable here."""
    program = shutil.which("bwrap") if sys.platform == "linux" else None
    if program is None:
        remedy = "install bubblewrap (bwrap)" if sys.platform == "linux" else "it needs Linux"
        raise UserError(f"--confined is not possible here, and nothing was run: {remedy}.")
    system_binds = tuple(word for path in _SYSTEM_PATHS for word in ("--ro-bind-try", path, path))
    errors_text = ""
    for options in ((), ("--unshare-user",)):
        command = (program, *_ISOLATION_OPTIONS, *options, *system_binds)
        probe_command = [*command, "--proc", "/proc", "--dev", "/dev", "--", "/usr/bin/env", "true"]
        try:
            process = subprocess.run(probe_command, capture_output=True, text=True, check=False, timeout=_TIMEOUT)
        except (OSError, subprocess.TimeoutExpired) as error:
            raise UserError(f"--confined is not possible here, and nothing was run: {error}.") from None
        if process.returncode == 0:
            return command
        errors_text = (process.stderr.strip().splitlines() or [f"exit code {process.returncode}"])[-1]
    raise UserError(f"--confined is not possible here, and nothing was run: {program} says: {errors_text}.")


@cache
def _python_folders() -> tuple[str, ...]:
    """Folders of Python and of this program that are not among the system paths."""
    root = Path(ali3.__file__).resolve().parents[1]
    folders = [Path(sys.prefix), Path(sys.base_prefix), Path(sys.executable).resolve().parents[1]]
    if not any(root.is_relative_to(folder) for folder in folders):  # a clone: only its packages
        folders += [file.parent for file in root.glob("*/__init__.py")]
    return tuple(dict.fromkeys(str(folder) for folder in folders if not folder.is_relative_to("/usr")))
