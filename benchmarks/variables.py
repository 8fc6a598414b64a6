"""Write the tables of the cars' variables into `docs/variables.md`: ``python -m benchmarks.variables``."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from ali3.files import write_text
from ali3.running import run_command
from benchmarks.car.variable_tables import full, overview, tables
from benchmarks.shared.pages import DOCS, replace


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.variables", description=__doc__)
    parser.add_argument("--docs", type=Path, default=DOCS, help="folder of the page")
    file = parser.parse_args(arguments).docs / "variables.md"
    found = tables()
    before = file.read_text(encoding="utf-8")
    after = replace(before, {"car variables": overview(found)} | full(found))
    write_text(file, after)
    print(f"{file.resolve()}: {'unchanged' if after == before else 'written'}")
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
