"""What must be read to know a command: lines of all files that it imports, also inside functions.

python -m tests.house.reading
"""

from __future__ import annotations

import grimp

from ali3.commands import COMMANDS
from tests.house.test_circles import FACADES, PACKAGES, ROOT


def lines_of(module: str) -> int:
    """Lines of a module's file."""
    path = ROOT.joinpath(*module.split("."))
    file = path.with_suffix(".py")
    return len((file if file.is_file() else path / "__init__.py").read_text(encoding="utf-8").splitlines())


def read_for(graph: grimp.ImportGraph, module: str) -> set[str]:
    """A module, all that it imports, and the packages around them."""
    found: set[str] = set()
    todo = [module]
    while todo:
        name = todo.pop()
        if name in found or name in FACADES:
            continue
        found.add(name)
        todo += [*graph.find_modules_directly_imported_by(name), *filter(None, [name.rpartition(".")[0]])]
    return found


def main() -> None:
    """Print the table."""
    graph = grimp.build_graph(*PACKAGES, exclude_type_checking_imports=False, cache_dir=None)
    for command in COMMANDS:
        files = read_for(graph, command.module)
        print(f"{command.name:12} {len(files):4d} files {sum(map(lines_of, files)):6d} lines")


if __name__ == "__main__":
    main()
