/* clang-format off */
/* Numbers of a lift. Written by `python -m mbs.elements.fields_in_c` from Lift. */
/* Signals: point (3 or 2), forward (3 or 2), up (3 or 2). */
#ifndef ALI3_LIFT_FIELDS_H
#define ALI3_LIFT_FIELDS_H
#include "element.h"

enum {
  /* Lift coefficient times frontal area, m^2; a negative one gives downforce. */
  LIFT_AREA,
  /* Density of the air, kg/m^3. */
  AIR_DENSITY,
  LIFT_REALS
};
enum {
  /* Index of an input, the speed of the air. */
  WIND_SPEED,
  /* Index of an input, the heading of the air. */
  WIND_HEADING,
  LIFT_INTEGERS
};
enum {
  /* Lift, positive along the upward axis, N. */
  LIFT_OUT_FORCE,
  LIFT_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field lift_fields[] = {
  {ALI3_IS_ANY, ""},
  {ALI3_IS_NOT_NEGATIVE, "the air density of a lift must not be negative"},
};
static const ali3_integer lift_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the speed of the air of a lift names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the heading of the air of a lift names an input that does not exist"},
};
#define ALI3_LIFT \
  .nsig = 9, .nsig_plane = 6, .nreal = 2, .nout = 1, .fields = lift_fields, .nfields = 2, \
  .integers = lift_integers, .nintegers = LIFT_INTEGERS
#endif
#endif
