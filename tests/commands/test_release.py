"""A release needs one version everywhere, a section of the changelog, and workflows that are valid."""

import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from tests.modules import module_of

ROOT = Path(__file__).parents[2]
FILES = ("pyproject.toml", "CITATION.cff", "CHANGELOG.md", "fmu_src/description/description.py")


@pytest.fixture(scope="module")
def check_release() -> ModuleType:
    return module_of(ROOT / ".ci" / "check_release.py")


@pytest.fixture
def tree(tmp_path: Path) -> Path:
    """What is ready to be released as 9.8.7."""
    (tmp_path / "fmu_src" / "description").mkdir(parents=True)
    (tmp_path / "pyproject.toml").write_text('[project]\nversion = "9.8.7"\n')
    (tmp_path / "CITATION.cff").write_text("version: 9.8.7\ndate-released: 2031-02-03\n")
    (tmp_path / "fmu_src" / "description" / "description.py").write_text('RELEASE_DATE = "2031-02-03T00:00:00Z"\n')
    now, before = "## [9.8.7] - 2031-02-03\n\n- A wheel.\n", "## [9.8.6] - 2030-01-01\n\n- Fire.\n"
    (tmp_path / "CHANGELOG.md").write_text(f"# Changelog\n\n## [Unreleased]\n\n{now}\n{before}")
    return tmp_path


def test_versions_agree_at_any_time(check_release):
    assert check_release.problems(ROOT, None) == []


def test_what_is_ready_has_its_notes(check_release, tree):
    assert check_release.problems(tree, "v9.8.7") == []
    assert check_release.section(tree, "9.8.7") == ("2031-02-03", "- A wheel.")


@pytest.mark.parametrize(
    ("file", "old", "new", "sentence"),
    [
        ("CITATION.cff", "9.8.7", "9.8.6", "CITATION.cff says version 9.8.6, pyproject.toml 9.8.7"),
        ("pyproject.toml", "9.8.7", "9.8.8", "The tag is v9.8.7; pyproject.toml says version 9.8.8"),
        ("CHANGELOG.md", "[9.8.7]", "[9.8.5]", "has no heading '## [9.8.7] - YYYY-MM-DD'"),
        ("CHANGELOG.md", "- A wheel.\n", "", "section [9.8.7] of CHANGELOG.md is empty"),
        ("CITATION.cff", "-03", "-04", "is of 2031-02-03, CITATION.cff says 2031-02-04"),
        ("fmu_src/description/description.py", "-03", "-04", "fmu_src/description/description.py says 2031-02-04"),
    ],
)
def test_inconsistent_versions_are_reported(check_release, tree, file, old, new, sentence):
    text = (tree / file).read_text()
    assert old in text
    (tree / file).write_text(text.replace(old, new))
    assert any(sentence in problem for problem in check_release.problems(tree, "v9.8.7"))


def test_the_command_ends_with_one_if_a_release_is_not_ready(check_release, tree, monkeypatch, capsys):
    monkeypatch.setattr(check_release, "ROOT", tree)
    monkeypatch.setattr("sys.argv", ["check_release.py", "v9.8.7"])
    assert check_release.main() == 0
    assert capsys.readouterr().out == "- A wheel.\n"
    monkeypatch.setattr("sys.argv", ["check_release.py", "v1.0.0"])
    assert check_release.main() == 1
    assert "error: The tag is v1.0.0" in capsys.readouterr().err


def test_all_parts_of_the_release_are_checked_with_the_present_files(tmp_path, check_release):
    """The places that are read are where they are read: a tag of another version is refused by three of them."""
    for name in FILES:
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    version = check_release.version_of(tmp_path)
    assert version is not None
    changes = tmp_path / "CHANGELOG.md"
    text = changes.read_text(encoding="utf-8")
    if f"[{version}]" not in text:
        changes.write_text(text.replace("## [Unreleased]", f"## [{version}] - 2000-01-02", 1), encoding="utf-8")
        problems = check_release.problems(tmp_path, f"v{version}")
        assert [s.rpartition(", ")[2].partition(" says")[0] for s in problems] == [
            "CITATION.cff",
            "fmu_src/description/description.py",
        ]


def test_workflows_are_valid():
    pytest.importorskip("check_jsonschema")
    files = sorted(map(str, (ROOT / ".github" / "workflows").glob("*.yml")))
    command = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows", *files]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout
