"""The binaries: dependencies, exported symbols, equal results without Python and on Windows, and from sources."""

import itertools
import os
import re
import shutil
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable
from contextlib import nullcontext
from pathlib import Path

import fmpy
import numpy as np
import pytest

from fmu_src.native.added_platforms import add_platforms
from fmu_src.native.platforms import PLATFORMS, TARGETS
from fmu_src.native.universal_binary import universal
from tests import kinds
from tests.fmu import native
from tests.fmu.calls import HostMaker
from tests.sanitize import OBJECTS
from tests.unoptimised import unoptimised

STEPS = 40
STEP = 0.01  # s
FUNCTIONS = 34


@pytest.fixture(scope="session")
def all_platforms(build: Callable[..., Path], made_once: Callable[[str, Callable[[Path], None]], Path]) -> Path:
    """The crane for all platforms; the compiler's first run for Windows takes minutes."""

    def fill(folder: Path) -> None:
        with unoptimised():
            add_platforms(
                build("crane"), PLATFORMS, folder / "Crane.fmu", report_stage=lambda what, note: nullcontext()
            )

    return made_once("all_platforms", fill) / "Crane.fmu"


def binary(fmu: Path, name: str) -> bytes:
    with zipfile.ZipFile(fmu) as archive:
        return archive.read(f"binaries/{name}")


def is_fmi2_only(names: set[str]) -> bool:
    return len(names) == FUNCTIONS and all(n.startswith("fmi2") for n in names)


@pytest.mark.skipif(fmpy.platform != "linux64", reason="looks at the library of x86-64 Linux")
def test_linux_needs_the_c_library_only(build: Callable[..., Path]) -> None:
    needed, exported = native.elf_dynamic(binary(build("crane"), "linux64/Crane.so"))
    assert set(needed) <= {"libc.so.6", "libm.so.6"}
    assert is_fmi2_only(exported)


@pytest.mark.slow
def test_what_differs_by_platform_compiles_for_each(build: Callable[..., Path], tmp_path: Path) -> None:
    """C files with a branch for a system or a processor; all files are compiled in the proof run."""
    folder = native.unpack(build("crane"), tmp_path) / "sources"
    branch = re.compile(r"^#.*(_WIN32|__APPLE__|__aarch64__)", re.MULTILINE)
    files = [file for file in folder.rglob("*.c") if branch.search(file.read_text(encoding="utf-8"))]
    assert len(files) > 2
    for target, file in itertools.product((target for name in PLATFORMS for target in TARGETS[name]), files):
        command = [sys.executable, "-m", "ziglang", "cc", "-target", target, "-c", f"-I{folder}", str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
        assert done.returncode == 0, done.stderr


@pytest.mark.proof
def test_linux_on_arm_has_a_binary(all_platforms: Path) -> None:
    data = binary(all_platforms, "aarch64-linux/Crane.so")
    assert data[:4] == b"\x7fELF"
    assert int.from_bytes(data[18:20], "little") == 183  # AArch64


@pytest.mark.proof
def test_windows_needs_its_own_libraries_only(all_platforms: Path) -> None:
    libraries, exported = native.pe_tables(binary(all_platforms, "win64/Crane.dll"))
    assert all(name == "kernel32.dll" or name.startswith("api-ms-win-crt-") for name in libraries)
    assert is_fmi2_only(exported)


@pytest.mark.proof
def test_mac_has_both_processors(all_platforms: Path) -> None:
    data = binary(all_platforms, "darwin64/Crane.dylib")
    magic, count = struct.unpack_from(">2I", data)
    assert (magic, count) == (0xCAFEBABE, 2)
    cpus = []
    for k in range(count):
        cpu, _, offset, size, align = struct.unpack_from(">5I", data, 8 + 20 * k)
        assert offset % (1 << align) == 0
        assert struct.unpack_from("<2I", data, offset) == (0xFEEDFACF, cpu)
        assert offset + size <= len(data)
        assert b"_fmi2DoStep\0" in data[offset : offset + size]
        cpus.append(cpu)
    assert cpus == [0x01000007, 0x0100000C]


def test_universal_refuses_other_files() -> None:
    thin = struct.pack("<3I", 0xFEEDFACF, 7, 3) + bytes(100)
    with pytest.raises(ValueError, match="Mach-O"):
        universal([bytes(100)])
    with pytest.raises(ValueError, match="same processor"):
        universal([thin, thin])


# 0.7 % above the file of the command: linux64 1019876 bytes, aarch64-linux 883809, win64 1075919, darwin64 1326073;
# unwind tables are 1.9 % (decision 193), AVX2 is 0.1 MB (160), batches of elements 0.03 MB (76), the lists of arrays
# and statuses 0.02 MB (8), code generated for the crane 0.004 to 0.006 MB (252)
LARGEST = {"linux64": 1.027e6, "aarch64-linux": 0.890e6, "win64": 1.083e6, "darwin64": 1.335e6}


def test_the_file_is_small(build: Callable[..., Path]) -> None:
    assert build("crane").stat().st_size < LARGEST[fmpy.platform]


def host_rows(program: list[str], folder: Path, library: str) -> np.ndarray:
    resources = folder.joinpath("resources").as_uri() if len(program) == 1 else f"file:///Z:{folder}/resources"
    command = [*program, str(folder / "binaries" / library), resources, native.guid_of(folder)]
    command += [str(STEPS), str(STEP), "4", "8", "0=2.5", "1=9.0"]
    environment = {k: v for k, v in os.environ.items() if k != "PATH"} if len(program) == 1 else dict(os.environ)
    done = subprocess.run(command, capture_output=True, text=True, check=False, env=environment | {"WINEDEBUG": "-all"})
    assert done.returncode == 0, done.stderr
    return np.array([[float.fromhex(v) for v in line.split()] for line in done.stdout.splitlines()])


def expected_rows(fmu: Path, host: HostMaker) -> np.ndarray:
    return np.array(host(fmu).start({"torque": 2.5, "spring.stiffness": 9.0}).run(STEPS, STEP))


def test_a_c_host_gets_the_same_bits(build: Callable[..., Path], host: HostMaker, tmp_path: Path) -> None:
    fmu = build("crane", "native")
    folder = native.unpack(fmu, tmp_path / "fmu")
    suffix = fmpy.sharedLibraryExtension
    rows = host_rows([str(native.compile_host(tmp_path))], folder, f"{fmpy.platform}/Crane{suffix}")
    assert rows.shape == (STEPS, 6)
    assert np.array_equal(rows[:, 1:], expected_rows(fmu, host))
    assert np.ptp(rows[:, 1]) > 1e-3


@pytest.mark.proof
@pytest.mark.skipif(shutil.which("wine") is None or sys.platform == "win32", reason="runs the Windows library by wine")
def test_windows_gets_the_same_bits(all_platforms: Path, host: HostMaker, tmp_path: Path) -> None:
    folder = native.unpack(all_platforms, tmp_path / "fmu")
    program = native.compile_host(tmp_path, "x86_64-windows-gnu")
    rows = host_rows(["wine", str(program)], folder, "win64/Crane.dll")
    assert np.array_equal(rows[:, 1:], expected_rows(all_platforms, host))


@pytest.mark.proof
@pytest.mark.skipif(shutil.which("wine") is None or sys.platform == "win32", reason="runs the Windows library by wine")
def test_a_state_continues_on_another_operating_system(all_platforms: Path, tmp_path: Path) -> None:
    folder, source = native.unpack(all_platforms, tmp_path / "fmu"), native.C_FOLDER / "relay.c"
    linux = [str(native.compile_host(tmp_path, source=source)), str(folder / "binaries/linux64/Crane.so")]
    windows = ["wine", str(native.compile_host(tmp_path, "x86_64-windows-gnu", source))]
    windows += [str(folder / "binaries/win64/Crane.dll")]

    def rows(command: list[str], what: str, state: str) -> list[list[float]]:
        root = "file:///Z:" if command[0] == "wine" else "file://"
        arguments = [f"{root}{folder}/resources", native.guid_of(folder), what, state]
        done = subprocess.run(
            [*command, *arguments],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"WINEDEBUG": "-all"},
            cwd=tmp_path,
        )
        return [[float.fromhex(v) for v in line.split()] for line in done.stdout.splitlines()]

    expected = rows(linux, "save", "linux.state")
    assert len(expected) == 30
    assert rows(windows, "load", "linux.state") == expected
    assert rows(windows, "save", "windows.state") == expected
    assert rows(linux, "load", "windows.state") == expected


@pytest.mark.proof  # all sources are named (`test_native_file.py`), and compiled by gcc for `test_stress`
@pytest.mark.skipif(shutil.which("cmake") is None, reason="FMPy compiles by CMake")
@pytest.mark.parametrize("kind", kinds.VERSIONS)
def test_fmpy_compiles_the_sources(build: Callable[..., Path], tmp_path: Path, kind: str) -> None:
    fmu = build("crane", kind)
    folder = native.unpack(fmu, tmp_path / "fmu")
    shutil.rmtree(folder / "binaries")
    # without optimisation, in half the time
    code = f"from fmpy.build import build_platform_binary as b; b({str(folder)!r}, configuration='Debug')"
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
    compiled = fmpy.simulate_fmu(str(folder), stop_time=0.5, start_values={"torque": 2.5}, output=["rod.angle"])
    packed = fmpy.simulate_fmu(str(fmu), stop_time=0.5, start_values={"torque": 2.5}, output=["rod.angle"])
    assert np.allclose(compiled["rod.angle"], packed["rod.angle"], rtol=0.0, atol=1e-9)
    assert np.ptp(packed["rod.angle"]) > 0.1


STRESS = [("leak", 1000), ("memory", 0), ("states", 4000), ("systems", 4000), ("crowd", 300), ("threads", 0)]


def stress_run(fmu: Path, folder: Path, objects: Path, system: str, output: str) -> Callable[[str, int], str]:
    """Runs `stress.c`, linked with the FMU's sources under sanitizers."""
    native.unpack(fmu, folder)
    program = folder / ("stress.exe" if sys.platform == "win32" else "stress")
    native.compile_stress(folder, program, objects)
    variables = fmpy.read_model_description(str(folder)).modelVariables
    reference = next(v.valueReference for v in variables if v.name == output)
    command = [str(program), folder.joinpath("resources").as_uri(), native.guid_of(folder)]
    command += [str(folder / "resources" / system), str(reference)]

    def run(what: str, count: int) -> str:
        done = subprocess.run([*command, what, str(count)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout + done.stderr[-4000:]
        return done.stdout

    return run


@pytest.fixture(scope="session")
def objects(shared: Path) -> Path:
    """Where sanitized objects are kept."""
    return Path(os.environ.get(OBJECTS, shared / "objects"))


@pytest.fixture(scope="session")
def stress(build: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory, objects: Path) -> Callable[..., str]:
    folder = tmp_path_factory.mktemp("stress")
    return stress_run(build("crane", "native"), folder, objects, "system_0.ali3", "rod.x")


@pytest.mark.slow
@pytest.mark.parametrize(("what", "count"), STRESS, ids=[w for w, _ in STRESS])
def test_stress(stress: Callable[[str, int], str], what: str, count: int) -> None:
    assert stress(what, count)
