"""The list of the pages that run FMUs, on a site with and without them."""

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest

from tests.modules import module_of

ROOT = Path(__file__).parents[2]
SITE = ROOT / "docs" / "_site"


@pytest.fixture(scope="module")
def live_pages() -> ModuleType:
    pytest.importorskip("sphinx")
    return module_of(SITE / "live_pages.py")


def site(out: Path) -> SimpleNamespace:
    builder = SimpleNamespace(format="html")
    return SimpleNamespace(outdir=str(out), builder=builder, config=SimpleNamespace(live_pages=None))


def text(live_pages: ModuleType, app: SimpleNamespace, page: str = "docs/driving.md") -> str:
    source = [(ROOT / page).read_text(encoding="utf-8")]
    live_pages.listed(app, page, source)
    assert live_pages.MARK not in source[0]
    return source[0]


def test_pages_that_cannot_be_made_are_left_out_with_one_line(live_pages, tmp_path, monkeypatch, capsys):
    result = {"prototype"}

    def make(names: Sequence[str], out: Path) -> str:
        for name in result & set(names):
            (out / f"{name}.html").write_text("x" * 1_600_000)
        return "; ".join(f"{name}: there is no compiler" for name in names if name not in result)

    monkeypatch.setattr(live_pages, "make", make)
    monkeypatch.delenv(live_pages.MODE, raising=False)
    app = site(tmp_path)
    live_pages.build(app)
    errors = capsys.readouterr().err
    assert errors.startswith(
        "warning: pages that run FMUs are left out of the site: proving_ground: there is no compiler; "
    )
    assert errors.count("\n") == 1
    shown = text(live_pages, app)
    assert '<a href="live/prototype.html">Open it</a> (1.6 MB)' in shown
    assert '<a href="live/prototype.html">Open it</a> (1.6 MB)' in text(live_pages, app, "README.md")
    assert "puma.html" not in shown

    monkeypatch.setenv(live_pages.MODE, "required")
    with pytest.raises(Exception, match="could not be made: proving_ground: there is no compiler"):
        live_pages.build(app)

    monkeypatch.delenv(live_pages.MODE)
    result |= set(live_pages.PAGES)
    live_pages.build(app)
    assert capsys.readouterr().err == ""
    result.clear()  # not made again from the same sources
    live_pages.build(app)
    assert app.config.live_pages == list(live_pages.PAGES)


def test_a_site_without_live_pages_says_so(live_pages, tmp_path, monkeypatch):
    monkeypatch.setenv(live_pages.MODE, "none")
    app = site(tmp_path)
    live_pages.build(app)
    assert "This copy of the site was built without the pages" in text(live_pages, app)
