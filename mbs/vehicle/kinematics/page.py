"""One HTML page with the table, the notes and the plots in it."""

from __future__ import annotations

import base64
import io
from html import escape
from typing import TYPE_CHECKING

from ali3 import html
from mbs.vehicle.kinematics.car_kinematics import Kinematics
from mbs.vehicle.kinematics.compliance import Compliance
from mbs.vehicle.kinematics.compliance_table import rows as compliance_rows
from mbs.vehicle.kinematics.plots import steer_figure, travel_figure
from mbs.vehicle.kinematics.table import rows

if TYPE_CHECKING:
    from matplotlib.figure import Figure

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 90em; padding: 0 1em; color: #222; }
table { border-collapse: collapse; } td, th { padding: 0.15em 0.8em; text-align: right; }
td:first-child, td:nth-child(n+4), th { text-align: left; } th { padding-top: 0.8em; }
tr td { border-top: 1px solid #e3e3e3; } img { width: 100%; margin-top: 2em; } td:last-child { color: #666; }
"""


def page(found: Kinematics, gives: Compliance) -> str:
    """The page as text; it needs no other file.

    Parameters
    ----------
    found : Kinematics
        Of a car.
    gives : Compliance
        Of the same car.
    """
    title = f"Kinematics of the car '{found.car}'"
    lines = [
        f"<h1>{escape(title)}</h1>",
        "<p>The chassis is held, rigid; the wheel centres move. Terms of ISO 8855: x forward, y left, z up.</p>",
        *(f"<p>{escape(text)}</p>" for text in (*found.notes, gives.sentence) if text),
        "<table><tr><td></td><td>front</td><td>rear</td><td></td><td></td></tr>",
    ]
    for line in (*rows(found), *compliance_rows(gives)):
        if not any(line[1:]):
            lines.append(f'<tr><th colspan="5">{escape(line[0])}</th></tr>')
        else:
            lines.append("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in line) + "</tr>")
    lines.append("</table>")
    for figure in (travel_figure(found, "front"), travel_figure(found, "rear"), steer_figure(found)):
        words = escape(figure.get_suptitle())
        lines.append(f'<img alt="{words}" src="data:image/png;base64,{_png(figure)}">')
    return html.page(title, "\n".join(lines), STYLE)


def _png(figure: Figure) -> str:
    out = io.BytesIO()
    figure.savefig(out, format="png", dpi=110)
    return base64.b64encode(out.getvalue()).decode()
