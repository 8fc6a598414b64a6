"""Tables of `docs/scale.md` from measurements of studies."""

from collections.abc import Sequence
from typing import Any

from benchmarks.shared.pages import Row, table


def study_blocks(rows: Sequence[Row]) -> dict[str, str]:
    """Tables by the names of their marks, of the measured parts."""
    results: dict[str, str] = {}
    runs = [r for r in rows if r["table"] == "runs"]
    car, spring = ([r for r in runs if r["case"] == case] for case in ("car", "spring"))
    if car:
        columns = {"workers": "d", "runs": ",d", "run, s": ".4f", "runs/s": ".2f", "chunks": ",d"}
        columns |= {"overhead, ms/run": ".2f", "overhead": ".2%", "bytes/run": ".0f", "parts": "d", "failed": "d"}
        loop = next((r for r in rows if r["table"] == "loop"), None)
        alone = f"\n\nThe same runs in a plain loop without Dask take {loop['run_s']:.4f} s each." if loop else ""
        results["study overhead"] = table(car, columns) + alone
    if spring:
        columns = {"runs": ",d", "main before, MB": ".0f", "main at most, MB": ".0f", "main, ms/run": ".3f"}
        columns |= {"worker, MB": ".0f", "bytes/run": ".0f", "parts": "d", "start again, s": ".1f"}
        again = {r["runs"]: r["start_s"] for r in rows if r["table"] == "start again"}
        results["study memory"] = table([r | {"start again, s": again.get(r["runs"])} for r in spring], columns)
    single = _single(rows)
    if single:
        results["study single"] = table(
            single, {"what": "", "number": ",d", "ms each": ".4f", "in all, s": ".2f", "MB": ".0f"}
        )
    return results


def _single(rows: Sequence[Row]) -> list[dict[str, Any]]:
    results = []
    for r in rows:
        if r["table"] == "plan":
            line = {"what": f"plan, {r['method'].replace('_', ' ')}", "number": r["runs"], "ms each": r["main_ms"]}
            results.append(line | {"in all, s": r["start_s"], "MB": r["main_mb"]})
        elif r["table"] == "rows":
            number, written = r["runs"], 1e-3 * r["main_ms"] * r["runs"]
            results.append({"what": "rows written", "number": number, "ms each": r["main_ms"], "in all, s": written})
            seconds = r["found_s"]
            results.append(
                {"what": "rows found", "number": number, "ms each": 1e3 * seconds / number, "in all, s": seconds}
            )
            line = {"what": "rows opened by pandas", "number": number, "ms each": 1e3 * r["read_s"] / number}
            results.append(line | {"in all, s": r["read_s"], "MB": r["read_mb"]})
        elif r["table"] == "empty tasks":
            line = {"what": "empty tasks, client and scheduler", "number": r["runs"], "ms each": r["main_ms"]}
            results.append(line | {"in all, s": r["elapsed_s"]})
    return results
