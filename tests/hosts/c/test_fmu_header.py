"""The header in C++: the bits of Python on Linux, under wine and on aarch64, and what it refuses."""

import platform
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import fmpy
import pytest

from hosts.fmu.built_fmu import build_fmu, fmu_of_car
from hosts.plant import Car
from tests.fmu.native import unpack

HERE = Path(__file__).parents[3] / "hosts" / "c"
HEADERS = Path(fmpy.__file__).parent / "c-code"
SPEED = 15.0  # m/s
SECONDS = 5.0  # s
STEP = 0.01  # s
LINUX = sys.platform == "linux" and platform.machine() == "x86_64"
PLATFORMS = {
    "wine": ("win64", "x86_64-windows-gnu", ["wine"]),
    "qemu-aarch64": ("aarch64-linux", "aarch64-linux-gnu", ["qemu-aarch64", "-L", "/usr/aarch64-linux-gnu"]),
}


def compiled(compiler: Sequence[str], source: Path, folder: Path, standard: str = "c++17") -> Path:
    program = folder / f"{source.stem}.exe"
    options = [f"-std={standard}", "-Wall", "-Wextra", "-Werror", f"-I{HEADERS}", f"-I{HERE}"]
    libraries = [] if any("windows" in word for word in compiler) else ["-ldl"]
    command = [*compiler, *options, str(source), *libraries, "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program


def driven() -> list[float]:
    """The loop of the example in Python."""
    with Car("prototype", step=STEP, inputs=("steering", "throttle")) as car:
        car.reset(**{"initial.speed": SPEED})
        for _ in range(round(SECONDS / STEP)):
            speed, yaw_rate = car.read(("speed", "chassis.wz"))
            car.step([2.0 * (0.3 - yaw_rate), max(0.0, 0.5 * (SPEED - speed))])
        return [float(x) for x in car.read(("speed", "chassis.wz"))]


def check(command: Sequence[str]) -> None:
    """Both passes of the example, the second from a saved state, end with the bits of Python."""
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert len(lines) == 4
    assert lines[0] == lines[2] == "after 5 s 14.515 m/s, yaw rate 0.2521 rad/s"
    for line in (lines[1], lines[3]):
        assert [float.fromhex(word) for word in line.split()] == driven()


@pytest.fixture
def prototype(tmp_path: Path) -> Path:
    """A folder with a blank in its name."""
    return unpack(fmu_of_car("prototype", lambda line: None), tmp_path / "the car")


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("c++") is None, reason="there is no c++; the test with zig needs none")
def test_the_example_drives_as_python_does(prototype: Path, tmp_path: Path) -> None:
    check([str(compiled(["c++"], HERE / "drive.cpp", tmp_path)), str(prototype)])


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("clang++") is None, reason="there is no clang++")
def test_the_header_compiles_without_a_warning_by_another_compiler_and_standard(tmp_path: Path) -> None:
    compiled(["clang++"], HERE / "drive.cpp", tmp_path, "c++20")


@pytest.mark.proof
def test_zig_compiles_the_header_too(prototype: Path, tmp_path: Path) -> None:
    """Its first program takes minutes, as its C++ library is compiled."""
    check([str(compiled([sys.executable, "-m", "ziglang", "c++"], HERE / "drive.cpp", tmp_path)), str(prototype)])


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("c++") is None, reason="there is no c++")
def test_each_refusal_is_one_sentence(prototype: Path, tmp_path: Path) -> None:
    program = compiled(["c++"], Path(__file__).parent / "refusals.cpp", tmp_path)
    done = subprocess.run([str(program), str(prototype), str(tmp_path)], capture_output=True, text=True, check=True)
    message = (
        "modelDescription.xml cannot be read.",
        "The FMU has no library for ",
        " cannot be loaded: ",
        "modelDescription.xml is damaged: 'b' has the valueReference 'c', which must be a whole number below 2^32.",
        "The FMU has no variable 'stering'.",
        "'steering' is not a String, but Real.",
        "'selector' is 0.500000; it must be a whole number.",
        "'road.file' is a String; it must be set with a text.",
        "'selector' is not a Real, but Integer.",
        "'initial.speed'",
        "'throttle' was refused. 'throttle' was set to nan; a finite number is needed",
        "a finite time and a positive step are needed.",
    )
    lines = done.stdout.splitlines()
    assert len(lines) == len(message)
    assert [(line, word) for line, word in zip(lines, message, strict=True) if word not in line] == []


@pytest.mark.proof
@pytest.mark.skipif(not LINUX, reason="runs programs of other platforms on Linux for x86-64")
@pytest.mark.parametrize("runner", PLATFORMS)
def test_other_platforms_get_the_same_bits(runner: str, tmp_path: Path) -> None:
    """The Windows library under wine, that of aarch64 under qemu's user mode (Debian: qemu-user, libc6-arm64-cross)."""
    if shutil.which(runner) is None:
        pytest.skip(f"{runner} is not there")
    name, target, command = PLATFORMS[runner]
    build_fmu("the car prototype", ("--car", "prototype", "--platforms", name), tmp_path)
    folder = unpack(next(tmp_path.glob("*.fmu")), tmp_path / "car")
    compiler = [sys.executable, "-m", "ziglang", "c++", "-target", target]
    check([*command, str(compiled(compiler, HERE / "drive.cpp", tmp_path)), str(folder)])
