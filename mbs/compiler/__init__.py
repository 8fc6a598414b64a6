"""From a model to a System: elimination, rows, elimination order, tables."""
