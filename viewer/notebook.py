"""Shows recordings in a notebook: the page in a frame of the output cell."""

import html
from collections.abc import Mapping, Sequence
from typing import Any

from ali3.scene.errors import ViewerError
from ali3.scene.recording import Recording
from viewer.page_file import notes_of, page_html, thinned


def html_of(
    recordings: Recording | Sequence[Recording],
    height: int = 480,
    options: Mapping[str, Any] | None = None,
) -> str:
    """HTML for ``_repr_html_`` of an object, which shows recordings in a notebook.

    Parameters
    ----------
    recordings : Recording or sequence of Recording
        See `viewer.page_file.write_page`.
    height : int
        Height of the frame, pixels.

    Returns
    -------
    str
        A frame that holds the whole page, and a line that says how large it is, since it is saved in the notebook.

    Raises
    ------
    ViewerError
        See `viewer.page_file.write_page`; or the height is not a whole number of pixels from 200 to 4000.
    """
    if not isinstance(height, int) or isinstance(height, bool) or not 200 <= height <= 4000:
        raise ViewerError(f"The height of the frame is {height!r}; it must be a whole number of pixels, 200 to 4000.")
    thinned_recordings = thinned(recordings)
    page = page_html(thinned_recordings, None, options)
    notes = [
        f"This animation takes {1e-6 * len(page.encode('utf-8')):.1f} MB of the notebook.",
        *notes_of(thinned_recordings),
    ]
    return (
        f'<iframe srcdoc="{html.escape(page, quote=True)}" style="width:100%;height:{height}px;border:0" '
        'allow="fullscreen" sandbox="allow-scripts allow-downloads"></iframe>'
        f'<div style="font-size:smaller;opacity:0.7">{html.escape(" ".join(notes))}</div>'
    )
