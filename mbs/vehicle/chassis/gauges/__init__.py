"""Strain gauges of a flexible chassis: on tubes, or on the nodes of matrices."""
