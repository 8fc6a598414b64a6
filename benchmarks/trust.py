"""What a run may be trusted for: ``python -m benchmarks.trust [--json FILE]``.

Error of a frequency by the steps in a period, of wheel loads by speed and step over a kerb, and of hard manoeuvres.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from ali3.running import run_command
from benchmarks.car.trust import COLUMNS, measure
from benchmarks.shared.command import parser_of, save_rows
from benchmarks.shared.tables import print_table


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command."""
    options = parser_of("trust", __doc__).parse_args(arguments)
    rows = measure()
    for name, part in rows.items():
        print(f"\n{name}")
        print_table(part, COLUMNS[name])
    save_rows(options.json, "trust", [{"table": k, **r} for k, part in rows.items() for r in part])
    return 0


if __name__ == "__main__":
    sys.exit(run_command(main))
