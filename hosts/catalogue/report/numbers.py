"""Numbers, units and limits as text of the report."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from ali3.html_elements import element
from ali3.units import typeset
from hosts.common.numbers import is_round_off

if TYPE_CHECKING:
    from lxml.html import HtmlElement

NONE = "–"
"""Text for a missing number."""


def number_text(value: float) -> str:
    """A number with four digits, without an exponent below 1e7; `NONE` for NaN."""
    if not math.isfinite(value):
        return NONE if math.isnan(value) else ("∞" if value > 0.0 else "-∞")
    if 1e4 <= abs(value) < 1e7:
        return f"{float(f'{value:.4g}'):.0f}"
    return f"{value:.4g}".replace("e+0", "e+").replace("e-0", "e-")


def with_unit(value: float, unit: str) -> str:
    """A number and its unit."""
    text, tail = number_text(value), typeset(unit)
    return f"{text} {tail}" if tail and text != NONE else text


def limit_element(is_kept: bool, text: str = "") -> HtmlElement:
    """Whether a limit is kept, in colour. `text`: instead of the default."""
    return element("span", text or ("kept" if is_kept else "not kept"), class_="kept" if is_kept else "broken")


def difference_text(value: float, first: float) -> str:
    """Difference from the number of the first car with sign, and in per cent if that is below 1000 %."""
    change = value - first
    if not math.isfinite(change):
        return ""
    if is_round_off(change, max(abs(value), abs(first))):
        return "same"
    sign = "+" if change > 0.0 else "−"
    text = f"{sign}{number_text(abs(change))}"
    if first != 0.0 and abs(change / first) < 10.0:
        text += f" ({sign}{100.0 * abs(change / first):.3g} %)"
    return text
