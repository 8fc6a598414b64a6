/* clang-format off */
/* Numbers of a lift. Written by `python -m mbs.elements.fields_in_c` from Lift. */
/* Signals: point (2 or 3), forward (2 or 3), up (2 or 3). */
/* Outputs: force (N), lift, positive along the upward axis */
#ifndef ALI3_LIFT_FIELDS_H
#define ALI3_LIFT_FIELDS_H
#include "element.h"

enum {
  /* Lift coefficient times frontal area, m^2; a negative one gives downforce. */
  LIFT_AREA,
  /* kg/m^3. */
  AIR_DENSITY,
  LIFT_REALS
};
#ifndef ALI3_WIDTH
static const ali3_field lift_fields[LIFT_REALS] = {
  {ALI3_IS_ANY, ""},
  {ALI3_IS_NOT_NEGATIVE, "the air density of a lift must not be negative"},
};
#define ALI3_LIFT .fields = lift_fields, .nfields = LIFT_REALS, \
  .nsig = -1, .nreal = LIFT_REALS, .nstate = 0, .nout = 1
#endif
#endif
