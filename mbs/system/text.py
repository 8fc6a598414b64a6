"""Text of `print(system)`: sizes, rank and degrees of freedom, non-zeros, notes on the model."""

from collections.abc import Mapping
from typing import Any


def system_text(name: str, dimension: int, report: dict[str, Any]) -> str:
    """Summary of a System, several lines; `report`: entry of `System.meta`."""
    rank, dofs = report["rank"], report["degrees_of_freedom"]
    space = "planar" if dimension == 2 else "spatial"
    immobile = "   (nothing can move)" if dofs == 0 else ""
    source = "stated" if report["length_stated"] else "extent of the drawing"
    redundant, fronts = report["redundant_equations"], f"{report['fronts']} fronts, largest {report['largest_front']}"
    lines = [
        f"System '{name}' ({space})",
        f"  bodies                {report['bodies']:>8}",
        f"  full coordinates      {report['full_coordinates']:>8}",
        f"  linear equations      {report['linear_equations']:>8}   ({redundant} of them redundant)",
        f"  coordinates           {report['coordinates']:>8}",
        f"  rows                  {report['rows']:>8}   ({report['dependent_rows']} dependent ones removed)",
        f"  rank at reference     {'not computed' if rank is None else rank:>8}",
        f"  degrees of freedom    {'not computed' if dofs is None else dofs:>8}{immobile}",
        f"  non-zeros of tangent  {report['tangent_nonzeros']:>8}   (lower triangle)",
        f"  non-zeros of factor   {report['factor_nonzeros']:>8}   ({fronts})",
        f"  force elements        {report['elements']:>8}",
        f"  length, m             {report['length']:>8.4g}   ({source}; tolerances are relative to it)",
        f"  inputs, sensors       {report['inputs']:>8}, {report['sensors']}",
    ]
    if report.get("closed"):
        lines.append(f"  closed by least squares        {_correction_text(report['closed'])}")
    lines += [f"  {message}" for key in ("locked", "contradiction") if (message := report.get(key))]
    return "\n".join(lines)


def model_notices(meta: Mapping[str, Any]) -> list[str]:
    """Notes on a model from its metadata: that it or parts of it cannot move, or that initial velocities contradict
    each other.
    """
    report = meta["report"]
    notices = [report.get("locked"), report.get("contradiction")]
    if report.get("degrees_of_freedom") == 0 and not meta["guides"] and not meta["switches"]:
        notices.insert(0, f"Nothing moves: the joints of {meta['name']!r} leave no freedom.")
    return list(filter(None, notices))


def _correction_text(corrections: Mapping[str, tuple[float, float]]) -> str:
    """Line with the largest correction of a joint of overconstrained loops; `corrections`: m and rad by joint."""
    name = max(corrections, key=lambda n: max(corrections[n]))
    distance, angle = corrections[name]
    return f"joint '{name}' closes by {distance:.2g} m, {angle:.2g} rad, the largest of {len(corrections)} corrections"
