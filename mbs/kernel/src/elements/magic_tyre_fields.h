/* clang-format off */
/* Numbers of a tyre. Written by `python -m mbs.elements.fields_in_c` from MagicTyre. */
/* Signals: centre (3), axis (3), spin (1). */
#ifndef ALI3_MAGIC_TYRE_FIELDS_H
#define ALI3_MAGIC_TYRE_FIELDS_H
#include "element.h"

enum {
  /* Free radius, m. */
  RADIUS,
  /* Loaded radius below which the rim bears, m. */
  BOTTOMING_RADIUS,
  /* Vertical, N/m. */
  STIFFNESS,
  /* N. */
  NOMINAL_LOAD,
  /* Vertical force of the squared deflection, N/m^2. */
  PROGRESSION,
  /* Vertical, N s/m; it grows from zero along the first 5 mm. */
  DAMPING,
  /* Of the rim, N/m. */
  BOTTOMING_STIFFNESS,
  /* Coefficient of friction of the road on which the coefficients hold. */
  REFERENCE_FRICTION,
  /* Multiplies the friction of the road. */
  FRICTION_FACTOR,
  /* Factor on LMUX of the file, the largest longitudinal force. */
  LMUX,
  /* Factor on LMUY of the file, the largest lateral force. */
  LMUY,
  /* Factor on LKX of the file, the longitudinal slip stiffness. */
  LKX,
  /* Factor on LKY of the file, the cornering stiffness. */
  LKY,
  /* Deviation of the inflation pressure from the nominal pressure, a ratio to the latter. */
  PRESSURE,
  /* Damping over stiffness of the carcass at rest, s. */
  SETTLING,
  /* Axes of the coefficients: key of `SIGNS`; x forward; ISO: y left, z up; SAE: y right, z down; the adapted SAE
   * axes of Pacejka have a slip angle of the other sign. */
  SIGN,
  /* Longitudinal slip, a ratio, beyond which forces stay. */
  SLIP_RANGE = SIGN + 3,
  /* Likewise, slip angle, rad. */
  ANGLE_RANGE = SLIP_RANGE + 2,
  /* Likewise, camber, rad. */
  CAMBER_RANGE = ANGLE_RANGE + 2,
  /* Likewise, N; the vertical force itself goes on. */
  LARGEST_LOAD = CAMBER_RANGE + 2,
  MAGIC_TYRE_REALS
};
enum {
  /* Torque against turning on the spot; it fades out up to 1 m/s, above which the formula gives the moments. */
  BORE = MAGIC_TYRE_REALS + 178,
};
enum {
  /* Index of the road. */
  ROAD,
  /* The version. */
  VERSION,
  /* The combination. */
  COMBINATION,
  /* The number of bore torques. */
  WITH_BORE,
  MAGIC_TYRE_INTEGERS
};
enum {
  /* Force of the road along the wheel's heading, N. */
  MAGIC_TYRE_OUT_LONGITUDINAL_FORCE,
  /* Force of the road to the left, N. */
  MAGIC_TYRE_OUT_LATERAL_FORCE,
  /* Force of the road along its normal, N. */
  MAGIC_TYRE_OUT_VERTICAL_FORCE,
  /* Moment about the road's normal, N m. */
  MAGIC_TYRE_OUT_ALIGNING_MOMENT,
  /* Longitudinal slip, positive when driven, between about -1 and 1. */
  MAGIC_TYRE_OUT_SLIP,
  /* Direction of travel from the wheel's heading, positive to the left, rad. */
  MAGIC_TYRE_OUT_SLIP_ANGLE,
  /* Radial deflection, m. */
  MAGIC_TYRE_OUT_DEFLECTION,
  /* Distance of the contact patch from the centre, m. */
  MAGIC_TYRE_OUT_LOADED_RADIUS,
  /* X of the contact point, earth; in the air of the road's nearest point in the wheel plane, m. */
  MAGIC_TYRE_OUT_CONTACT_X,
  /* Y of the contact point, earth; in the air of the road's nearest point in the wheel plane, m. */
  MAGIC_TYRE_OUT_CONTACT_Y,
  /* Z of the contact point, earth; in the air of the road's nearest point in the wheel plane, m. */
  MAGIC_TYRE_OUT_CONTACT_Z,
  /* Of the wheel plane from the road's normal, positive with the top right, rad. */
  MAGIC_TYRE_OUT_INCLINATION,
  /* X of the road's unit normal at the contact point, earth, upwards. */
  MAGIC_TYRE_OUT_NORMAL_X,
  /* Y of the road's unit normal at the contact point, earth, upwards. */
  MAGIC_TYRE_OUT_NORMAL_Y,
  /* Z of the road's unit normal at the contact point, earth, upwards. */
  MAGIC_TYRE_OUT_NORMAL_Z,
  /* About the contact point: rolling resistance, and Fx by its lever, N m. */
  MAGIC_TYRE_OUT_ROLLING_MOMENT,
  /* Moment about the wheel's heading in the plane of the road, N m. */
  MAGIC_TYRE_OUT_OVERTURNING_MOMENT,
  /* Moment of rolling resistance about the wheel's axis, N m. */
  MAGIC_TYRE_OUT_RESISTANCE_MOMENT,
  MAGIC_TYRE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field magic_tyre_fields[] = {
  {ALI3_IS_POSITIVE, "the radius of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the bottoming radius of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stiffness of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the nominal load of a tyre must be greater than zero"},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_NOT_NEGATIVE, "the damping of a tyre must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the bottoming stiffness of a tyre must not be negative"},
  {ALI3_IS_POSITIVE, "the reference friction of a tyre must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the friction factor of a tyre must not be negative"},
  {ALI3_IS_POSITIVE, "the factor on LMUX of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the factor on LMUY of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the factor on LKX of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the factor on LKY of a tyre must be greater than zero"},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_POSITIVE, "the settling of a tyre must be greater than zero"},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_POSITIVE, "the largest load of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the width of the bore torque of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stiffness of the bore torque of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the damping of the bore torque of a tyre must be greater than zero"},
};
static const ali3_integer magic_tyre_integers[] = {
  {ALI3_OF_ROADS, 0, INT32_MAX, 0, 0, "the road of a tyre names a road that does not exist"},
  {ALI3_OF_NUMBERS, 0, INT32_MAX, 0, 0, "the version of a tyre must be at least 0"},
  {ALI3_OF_NUMBERS, 0, 2, 0, 0, "the combination of a tyre must be 0 or 1 or 2"},
  {ALI3_OF_NUMBERS, 1, 1, 0, 0, "the number of bore torques of a tyre must be 1"},
};
#define ALI3_MAGIC_TYRE \
  .nsig = 7, .nreal = 203, .nreal_more = 3, .nint = 3, .nstate = 4, .nstate_more = 2, .nout = 18, \
  .fields = magic_tyre_fields, .nfields = 28, .integers = magic_tyre_integers, \
  .nintegers = MAGIC_TYRE_INTEGERS
#endif
#endif
