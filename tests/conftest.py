"""What every test needs: the compiled kernel, commands as they are before the first, and Ctrl-C."""

from __future__ import annotations

import signal

import pytest

# Where a shell runs the tests in the background Ctrl-C is ignored; programs that the tests start would inherit that.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session", autouse=True)
def _kernel_library() -> None:
    """Says in one sentence what is wrong when the kernel library is not there."""
    from mbs.kernel import binding

    try:
        binding.load_library()
    except OSError as error:
        pytest.fail(f"The kernel library cannot be loaded ({error}); first run: pip install -e .", pytrace=False)


@pytest.fixture(autouse=True)
def _typed_as_modules(monkeypatch: pytest.MonkeyPatch) -> None:
    """Sentences name commands as the test calls them, whatever a test before has typed."""
    monkeypatch.setattr("ali3.running._prefix", None)
    monkeypatch.setattr("ali3.extras._extra", None)
