/* clang-format off */
/* Numbers of a force. Written by `python -m mbs.elements.fields_in_c` from BodyForce. */
/* Signals: point (3 or 2), axes (9 or 2). */
#ifndef ALI3_BODY_FORCE_FIELDS_H
#define ALI3_BODY_FORCE_FIELDS_H
#include "element.h"

enum {
  /* Index of the first input, -1: none. */
  FIRST,
  /* Index of the second input, -1: none. */
  SECOND,
  /* Index of the third input, -1: none. */
  THIRD,
  BODY_FORCE_INTEGERS
};
#ifndef ALI3_WIDTH
static const ali3_integer body_force_integers[] = {
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the first input of a force names an input that does not exist"},
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the second input of a force names an input that does not exist"},
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the third input of a force names an input that does not exist"},
};
#define ALI3_BODY_FORCE \
  .nsig = 12, .nsig_plane = 4, .nint = 3, .integers = body_force_integers, \
  .nintegers = BODY_FORCE_INTEGERS
#endif
#endif
