"""What every test needs: the compiled kernel, commands as before the first, and Ctrl-C; what is made once for all
processes; the order of the tests, and one line for those that need a browser.
"""

import functools
import gc
import os
import re
import shutil
import signal
import sys
import tempfile
from collections.abc import Callable, Generator, Iterator
from pathlib import Path
from typing import Any

import pytest
from filelock import FileLock

# Before NumPy is loaded: beside other processes, threads of BLAS make small matrices several times as slow.
os.environ.setdefault("OMP_NUM_THREADS", "1")

# Else every program that a test starts compiles all that it imports, and each process of pytest every test.
if os.environ.pop("PYTHONDONTWRITEBYTECODE", ""):
    sys.dont_write_bytecode = False

# A shell that runs the tests in the background ignores Ctrl-C, `nohup` a closed terminal; programs that the tests start
# would inherit that.
for _name, _default in (
    ("SIGINT", signal.default_int_handler),
    ("SIGHUP", signal.SIG_DFL),
    ("SIGTERM", signal.SIG_DFL),
):
    _number = getattr(signal, _name, None)
    if _number is not None and signal.getsignal(_number) is signal.SIG_IGN:
        signal.signal(_number, _default)


@pytest.fixture(scope="session", autouse=True)
def _kernel_library() -> None:
    """Says in one sentence what is wrong when the kernel library is not there."""
    from mbs.kernel import binding

    try:
        binding.load_library()
    except OSError as error:
        pytest.fail(f"The kernel library cannot be loaded ({error}); first run: pip install -e .", pytrace=False)


@pytest.fixture(scope="session", autouse=True)
def _no_bar_by_time() -> Iterator[None]:
    """A bar appears after two seconds: on a slow machine it would stand among the messages that tests compare."""
    from ali3 import bars

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bars, "DELAY", 1e6)
        yield


@pytest.fixture(scope="session", autouse=True)
def _temporary_files(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """What tests and their programs leave among temporary files goes with them: fmpy unpacks each FMU there."""
    tmp_path_factory.getbasetemp()  # before: pytest keeps its own folders of the last three runs
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder, pytest.MonkeyPatch.context() as patch:
        patch.setattr(tempfile, "tempdir", folder)
        for name in ("TMPDIR", "TEMP", "TMP"):
            patch.setenv(name, folder)
        yield


@pytest.fixture(scope="session")
def shared(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that all processes of pytest-xdist have."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if "PYTEST_XDIST_WORKER" in os.environ else base


@pytest.fixture(scope="session")
def made_once(shared: Path) -> Callable[[str, Callable[[Path], None]], Path]:
    """A folder by its name that a function has filled, once for all processes of pytest-xdist."""

    def make(name: str, fill: Callable[[Path], None]) -> Path:
        folder, part = shared / name, shared / f"{name}.part"
        with FileLock(f"{folder}.lock"):
            if not folder.is_dir():
                shutil.rmtree(part, ignore_errors=True)
                part.mkdir()
                fill(part)
                part.rename(folder)
        return folder

    return make


@pytest.fixture(scope="session")
def scene_fmu(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Callable[..., Path]:
    """Builds the FMU of a scene, with `wasm` for pages too, once for all processes, also those forked for one test."""

    def make(scene: str, kind: str = "native", *, plain: bool = False, wasm: bool = False) -> Path:
        from fmpy import platform

        from fmu_src.build.build import build_fmu
        from fmu_src.build.scene_registry import load_scene

        def fill(folder: Path) -> None:
            name, system = load_scene(scene)
            build_fmu(system, name, folder, [platform, *["wasm32"] * wasm], kind=kind, plain=plain)

        options = f"{kind}{'_plain' * plain}{'_wasm' * wasm}"
        (path,) = made_once(f"{re.sub(r'[^a-z0-9]+', '_', scene[-40:])}_{options}", fill).glob("*.fmu")
        return path

    return make


@pytest.fixture(scope="session")
def prototype_fmu(scene_fmu: Callable[..., Path]) -> Path:
    """The FMU of the rigid prototype for this platform."""
    return scene_fmu("prototype_car")


@pytest.fixture(scope="session")
def renamed_fmu(made_once: Callable[[str, Callable[[Path], None]], Path]) -> Callable[[str], Path]:
    """The FMU of the rigid prototype under the names of another program, built once for all processes."""

    def make(names: str) -> Path:
        from tests.in_process import build_fmu

        options = ("--car", "prototype", "--fidelity", "0", "--names", names)
        return next(made_once(f"rigid_{names}", lambda folder: build_fmu(folder, *options)).glob("*.fmu"))

    return make


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    """A Chromium without a window; tests are skipped where there is none."""
    from tests.in_browser import bundle_or_skip, headless_chromium

    bundle_or_skip()
    with headless_chromium() as browser:
        yield browser


@pytest.fixture(autouse=True)
def _typed_as_modules(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sentences name commands as the test calls them, whatever a test before has typed."""
    monkeypatch.setattr("ali3.processes._prefix", None)
    monkeypatch.setattr("ali3.extras._extra", None)


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Files with slow tests come first.

    Each process of pytest-xdist starts with an equal part of the list, and takes from the end of another's when it has
    done its own: files with slow tests are dealt out to the beginnings of the parts.
    """
    files: dict[Path, list[pytest.Item]] = {}
    for item in sorted(items, key=lambda item: item.path):  # each process has imported in another order
        files.setdefault(item.path, []).append(item)
    slow = {p: sum(item.get_closest_marker("slow") is not None for item in tests) for p, tests in files.items()}
    parts: list[list[pytest.Item]] = [[] for _ in range(getattr(config, "workerinput", {}).get("workercount", 1))]
    for k, path in enumerate(sorted(filter(slow.get, files), key=lambda p: -slow[p])):
        parts[k % len(parts)] += files[path]
    for path in files:
        if not slow[path]:
            min(parts, key=len).extend(files[path])
    items[:] = [item for part in parts for item in part]


@pytest.hookimpl(wrapper=True)
def pytest_collection(session: pytest.Session) -> Generator[None, object, object]:
    """Each process of pytest-xdist begins to import in another folder, so that a fresh clone is compiled once by all.

    No garbage is looked for among modules and tests, which all stay: that took a third of the time.
    """
    worker = getattr(session.config, "workerinput", None)
    if worker is not None and session.config.args == session.config.getini("testpaths"):
        folders = sorted(str(path) for path in Path(__file__).parent.iterdir() if any(path.rglob("test_*.py")))
        first = len(folders) * int(worker["workerid"].removeprefix("gw")) // worker["workercount"]
        session.config.args = [*folders[first:], *folders[:first]]
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """``-n auto``: one process more than there are processors, since many tests wait for programs and sockets."""
    return (os.cpu_count() or 1) + 1


_UNSEEN = "not looked at without a browser"


@functools.cache
def _why_unseen() -> str:
    """What is said where a page cannot be looked at; empty where there is a browser."""
    from viewer.browser import BrowserError, find_chromium

    try:
        find_chromium()
    except BrowserError as error:
        return str(error)
    return ""


def pytest_report_teststatus(report: pytest.TestReport) -> tuple[str, str, str] | None:
    """Tests of pages that are skipped without a browser are a kind of their own, which is not listed one by one."""
    if report.skipped and _why_unseen() and _why_unseen() in str(report.longrepr):
        return _UNSEEN, "s", "SKIPPED"
    return None


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """One line for all of them."""
    unseen = len(terminalreporter.stats.get(_UNSEEN, ()))
    if unseen:
        terminalreporter.write_line(f"Pages were not looked at: {unseen} tests were skipped. {_why_unseen()}")
