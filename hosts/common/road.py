"""The option ``--road``: a road for the parameter ``road.file`` of an FMU."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from ali3.files import make_folder
from ali3.running import module_command
from hosts.common.errors import HostError

PARAMETER = "road.file"
MADE_OF = (".csv", ".txt", ".npy", ".npz", ".png", ".toml")
"""Suffixes of what ``ali3 road`` makes a road file of."""


def road_value(given: str, out: Path) -> str:
    """What `PARAMETER` is set to.

    Parameters
    ----------
    given : str
        A road file here; the name of one in the FMU; or what ``ali3 road`` makes one of without further options.
    out : Path
        Folder that takes the road file that is made.

    Returns
    -------
    str
        The path of the file, or the name as it is.

    Raises
    ------
    HostError
        The file is no road; with the words of ``ali3 road``.
    """
    path = Path(given)
    if path.suffix.lower() not in MADE_OF:
        return str(path.absolute()) if path.exists() else given
    made = make_folder(out) / f"{path.stem}.road"
    command = module_command("mbs.worlds.road_command", str(path), str(made))
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        words = done.stderr.strip().splitlines()
        raise HostError(words[-1].removeprefix("error: ") if words else f"{given} is no road.")
    print(done.stderr, end="", file=sys.stderr)  # what is odd about the road
    return str(made.absolute())
