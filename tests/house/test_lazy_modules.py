"""Packages of the engine are attributes of `mbs`, and importing `mbs` loads none of them."""

import importlib
import pkgutil
import subprocess
import sys

import pytest

from tests.house.test_import_directions import ROOT

PATHS = (
    "vehicle.load",
    "vehicle.json_schema",
    "vehicle.kinematics.read_curve",
    "elements.ScalarSpringDamper",
    "flexible.craig_bampton",
    "flexible.scene_part.flexible_parts",
    "shapes.pose_outputs.pose_outputs",
    "roads.read_road",
)


OPTIONAL_OF_A_STUDY = {
    "hosts.study.analysis.report",
    "hosts.study.random_points",
    "hosts.study.repeated_run",
    "hosts.study.target",
}
"""What only some options and files of a study ask for."""


FACADES = sorted(
    ".".join(file.parent.relative_to(ROOT).parts)
    for file in (ROOT / "mbs").rglob("__init__.py")
    if "\n__getattr__ = " in file.read_text(encoding="utf-8")
)


def ran(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_paths_of_the_documents_need_one_import() -> None:
    """Each with none of the engine imported, but NumPy and others that are not ours."""
    code = """import sys, mbs
for path in sys.argv[1:]:
    for name in [n for n in sys.modules if n.partition(".")[0] == "mbs"]:
        del sys.modules[name]
    import mbs
    found = mbs
    try:
        for part in path.split("."):
            found = getattr(found, part)
    except AttributeError as error:
        print(path, error)
    else:
        print(*[path] * (not callable(found)), end="")"""
    done = subprocess.run([sys.executable, "-c", code, *PATHS], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_what_is_not_there_is_an_attribute_error() -> None:
    done = ran("import mbs; mbs.vehicles")
    assert done.stderr.endswith("AttributeError: module 'mbs' has no attribute 'vehicles'\n")


@pytest.mark.parametrize("name", FACADES)
def test_no_name_is_hidden_by_a_submodule(name: str) -> None:
    """An import of the submodule anywhere would put it in the place of a lazy function of its name."""
    package = importlib.import_module(name)
    submodules = {module.name for module in pkgutil.iter_modules(package.__path__)}
    assert submodules.isdisjoint(getattr(package, "_LAZY", ()))


def test_importing_mbs_loads_no_package() -> None:
    code = "import sys, mbs; print(*(n for n in sys.modules if n in ('mbs.vehicle', 'mbs.scenes')))"
    assert ran(code).stdout.split() == []


@pytest.mark.slow
def test_a_study_does_not_load_optional_packages() -> None:
    names = {f"hosts.study.{name}" for name in ("campaign", "command", "outcome_table", "trial_runs")}
    names |= {f"hosts.experiment.{name}" for name in ("cluster", "cluster_runs")}
    loaded = ran(f"import sys, {', '.join(names)}; print(*sys.modules)").stdout.split()
    assert names <= set(loaded)
    assert OPTIONAL_OF_A_STUDY.isdisjoint(loaded)


def test_a_process_for_code_of_others_leaves_its_guard_before_it_loads_packages() -> None:
    """A fork copies what is loaded, with threads of none; and not all platforms have `resource`."""
    loaded = ran(
        "import sys; before = {*sys.modules}; import ali3.worker; print(*{*sys.modules} - before)"
    ).stdout.split()
    assert "ali3.process_supervisor" in loaded
    assert {"numpy", "pydantic", "resource"}.isdisjoint(loaded)
