"""The scene of an FMU, `resources/geometry.json`: the drawing of its model, moved by the FMU's own variables."""
