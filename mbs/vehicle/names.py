"""Names and texts that a user chooses in a car file."""

from typing import Annotated

from pydantic import Field

FORMS = {
    r"^[A-Za-z][A-Za-z0-9_]*$": "letters, digits and underscores, a letter first",
    r"^[a-z][a-z0-9_]*$": "lower-case letters, digits and underscores, a letter first",
    r"^[^\x00-\x1f\x7f]+$": "one line of text, not empty, without control characters",
}
"""Patterns of texts in words."""
_NAME, _CAR_NAME, _LINE = FORMS
Name = Annotated[str, Field(pattern=_NAME, max_length=40)]
"""Name of a thing that becomes part of the names of variables."""
NAME_WORDS = f"up to 40 {FORMS[_NAME]}"
CarName = Annotated[str, Field(pattern=_CAR_NAME, max_length=40)]
"""Name of a car, also for files."""
Text = Annotated[str, Field(pattern=_LINE, max_length=500)]
"""A line of text."""
