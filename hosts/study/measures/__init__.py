"""Numbers of a run: expressions of its signals, and functions of the user's."""

from hosts.study.measures.parse import StudyMeasure, parse_measure

__all__ = ["StudyMeasure", "parse_measure"]
