"""The WebAssembly module: imports and exports, files and messages in its memory, exhausted memory."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
import zipfile
from collections.abc import Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pytest
from fmpy.fmi1 import FMICallException
from fmpy.validation import validate_fmu
from wasm_hosts import Fmu, Plan, assert_same, native, wasmtime

import build_fmu
from ali3.processes import module_command
from benchmarks.shared.fmu_module import FmuModule
from fmu_src.build.build import build_fmu as build
from fmu_src.build.scene_registry import load_scene
from fmu_src.native.sources import packed_sources
from hosts.check.command import main as check
from mbs.elements import GridRoad
from mbs.kernel import build as kernel_build
from mbs.kernel.binding import load_library
from mbs.kernel.binding.errors import status_text
from mbs.roads import write_road
from tests.unoptimised import unoptimised

STACK = 1 << 20
HELPERS = {"memory", "_initialize", "malloc", "free"}
HELPERS |= {"ali3_file_add", "ali3_file_remove", "ali3_callbacks", "ali3_messages"}
SCENES = Path(__file__).parents[1] / "fmu" / "scenes.py"


def module(fmu: Fmu, **more: Any) -> FmuModule:
    return FmuModule(fmu.wasm, fmu.resources, fmu.description.guid, **more)


@pytest.mark.slow
def test_it_imports_nothing_and_exports_fmi(small):
    import wasmtime

    fmu = small("crane")
    module = wasmtime.Module(wasmtime.Engine(), fmu.wasm)
    assert list(module.imports) == []
    names = {export.name for export in module.exports}
    sources = "".join(f.read_text() for f in (fmu.folder / "sources").glob("fmi2_*.c"))
    fmi = set(re.findall(r"FMI2_(?:NAME|ENTRY)\((fmi2\w+)", sources))
    assert len(fmi) == 34
    assert names == fmi | HELPERS


@pytest.mark.slow
def test_the_stack_lies_below_all_data(small):
    """An overflow is then a trap, and no change of data."""
    loaded = module(small("crane"))
    assert loaded.address("ali3_messages") >= STACK
    assert loaded.address("ali3_callbacks") >= STACK


@pytest.mark.slow
def test_memory_that_runs_out_is_a_sentence(prototype):
    loaded = module(prototype)
    assert loaded.there
    for limit, there in ((loaded.memory_size, True), (loaded.memory_size - (1 << 18), False)):
        limited = module(prototype, memory_limit=limit)
        assert limited.there == there
        if not there:
            assert any("memory" in text for _, text in limited.messages), limited.messages


@pytest.mark.slow
def test_a_road_for_which_there_is_no_memory(prototype):
    loaded = module(prototype, memory_limit=module(prototype).memory_size + (1 << 16))
    with pytest.raises(FMICallException):
        loaded.set("String", [prototype.kinds["road.file"][1]], ["own.road"])
    assert loaded.messages[-1][1].endswith(": there is not enough memory.")
    with pytest.raises(MemoryError):
        loaded.add_file("roads/large.road", bytes(1 << 20))


@pytest.mark.slow
def test_a_table_whose_points_exceed_32_bits_is_refused(prototype):
    """65536 x 65536 points are 0 in 32 bits."""
    result, n = module(prototype), 1 << 16
    result.add_file("roads/large.csv", b"y/x" + b";1" * n + b"\n" + (b"1" + b";0" * n + b"\n") * 4 + b"1;0\n" * (n - 4))
    with pytest.raises(FMICallException):
        result.set("String", [prototype.kinds["road.file"][1]], ["large.csv"])
    assert "its size does not allow so many rows and columns" in result.messages[-1][1]


@pytest.mark.slow
def test_messages_beyond_the_room_for_them_are_counted(small):
    fmu = small("crane")
    loaded = module(fmu)
    reference = struct.pack("<I", fmu.kinds["torque"][1])
    where, value = loaded.block(reference), loaded.block(struct.pack("<d", np.nan))
    refuse = loaded.caller("fmi2SetReal")
    assert {refuse(where, 1, value) for _ in range(2000)} == {3}
    loaded.fetch_messages()
    *kept, lost = loaded.messages
    assert lost == (1, f"{2000 - len(kept)} lost")
    assert 300 < len(kept) < 2000
    assert len(set(kept)) == 1
    assert kept[0][0] == 3
    assert "'torque' was set to nan" in kept[0][1]
    refuse(where, 1, value)
    loaded.fetch_messages()
    assert loaded.messages[-1] == kept[0]


@pytest.mark.slow
def test_a_percent_sign_is_one(prototype):
    loaded = module(prototype)
    with pytest.raises(FMICallException):
        loaded.set("String", [prototype.kinds["road.file"][1]], ["50%.road"])
    assert "'50%.road' (/resources/roads/50%.road)" in loaded.messages[-1][1]


@pytest.mark.slow
def test_a_file_that_is_open_stays_when_another_takes_its_name(prototype, tmp_path):
    """Of a road with more tiles than are near; what comes later is read from the file as it was opened."""
    for name, seed in (("long.road", 1), ("other.road", 2)):
        heights = 0.002 * np.random.default_rng(seed).standard_normal((6000, 64))
        write_road(GridRoad((-10.0, -3.2), (0.1, 0.1), heights, 0.9), tmp_path / name)
    files = [(tmp_path / name).read_bytes() for name in ("long.road", "other.road")]

    def driven(change: str) -> list[float]:
        loaded = module(prototype)
        loaded.add_file("roads/long.road", files[0])
        loaded.set("String", [prototype.kinds["road.file"][1]], ["long.road"])
        loaded.set("Real", [prototype.kinds["initial.speed"][1]], [60.0])
        loaded.setupExperiment()
        loaded.enterInitializationMode()
        loaded.exitInitializationMode()
        if change == "other":
            loaded.add_file("roads/long.road", files[1])
        elif change == "none":
            assert loaded.remove_file("roads/long.road")
            assert not loaded.remove_file("roads/long.road")
        heights = []
        for k in range(80):
            loaded.doStep(k * 0.05, 0.05)
            heights += loaded.getReal([prototype.kinds[name][1] for name in ("chassis.x", "chassis.z")])
        return heights

    usual = driven("")
    assert usual[-2] > 200.0
    assert driven("other") == usual
    assert driven("none") == usual


@pytest.fixture
def bare(tmp_path: Path) -> Path:
    """The crane for this machine only."""
    name, system = load_scene(f"{SCENES}:crane")
    return build(system, name, tmp_path / "bare", [fmpy.platform], kind="native")


@pytest.mark.slow
def test_an_fmu_is_compiled_again_from_its_own_sources(bare, small, tmp_path):
    out = tmp_path / "out"
    assert build_fmu.main(["--fmu", str(bare), "--platforms", "wasm32", "--out", str(out)]) == 0
    fmu = Fmu(out / "Crane.fmu", tmp_path / "made")
    assert fmu.wasm == small("crane").wasm  # the same sources give the same module
    with zipfile.ZipFile(bare) as before, zipfile.ZipFile(out / "Crane.fmu") as after:
        assert {n: after.read(n) for n in before.namelist()} == {n: before.read(n) for n in before.namelist()}
    again = ["--fmu", str(out / "Crane.fmu"), "--platforms", "wasm32", "--out", str(out)]
    done = subprocess.run(module_command("ali3", "build", *again), capture_output=True, text=True, check=True)
    assert done.stdout.endswith("added: nothing\n")


@pytest.mark.slow
def test_other_sources_than_those_installed_are_compiled(bare, tmp_path):
    """The sign of a damper is turned in the FMU's sources: the module has it, the library of this machine has not."""
    plan = Plan({"torque": 2.0}, ["torque"], [{"h": 0.01, "inputs": [2.0]}] * 20)
    turned = tmp_path / "turned" / "Crane.fmu"
    turned.parent.mkdir()
    with zipfile.ZipFile(bare) as archive, zipfile.ZipFile(turned, "w") as other:
        for name in archive.namelist():
            data = archive.read(name)
            if name.endswith("elements/scalar_spring_damper.c"):
                assert data.count(b"- c * a->ud[0]") == 1
                data = data.replace(b"- c * a->ud[0]", b"+ c * a->ud[0]")
            other.writestr(name, data)
    assert build_fmu.main(["--fmu", str(turned), "--platforms", "wasm32", "--out", str(tmp_path)]) == 0
    fmu = Fmu(tmp_path / "Crane.fmu", tmp_path / "unpacked")
    with pytest.raises(pytest.fail.Exception, match="values differ, first 'rod.x' after step 1"):
        assert_same(wasmtime(fmu, plan), native(fmu, plan), fmu, plan)


@pytest.mark.slow
def test_fmus_that_cannot_be_compiled_again_are_refused(bare, tmp_path, capsys, small):
    def words(file: Path) -> str:
        assert build_fmu.main(["--fmu", str(file), "--platforms", "wasm32", "--out", str(tmp_path / "out")]) == 2
        return capsys.readouterr().err

    def without(leave: str) -> Path:
        file = tmp_path / "less.fmu"
        with zipfile.ZipFile(bare) as archive, zipfile.ZipFile(file, "w") as other:
            for name in archive.namelist():
                if leave not in name:
                    other.writestr(name, archive.read(name))
        return file

    (tmp_path / "text.fmu").write_text("x")
    assert "There is no file" in words(tmp_path / "none.fmu")
    assert "is not an FMU (not a zip archive)" in words(tmp_path / "text.fmu")
    for source in ("fmi2_direct.c", "fmi2_alone.c"):
        assert "is not an FMU of ALi3 of the kind native" in words(without(source))
    assert "has no modelDescription.xml" in words(without("modelDescription.xml"))
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_other_tools_do_not_mind_it(small, tmp_path, capfd):
    fmu = small("crane")
    assert "wasm32" in {part.name for part in (fmu.folder / "binaries").iterdir()}
    assert fmpy.supported_platforms(str(fmu.path)) == ["c-code", fmpy.platform]
    assert validate_fmu(str(fmu.path)) == []
    shutil.copy(fmu.path, tmp_path / "Crane.fmu")
    result = fmpy.simulate_fmu(str(tmp_path / "Crane.fmu"), stop_time=0.5, start_values={"torque": 2.5})
    assert np.ptp(result["rod.angle"]) > 0.1
    assert check([str(tmp_path / "Crane.fmu"), "--steps", "10"]) == 0
    assert "nothing bad found" in capfd.readouterr().out


def test_the_platform_is_asked_for_by_name(tmp_path, capsys, monkeypatch):
    """Its compilation takes longest where it was never done: other tests look at what it gives."""
    requested: list[tuple[tuple[str, ...], str]] = []

    def compiled(targets: Sequence[str], face: str, *_: object) -> bytes:
        requested.append((tuple(targets), face))
        return b"\0asm"

    monkeypatch.setattr("fmu_src.native.package.compile_library", compiled)
    monkeypatch.setattr("fmu_src.native.early_compilation.compiled_ahead", lambda work: nullcontext())
    scene = ["--scene", f"{SCENES}:crane", "--out", str(tmp_path)]
    assert build_fmu.main([*scene, "--platforms", "wasm32"]) == 0
    printed = capsys.readouterr().out
    assert "fmi3: left out, it runs on linux64, win64, darwin64, aarch64-linux only" in printed
    assert "python: left out, it runs on linux64, win64 only" in printed
    assert sorted(p.name for p in tmp_path.iterdir()) == ["Crane.fmu", "Crane.ssv"]
    with zipfile.ZipFile(tmp_path / "Crane.fmu") as archive:
        assert [n for n in archive.namelist() if n.startswith("binaries/")] == ["binaries/wasm32/Crane.wasm"]
        assert archive.read("binaries/wasm32/Crane.wasm") == b"\0asm"
    assert requested == [(("wasm32-wasi",), "fmi2")]


def test_sources_for_a_file_system_leave_the_room_out():
    """Its files lie in every FMU, and are empty but with ALI3_ALONE."""
    sources = packed_sources("fmi2", "")
    for name in ("fmi2_alone.c", "kernel/src/files/file_room.c"):
        assert b"#if defined(ALI3_ALONE)" in sources[name]


@pytest.mark.slow
@unoptimised()
def test_the_kernel_alone_is_a_module_too(tmp_path):
    import wasmtime

    path = kernel_build.compile_library("wasm32-wasi", tmp_path / kernel_build.library_name("wasm32-wasi"))
    assert path.name == "ali3.wasm"
    engine = wasmtime.Engine()
    result = wasmtime.Module.from_file(engine, str(path))
    assert list(result.imports) == []
    assert {e.name for e in result.exports} == (
        {"memory", "_initialize"} | set(kernel_build.functions()) | set(kernel_build.WASM_HELPERS)
    )
    store = wasmtime.Store(engine)
    exports: Any = wasmtime.Instance(store, result, []).exports(store)
    address = exports["ali3_status_text"](store, 0)
    text = bytes(exports["memory"].read(store, address, address + 200)).split(b"\0")[0]
    assert text.decode() == status_text(load_library(), 0).removesuffix(".")
