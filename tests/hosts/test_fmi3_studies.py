"""Studies of an FMU of FMI 3.0 have the results of the same model in FMI 2.0, and so has a comparison with a log."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hosts.compare.command import main as compare
from hosts.study.command import main as study
from hosts.study.store import read_study
from tests import kinds

HERE = Path(__file__).parent
MEASURES = ["lowest", "highest"]


@pytest.fixture(scope="module")
def fmus(scene_fmu: Callable[..., Path]) -> dict[str, Path]:
    return {k: scene_fmu(f"{HERE / 'scenes.py'}:tuned", k) for k in kinds.VERSIONS}


@pytest.mark.slow
def test_a_study(fmus: dict[str, Path], tmp_path: Path) -> None:
    text = (HERE / "study" / "study.txt").read_text(encoding="utf-8").replace("runs = 16", "runs = 4")
    results = {}
    for kind, fmu in fmus.items():
        file, out = tmp_path / f"{kind}.toml", tmp_path / kind
        file.write_text(text.format(fmu=fmu), encoding="utf-8")
        assert study([str(file), "--out", str(out), "--jobs", "1", "--no-report"]) == 0
        results[kind] = read_study(out)
    assert list(results["fmi3"]["status"]) == ["done"] * 4
    for name in MEASURES:
        assert list(results["fmi3"][name]) == list(results["native"][name])
        assert results["fmi3"][name].std() > 1e-3
        assert results["fmi3"].attrs["units"][name] == results["native"].attrs["units"][name] == "m"


@pytest.mark.slow
def test_a_comparison_with_a_log(fmus: dict[str, Path], tmp_path: Path) -> None:
    """Its log is the motion of a softer spring by SciPy; FMI 3.0 holds inputs, which makes them half a step late."""
    stiffness, damping, mass, length, gravity = 60.0, 1.0, 2.0, 0.8, 9.80665

    def rates(t: float, state: np.ndarray) -> list[float]:
        x, y, u, v = state
        r = np.hypot(x, y)
        tension = stiffness * (r - length) + damping * (x * u + y * v) / r
        return [u, v, (6.0 * np.sin(1.3 * t) - tension * x / r) / mass, -tension * y / r / mass - gravity]

    t = np.arange(0.0, 4.005, 0.01)
    x, y = solve_ivp(rates, (0.0, 4.1), [0.0, -1.0, 0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-11).y[:2]
    log, actual = tmp_path / "log.csv", {}
    rows = np.column_stack([t, 6.0 * np.sin(1.3 * t), x, y])
    log.write_text("time,pull,bob.x,bob.y\n" + "\n".join(",".join(map(repr, map(float, r))) for r in rows) + "\n")
    for kind, fmu in fmus.items():
        out = tmp_path / kind
        requested = [str(fmu), str(log), "--out", str(out), "--json", str(tmp_path / f"{kind}.json")]
        assert compare([*requested, "--fit", "spring.stiffness", "--fit", "spring.damping=0.2:5"]) == 0
        record = json.loads((tmp_path / f"{kind}.json").read_text())
        actual[kind] = {f["name"]: f["value"] for f in record["fit"]["found"]}
    for name, true in (("spring.stiffness", stiffness), ("spring.damping", damping)):
        assert actual["native"][name] == pytest.approx(true, rel=0.02)
        assert actual["fmi3"][name] == pytest.approx(true, rel=0.03)
