"""Steady-state circular driving to both sides, after ISO 4138: steering over lateral acceleration."""

from hosts.catalogue.circle_run import CircleRun, drive_circle
from hosts.catalogue.measure_sheet import Sheet
from hosts.catalogue.steering import steering_ratio


def drive(sheet: Sheet) -> None:
    """Measure the steering ratio in a slow drive, then drive circles to both sides at increasing acceleration."""
    ratio = steering_ratio(sheet.car)
    sheet.progress(0.04)
    runs: dict[str, CircleRun] = {}
    for k, (side, sign) in enumerate((("left", 1.0), ("right", -1.0))):
        runs[side] = drive_circle(
            sheet.car,
            sign,
            sheet.settings,
            ratio,
            lambda done, k=k: sheet.progress(0.04 + 0.48 * (k + done)),  # type: ignore[misc]
        )
        sheet.runs[side] = runs[side].result
    left, right = ({"side": side, "sign": 1.0 if side == "left" else -1.0, "run": run} for side, run in runs.items())
    sheet.add("circle", ratio=ratio, left=left, right=right)
