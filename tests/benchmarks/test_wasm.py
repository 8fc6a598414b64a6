"""`python -m benchmarks.wasm`: a figure for every host, which all end at the same place; sizes in the file."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from benchmarks import wasm


@pytest.mark.slow
def test_every_host_has_its_figures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "wasm.json"
    assert wasm.main(["--steps", "20", "--repeats", "1", "--rounds", "1", "--json", str(file)]) == 0
    printed = capsys.readouterr().out
    content = json.loads(file.read_text(encoding="utf-8"))
    hosts = list(content["meta"]["hosts"])
    assert hosts[:2] == ["native", "wasmtime"]
    assert all(host in printed for host in hosts)
    assert {(r["fidelity"], r["host"]) for r in content["rows"]} == {(f, h) for f in ("0", "2") for h in hosts}
    assert all(r["us"] >= r["best_us"] > 0.0 for r in content["rows"])
    assert all(r["ratio"] == 1.0 for r in content["rows"] if r["host"] == "native")
    size = content["meta"]["module"]
    assert 100e3 < size["gzip"] < size["bytes"] < 1e6
