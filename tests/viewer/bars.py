"""Checks of the bar of a page: one line within the window, and no choice with cut text."""

from typing import Any

_MEASURED = """(bar) => {
  const parts = [...document.querySelector(bar).children].map((part) => part.getBoundingClientRect());
  const boxes = parts.filter((box) => box.width);
  const of = (side) => boxes.map((box) => box[side]);
  const context = document.createElement("canvas").getContext("2d");
  const cut = (choice) => {
    const style = getComputedStyle(choice);
    context.font = style.font;
    const room = choice.clientWidth - parseFloat(style.paddingLeft) - parseFloat(style.paddingRight);
    return context.measureText(choice.selectedOptions[0].text).width + 12 > room; // with its arrow
  };
  return {
    count: boxes.length,
    rows: Math.max(...of("top")) < Math.min(...of("bottom")) ? 1 : 2,
    right: Math.max(...of("right")),
    width: innerWidth,
    cut: [...document.querySelectorAll(bar + " select")].filter((one) => one.checkVisibility() && cut(one)).map((one) => one.title),
  };
}"""  # noqa: E501


def check_bar(page: Any, bar: str, width: int) -> None:
    """Make the page so wide and look at its bar.

    Parameters
    ----------
    page : playwright Page
    bar : str
        Selector of the bar.
    width : int
        Of the window, pixels.
    """
    page.set_viewport_size({"width": width, "height": 600})
    result = page.evaluate(_MEASURED, bar)
    assert result["width"] == width
    assert result["count"] > 3
    assert result["rows"] == 1
    assert result["right"] <= width
    assert result["cut"] == []
