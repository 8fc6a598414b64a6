"""Differences between hosts: location of the resources, computation of time, length of a step."""

import os
import re
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import fmpy
import pytest

from fmu_src.build.build import build_fmu
from fmu_src.build.scene_registry import load_scene
from tests.fmu.calls import ERROR, OK

H = 0.01
SECONDS = 30.0


def test_the_scheme_of_the_resources_in_any_case(build, host):
    for scheme in ("FILE", "File"):
        driven = host(build("crane"))
        take = driven.slave.fmi2Instantiate
        uri = scheme + (driven.folder / "resources").as_uri().removeprefix("file")
        driven.slave.fmi2Instantiate = lambda *a, take=take, uri=uri: take(*a[:3], uri.encode(), *a[4:])
        driven.slave.instantiate(callbacks=driven._callbacks)
        assert driven.start().step(0.0, H) == OK


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="named pipes of POSIX")
@pytest.mark.parametrize(("kind", "name"), [("native", "system_0.ali3"), ("python", "slavemodule.txt")])
def test_a_named_pipe_as_resource_is_refused(build, tmp_path, kind, name):
    fmu = build("crane", kind)
    folder = Path(fmpy.extract(str(fmu), unzipdir=str(tmp_path)))
    (file,) = (folder / "resources").rglob(name)
    file.unlink()
    os.mkfifo(file)
    code = (
        "import fmpy\nfrom fmpy.fmi2 import FMU2Slave\n"
        f"d = fmpy.read_model_description({str(fmu)!r})\n"
        f"s = FMU2Slave(guid=d.guid, unzipDirectory={str(folder)!r}, "
        "modelIdentifier=d.coSimulation.modelIdentifier, instanceName='x')\ns.instantiate()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, timeout=SECONDS)
    assert done.returncode == 1
    assert "Failed to instantiate" in done.stderr


def test_a_start_where_the_clock_stands_is_refused(crane, host):
    driven = host(crane).start(time=1e16)
    assert driven.step(1e16, H) == ERROR
    assert "begin nearer to zero" in driven.messages[-1]
    assert host(crane).start(time=1.7e9).step(1.7e9, H) == OK


def test_a_step_that_would_take_hours_is_refused(crane, host):
    driven = host(crane).start()
    assert driven.step(0.0, 1.1e6 * H) == ERROR
    assert "1e+06 inner steps" in driven.messages[-1]
    assert driven.step(0.0, 10 * H) == OK


def test_careless_calls_are_refused(crane, host):
    driven = host(crane)
    assert driven.call("getReal", [driven.references["rod.x"]]) == ERROR
    assert re.search("before initialisation|there in initialisation mode", driven.messages[-1])
    assert driven.call("setDebugLogging", True, ["logNoSuchThing"]) == ERROR
    assert "no log category" in driven.messages[-1]
    assert driven.call("setDebugLogging", True, ["logAll"]) == OK
    with pytest.raises(Exception, match="instantiate"):
        driven.instance(name="")
    assert "needs a name" in driven.messages[-1]


def test_a_step_beyond_the_stop_time_is_an_error(crane, host):
    driven = host(crane)
    driven.slave.setupExperiment(startTime=0.0, stopTime=0.03)
    driven.slave.enterInitializationMode()
    driven.slave.exitInitializationMode()
    driven.run(2, H)
    assert driven.step(0.02, 2 * H) == ERROR
    assert "stop time 0.03" in driven.messages[-1]
    assert driven.step(0.02, H) == OK


def test_a_run_may_end_where_it_starts(crane, host):
    """Then no step fits; its state can be set again; an end before the start is refused."""
    driven = host(crane)
    assert ERROR in (driven.call("setupExperiment", None, 2.0, 1.0), driven.call("enterInitializationMode"))
    assert "lies before the start time 2 s" in driven.messages[-1]
    driven.slave.reset()
    assert driven.call("setupExperiment", None, 2.0, 2.0) == driven.call("enterInitializationMode") == OK
    assert driven.call("exitInitializationMode") == OK
    before = driven.outputs()
    assert driven.restore(driven.saved()) == OK
    assert driven.outputs() == before
    assert not driven.three or driven.get("time") == 2.0
    assert driven.step(2.0, H) == ERROR
    assert "beyond the stop time" in driven.messages[-1]


def test_an_input_without_limits(build, host):
    driven = host(build("crank_slider"))
    (torque,) = (v for v in driven.description.modelVariables if v.name == "torque")
    assert torque.min is torque.max is None
    driven.start({"torque": -1e6})
    assert driven.get("torque") == -1e6


def test_sources_name_the_mathematical_library(build):
    with zipfile.ZipFile(build("crane", "fmi3")) as archive:
        root = ElementTree.fromstring(archive.read("sources/buildDescription.xml"))
    assert [e.get("name") for e in root.iter("Library")] == ["m"]


def test_the_date_is_that_of_the_environment_or_the_version(build, tmp_path, monkeypatch):
    assert str(fmpy.read_model_description(str(build("crane"))).generationDateAndTime) > "2026"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    name, system = load_scene(f"{Path(__file__).parent / 'scenes.py'}:crane")
    fmu = build_fmu(system, name, tmp_path, [fmpy.platform], author="A. Author", copyright="(c) A", licence="MIT")
    description = fmpy.read_model_description(str(fmu))
    assert (description.author, description.copyright, description.license) == ("A. Author", "(c) A", "MIT")
    assert description.generationDateAndTime == "2023-11-14T22:13:20Z"
