"""The entry of a limit in a TOML file."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator


class LimitEntry(BaseModel):
    """Least and largest value of a measure; a list of two numbers stands for both."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    min: FiniteFloat | None = Field(default=None, title="a number, the least value")
    max: FiniteFloat | None = Field(default=None, title="a number, the largest value")
    unit: str | None = Field(default=None, title="the unit of these numbers, as text; default: that of the measure")

    @model_validator(mode="before")
    @classmethod
    def _as_table(cls, entry: object) -> object:
        if isinstance(entry, list) and len(entry) != 2:
            raise ValueError(f"it is a list of {len(entry)}; a list has the least and the largest value")
        if not isinstance(entry, (list, dict)):
            raise ValueError(f"it is {entry}; it must be a table with min or max, or a list of both")
        return dict(zip(("min", "max"), entry, strict=True)) if isinstance(entry, list) else entry

    @model_validator(mode="after")
    def _check_order(self) -> LimitEntry:
        if self.min is None and self.max is None:
            raise ValueError("it needs min or max, or both")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"its limits are {self.min:g} and {self.max:g}; the lower one comes first")
        return self
