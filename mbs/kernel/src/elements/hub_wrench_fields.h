/* clang-format off */
/* Numbers of a wrench. Written by `python -m mbs.elements.fields_in_c` from HubWrench. */
/* Signals: centre (3), axis (3), spin (1). */
#ifndef ALI3_HUB_WRENCH_FIELDS_H
#define ALI3_HUB_WRENCH_FIELDS_H
#include "element.h"

enum {
  /* Index of an entry of the inputs. */
  FORCE_X,
  /* Index of an entry of the inputs. */
  FORCE_Y,
  /* Index of an entry of the inputs. */
  FORCE_Z,
  /* Index of an entry of the inputs. */
  MOMENT_X,
  /* Index of an entry of the inputs. */
  MOMENT_Y,
  /* Index of an entry of the inputs. */
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
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "an entry of the inputs of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "an entry of the inputs of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "an entry of the inputs of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "an entry of the inputs of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "an entry of the inputs of a wrench names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "an entry of the inputs of a wrench names an input that does not exist"},
};
#define ALI3_HUB_WRENCH \
  .nsig = 7, .nint = 6, .nout = 1, .integers = hub_wrench_integers, .nintegers = HUB_WRENCH_INTEGERS
#endif
#endif
