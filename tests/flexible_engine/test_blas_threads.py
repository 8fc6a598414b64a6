"""A System with flexible bodies has the same bits, whatever number of threads BLAS has where it is compiled."""

import hashlib
import os
import subprocess
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from threading import Thread

import numpy as np
import pytest
from threadpoolctl import threadpool_info, threadpool_limits

from mbs import compile
from mbs.common.one_thread import in_one_thread
from mbs.flexible.component_modes import craig_bampton
from mbs.flexible.damping import RayleighDamping
from mbs.flexible.frame import Beam, Frame
from mbs.flexible.load_paths import interface_loads, load_path_modes
from mbs.flexible.recovery import StrainGauge, gauge_rows
from mbs.flexible.relief_solution import inertia_relief
from mbs.flexible.section import round_bar
from mbs.model import Model
from mbs.vehicle import load
from tests.flexible_engine.bodies import ALUMINIUM

NODES = 90
ENDS = tuple(range(0, NODES, 6))


def bits() -> dict[str, str]:
    """Digests of what has stress, modes and load paths of a bent tube, and of a car whose stresses are quasi-static."""
    turns = np.linspace(0.0, 6.0, NODES)
    points = np.transpose([np.cos(turns), np.sin(turns), 0.3 * turns])
    beams = tuple(Beam(i, k, round_bar(0.03), ALUMINIUM) for i, k in pairwise(range(NODES)))
    frame = Frame(points, beams)
    model, damping = frame.finite_element_model(), RayleighDamping.fitted(0.01, 10.0, 100.0)
    modes = craig_bampton(model, 1, ENDS, 40, inertia_modes=True, damping=damping)
    rows = gauge_rows(frame, tuple(StrainGauge(f"gauge {k}", k) for k in range(NODES - 1)))[1]
    turned = modes.transformed(np.eye(modes.n_modes)[::-1] + 0.1, modes.mode_names, modes.frequencies)
    relief = inertia_relief(model, 1, ENDS, rows)
    paths = load_path_modes(modes, interface_loads(modes, {str(end): np.eye(3) for end in ENDS}))
    found = {"modes": modes.modes, "stresses": modes.recovery(rows), "turned": turned.modes, "relief": relief.balanced}
    found |= {"load paths": paths.K}
    models = {"car": load("hatchback").model(fidelity=1)}
    for name, reduced in {"body": modes, "reduced body": paths}.items():
        models[name] = Model(name)
        models[name].flexible_body("tube", reduced)
    data = {name: array.tobytes() for name, array in found.items()}
    data |= {name: compile(model).to_bytes() for name, model in models.items()}
    return {name: hashlib.sha256(value).hexdigest() for name, value in data.items()}


def test_a_system_has_the_same_bits_for_one_and_two_threads() -> None:
    """In new processes, as the number is read when BLAS is loaded."""
    results = []
    for threads in "1", "2":
        results.append(subprocess.run(
            [sys.executable, "-c", "from tests.flexible_engine.test_blas_threads import bits; print(bits())"],
            env=os.environ | dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), threads),
            cwd=Path(__file__).parents[2], capture_output=True, check=True, text=True,
        ).stdout)  # fmt: skip
    assert results[0].count(":") == 8
    assert results[0] == results[1]


def numbers_of_threads() -> set[int]:
    """Of the BLAS libraries of this process."""
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


def run_in_a_thread(function: Callable[..., object], *arguments: object) -> None:
    """A thread that lives on would keep the right to set limits."""
    thread = Thread(target=function, args=arguments)
    thread.start()
    thread.join()


def test_the_threads_are_given_back_by_the_last_of_several_contexts() -> None:
    run_in_a_thread(threadpool_limits, 2, "blas")
    try:
        before = numbers_of_threads()
        if before != {2}:
            pytest.skip("this BLAS has one thread")
        in_one_thread.__enter__()
        with in_one_thread:
            pass
        assert numbers_of_threads() == {1}
        run_in_a_thread(in_one_thread.__exit__, None, None, None)
        assert numbers_of_threads() == {2}
    finally:
        run_in_a_thread(threadpool_limits, 1, "blas")
