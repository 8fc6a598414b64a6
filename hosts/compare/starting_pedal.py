"""The pedal with which a driver starts who holds a measured speed."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from hosts.compare.log import Signal
from hosts.compare.replay import Replay
from hosts.driving.manoeuvre import Manoeuvre
from hosts.fmu.aliases.alias import Aliases

_AHEAD = 0.5  # s, until when the speed is met
_CLOSE = 0.005  # of the pedal


def starting_pedal(path: Path, aliases: Aliases, manoeuvre: Manoeuvre, step: float, speed: Signal) -> float:
    """The constant pedal with which the FMU has the measured speed half a second after the start.

    Parameters
    ----------
    path : Path
        FMU.
    manoeuvre : Manoeuvre
        Without the pedals.
    step : float
        Communication step, s.
    speed : Signal
        From time 0 on.

    Returns
    -------
    float
        Throttle; negative: brake. 1 or -1 where that is not enough.
    """
    short = replace(manoeuvre, stop_time=max(step, min(_AHEAD, manoeuvre.stop_time)))
    with Replay(path, aliases, short, step) as replay:

        def excess(pedal: float) -> float:
            result = replay.run({"throttle": max(pedal, 0.0), "brake": max(-pedal, 0.0)})
            return float(result["speed"][-1] - np.interp(result.time[-1], speed.time, speed.values))

        rolling = excess(0.0)
        end = -1.0 if rolling > 0.0 else 1.0
        if rolling == 0.0 or not rolling * excess(end) < 0.0:
            return 0.0 if rolling == 0.0 else end
        return float(brentq(excess, min(0.0, end), max(0.0, end), xtol=_CLOSE))
