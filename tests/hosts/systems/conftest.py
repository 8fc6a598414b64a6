"""Small FMUs of which the tests make systems."""

from pathlib import Path

import pytest
from pythonfmu import FmuBuilder

FMUS = Path(__file__).parent / "fmus"


@pytest.fixture(scope="package")
def partners(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Two halves of an oscillator, a step function, parameters of all types; the step function without states too."""
    folder = tmp_path_factory.mktemp("partners")
    names = ("half_mass", "half_spring", "jump", "settings")
    fmus = {n: Path(FmuBuilder.build_FMU(FMUS / f"{n}.py", dest=folder, canGetAndSetFMUstate=True)) for n in names}
    (folder / "without").mkdir()
    return fmus | {"stateless": Path(FmuBuilder.build_FMU(FMUS / "jump.py", dest=folder / "without"))}
