/* clang-format off */
/* Numbers of a drive. Written by `python -m mbs.elements.fields_in_c` from ElectricDrive. */
/* Signals: left (1), right (1), f (3), g (3). */
#ifndef ALI3_ELECTRIC_DRIVE_FIELDS_H
#define ALI3_ELECTRIC_DRIVE_FIELDS_H
#include "element.h"

enum {
  /* Largest torque of the motor, N m. */
  MAX_TORQUE,
  /* Largest power of the motor at its shaft, W. */
  MAX_POWER,
  /* Ratio of the speed of the motor to the mean speed of the wheels. */
  RATIO,
  /* Speed of the motor beyond which its torque fades to zero within 5 %, rad/s. */
  LIMIT_SPEED,
  /* Efficiency between battery and shaft of the motor, both ways. */
  EFFICIENCY,
  /* Efficiency between shaft and wheels, both ways. */
  GEAR_EFFICIENCY,
  /* Torque of the motor that brakes with closed throttle, N m. */
  REGENERATION_TORQUE,
  /* Largest power of regeneration, W. */
  REGENERATION_POWER,
  /* Speed of the motor below which regeneration fades, so that the car rests, rad/s. */
  REGENERATION_SPEED,
  /* Part of the largest torque available in reverse, a ratio. */
  REVERSE_TORQUE,
  /* Speed of the motor beyond which its torque fades in reverse, rad/s. */
  REVERSE_SPEED,
  /* Mean speed of the wheels up to which a direction against their motion engages, rad/s; beyond, the drive stays in
   * neutral. */
  ENGAGE_SPEED,
  /* Time in which the torque fades out and in when the selector moves, s. */
  ENGAGE_TIME,
  ELECTRIC_DRIVE_REALS
};
enum {
  /* Index of the input. */
  THROTTLE,
  /* Index of an input, the selector. */
  SELECTOR,
  ELECTRIC_DRIVE_INTEGERS
};
enum {
  /* Speed of the motor, rad/s. */
  ELECTRIC_DRIVE_OUT_MOTOR_SPEED,
  /* Torque of the motor, N m. */
  ELECTRIC_DRIVE_OUT_MOTOR_TORQUE,
  /* Torque on each of the two wheels, N m. */
  ELECTRIC_DRIVE_OUT_WHEEL_TORQUE,
  /* Power from the battery, negative in regeneration, W. */
  ELECTRIC_DRIVE_OUT_ELECTRIC_POWER,
  /* Direction engaged: -1 reverse, 0 neutral, 1 drive. */
  ELECTRIC_DRIVE_OUT_GEAR,
  /* Power on the left wheel, W. */
  ELECTRIC_DRIVE_OUT_LEFT_POWER,
  /* Power on the right wheel, W. */
  ELECTRIC_DRIVE_OUT_RIGHT_POWER,
  ELECTRIC_DRIVE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field electric_drive_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the max torque of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the max power of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the ratio of a drive must be greater than zero"},
  {ALI3_IS_POSITIVE, "the limit speed of a drive must be greater than zero"},
  {ALI3_IS_SHARE, "the efficiency of a drive must be above 0 and at most 1"},
  {ALI3_IS_SHARE, "the gear efficiency of a drive must be above 0 and at most 1"},
  {ALI3_IS_NOT_NEGATIVE, "the regeneration torque of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the regeneration power of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the regeneration speed of a drive must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the reverse torque of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the reverse speed of a drive must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the engage speed of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the engage time of a drive must be greater than zero"},
};
static const ali3_integer electric_drive_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the input of a drive names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the selector of a drive names an input that does not exist"},
};
#define ALI3_ELECTRIC_DRIVE \
  .nsig = 8, .nreal = 13, .nint = 1, .nstate_more = 2, .nout = 7, .fields = electric_drive_fields, \
  .nfields = 13, .integers = electric_drive_integers, .nintegers = ELECTRIC_DRIVE_INTEGERS
#endif
#endif
