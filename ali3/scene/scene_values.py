"""Types of single values in scenes: numbers, texts, vectors, arrays encoded as text."""

from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field

Number = Annotated[float, Field(strict=True, allow_inf_nan=False)]
Positive = Annotated[Number, Field(gt=0.0)]
Share = Annotated[Number, Field(ge=0.0, le=1.0)]
Whole = Annotated[int, Field(strict=True, ge=0, lt=2**32)]
Text = Annotated[str, Field(strict=True)]
# plain_names.js of the page has the same patterns.
NAME = r"^[^\u0000-\u001f<>\u007f-\u009f\u2028\u2029]*$"
UNIT = r"""^[^\u0000-\u001f"&'<>`\u007f-\u009f\u2028\u2029]{0,40}$"""
Title = Annotated[str, Field(strict=True, pattern=NAME)]
Name = Annotated[str, Field(strict=True, min_length=1, pattern=NAME)]
Unit = Annotated[str, Field(strict=True, pattern=UNIT)]
Vector = tuple[Number, Number, Number]
Quaternion = tuple[Number, Number, Number, Number]
Axes = tuple[Vector, Vector, Vector]
Names = tuple[Name, Name, Name]
Anchor = tuple[Name, Vector]
Floats = Annotated[str, Field(strict=True, description="base64 of float32, little-endian")]
Indices = Annotated[str, Field(strict=True, description="base64 of uint32, little-endian")]
Octets = Annotated[str, Field(strict=True, description="base64 of uint8")]
Color = Annotated[str, Field(strict=True, pattern=r"^#[0-9a-fA-F]{6}$")]
Material = Literal["steel", "paint", "dark_paint", "rubber", "rim", "glass", "plastic", "chrome"]


class Part(BaseModel):
    """A table of the scene: no other keys than its own."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)
