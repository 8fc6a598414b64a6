"""Test files with a test skipped because of a missing Python package: ``python .ci/skipped_for_packages.py LOG``.

LOG is the output of pytest with ``-ra``. The environment of the test command has not every package; these files are run
once more where all are installed.
"""

import re
import sys
from pathlib import Path

REASON = r"could not import|extra '|[Tt]he package \S+ is not installed"


def files(log: str) -> list[str]:
    """Paths in alphabetical order."""
    return sorted(set(re.findall(rf"^SKIPPED \[\d+\] (\S+?):\d+: .*(?:{REASON})", log, re.M)))


if __name__ == "__main__":
    for file in files(Path(sys.argv[1]).read_text(encoding="utf-8", errors="replace")):
        print(file)
