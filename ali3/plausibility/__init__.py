"""Plausibility of files: quantities of their content are compared with usual ranges of the field.

A reader makes a `Plausibility`: values of quantities of the table `quantities.csv`, each with the keys that it follows
from, and common mistakes of the kind of file, each with the values without it. `Plausibility.warnings` compares the
values with the ranges, `Plausibility.text` prints them. The object that a reader returns is `Summarised`.
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
