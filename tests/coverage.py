"""Which lines of C and of Python the tests run.

    python -m tests.coverage [arguments for pytest]

The C part is that of the kernel and needs gcc with gcov; the elements that the tests in `tests/elements` compile by
themselves are not counted there.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from mbs.kernel import build

ROOT = Path(__file__).resolve().parents[1]
PACKAGES = [name for name in ("ali3", "mbs", "fmu_src", "hosts") if (ROOT / name).is_dir()]
FLAGS = ["-O1", "-std=c11", "-fPIC", "-shared", "-fvisibility=hidden", "-ffp-contract=off", "-fprofile-update=atomic"]


def kernel_lines(folder: Path) -> dict[str, dict[int, int]]:
    """Counts of the lines of each C file, by its name within the sources."""
    data = [path.name for path in folder.glob("*.gcda")]
    result = subprocess.run(["gcov", "-t", "-j", *data], cwd=folder, capture_output=True, text=True, check=True)
    counts: dict[str, dict[int, int]] = defaultdict(lambda: defaultdict(int))
    for unit in filter(lambda line: line.startswith("{"), result.stdout.splitlines()):
        for file in json.loads(unit)["files"]:
            path = Path(file["file"])
            if build.HERE in path.parents:
                for line in file["lines"]:
                    counts[str(path.relative_to(build.HERE / "src"))][line["line_number"]] += line["count"]
    return counts


def table(counts: dict[str, dict[int, int]]) -> str:
    """One row a file, and all."""
    rows = [(name, len(lines), sum(n > 0 for n in lines.values())) for name, lines in sorted(counts.items())]
    rows.append(("TOTAL", sum(r[1] for r in rows), sum(r[2] for r in rows)))
    width = max(len(row[0]) for row in rows)
    head = f"{'C file':{width}}  lines   run  share"
    body = [f"{name:{width}}  {lines:5d} {run:5d} {100.0 * run / max(lines, 1):5.1f}%" for name, lines, run in rows]
    return "\n".join([head, *body])


def main(arguments: list[str]) -> int:
    """Exit code of pytest."""
    with tempfile.TemporaryDirectory(prefix="ali3-coverage-") as name:
        folder, environment = Path(name), {"COVERAGE_FILE": str(Path(name) / "python")}
        with_c = shutil.which("gcc") is not None and shutil.which("gcov") is not None
        if with_c:
            library = folder / build.library_name(build.host_target())
            command = ["gcc", *FLAGS, "--coverage", "-o", library, *build.sources(), "-lm"]
            subprocess.run(command, cwd=folder, check=True)
            environment["ALI3_KERNEL_LIBRARY"] = str(library)
        command = [sys.executable, "-m", "pytest", "-q", *(f"--cov={package}" for package in PACKAGES), *arguments]
        code = subprocess.run(command, cwd=ROOT, env=os.environ | environment, check=False).returncode
        print(table(kernel_lines(folder)) if with_c else "No coverage of C: gcc or gcov is missing.")
    return code


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
