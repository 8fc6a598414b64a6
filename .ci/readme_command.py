"""One of the two commands of README.md as it stands there: ``python .ci/readme_command.py 1`` or ``2``."""

import re
import sys
from pathlib import Path

README = Path(__file__).resolve().parents[1] / "README.md"
SECTION, START = "## Two commands", "python3 "


def commands(text: str) -> list[str]:
    """The indented lines that start with ``python3`` in the section of the two commands."""
    section = text.partition(f"\n{SECTION}\n")[2].partition("\n## ")[0]
    return re.findall(rf"^    ({START}.*)$", section, re.M)


def main() -> int:
    """Run the command."""
    result = commands(README.read_text(encoding="utf-8"))
    if len(result) != 2:
        print(
            f"error: README.md has {len(result)} indented commands that start with '{START}' under '{SECTION}'; "
            "there must be two.",
            file=sys.stderr,
        )
        return 1
    print(result[int(sys.argv[1]) - 1])
    return 0


if __name__ == "__main__":
    sys.exit(main())
