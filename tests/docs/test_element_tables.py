"""Tables of force elements: a row for each, of what its class declares."""

import importlib
import re
import sys

import pytest

from mbs.elements.fields_in_c import FOLDER, class_of
from mbs.elements.reals import each_real
from mbs.elements.tables import element_table, law_table, number_table
from mbs.kernel.header.enumerations import ElementType
from tests.docs.test_documents import ROOT


def test_each_type_has_a_row_with_its_number() -> None:
    rows = re.findall(r"^\| (\d+) \| (\w+) \|", element_table(), re.MULTILINE)
    assert [(int(number), name) for number, name in rows] == [(kind.value, kind.name) for kind in ElementType]


def test_each_law_has_a_sentence_and_its_file() -> None:
    rows = re.findall(r"^\| `(\w+)` \| ([A-Z].+\.) \| `(.+)` \|$", law_table(), re.MULTILINE)
    assert [name for name, _, _ in rows] == [class_of(kind).__name__ for kind in ElementType]
    assert all((ROOT / file).parent == FOLDER and (ROOT / file).is_file() for _, _, file in rows)


def test_numbers_stand_in_the_order_of_the_kernel_with_ranges_and_defaults() -> None:
    table = number_table()
    parts = re.split(r"^\| `([A-Z_]+)` ", table, flags=re.MULTILINE)
    rows = dict(zip(parts[1::2], parts[2::2], strict=True))
    for kind in ElementType:
        named = [
            name
            for row in re.findall(r"^ *\|[ |]*?(`.+?`) \| ", rows.get(kind.name, ""), re.MULTILINE)
            for name in re.findall(r"`(\w+)`", row)
        ]
        assert named == [name for name, _, _ in each_real(class_of(kind))], kind
    assert "| `SPRING_DAMPER` | `stiffness` | not negative |  | N/m. |" in table
    assert "|  | `metal_onset` | not negative | 0.001 | Depth over which it sets in, m. |" in table
    assert "|  | `bore_width` | greater than zero |  | Width of the patch, m. |" in table
    assert "|  | `efficiency` | above 0 and at most 1 | 0.9 | " in table


def test_the_site_has_them(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("sphinx")
    monkeypatch.syspath_prepend(ROOT / "docs" / "_site")
    monkeypatch.delitem(sys.modules, "made_tables", raising=False)
    result = importlib.import_module("made_tables")
    pages = "".join(page.read_text(encoding="utf-8") for page in (ROOT / "docs").glob("*.md"))
    assert sorted(result.MARK.findall(pages)) == sorted(result.MAKERS)
