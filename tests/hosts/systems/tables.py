"""The tables of docs/systems.md, printed; with --write they and the picture are put there.

python -m tests.hosts.systems.tables [--write]
"""

import sys

from benchmarks.shared.pages import DOCS, replace
from tests.hosts.systems import twins, weak_coupling

if __name__ == "__main__":
    errors: weak_coupling.Errors = {}
    blocks = {"coupling of parts": "", "coupling of controllers": ""}
    for name, lines in zip(blocks, (weak_coupling.lines(errors), twins.lines()), strict=True):
        for line in lines:
            print(line, flush=True)
            blocks[name] += f"{line}\n"
        print()
    if "--write" in sys.argv[1:]:
        page = DOCS / "systems.md"
        page.write_text(replace(page.read_text(encoding="utf-8"), blocks), encoding="utf-8")
        weak_coupling.chart(errors, DOCS / "images" / "weak_coupling.png")
