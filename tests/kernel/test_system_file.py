"""System files whose header or names were altered under a right checksum: one sentence, never a raw KeyError."""

import json
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mbs
from ali3.errors import FileError
from mbs.kernel.binding import KernelError, LoadedSystem
from mbs.system.compiled_model import SystemFileError
from mbs.system.system import System


def model() -> mbs.Model:
    m = mbs.Model("swing", dimension=2)
    bob = m.point_mass("bob", mass=1.0, position=(0.6, 0.8))
    m.distance("rod", (m.ground, (0.0, 0.0)), bob)
    push = m.input("push", min=0.0, max=10.0, unit="N")
    m.force("wind", bob, inputs=(push, None))
    m.sense_position("bob.x", bob, component="x")
    return m


def test_the_end_of_the_header_is_zero() -> None:
    data = bytearray(mbs.compile(model()).to_bytes())
    data[31] ^= 1
    with pytest.raises(KernelError, match="not zero"):
        LoadedSystem(bytes(data))
    with pytest.raises(SystemFileError, match="not zero"):
        System.from_bytes(bytes(data))


META_CHANGES: list[Callable[[dict[str, Any]], object]] = [
    lambda m: m.pop("experiment"),
    lambda m: m["experiment"].update(step_s=0.0),
    lambda m: m.update(dimension=True),
    lambda m: m["report"].clear(),
    lambda m: m["sensors"].pop(),
    lambda m: m["inputs"][0].pop("max"),
    lambda m: m["inputs"][0].update(min="x"),
    lambda m: m["parameters"].append({"name": "p"}),
    lambda m: m["coordinates"].pop(),
    lambda m: m.update(rows=None),
]


@pytest.mark.parametrize("change", META_CHANGES)
def test_altered_names_are_a_sentence(change: Callable[[dict[str, Any]], object]) -> None:
    system = mbs.compile(model())
    meta = system.meta
    change(meta)
    with pytest.raises(SystemFileError, match="names in the System file"):
        System.from_bytes(System(system.arrays, meta).to_bytes())


def test_numbers_in_the_names_are_finite(monkeypatch: pytest.MonkeyPatch) -> None:
    system = mbs.compile(model())
    meta = system.meta
    meta["experiment"]["stop_time_s"] = math.inf
    dumps = json.dumps
    with monkeypatch.context() as patched:
        patched.setattr(json, "dumps", lambda value, allow_nan, **more: dumps(value, **more))
        data = System(system.arrays, meta).to_bytes()
    with pytest.raises(SystemFileError, match=r"experiment\.stop_time_s is inf; it must be a finite number\.$"):
        System.from_bytes(data)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes of POSIX")
def test_a_named_pipe_is_no_system_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(FileError, match="is a pipe"):
        System.load(tmp_path / "pipe")
