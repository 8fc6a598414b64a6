"""What every test needs: the compiled kernel."""

from __future__ import annotations

import pytest


@pytest.fixture(scope="session", autouse=True)
def _kernel_library() -> None:
    """Says in one sentence what is wrong when the kernel library is not there."""
    from mbs.kernel import binding

    try:
        binding.load_library()
    except OSError as error:
        pytest.fail(f"The kernel library cannot be loaded ({error}); first run: pip install -e .", pytrace=False)
