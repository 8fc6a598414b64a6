"""documentation/index.html of an FMU: its model, its axes and a table of all variables."""

from collections.abc import Sequence
from html import escape
from typing import Any

from ali3 import html
from ali3.html_elements import markup
from ali3.html_elements import table as html_table
from fmu_src.variables.variables import Variable

_STYLE = "svg { max-width: 22em; color: var(--ink); }\n"
# Vehicle axes of ISO 8855, seen from behind, above and the right.
_AXES = """<svg viewBox="0 0 235 150" role="img" aria-label="axes: x forward, y left, z up">
<defs>
<marker id="a" markerWidth="8" markerHeight="8" refX="6" refY="3" orient="auto">
<path d="M0,0L7,3L0,6z" fill="currentColor"/></marker></defs>
<g stroke="currentColor" stroke-width="2" fill="none" marker-end="url(#a)">
<path d="M110,100L180,62" marker-end="url(#a)"/><path d="M110,100L36,76" marker-end="url(#a)"/>
<path d="M110,100L110,22" marker-end="url(#a)"/></g>
<g font-size="13" font-family="sans-serif" fill="currentColor"><text x="172" y="54">x forward</text>
<text x="6" y="70">y left</text>
<text x="117" y="26">z up</text></g></svg>"""


def documentation(
    name: str, description: str, version: str, step_size: float, table: Sequence[Variable], paragraphs: Sequence[str]
) -> str:
    """The page.

    `step_size`: default step, s; `paragraphs`: what is peculiar to the kind of FMU; plain text. Result: HTML that needs
    no other file but the picture.
    """
    columns = ("name", "causality", "variability", "unit", "start", "min", "max", "description")
    rows = markup([html_table("", columns, ([_cell(getattr(v, c)) for c in columns] for v in table))])
    paragraphs_html = "\n".join(f"<p>{escape(p)}</p>" for p in paragraphs)
    body = (
        f"<h1>{escape(name)}</h1><p>{escape(description)}</p>\n"
        f"<p>Made by ALi3 {escape(version)}. Default step {step_size:g} s. Inputs are held over a communication "
        "step or follow the derivatives that are set; outputs belong to its end. A step that fails is refused and the "
        f"last good state is kept.</p>\n{paragraphs_html}\n<h2>Axes</h2>\n{_AXES}\n"
        "<p>Earth axes with z up; a vehicle's axes are those of ISO 8855: x forward, y left, z up, angles "
        "Z-Y'-X'' (yaw, pitch, roll), quaternions scalar first (qw). SI units throughout.</p>\n"
        f"<h2>Variables</h2>\n{rows}"
    )
    return html.report(name, body, _STYLE)


def _cell(value: Any) -> str:
    return "" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
