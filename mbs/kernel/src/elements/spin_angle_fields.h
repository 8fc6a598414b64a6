/* clang-format off */
/* Numbers of an angle of a spinning wheel. Written by `python -m mbs.elements.fields_in_c` from SpinAngle. */
/* Signals: f (3), g (3), spin (1). */
/* Outputs: angle (rad), angle of the wheel on its carrier since the start */
#ifndef ALI3_SPIN_ANGLE_FIELDS_H
#define ALI3_SPIN_ANGLE_FIELDS_H
#include "element.h"

#ifndef ALI3_WIDTH
#define ALI3_SPIN_ANGLE \
  .nsig = 7, .nstate = 7, .nout = 1
#endif
#endif
