"""The text of a page that runs FMUs, beside recordings that go along."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from ali3.scene.recording import Recording
from hosts.common.errors import HostError
from hosts.driving.manoeuvre import Manoeuvre
from hosts.view.page_parts import FmuParts, packed
from viewer.html_document import html_document
from viewer.page_data import page_data


@dataclass(frozen=True)
class Page:
    """The content of a page."""

    fmus: Sequence[FmuParts]
    """Each with its binary; they run in step, with the same inputs."""
    names: Sequence[str]
    options: Mapping[str, Any] = field(default_factory=dict)
    """Of the page: ``name`` of what it records, ``run`` at once, ``start`` values, ``step``, ``plots``."""
    manoeuvre: Manoeuvre | None = None
    """Inputs over time, which a person may take over."""
    recordings: Sequence[Recording] = ()
    """Drawn beside the FMUs at the same time."""
    ends: Sequence[str] = ()
    """What is said when a recording is over, one for each."""

    def text(self, title: str) -> str:
        """The HTML file. Raises `ViewerError`: the script of the viewer is not there and cannot be built."""
        data: dict[str, Any] = {
            "fmus": [fmu.record(name) for fmu, name in zip(self.fmus, self.names, strict=True)],
            "options": dict(self.options),
        }
        if self.manoeuvre is not None:
            data["script"] = packed(json.dumps(script_of(self.manoeuvre)).encode())
        if self.recordings:
            data["beside"] = page_data([recording.thinned() for recording in self.recordings], {})
            data["ends"] = list(self.ends)
        return html_document(title, data, "ALi3Viewer.drive")


def script_of(manoeuvre: Manoeuvre) -> dict[str, Any]:
    """Inputs over time as the page reads them.

    Raises `HostError`: the manoeuvre has a driver: he cannot sit in a page.
    """
    if manoeuvre.driver:
        raise HostError(
            f"The manoeuvre {manoeuvre.name} has a driver, who steers by what the car does; in a page a person drives. "
            "Give a table of inputs."
        )
    columns = {name: values.tolist() for name, values in manoeuvre.inputs.items()}
    return {"t": manoeuvre.time.tolist(), "columns": columns}
