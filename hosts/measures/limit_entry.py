"""A limit as a TOML file has it."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator


class LimitEntry(BaseModel):
    """What a measure must keep; a list of two numbers means its least and its largest value."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    min: FiniteFloat | None = Field(default=None, title="a number, the least value")
    max: FiniteFloat | None = Field(default=None, title="a number, the largest value")
    unit: str | None = Field(default=None, title="the unit of these numbers, as text; default: that of the measure")

    @model_validator(mode="before")
    @classmethod
    def _pair(cls, given: object) -> object:
        if isinstance(given, list) and len(given) != 2:
            raise ValueError(f"it is a list of {len(given)}; a list has the least and the largest value")
        if not isinstance(given, (list, dict)):
            raise ValueError(f"it is {given}; it must be a table with min or max, or a list of both")
        return dict(zip(("min", "max"), given, strict=True)) if isinstance(given, list) else given

    @model_validator(mode="after")
    def _fits(self) -> LimitEntry:
        if self.min is None and self.max is None:
            raise ValueError("it needs min or max, or both")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"its limits are {self.min:g} and {self.max:g}; the lower one comes first")
        return self
