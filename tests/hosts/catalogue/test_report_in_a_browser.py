"""The report in Chromium: no error, nothing loaded, nothing wider than a phone."""

import pytest

from hosts.catalogue.report import write_report
from tests.hosts.catalogue.synthetic_records import synthetic
from tests.in_browser import headless_chromium

pytestmark = pytest.mark.drawn


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """Pages by width, what they told and asked for, and how they stand."""
    folder = tmp_path_factory.mktemp("report")
    file = folder / "report.html"
    write_report(file, *synthetic(folder / "none.fmu", tests=2, points=500))
    messages, requested = [], []
    with headless_chromium() as chromium:
        pages = {}
        for width, colours in ((1280, "light"), (390, "dark")):
            page = chromium.new_page(viewport={"width": width, "height": 900}, color_scheme=colours)
            page.on("console", lambda message: messages.append(message.text))
            page.on("pageerror", lambda error: messages.append(str(error)))
            page.on("request", lambda request: requested.append(request.url))
            page.goto(file.as_uri())
            page.evaluate("document.querySelectorAll('img').forEach(i => i.loading = 'eager')")
            page.evaluate("Promise.all([...document.images].map(i => i.decode()))")
            pages[width] = page
        yield pages, messages, requested


def test_it_opens_without_console_messages_and_loads_nothing(seen):
    _, messages, requested = seen
    assert messages == []
    assert {url.partition(":")[0] for url in requested} <= {"file", "data"}
    assert sum(url.startswith("file") for url in requested) == 2


def test_pictures_are_there_and_nothing_is_too_wide(seen):
    for width, page in seen[0].items():
        assert page.evaluate("[...document.images].every(i => i.naturalWidth > 100)")
        assert page.evaluate("document.documentElement.scrollWidth") <= width


def test_dark_and_light_have_enough_contrast(seen):
    """Text on the ground, by the luminance of WCAG: 4.5 and more."""
    for page in seen[0].values():
        ratios = page.evaluate(
            """() => {
              const light = text => {
                const [r, g, b] = text.match(/[0-9.]+/g).slice(0, 3).map(v => v / 255)
                  .map(v => v <= 0.03928 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
                return 0.2126 * r + 0.7152 * g + 0.0722 * b;
              };
              const ground = light(getComputedStyle(document.body).backgroundColor);
              return ['body', '.kept', '.broken', 'td small', 'nav a'].map(name => {
                const ink = light(getComputedStyle(document.querySelector(name)).color);
                return (Math.max(ink, ground) + 0.05) / (Math.min(ink, ground) + 0.05);
              });
            }"""
        )
        assert min(ratios) > 4.5, ratios


def test_tables_open(seen):
    page = seen[0][390]
    page.locator("summary").first.click()
    assert page.locator("details table").first.is_visible()
