"""The page of the keys has the rows of the table from which all pages take them, in its order."""

import json
from pathlib import Path

from benchmarks.figures import PAGES_OF_KEYS

ROOT = Path(__file__).parents[2]


def test_the_page_of_the_keys_is_their_table() -> None:
    rows = json.loads((ROOT / "viewer" / "keys.json").read_text(encoding="utf-8"))
    expected = [f"| {row['shown']} | {row['words']} | {PAGES_OF_KEYS[row.get('where', '')]} |" for row in rows]
    page = (ROOT / "docs" / "driving.md").read_text(encoding="utf-8")
    lines = page.partition("\n## Keys\n")[2].partition("\n## ")[0].splitlines()
    assert [line for line in lines if line.startswith("|")][2:] == expected
