"""Strain gauges of a flexible chassis, one file a kind: on tubes, or on the nodes of matrices."""

from typing import Annotated

from pydantic import Field

from mbs.vehicle.chassis.gauges.node_pair import NodePair
from mbs.vehicle.chassis.gauges.recovery_rows import RecoveryRows

MatrixGauge = Annotated[NodePair | RecoveryRows, Field(discriminator="kind")]
"""A gauge of a frame that comes as matrices."""

__all__ = ["MatrixGauge"]
