"""FMUs with C that was generated for their Systems: it is called, and their bits are those of the engine's loops."""

import zipfile
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest

import mbs
from fmu_src.build.build import build_fmu
from fmu_src.build.command import main
from fmu_src.native.added_platforms import add_platforms
from fmu_src.native.archive import write_zip
from mbs.compiler.generated.library import named_code_of
from mbs.compiler.generated.source import TABLE
from tests.fmu import scenes
from tests.fmu.conftest import PLATFORM
from tests.in_process import run

STEPS = 60
STEP = 0.01  # s
PULLS = {"crane": ("torque", 4.0), "reach": ("pull", 0.3), "answered": ("push", 40.0), "towed": ("left.push", 2.0)}
"""An angle and a spring, a driving function, contacts, no rows."""
CODE = "use the code that was generated for it."
LOOPS = "use the loops of the kernel"


def packed(fmu: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(fmu) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def driven_rows(driven: Any, name: str, value: float) -> tuple[str, list[list[float]]]:
    """What is said of the System, and outputs after each step."""
    driven.slave = driven.instance(name="logged", logged=True)
    messages = next(text for text in driven.messages if text.startswith("System loaded"))
    driven.start()
    driven.set(name, value)
    return messages, driven.run(STEPS, STEP)


def engine_rows(system: mbs.System, name: str, value: float) -> list[list[float]]:
    """The same by the loops of the kernel in Python."""
    simulation, rows = mbs.Simulation(system), []
    inner = system.meta["experiment"]["step_s"]
    simulation.set_input(name, value)
    for _ in range(STEPS):
        for _ in range(round(STEP / inner)):
            simulation.step(inner)
        rows.append(list(simulation.sensors.values()))
    return rows


@pytest.mark.parametrize(("scene", "kind"), [*((scene, "native") for scene in PULLS), ("crane", "fmi3_scalar")])
def test_an_fmu_runs_its_code_with_the_bits_of_the_engine(build, host, scene, kind):
    message, rows = driven_rows(host(build(scene, kind)), *PULLS[scene])
    assert message.endswith(CODE)
    system = mbs.compile(getattr(scenes, scene)())
    sensors = len(system.meta["sensors"])
    assert [row[:sensors] for row in rows] == engine_rows(system, *PULLS[scene])
    assert rows[0] != rows[-1]


def test_without_it_the_bits_are_the_same(build, host, tmp_path):
    plain = build_fmu(mbs.compile(scenes.crane()), "crane", tmp_path, [PLATFORM], plain=True)
    message, rows = driven_rows(host(plain), *PULLS["crane"])
    assert message.endswith(f"{LOOPS}, as no code was generated for it.")
    assert rows == driven_rows(host(build("crane")), *PULLS["crane"])[1]
    assert not [name for name in packed(plain) if TABLE in name]


def test_another_system_in_the_file_takes_the_loops(build, host, tmp_path):
    """It has a coefficient where the code has none."""
    system = mbs.compile(scenes.reach())
    coefficients = system.arrays["row_lin"].copy()
    assert coefficients[0] == 0.0
    coefficients[0] = 1e-6
    other = system.with_arrays({"row_lin": coefficients})
    file = tmp_path / "Reach.fmu"
    write_zip(packed(build("reach")) | {"resources/system_0.ali3": other.kernel_bytes()}, file)
    message, rows = driven_rows(host(file), *PULLS["reach"])
    assert f"{LOOPS}: the code was generated for another System, of structure " in message
    assert rows == engine_rows(other, *PULLS["reach"])
    assert rows != engine_rows(system, *PULLS["reach"])


def test_a_build_from_its_sources_has_its_bits(build, host, tmp_path):
    """Sources that are not those of this package are compiled as they lie in the FMU."""
    fmu = build("crane")
    files = {name: data for name, data in packed(fmu).items() if not name.startswith("binaries/")}
    (code,) = (name for name in files if name.startswith(f"sources/{TABLE}_"))
    assert code.removeprefix("sources/").encode() in files["modelDescription.xml"]
    expected, file = driven_rows(host(fmu), *PULLS["crane"]), tmp_path / "Crane.fmu"
    for word in (b"", b"/* a word */\n"):
        write_zip(files | {code: files[code] + word}, file)
        assert add_platforms(file, [PLATFORM], file, report_stage=lambda what, note: nullcontext()) == [PLATFORM]
        assert driven_rows(host(file), *PULLS["crane"]) == expected


def test_systems_of_one_structure_share_it_and_others_do_not():
    named = [named_code_of(mbs.compile(make())) for make in (scenes.crane, scenes.heavy_crane, scenes.reach)]
    assert named[0] == named[1]
    assert named[0][0] != named[2][0]
    assert all(f"const ali3_generated {name} = {{" in text for name, text in named)


def test_the_option_plain_needs_a_car_or_a_scene():
    done = run(main, "--plain", "--kernel")
    assert done.returncode == 2
    assert "--plain needs a car or a scene to build; " in done.stderr
