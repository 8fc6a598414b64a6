"""Why a library does not read a file, in a sentence."""

from ali3.words import one_line


def reader_stops(error: Exception) -> str:
    """The end of a sentence: what a library raises on a damaged file is often none."""
    words = (str(error).strip() or repr(error)).splitlines()[0].rstrip(".!")
    return f"it is damaged or of another format; its reader stops with '{one_line(words)}'."
