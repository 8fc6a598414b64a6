"""`ali3 check` of FMUs that loop for ever, crash, step for long, or lack functions: each check has its verdict."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import fmpy
import pytest

from ali3.isolated_processes import Lost
from hosts.check.all_checks import CHECKS, Checker, finding_of_loss
from hosts.check.instance import Finding
from hosts.experiment.pool import Pool
from tests.hosts.changed_fmu import DESCRIPTION, changed_fmu
from tests.hosts.odd_fmus import odd_fmu
from tests.hosts.one_check import all_checks

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def fmu(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], Path]:
    folder, fmus = tmp_path_factory.mktemp("odd"), dict[str, Path]()

    def of_name(name: str) -> Path:
        if name not in fmus:
            fmus[name] = odd_fmu(name, folder)
        return fmus[name]

    return of_name


def of_some(path: Path, names: tuple[str, ...], steps: int, limit: float = 20.0) -> list[tuple[str, str]]:
    """Verdict and words of some checks in one process, which is replaced as the command does it."""
    by_name = {check.name: number for number, check in enumerate(CHECKS)}
    results = []
    with Pool(Checker(path, steps, {}), Finding, reads=(path,), limit=limit, in_all=True) as pool:
        for name in names:
            result = pool.run(by_name[name])
            finding = finding_of_loss(CHECKS[by_name[name]], result, limit) if isinstance(result, Lost) else result
            results.append((finding.verdict, finding.words))
    return results


def test_a_step_that_never_ends_is_bad_and_other_checks_are_done(fmu: Callable[[str], Path]) -> None:
    names = ("runs", "units", "long steps", "reset")
    first, document, long, later = of_some(fmu("endless"), names, 3, 0.5)
    for verdict, words in (first, later):
        assert verdict == "bad"
        assert words.startswith("took more than 0.5 s in fmi2DoStep at 0 s; --time-limit")
    assert document[0] == "good"
    assert long[0] == "note"
    assert "FMI 2.0" in long[1]


@pytest.mark.skipif(sys.platform == "win32", reason="names of signals")
def test_a_step_that_crashes_is_bad_and_every_other_check_is_done(fmu: Callable[[str], Path]) -> None:
    code, found = all_checks(fmu("crashing"), "--steps", 5)
    assert code == 1
    assert list(found) == [check.name for check in CHECKS]
    for name in ("runs", "repeats", "reset", "states"):
        assert found[name] == ("BAD", "the process crashed (SIGSEGV) in fmi2DoStep at 0.02 s")
    assert found["long steps"] == ("BAD", "the process crashed (SIGSEGV) in fmi2DoStep at 0 s")
    assert found["quiet steps"][0] == "ok"
    assert found["refusals"][0] == "note"


def test_long_steps_are_notes(fmu: Callable[[str], Path]) -> None:
    code, found = all_checks(fmu("long_steps"), "--steps", 5, "--time-limit", 2)
    assert code == 0
    assert list(found) == [check.name for check in CHECKS]
    assert not [name for name, (verdict, _) in found.items() if verdict == "BAD"]
    assert found["stop time"][0] == "note"
    assert "(FMI 2.0, 2.1.6)" in found["stop time"][1]
    assert found["far from zero"] == (
        "note",
        "a step of 0.01 s at 1e+16 s is accepted, but its time does not change; FMI does not define this "
        "(FMI 2.0, 4.2.2)",
    )
    assert found["long steps"][0] == "note"
    assert found["long steps"][1].startswith("took more than 2 s in fmi2DoStep at 0 s (FMI sets no time for a step")


def test_missing_functions_are_one_line(fmu: Callable[[str], Path], tmp_path: Path) -> None:
    library = f"binaries/{fmpy.platform}/long_steps{fmpy.sharedLibraryExtension}"
    other = {library: lambda data: data.replace(b"fmi2GetRealStatus\0", b"fmi2GetRealStatos\0")}
    code, found = all_checks(changed_fmu(fmu("long_steps"), tmp_path / "copy.fmu", other))
    assert code == 1
    assert [name for name, (verdict, _) in found.items() if verdict == "BAD"] == ["functions"]
    assert found["functions"][1].startswith("1 of 34 are missing: fmi2GetRealStatus (FMI 2.0, 2.3)")
    left_out = [check for check in CHECKS if check.calls]
    assert found["not done"] == ("note", f"{len(left_out)} checks, which call functions of the FMU")
    assert len(found) == len(CHECKS) - len(left_out) + 1


def test_a_state_of_any_size_is_named(tmp_path: Path) -> None:
    fmu = odd_fmu("faults", tmp_path, "STATE_SIZE=(size_t)1<<45")
    altered, restored = of_some(fmu, ("altered states", "states"), 5)
    bound = "at most 100000000 (or ALI3_LIMITS=351844 set)"
    message = f"The FMU says that its state has 35184372088832 bytes; it must have {bound}"
    assert altered == ("bad", message)
    assert restored == ("bad", f"{message}; say the size that is needed (FMI 2.0, 2.1.8)")


def test_a_limit_of_memory_is_no_cause_where_there_is_room(fmu: Callable[[str], Path], tmp_path: Path) -> None:
    """An FMU that is not instantiated, for its token is another, which it says where logging is on."""
    resource, limit = pytest.importorskip("resource", reason="limits of memory"), 900_000_000
    other = {DESCRIPTION: lambda data: data.replace(b'guid="{small}"', b'guid="{other}"')}
    copy = changed_fmu(fmu("long_steps"), tmp_path / "other.fmu", other)
    done = subprocess.run(
        [sys.executable, "-m", "ali3", "run", str(copy), "--out", str(tmp_path)],
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (limit, limit)),
    )
    assert done.returncode == 2
    assert done.stderr.endswith("other.fmu cannot be loaded on linux: Failed to instantiate model: another GUID\n")
