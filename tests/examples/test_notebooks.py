"""The notebooks run from the first cell to the last, and their results satisfy the stated claims."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.quick import quick

FOLDER = Path(__file__).parents[2] / "examples" / "notebooks"
CLAIMS = {
    "abs_by_pid": "ways['PID'] < 0.95 * ways['locked']",
    "lane_keeping_by_mpc": "errors['MPC'] < 0.08 and errors['plain feedback'] > 0.15 and not runs['MPC'][1] "
    "and abs(runs['MPC'][0][:, 1]).max() == np.float32(0.08)",
    "lap_by_evolution": "lap_time < baseline[1] - 5.0 and lap_time == best[1] and told == sorted(told, reverse=True)",
}
"""What is true at the end of each."""


def cells(name: str) -> list[dict]:
    return json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))["cells"]


def test_every_notebook_is_named_and_without_outputs() -> None:
    assert {path.stem for path in FOLDER.glob("*.ipynb")} == set(CLAIMS)
    for name in CLAIMS:
        assert all(not cell.get("outputs") and cell.get("execution_count") is None for cell in cells(name)), name
        assert sum(len("".join(cell["source"]).splitlines()) for cell in cells(name)) < 130, name


@pytest.mark.slow
@pytest.mark.parametrize("name", quick(("abs_by_pid", "lane_keeping_by_mpc"), CLAIMS, "proof"))
def test_a_notebook_runs(name: str, tmp_path: Path) -> None:
    """Its cells one after another."""
    code = "\n".join("".join(cell["source"]) for cell in cells(name) if cell["cell_type"] == "code")
    code = f"import matplotlib\nmatplotlib.use('Agg')\n{code}\nassert {CLAIMS[name]}\n"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert (tmp_path / f"{name}.png").stat().st_size > 10_000
