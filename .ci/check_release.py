"""Whether a release is ready: ``python .ci/check_release.py [TAG]`` prints its notes, or says what does not fit.

The version stands in pyproject.toml; the tag, the section of CHANGELOG.md, CITATION.cff and the date that FMUs carry
must agree with it. Without a tag, only the places that must agree at any time are compared.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def problems(root: Path, tag: str | None) -> list[str]:
    """Sentences on disagreements between the files of a release."""
    version = version_of(root)
    results = []
    cited = _first(r"^version: *(\S+)$", root / "CITATION.cff")
    if cited != version:
        results.append(f"CITATION.cff says version {cited}, pyproject.toml {version}.")
    if tag is None:
        return results
    if tag != f"v{version}":
        results.append(f"The tag is {tag}; pyproject.toml says version {version}, whose tag is v{version}.")
    date, text = section(root, version)
    if date is None:
        return [*results, f"CHANGELOG.md has no heading '## [{version}] - YYYY-MM-DD'."]
    if not text:
        results.append(f"The section [{version}] of CHANGELOG.md is empty.")
    for name, pattern in (
        ("CITATION.cff", r"^date-released: *[\"']?([\d-]+)"),
        ("fmu_src/description/description.py", r'^RELEASE_DATE = "([\d-]+)T'),
    ):
        other = _first(pattern, root / name)
        if other != date:
            results.append(f"CHANGELOG.md says that {version} is of {date}, {name} says {other or 'nothing'}.")
    return results


def version_of(root: Path) -> str | None:
    """Version in pyproject.toml."""
    return _first(r'^version = "(.+)"$', root / "pyproject.toml")


def section(root: Path, version: str | None) -> tuple[str | None, str]:
    """Date and text of a version in CHANGELOG.md; None without a heading with a date."""
    text = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    match = re.search(rf"^## \[{re.escape(str(version))}\] - (\d{{4}}-\d\d-\d\d)\n(.*?)(?=^## |\Z)", text, re.M | re.S)
    return (match[1], match[2].strip()) if match else (None, "")


def _first(pattern: str, file: Path) -> str | None:
    match = re.search(pattern, file.read_text(encoding="utf-8"), re.M)
    return match[1] if match else None


def main() -> int:
    """Run the command."""
    tag = sys.argv[1] if len(sys.argv) > 1 else None
    faults = problems(ROOT, tag)
    for sentence in faults:
        print(f"error: {sentence}", file=sys.stderr)
    if not faults and tag is not None:
        print(section(ROOT, version_of(ROOT))[1])
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
