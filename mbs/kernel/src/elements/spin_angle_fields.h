/* clang-format off */
/* Numbers of an angle of a spinning wheel. Written by `python -m mbs.elements.fields_in_c` from SpinAngle. */
/* Signals: f (3), g (3), spin (1). */
#ifndef ALI3_SPIN_ANGLE_FIELDS_H
#define ALI3_SPIN_ANGLE_FIELDS_H
#include "element.h"

enum {
  /* Angle of the wheel on its carrier since the start, rad. */
  SPIN_ANGLE_OUT_ANGLE,
  SPIN_ANGLE_OUTPUTS
};
#ifndef ALI3_WIDTH
#define ALI3_SPIN_ANGLE \
  .nsig = 7, .nstate = 7, .nout = 1
#endif
#endif
