"""Inputs of the driver of a car."""

from mbs.model.model import Model
from mbs.model.records import Input
from mbs.vehicle.ports import Ports


def driver_inputs(m: Model, ports: Ports) -> dict[str, Input]:
    """Add the inputs of the driver, except for parts that ports replace; return them by name."""
    inputs = {}
    if ports.steering != "rack_position":
        inputs["steering"] = m.input("steering", min=-1.0, max=1.0, description="steering, positive to the left")
    if ports.torque is None:
        inputs["throttle"] = m.input("throttle", min=0.0, max=1.0, description="throttle pedal")
    if ports.brakes is None:
        inputs["brake"] = m.input("brake", min=0.0, max=1.0, description="brake pedal")
    text = "hand brake on the rear wheels"
    inputs["hand_brake"] = m.input("hand_brake", min=0.0, max=1.0, description=text)
    if ports.torque is None:
        text = "selector: -1 reverse, 0 neutral, 1 drive"
        inputs["selector"] = m.input("selector", start=1.0, min=-1.0, max=1.0, description=text, whole=True)
    return inputs
