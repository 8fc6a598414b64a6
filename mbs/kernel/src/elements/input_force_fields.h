/* clang-format off */
/* Numbers of an input force. Written by `python -m mbs.elements.fields_in_c` from InputForce. */
/* Signals: any number. */
#ifndef ALI3_INPUT_FORCE_FIELDS_H
#define ALI3_INPUT_FORCE_FIELDS_H
#include "element.h"

enum {
  /* Index of the input. */
  INPUT,
  INPUT_FORCE_INTEGERS
};
#ifndef ALI3_WIDTH
static const ali3_integer input_force_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the input of an input force names an input that does not exist"},
};
#define ALI3_INPUT_FORCE \
  .nsig = -1, .nreal = -1, .nint = 1, .integers = input_force_integers, \
  .nintegers = INPUT_FORCE_INTEGERS
#endif
#endif
