"""List the commands: ``python -m benchmarks``."""

import ast
import sys
from pathlib import Path

FOLDER = Path(__file__).parent


def commands() -> dict[str, Path]:
    """Files of the commands by name: modules of this folder, and packages with a `__main__`."""
    files = {file.stem: file for file in FOLDER.glob("*.py") if not file.stem.startswith("__")}
    return files | {file.parent.name: file for file in FOLDER.glob("*/__main__.py")}


def main() -> int:
    """Print each command with the beginning of its docstring."""
    descriptions = {
        name: ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))) for name, file in commands().items()
    }
    width = max(map(len, descriptions))
    for name, text in sorted(descriptions.items()):
        print(f"python -m benchmarks.{name:{width}}  {' '.join((text or '').split()).partition(':')[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
