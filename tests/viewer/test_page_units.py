"""The parts of the page that need no browser, by Node's own test runner."""

import subprocess
from pathlib import Path

import pytest

from viewer import page_build

PAGE = Path(page_build.__file__).parent / "page"


@pytest.mark.slow
def test_units_of_the_page():
    """In one process: each file of its own would start Node again."""
    try:
        page_build.install_packages(PAGE)
    except RuntimeError as error:
        pytest.skip(str(error))
    result = subprocess.run(
        [page_build.node_and_npm()[0], "--test", "--test-isolation=none", *map(str, (PAGE / "test").glob("*.test.js"))],
        cwd=PAGE,
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "# pass 0" not in result.stdout
