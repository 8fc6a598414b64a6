"""The content of an installation: four packages, data, types, and a command."""

import os
import subprocess
import sys
import venv
import zipfile
from configparser import ConfigParser
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
USER = """import mbs

m = mbs.Model("pendulum", dimension=2)
rod = m.body("rod", mass=2.0, com=(0.5, 0.0), inertia=0.17)
m.revolute("pin", m.ground, rod, point=(0.0, 0.0))
m.sense_position("tip.y", rod, (1.0, 0.0), "y")
run = mbs.simulate(mbs.compile(m), t_end=2.0, h=0.001)
"""


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, as hatchling and our hook build it."""
    builder = pytest.importorskip("hatchling.builders.wheel").WheelBuilder(str(ROOT))
    return Path(next(builder.build(directory=str(tmp_path_factory.mktemp("wheel")), versions=["standard"])))


@pytest.fixture(scope="module")
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Python of an environment in which the wheel is unpacked."""
    folder = tmp_path_factory.mktemp("installed") / "venv"
    venv.create(folder, with_pip=False)
    python = folder / ("Scripts/python.exe" if os.name == "nt" else "bin/python")
    where = [str(python), "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    place = subprocess.run(where, capture_output=True, text=True, check=True).stdout.strip()
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(place)
    return python


def test_the_names_it_puts_among_the_packages(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
    top = {name.partition("/")[0] for name in names}
    assert {name for name in top if not name.endswith(".dist-info")} == {"ali3", "mbs", "fmu_src", "hosts", "viewer"}
    for needed in (
        "mbs/py.typed",
        "mbs/kernel/include/ali3.h",
        "ali3/alias_files/carsim.toml",
        "ali3/report.css",
        "hosts/driving/manoeuvres/slalom.toml",
        "hosts/c/host.c",
        "viewer/bundle/ali3-viewer.js",
        "viewer/bundle/ali3-gltf.mjs",  # glTF files
    ):
        assert needed in names
    assert any(name.startswith("mbs/kernel/lib/") for name in names)


def test_its_command_is_ali3_and_its_drawer_is_found(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        points = next(name for name in archive.namelist() if name.endswith("entry_points.txt"))
        parser = ConfigParser()
        parser.read_string(archive.read(points).decode())
    assert {name: dict(parser[name]) for name in parser.sections()} == {
        "console_scripts": {"ali3": "ali3.__main__:main"},
        "ali3.drawers": {"page": "viewer.drawer"},
    }


@pytest.mark.skipif(sys.platform != "linux", reason="the tag is that of Linux")
def test_its_tag_is_that_of_the_oldest_system_it_runs_on(wheel: Path) -> None:
    assert wheel.name.split("-")[2:4] == ["py3", "none"]
    assert wheel.stem.rpartition("-")[2].startswith("manylinux_2_17_")


@pytest.mark.slow
def test_its_types_reach_a_user(installed: Path, tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    command = [sys.executable, "-m", "mypy", "--strict", "--python-executable", str(installed), "user.py"]
    environment = {k: v for k, v in os.environ.items() if k not in ("MYPYPATH", "PYTHONPATH")}

    def said(text: str) -> str:
        (tmp_path / "user.py").write_text(text)
        return subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True).stdout

    assert "Success: no issues found" in said(USER)
    wrong = said(USER + "system: int = mbs.compile(m)\nm.bodie('x')\n")
    assert 'has type "System", variable has type "int"' in wrong
    assert '"Model" has no attribute "bodie"' in wrong
