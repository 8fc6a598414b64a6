"""The text of a page that runs FMUs beside recordings."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

from ali3.scene.recording import Recording
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.view.page_parts import FmuParts, packed
from viewer.html_document import html_document
from viewer.page_data import page_data


def page_text(
    title: str,
    fmus: Sequence[tuple[str, FmuParts]],
    options: Mapping[str, Any],
    manoeuvre: Manoeuvre | None = None,
    recordings: Sequence[Recording] = (),
    ends: Sequence[str] = (),
) -> str:
    """The HTML file of a page. Raises `ViewerError`: the script of the viewer is not there and cannot be built.

    Parameters
    ----------
    fmus : sequence of (str, FmuParts)
        FMUs with their titles and binaries; they run in step, with the same inputs.
    options : mapping
        Of the page: ``name`` of what it records, ``run`` at once, ``start`` values, ``step``, ``plots``.
    manoeuvre : Manoeuvre, optional
        Inputs over time, until the user takes over.
    recordings : sequence of Recording
        Drawn beside the FMUs at the same time.
    ends : sequence of str
        Messages of the page at the end of each recording.
    """
    data: dict[str, Any] = {"fmus": [fmu.record(name) for name, fmu in fmus], "options": dict(options)}
    if manoeuvre is not None:
        data["script"] = packed(json.dumps(script_of(manoeuvre)).encode())
    if recordings:
        data["beside"] = page_data([recording.thinned() for recording in recordings], {})
        data["ends"] = list(ends)
    return html_document(title, data, "Drive")


def script_of(manoeuvre: Manoeuvre) -> dict[str, Any]:
    """Inputs over time as the page reads them.

    Raises `HostError`: the manoeuvre has a driver, whom a page does not have.
    """
    if manoeuvre.driver:
        raise HostError(
            f"The manoeuvre {manoeuvre.name} has a driver, who steers by what the car does; in a page a person drives. "
            "Give a table of inputs."
        )
    columns = {name: values.tolist() for name, values in manoeuvre.inputs.items()}
    return {"t": manoeuvre.time.tolist(), "columns": columns}
