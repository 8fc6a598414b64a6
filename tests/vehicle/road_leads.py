"""The table of where a road in another program is best asked for.

python -m tests.vehicle.road_leads
"""

from __future__ import annotations

from tests.vehicle.test_road_port import Waves, drive

if __name__ == "__main__":
    print("| car | waves | speed, m/s | at its start | in its middle | at its end |")
    print("| --- | --- | --- | --- | --- | --- |")
    for car in ("hatchback", "prototype"):
        for length, high in ((1.0, 0.008), (2.0, 0.03), (5.0, 0.08)):
            for speed in (10.0, 25.0, 40.0):
                waves = Waves(car, length, 0.5 * high)
                found = [drive(0.002, "in turn", lead, speed, waves)["load"] for lead in (0.0, 0.5, 1.0)]
                cells = " | ".join(f"{100.0 * load:.2g} %" for load in found)
                print(f"| {car} | {1e3 * high:g} mm, {length:g} m | {speed:g} | {cells} |", flush=True)
