"""Types of the names and texts that a user chooses in a car file."""

from typing import Annotated

from pydantic import Field

_NAME = r"^[A-Za-z][A-Za-z0-9_]*$"
_CAR_NAME = r"^[a-z][a-z0-9_]*$"
_LINE = r"^[^\x00-\x1f\x7f]+$"
PATTERN_WORDS = {
    _NAME: "letters, digits and underscores, a letter first",
    _CAR_NAME: "lower-case letters, digits and underscores, a letter first",
    _LINE: "one line of text, not empty, without control characters",
}
"""What each pattern allows, for messages."""
_MAX_NAME_LENGTH = 40
Name = Annotated[str, Field(pattern=_NAME, max_length=_MAX_NAME_LENGTH)]
"""Name of a part of the car; it becomes part of variable names."""
NAME_WORDS = f"up to {_MAX_NAME_LENGTH} {PATTERN_WORDS[_NAME]}"
"""What `Name` allows, for messages."""
CarName = Annotated[str, Field(pattern=_CAR_NAME, max_length=_MAX_NAME_LENGTH)]
"""Name of a car, also used as a file name."""
Text = Annotated[str, Field(pattern=_LINE, max_length=500)]
"""A line of text."""
