"""Signals that end a program are handled as Ctrl-C is; ignored signals stay ignored."""

import os
import signal
import subprocess
import sys

import pytest

from ali3.command_run import run_command

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_a_terminated_command_cleans_up_and_reports_it(number: int, capsys: pytest.CaptureFixture[str]) -> None:
    done = []

    def work() -> int:
        try:
            os.kill(os.getpid(), number)
            signal.pause()
        except KeyboardInterrupt:
            done.append("kept")
            raise
        return 0

    before = signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGHUP)
    assert run_command(work) == 128 + number
    assert (done, capsys.readouterr().err) == (["kept"], f"stopped by {signal.Signals(number).name}\n")
    assert (signal.getsignal(signal.SIGTERM), signal.getsignal(signal.SIGHUP)) == before


def test_under_nohup_a_closed_terminal_ends_nothing() -> None:
    text = (
        "import os, signal; from ali3.command_run import run_command\n"
        "def work():\n    os.kill(os.getpid(), signal.SIGHUP); print('done'); return 0\n"
        "raise SystemExit(run_command(work))"
    )
    done = subprocess.run(
        ["nohup", sys.executable, "-c", text], capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL
    )
    assert (done.returncode, done.stdout) == (0, "done\n")
