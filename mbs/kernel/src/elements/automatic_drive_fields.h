/* clang-format off */
/* Numbers of a drive. Written by `python -m mbs.elements.fields_in_c` from AutomaticDrive. */
/* Signals: left (1), right (1), f (3), g (3). */
#ifndef ALI3_AUTOMATIC_DRIVE_FIELDS_H
#define ALI3_AUTOMATIC_DRIVE_FIELDS_H
#include "element.h"

enum {
  /* Torque of the engine, N m; full torque is the lesser of it and of the power divided by the speed. */
  MAX_TORQUE,
  /* Power of the engine, W. */
  MAX_POWER,
  /* Efficiency of the driveline under power. */
  EFFICIENCY,
  /* Torque ratio of the converter at stall. */
  STALL_FACTOR,
  /* Speed ratio of the converter above which its torque ratio is 1. */
  COUPLING_RATIO,
  /* Engine speed at rest with closed throttle, rad/s. */
  IDLE_SPEED,
  /* Engine speed at rest with open throttle, rad/s. */
  STALL_SPEED,
  /* Engine speed at which the limiter sets in, rad/s. */
  LIMIT_SPEED,
  /* Torque per driven wheel at rest with closed throttle, the selector in drive, N m; 0: neutral. */
  CREEP_TORQUE,
  /* Wheel speed at which the creep torque has faded, rad/s. */
  CREEP_SPEED,
  /* Torque of the engine at its limit speed with closed throttle, N m. */
  DRAG_TORQUE,
  /* Speed of the turbine at which it shifts up with closed throttle, rad/s. */
  UP_CLOSED,
  /* Speed of the turbine at which it shifts up with open throttle, rad/s. */
  UP_OPEN,
  /* Speed of the turbine at which it shifts down with closed throttle, rad/s. */
  DOWN_CLOSED,
  /* Speed of the turbine at which it shifts down with open throttle, rad/s. */
  DOWN_OPEN,
  /* Least time between shifts, s. */
  DWELL,
  /* Duration of a shift, s. */
  RAMP,
  /* Share of the torque by which the slower driven wheel can have more than the faster; 0: open differential. */
  LOCKING,
  AUTOMATIC_DRIVE_REALS
};
enum {
  /* Total ratio of reverse. */
  REVERSE_RATIO = AUTOMATIC_DRIVE_REALS,
  /* Mean speed of the wheels up to which a direction against their motion engages, rad/s; beyond, the drive stays in
   * neutral. */
  ENGAGE_SPEED,
  /* Time in which the torque fades out of one direction, and into the other, s. */
  ENGAGE_TIME,
};
enum {
  /* Index of the input. */
  THROTTLE,
  /* Number of gears; numbers of each: total ratio. */
  GEARS,
  /* Index of an input, the selector. */
  SELECTOR,
  /* Index of an input, the request, -1: none. */
  REQUEST,
  /* Index of an input, the clutch. */
  CLUTCH,
  AUTOMATIC_DRIVE_INTEGERS
};
enum {
  /* Speed of the engine, rad/s. */
  AUTOMATIC_DRIVE_OUT_ENGINE_SPEED,
  /* Gear engaged. */
  AUTOMATIC_DRIVE_OUT_GEAR,
  /* Torque on each of the two wheels, the mean if the differential locks, N m. */
  AUTOMATIC_DRIVE_OUT_WHEEL_TORQUE,
  /* Torque of the engine, N m. */
  AUTOMATIC_DRIVE_OUT_ENGINE_TORQUE,
  /* Power on the left wheel, W. */
  AUTOMATIC_DRIVE_OUT_LEFT_POWER,
  /* Power on the right wheel, W. */
  AUTOMATIC_DRIVE_OUT_RIGHT_POWER,
  /* Torque on the left wheel, N m. */
  AUTOMATIC_DRIVE_OUT_LEFT_TORQUE,
  /* Torque on the right wheel, N m. */
  AUTOMATIC_DRIVE_OUT_RIGHT_TORQUE,
  AUTOMATIC_DRIVE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field automatic_drive_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the max torque of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the max power of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the efficiency of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the stall factor of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the coupling ratio of a drive must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the idle speed of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the stall speed of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the limit speed of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the creep torque of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the creep speed of a drive must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the drag torque of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the upshift speed with closed throttle of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the upshift speed with open throttle of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the downshift speed with closed throttle of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the downshift speed with open throttle of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the time between shifts of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the shift duration of a drive must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the locking share of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the reverse ratio of a drive must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the engage speed of a drive must not be negative"},
  {ALI3_IS_POSITIVE, "the engage time of a drive must be greater than zero"},
};
static const ali3_integer automatic_drive_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the input of a drive names an input that does not exist"},
  {ALI3_OF_NUMBERS, 1, INT32_MAX, 1, 0, "the gears of a drive must be at least 1"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the selector of a drive names an input that does not exist"},
  {ALI3_OF_INPUTS, -1, INT32_MAX, 0, 0, "the request of a drive names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the clutch of a drive names an input that does not exist"},
};
#define ALI3_AUTOMATIC_DRIVE \
  .nsig = 8, .nreal = 18, .nreal_more = 3, .nint = 2, .nstate = 4, .nstate_more = 2, .nout = 8, \
  .fields = automatic_drive_fields, .nfields = 21, .integers = automatic_drive_integers, \
  .nintegers = AUTOMATIC_DRIVE_INTEGERS
#endif
#endif
