/* clang-format off */
/* Numbers of a brake. Written by `python -m mbs.elements.fields_in_c` from Brake. */
/* Signals: f (3), g (3), spin (1). */
#ifndef ALI3_BRAKE_FIELDS_H
#define ALI3_BRAKE_FIELDS_H
#include "element.h"

enum {
  /* Torque at full pedal, N m. */
  MAX_TORQUE,
  /* Stiffness of a standing brake about the wheel's axis, N m/rad. */
  STICK_STIFFNESS,
  /* Damping of a standing brake, N m s/rad. */
  STICK_DAMPING,
  /* Factor on max_torque, so that a total torque and a balance may be parameters. */
  SHARE,
  /* Torque at full hand brake, N m; the torque of the pedal is added to it. */
  HAND_TORQUE,
  /* Factor on the share, so that brakes that differ from left to right may be a parameter. */
  SIDE,
  BRAKE_REALS
};
enum {
  /* Index of the input. */
  PEDAL,
  /* Index of an input, the hand brake, -1: none. */
  HAND,
  /* The choice of a size as the input. */
  BY_SIZE,
  BRAKE_INTEGERS
};
enum {
  /* Torque of the brake on the wheel about the axis, N m. */
  BRAKE_OUT_TORQUE,
  /* 1 while the brake sticks, else 0. */
  BRAKE_OUT_STICKING,
  /* Spin of the wheel relative to its carrier, rad/s. */
  BRAKE_OUT_RATE,
  /* Power of the torque on wheel and carrier together, W. */
  BRAKE_OUT_POWER,
  BRAKE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field brake_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the max torque of a brake must not be negative"},
  {ALI3_IS_POSITIVE, "the stick stiffness of a brake must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stick damping of a brake must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the share of a brake must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the hand torque of a brake must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the side of a brake must not be negative"},
};
static const ali3_integer brake_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the input of a brake names an input that does not exist"},
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the hand brake of a brake names an input that does not exist"},
  {ALI3_OF_NUMBERS, 0, 1, 0, 0, "the choice of a size as the input of a brake must be 0 or 1"},
};
#define ALI3_BRAKE \
  .nsig = 7, .nreal = 6, .nint = 2, .nstate = 2, .nout = 4, .fields = brake_fields, .nfields = 6, \
  .integers = brake_integers, .nintegers = BRAKE_INTEGERS
#endif
#endif
