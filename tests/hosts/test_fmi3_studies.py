"""A comparison of an FMU of FMI 3.0 with a log, and its fit."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hosts.compare.command import main as compare

HERE = Path(__file__).parent


@pytest.mark.slow
def test_a_comparison_with_a_log(scene_fmu: Callable[..., Path], tmp_path: Path) -> None:
    """Its log is the motion of a softer spring by SciPy; FMI 3.0 holds inputs, which makes them half a step late."""
    stiffness, damping, mass, length, gravity = 60.0, 1.0, 2.0, 0.8, 9.80665

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, y, u, v = state
        r = np.hypot(x, y)
        tension = stiffness * (r - length) + damping * (x * u + y * v) / r
        return [u, v, (6.0 * np.sin(1.3 * t) - tension * x / r) / mass, -tension * y / r / mass - gravity]

    t = np.arange(0.0, 4.005, 0.01)
    x, y = solve_ivp(rates, (0.0, 4.1), [0.0, -1.0, 0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-11).y[:2]
    log, record = tmp_path / "log.csv", tmp_path / "record.json"
    rows = np.column_stack([t, 6.0 * np.sin(1.3 * t), x, y])
    log.write_text("time,pull,bob.x,bob.y\n" + "\n".join(",".join(map(repr, map(float, r))) for r in rows) + "\n")
    fmu = scene_fmu(f"{HERE / 'scenes.py'}:tuned", "fmi3")
    requested = [str(fmu), str(log), "--out", str(tmp_path / "out"), "--json", str(record)]
    assert compare([*requested, "--fit", "spring.stiffness", "--fit", "spring.damping=0.2:5"]) == 0
    actual = {f["name"]: f["value"] for f in json.loads(record.read_text())["fit"]["found"]}
    assert actual["spring.stiffness"] == pytest.approx(stiffness, rel=0.03)
    assert actual["spring.damping"] == pytest.approx(damping, rel=0.03)
