"""From a model to its scene: frames, shapes, arrows and roads."""

from typing import TYPE_CHECKING

from mbs.common.lazy_modules import lazy_modules

if TYPE_CHECKING:
    from mbs.shapes import pose_outputs as pose_outputs

__getattr__ = lazy_modules(__name__, ("pose_outputs",))
