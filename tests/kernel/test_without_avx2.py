"""The kernel as on a processor without AVX2: the bits of states are those of one with it."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import mbs
from mbs.elements.road import KerbRoad
from mbs.kernel import build
from mbs.kernel.binding.library import library_path
from mbs.kernel.binding.many import widest_lanes
from mbs.vehicle import load
from tests.unoptimised import unoptimised

STEPS = 30
NO_AVX2 = "int ali3_processor_lanes(void) { return 2; }\n"
NO_BATCHES = "void ali3_batches_forces(void *in, const void *call) { (void)in, (void)call, __builtin_trap(); }\n"
DRIVEN = {0: "ali3p", 2: "energy_momentum"}  # fidelity and method


def states() -> bytes:
    """Saved states of a car that steers over an edge, one after the other."""
    result = b""
    for fidelity, method in DRIVEN.items():
        system = mbs.compile(load("prototype").model(KerbRoad(1.0, 0.05, 0.05, "after", 1.0), fidelity=fidelity))
        settings = mbs.Settings(method=method)
        car = mbs.Simulation(system, settings=settings, inputs={"steering": 0.3}, pose=mbs.Pose(speed=15.0))
        for _ in range(STEPS):
            car.step(0.01)
        result += car.save()
    return result


@pytest.mark.slow
@unoptimised()
def test_states_have_the_same_bits_without_avx2(tmp_path):
    """Two numbers a vector in place of four; what runs beside it is the optimised kernel.

    What is compiled for processors with AVX2 is not entered.
    """
    if widest_lanes() == 2:
        pytest.skip("this processor has no AVX2")
    results = [states_of(library_path(), widest_lanes()), states_of(kernel(tmp_path), 2)]
    assert [r.stderr.decode() for r in results if r.returncode != 0] == []
    one, two = (np.frombuffer(r.stdout, np.uint8) for r in results)
    assert np.array_equal(one, two)


def kernel(folder: Path) -> Path:
    """A library of the kernel in which processors have no AVX2, and batches of elements end the process."""
    file, library = folder / "replaced.c", folder / build.library_name(build.host_target())
    file.write_text(NO_AVX2 + NO_BATCHES, encoding="utf-8")
    others = [source for source in build.sources() if source.name not in ("processor.c", "element_batches.c")]
    build.compile_c([*others, file], build.host_target(), library, what="a kernel without some of its files")
    return library


def states_of(library: Path, lanes: int) -> subprocess.CompletedProcess[bytes]:
    """What `states` gives with a library that has so many lanes, by a process of its own."""
    return subprocess.run(
        [sys.executable, "-c", "import sys; from tests.kernel.test_without_avx2 import states, widest_lanes; "
         f"assert widest_lanes() == {lanes}; sys.stdout.buffer.write(states())"],
        env=os.environ | {"ALI3_KERNEL_LIBRARY": str(library)}, cwd=Path(__file__).parents[2], capture_output=True,
        check=False,
    )  # fmt: skip
