/* clang-format off */
/* Numbers of a spin torque. Written by `python -m mbs.elements.fields_in_c` from SpinTorque. */
/* Signals: f (3), g (3), spin (1). */
/* Outputs: torque (N m), torque on the wheel about the axis; power (W), power of the torque on wheel and carrier
 * together */
#ifndef ALI3_SPIN_TORQUE_FIELDS_H
#define ALI3_SPIN_TORQUE_FIELDS_H
#include "element.h"

enum {
  /* Torque on the wheel about its axis per unit of the input, N m. */
  GAIN,
  SPIN_TORQUE_REALS
};
#ifndef ALI3_WIDTH
static const ali3_field spin_torque_fields[SPIN_TORQUE_REALS] = {
  {ALI3_IS_ANY, ""},
};
#define ALI3_SPIN_TORQUE .fields = spin_torque_fields, .nfields = SPIN_TORQUE_REALS, \
  .nsig = 7, .nreal = SPIN_TORQUE_REALS, .nstate = 0, .nout = 2
#endif
#endif
