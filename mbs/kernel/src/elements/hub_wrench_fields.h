/* clang-format off */
/* Numbers of a wrench. Written by `python -m mbs.elements.fields_in_c` from HubWrench. */
/* Signals: centre (3), axis (3), spin (1). */
#ifndef ALI3_HUB_WRENCH_FIELDS_H
#define ALI3_HUB_WRENCH_FIELDS_H
#include "element.h"

enum {
  /* Index of the force x input. */
  FORCE_X,
  /* Index of the force y input. */
  FORCE_Y,
  /* Index of the force z input. */
  FORCE_Z,
  /* Index of the moment x input. */
  MOMENT_X,
  /* Index of the moment y input. */
  MOMENT_Y,
  /* Index of the moment z input. */
  MOMENT_Z,
  HUB_WRENCH_INTEGERS
};
enum {
  /* Power of force and moment on wheel and carrier together, W. */
  HUB_WRENCH_OUT_POWER,
  HUB_WRENCH_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_integer hub_wrench_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the force x input of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the force y input of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the force z input of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the moment x input of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the moment y input of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the moment z input of a wrench names an input that does not exist"},
};
#define ALI3_HUB_WRENCH \
  .nsig = 7, .nint = 6, .nout = 1, .integers = hub_wrench_integers, .nintegers = HUB_WRENCH_INTEGERS
#endif
#endif
