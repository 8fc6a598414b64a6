"""Plausibility of a file, in the terms of the field: one table of quantities, one comparison, one sentence.

A reader gives a `Plausibility`: values of its quantities of the table (`quantities.csv`, a line each), each with the
keys that it follows from, and the common mistakes of its kind of file with what the values are without each.
`Plausibility.warnings` compares, `Plausibility.text` prints. What a reader returns is `Summarised`: its `summary()` is
the table.
"""

from ali3.plausibility.quantity import WIDEST, Quantity, Range, quantities_of
from ali3.plausibility.range_check import Mistake, Plausibility, Value, far_values
from ali3.plausibility.summary import Summarised, plausibility_of, summary_of, tables_of

__all__ = [
    "WIDEST",
    "Mistake",
    "Plausibility",
    "Quantity",
    "Range",
    "Summarised",
    "Value",
    "far_values",
    "plausibility_of",
    "quantities_of",
    "summary_of",
    "tables_of",
]
