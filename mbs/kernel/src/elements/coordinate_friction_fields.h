/* clang-format off */
/* Numbers of a friction. Written by `python -m mbs.elements.fields_in_c` from CoordinateFriction. */
/* Signals: coordinate (1). */
#ifndef ALI3_COORDINATE_FRICTION_FIELDS_H
#define ALI3_COORDINATE_FRICTION_FIELDS_H
#include "element.h"

enum {
  /* Force at which it slides, N m of an angle, N of a length. */
  LARGEST,
  /* While it holds, N m/rad or N/m. */
  STICK_STIFFNESS,
  /* While it holds, N m s/rad or N s/m. */
  STICK_DAMPING,
  COORDINATE_FRICTION_REALS
};
enum {
  /* Friction on the coordinate, N m. */
  COORDINATE_FRICTION_OUT_FORCE,
  /* 1 while it sticks, else 0. */
  COORDINATE_FRICTION_OUT_STICKING,
  COORDINATE_FRICTION_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field coordinate_friction_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the largest force of a friction must not be negative"},
  {ALI3_IS_POSITIVE, "the stick stiffness of a friction must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stick damping of a friction must be greater than zero"},
};
#define ALI3_COORDINATE_FRICTION \
  .nsig = 1, .nreal = 3, .nstate = 2, .nout = 2, .fields = coordinate_friction_fields, .nfields = 3
#endif
#endif
