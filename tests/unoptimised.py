"""Compiles C without optimisation, in a fifth of the time, for tests that do not depend on it."""

from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from mbs.kernel import build


@contextmanager
def unoptimised() -> Iterator[None]:
    """A context in which `mbs.kernel.build` compiles so; results keep their bits."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(build, "FLAGS", ["-O0", "-fno-sanitize=undefined", "-fno-stack-protector", *build.FLAGS[1:]])
        yield
