"""The command of FMUs: a figure for every call, positive; tables of the pages."""

import json
from pathlib import Path

import pytest

from benchmarks import fmu
from benchmarks.car import fmu_calls

SCENE = Path(__file__).parents[2] / "examples" / "motor_pendulum.py"


@pytest.mark.slow
def test_every_quantity_has_a_figure(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "fmu.json"
    scene = f"{SCENE}:motor_pendulum"
    arguments = ["calls", "--scene", scene, "--steps", "20", "--repeats", "2", "--instances", "5", "--json", str(file)]
    assert fmu.main(arguments) == 0
    printed = capsys.readouterr().out
    assert all(f"| {title} |" in printed for title in fmu_calls.CALLS.values())
    content = json.loads(file.read_text(encoding="utf-8"))
    native = {r["quantity"]: r["value"] for r in content["rows"] if r["kind"] == "native"}
    assert {*native} >= {*fmu_calls.CALLS, "memory_per_instance_kB", "file_MB"}
    assert all(value > 0.0 for value in native.values())
    assert content["meta"]["scene"] == scene


@pytest.mark.proof  # minutes: FMUs for WebAssembly are built, and Node and a browser step them
def test_every_host_has_its_figures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "wasm.json"
    assert fmu.main(["wasm", "--steps", "20", "--repeats", "1", "--rounds", "1", "--json", str(file)]) == 0
    printed = capsys.readouterr().out
    content = json.loads(file.read_text(encoding="utf-8"))
    hosts = list(dict.fromkeys(row["host"] for row in content["rows"]))
    assert hosts[:2] == ["native", "wasmtime"]
    assert all(f"{host} " in printed for host in hosts)
    assert {(r["fidelity"], r["host"]) for r in content["rows"]} == {(f, h) for f in ("0", "2") for h in hosts}
    assert all(r["best_us"] > 0.0 for r in content["rows"])
