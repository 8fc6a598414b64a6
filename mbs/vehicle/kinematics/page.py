"""HTML page of a car's kinematics: table, notes and plots."""

from ali3.charts import drawing
from ali3.html_elements import document, element, picture, table
from mbs.vehicle.kinematics.axle_compliance import Compliance
from mbs.vehicle.kinematics.car_kinematics import Kinematics
from mbs.vehicle.kinematics.plots import steer_figure, travel_figure
from mbs.vehicle.kinematics.table import compliance_rows, rows


def page(kinematics: Kinematics, compliance: Compliance) -> str:
    """HTML text of the page, which needs no other file."""
    title = f"Kinematics of the car '{kinematics.car}'"
    parts = [
        element("h1", title),
        element("p", "The chassis is held, rigid; the wheel centres move. Terms of ISO 8855: x forward, y left, z up."),
        *(element("p", text) for text in (*kinematics.notes, compliance.sentence) if text),
        table(
            "",
            ("", "front", "rear", "unit", ""),
            (line if any(line[1:]) else line[:1] for line in (*rows(kinematics), *compliance_rows(compliance))),
        ),
    ]
    figures = [travel_figure(kinematics, axle) for axle, motion in kinematics.curves if motion == "parallel"]
    figures += [steer_figure(kinematics) for _, motion in kinematics.curves if motion == "steer"]
    for figure in figures:
        parts.append(picture(drawing(figure, figure.get_suptitle())))
    return document(title, parts)
