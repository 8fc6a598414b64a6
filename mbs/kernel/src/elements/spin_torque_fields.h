/* clang-format off */
/* Numbers of a spin torque. Written by `python -m mbs.elements.fields_in_c` from SpinTorque. */
/* Signals: f (3), g (3), spin (1). */
#ifndef ALI3_SPIN_TORQUE_FIELDS_H
#define ALI3_SPIN_TORQUE_FIELDS_H
#include "element.h"

enum {
  /* Torque on the wheel about its axis per unit of the input, N m. */
  GAIN,
  SPIN_TORQUE_REALS
};
enum {
  /* Index of the input. */
  INPUT,
  SPIN_TORQUE_INTEGERS
};
enum {
  /* Torque on the wheel about the axis, N m. */
  SPIN_TORQUE_OUT_TORQUE,
  /* Power of the torque on wheel and carrier together, W. */
  SPIN_TORQUE_OUT_POWER,
  SPIN_TORQUE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field spin_torque_fields[] = {
  {ALI3_IS_ANY, ""},
};
static const ali3_integer spin_torque_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the input of a spin torque names an input that does not exist"},
};
#define ALI3_SPIN_TORQUE \
  .nsig = 7, .nreal = 1, .nint = 1, .nout = 2, .fields = spin_torque_fields, .nfields = 1, \
  .integers = spin_torque_integers, .nintegers = SPIN_TORQUE_INTEGERS
#endif
#endif
