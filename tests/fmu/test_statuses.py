"""Statuses of the kernel in an FMU: the words and the remedy of each stand in what it says."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from mbs.kernel.binding import Status, load_library
from mbs.kernel.binding.errors import status_remedy
from tests.fmu.calls import DISCARD, ERROR, OK, HostMaker
from tests.fmu.test_refused_steps import LONG, at_the_edge

H = 0.01


def said(status: Status, text: str) -> None:
    assert load_library().ali3_status_text(status).decode() + "." in text
    assert text.count(status_remedy(status)) == 1


def test_a_start_that_does_not_close(build: Callable[..., Path], host: HostMaker, kind: str) -> None:
    driven = host(build("led_crank", kind))
    assert driven.set("angle", 1.6) == OK
    driven.slave.setupExperiment(startTime=0.0)
    driven.slave.enterInitializationMode()
    assert driven.call("exitInitializationMode") == ERROR
    said(Status.NOT_ASSEMBLED, driven.messages[-1])
    assert "Worst constraint: 'bar" in driven.messages[-1]


def test_a_motion_that_becomes_infinite(build: Callable[..., Path], host: HostMaker, kind: str) -> None:
    driven = host(build("led_crank", kind)).start()
    assert driven.set("push", 1e300) == OK
    assert driven.step(0.0, H) == DISCARD
    said(Status.NOT_FINITE, driven.messages[-1])
    assert "The step_size is 0.01 s" in driven.messages[-1]


def test_what_is_pulled_beyond_its_reach(reach: Path, host: HostMaker) -> None:
    driven = at_the_edge(reach, host)
    assert driven.step(0.05, LONG) == DISCARD
    said(Status.NOT_CONVERGED, driven.messages[-1])
