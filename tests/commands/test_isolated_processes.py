"""Work in processes of its own: a crash of one is reported, and the others continue."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pytest

from ali3.errors import FileError, UserError
from ali3.isolated_processes import READY, Isolated, Lost

posix = pytest.mark.skipif(sys.platform == "win32", reason="signals")
Tell = Callable[[Any], None]


class Counter:
    """It knows how many tasks it has had."""

    count = 0

    def __call__(self, task: str, tell: Tell) -> tuple[int, int]:
        self.count += 1
        if task == "crash":
            os.abort()
        if task == "kill":
            os.kill(os.getpid(), signal.SIGKILL)
        if task == "hang":
            tell(0)
            time.sleep(1000.0)
        if task == "leave":
            os._exit(3)
        if task == "wrong":
            raise UserError("The value is 3.")
        if task == "unreadable":
            raise FileError("a.csv cannot be read.")
        if task == "fault":
            raise KeyError("nothing")
        if task == "unframed":
            return lambda: None  # type: ignore[return-value]
        if task == "loud":
            os.write(1, b"what an FMU prints\n" * 10_000)
        for k in range(3 if task == "tell" else 0):
            tell(k)
        return self.count, os.getpid()


def test_an_error_of_a_callback_is_raised_and_the_next_task_is_done(worker):
    def full(word: object) -> None:
        raise OSError(28, "No space left on device")

    with pytest.raises(OSError, match="No space"):
        worker.do("tell", full)
    done = worker.do("")
    assert not isinstance(done, Lost)
    assert done[0] == 1


@pytest.fixture
def worker() -> Any:
    isolated = Isolated(Counter(), tuple[int, int])
    yield isolated
    isolated.close()


def test_a_process_that_does_not_begin_is_reported_as_such(worker, monkeypatch):
    monkeypatch.setattr("ali3.isolated_processes._START_TIMEOUT", 1e-3)
    assert worker.do("") == Lost("had not begun after 0.001 s", late=True)


def test_a_process_keeps_its_state_between_tasks_and_may_print(worker):
    heard: list[int] = []
    first, process = worker.do("tell", heard.append)
    assert (first, heard) == (1, [0, 1, 2])
    assert process != os.getpid()
    assert worker.do("loud") == (2, process)
    assert worker.do("") == (3, process)


def test_a_task_is_lost_if_another_thread_closes_before_it_is_sent(worker, monkeypatch):
    worker.do("")
    started = worker._started

    def started_and_closed() -> Any:
        result = started()
        worker.close()
        return result

    monkeypatch.setattr(worker, "_started", started_and_closed)
    assert worker.do("") == Lost("was ended")


def test_nothing_is_sent_if_another_thread_closes_meanwhile(worker, monkeypatch):
    worker.do("")
    readings = iter([worker._process, None])
    with monkeypatch.context() as patch:
        patch.setattr(Isolated, "_process", property(lambda _: next(readings)), raising=False)
        worker.send("word")
        assert next(readings) is None, "the process is read once"


def test_a_start_that_ends_at_its_time_limit_is_reported_as_late(worker, monkeypatch):
    read_answer = worker._answer

    def read_late(process: Any, limit: float | None, end: Callable[[], None]) -> Any:
        answer = read_answer(process, limit, end)
        if answer is not None and answer[0] == READY:
            end()
        return answer

    monkeypatch.setattr(worker, "_answer", read_late)
    lost = worker.do("hang")
    assert isinstance(lost, Lost)
    assert lost.late
    assert lost.how.startswith("had not begun after 600 s")


@pytest.mark.slow
@posix
def test_after_a_loss_there_is_a_new_process(worker):
    ways = {
        "crash": "crashed (SIGABRT)",
        "kill": "was killed (SIGKILL), by a user or by the system because memory ran out",
        "leave": "ended with exit code 3",
        "fault": "ended with exit code 1: KeyError: 'nothing'",
        "hang": "took more than 0.5 s",
    }
    before = worker.do("")[1]
    for task, how in ways.items():
        worker.do("")
        assert worker.do(task, limit=0.5 if task == "hang" else None) == Lost(how, task == "hang")
        count, process = worker.do("")
        assert count == 1
        assert process != before
        before = process
    lost = worker.do("unframed")
    assert isinstance(lost, Lost)
    assert lost.how.startswith("ended with exit code 1: ")


def test_errors_of_the_user_come_back(worker):
    for task, message in (("wrong", r"The value is 3\."), ("unreadable", r"a\.csv cannot be read\.")):
        with pytest.raises(UserError, match=message):
            worker.do(task)
    assert worker.do("")[0] == 3


@posix
def test_processes_end_with_the_program_in_the_middle_of_a_task():
    text = "from ali3.isolated_processes import Isolated; from tests.commands.test_isolated_processes import Counter; "
    program = subprocess.Popen(
        [sys.executable, "-c", f"{text}Isolated(Counter(), int).do('hang', lambda word: print(word, flush=True))"],
        cwd=Path(__file__).parents[2],
        stdout=subprocess.PIPE,
    )
    assert program.stdout is not None
    assert program.stdout.readline() == b"0.0\n"  # the task has begun
    children = psutil.Process(program.pid).children(recursive=True)
    assert children
    program.kill()
    program.communicate()
    assert psutil.wait_procs(children, timeout=30.0)[1] == []


@posix
def test_signals_of_a_terminal_are_left_to_the_program(worker):
    process = worker.do("")[1]
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        os.kill(process, number)
    assert worker.do("") == (2, process)


def talkative(task: float, tell: Tell) -> int:
    for k in range(8):
        time.sleep(task)
        tell(k)
    return 8


def test_the_limit_is_a_time_without_a_message():
    worker: Isolated[float, int] = Isolated(talkative, int)
    try:
        heard: list[float] = []
        assert worker.do(0.4, heard.append, limit=3.0) == 8  # 3.2 s in all
        assert heard == list(range(8))
        assert worker.do(1000.0, heard.append, limit=0.2) == Lost("took more than 0.2 s", late=True)
        assert worker.do(0.5, heard.append, limit=2.0, in_all=True) == Lost("took more than 2 s", late=True)
        assert 8 < len(heard) < 14
    finally:
        worker.close()
