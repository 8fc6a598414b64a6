/* clang-format off */
/* Numbers of a torque. Written by `python -m mbs.elements.fields_in_c` from BodyTorque. */
/* Signals: frame (9 or 2). */
#ifndef ALI3_BODY_TORQUE_FIELDS_H
#define ALI3_BODY_TORQUE_FIELDS_H
#include "element.h"

enum {
  /* Index of the first input, -1: none. */
  FIRST,
  /* Index of the second input, -1: none. */
  SECOND,
  /* Index of the third input, -1: none. */
  THIRD,
  /* The axes. */
  AXES,
  BODY_TORQUE_INTEGERS
};
#ifndef ALI3_WIDTH
static const ali3_integer body_torque_integers[] = {
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the first input of a torque names an input that does not exist"},
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the second input of a torque names an input that does not exist"},
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the third input of a torque names an input that does not exist"},
  {ALI3_OF_NUMBERS, 0, 1, 0, 0, "the axes of a torque must be 0 or 1"},
};
#define ALI3_BODY_TORQUE \
  .nsig = 9, .nsig_plane = 2, .nint = 4, .integers = body_torque_integers, \
  .nintegers = BODY_TORQUE_INTEGERS
#endif
#endif
