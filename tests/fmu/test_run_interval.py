"""Rows of a table at an interval: the same bits as with a row after each step, and stresses are read there alone."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hosts.driving.co_simulation import run as driven
from hosts.driving.manoeuvre_file import read_manoeuvre
from hosts.fmu.fmu import Fmu
from hosts.run.command import main
from tests.in_process import run

H = 0.01


@pytest.mark.slow
def test_rows_at_an_interval_are_those_of_every_step(kerb_fmus: Path, tmp_path: Path) -> None:
    tables, outputs = {}, {}
    for name, more in (("all", ()), ("few", ("--interval", "0.05"))):
        requested = (
            "--fidelity",
            "0",
            "-m",
            "step_steer_given_throttle",
            "--stop-time",
            "1.5",
            "--step",
            str(H),
            "--out",
            tmp_path / name,
        )
        done = run(main, kerb_fmus / "native.fmu", *requested, *more)
        assert done.returncode == 0, done.stderr
        (file,) = (tmp_path / name).glob("*.csv")
        tables[name], outputs[name] = file.read_text(encoding="utf-8").splitlines(), done.stdout
    assert tables["few"] == [tables["all"][0], *tables["all"][1::5]]
    assert len(tables["few"]) == 32
    assert "read every 10 ms; --interval reads fewer" in outputs["all"]
    assert "read every 50 ms\n" in outputs["few"]
    assert "failed steps               0 of 150" in outputs["few"]


def test_an_interval_that_is_no_multiple_of_the_step_is_refused(kerb_fmus: Path, tmp_path: Path) -> None:
    for interval in ("0.025", "0.001", "nan"):
        done = run(main, kerb_fmus / "native.fmu", "--step", str(H), "--interval", interval, "--out", tmp_path)
        assert done.returncode == 2
        assert "not a multiple of the step of 0.01 s" in done.stderr or "--interval" in done.stderr


@pytest.mark.parametrize("looks", [False, True])
def test_between_rows_outputs_are_read_that_somebody_looks_at(kerb_fmus: Path, looks: bool) -> None:
    """Who looks between rows sees the value of that time."""
    recorded: list[float] = []
    read: list[int] = []
    with Fmu(kerb_fmus / "native.fmu") as fmu:
        reader = fmu.reader

        def counted(names):  # type: ignore[no-untyped-def]
            read_values = reader(names)

            def read_counted(into):  # type: ignore[no-untyped-def]
                read.append(len(names))
                read_values(into)

            return read_counted

        fmu.reader = counted  # type: ignore[method-assign]
        outputs = len(fmu.names("output"))
        manoeuvre = read_manoeuvre("step_steer_given_throttle")
        manoeuvre = replace(manoeuvre, start={**manoeuvre.start, "fidelity": 0})

        def until(time, observation):  # type: ignore[no-untyped-def]
            if looks:
                recorded.append(observation["stress.SG1"])
            return time > 0.295

        result = driven(fmu, manoeuvre, H, until=until, every=10)
    assert [n for n in read if n > 1] == 4 * [outputs]
    assert len(read) - 4 == (27 if looks else 0)
    if looks:
        assert recorded[9::10] == result["stress.SG1"][1:].tolist()
        assert len(np.unique(recorded)) > 25
