"""The FMU state is exact: roll back, another instance, another process."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

from tests.fmu.calls import ERROR, HostMaker

OTHER_PROCESS = """
import json, sys
from pathlib import Path
sys.path.insert(0, sys.argv[1])
from tests.fmu.conftest import Host
driven = Host(Path(sys.argv[2]))
assert driven.restore(Path(sys.argv[3]).read_bytes()) == 0
print(json.dumps([driven.outputs(), *driven.run(49, 0.01, 0.3)]))
"""
ROOT = Path(__file__).parents[2]


def test_roll_back_repeats_bit_for_bit(crane: Path, host: HostMaker) -> None:
    driven = host(crane).start({"torque": 4.0})
    driven.run(30, 0.01)
    driven.set("torque", -9.0)
    state = driven.slave.getFMUstate()
    at_state = driven.outputs()
    first = driven.run(40, 0.01, 0.3)
    driven.set("torque", 25.0)
    driven.set("spring.stiffness", 40.0)
    driven.run(7, 0.01, 0.7)
    driven.slave.setFMUstate(state)
    assert driven.outputs() == at_state
    assert driven.get("torque") == -9.0
    assert driven.get("spring.stiffness") == 5.0
    assert driven.run(40, 0.01, 0.3) == first
    driven.slave.freeFMUstate(state)


def test_state_goes_to_a_new_process(build: Callable[..., Path], host: HostMaker, tmp_path: Path) -> None:
    crane = build("crane")
    driven = host(crane).start({"torque": 4.0, "spring.stiffness": 9.0})
    driven.run(30, 0.01)
    data = driven.saved()
    (tmp_path / "state").write_bytes(data)
    expected = [driven.outputs(), *driven.run(49, 0.01, 0.3)]
    done = subprocess.run(
        [sys.executable, "-c", OTHER_PROCESS, str(ROOT), str(crane), str(tmp_path / "state")],
        capture_output=True,
        text=True,
        check=True,
    )
    assert json.loads(done.stdout) == expected


def test_state_before_initialisation(sled: Path, host: HostMaker) -> None:
    driven = host(sled)
    driven.set("initial.speed", 2.0)
    state = driven.slave.getFMUstate()
    driven.set("initial.speed", 5.0)
    driven.slave.setFMUstate(state)
    assert driven.start().get("speed") == 2.0


def test_state_of_another_fmu_is_refused(crane: Path, reach: Path, host: HostMaker) -> None:
    other = host(reach).start()
    data = other.saved()
    driven = host(crane).start()
    driven.run(3, 0.01)
    before = driven.outputs()
    assert driven.restore(data) == ERROR
    assert "same build" in driven.messages[-1]
    assert driven.outputs() == before


def test_a_state_of_another_version_is_refused_with_a_remedy(crane: Path, host: HostMaker) -> None:
    driven = host(crane).start()
    data = bytearray(driven.saved())
    data[8] -= 1
    assert driven.restore(bytes(data)) == ERROR
    assert "of another version; save one again with this FMU" in driven.messages[-1]


def test_damaged_states_are_refused(crane: Path, host: HostMaker) -> None:
    driven = host(crane).start()
    driven.run(3, 0.01)
    before = driven.outputs()
    data = driven.saved()
    flipped = [bytes(b ^ (k == place) for k, b in enumerate(data)) for place in range(0, len(data), 97)]
    for bad in (data[:20], data[:-8], data + b"\0", bytes(len(data)), b"x", *flipped):
        assert driven.restore(bad) == ERROR
        assert driven.outputs() == before
    assert "altered" in driven.messages[-1]
    assert driven.run(3, 0.01, 0.03) == host(crane).start().run(6, 0.01)[3:]


def test_freed_state_is_null(crane: Path, host: HostMaker) -> None:
    driven = host(crane).start()
    state = driven.slave.getFMUstate()
    assert state.value
    driven.slave.freeFMUstate(state)
    assert not state.value
    driven.slave.freeFMUstate(state)
