"""What was understood of a file, in the terms of the field: one table of quantities, one comparison, one sentence.

A reader gives an `Echo`: values of its quantities of the table (`quantities.csv`, a line each), each with the keys that
it follows from, and the common mistakes of its kind of file with what the values are without each. `Echo.warnings`
compares, `Echo.text` prints. What a reader returns is `Understood`: its `summary()` is the table.
"""

from ali3.plausibility.quantity import WIDEST, Quantity, Range, quantities_of
from ali3.plausibility.range_check import Echo, Mistake, Value, far_values
from ali3.plausibility.summary import Understood, echo_of, summary_of, tables_of

__all__ = [
    "WIDEST",
    "Echo",
    "Mistake",
    "Quantity",
    "Range",
    "Understood",
    "Value",
    "echo_of",
    "far_values",
    "quantities_of",
    "summary_of",
    "tables_of",
]
