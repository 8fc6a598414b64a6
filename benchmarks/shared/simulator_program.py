"""The simulator as a program of its own."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def simulator(fmu: Path, options: Sequence[str]) -> Iterator[str]:
    """Start the simulator; gives its address."""
    command = [sys.executable, "-m", "ali3", "simulator", str(fmu), "--no-open", "--no-devices", *options]
    host = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    said = ""
    try:
        for line in host.stdout or ():
            said += line
            if found := re.search(r"http://\S+", line):
                break
        else:
            raise RuntimeError(f"The simulator did not start: {said}")
        yield found[0]
    finally:
        host.terminate()
        host.communicate()
