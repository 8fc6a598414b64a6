/* clang-format off */
/* Numbers of a tyre. Written by `python -m mbs.elements.fields_in_c` from Tyre. */
/* Signals: centre (3), axis (3), spin (1). */
#ifndef ALI3_TYRE_FIELDS_H
#define ALI3_TYRE_FIELDS_H
#include "element.h"

enum {
  /* Free radius, m. */
  TYRE_RADIUS,
  /* Loaded radius below which the rim bears, m. */
  TYRE_BOTTOMING_RADIUS,
  /* Radial stiffness, N/m. */
  TYRE_STIFFNESS,
  /* Radial damping, N s/m; it grows from zero along the first 5 mm. */
  TYRE_DAMPING,
  /* Longitudinal force over longitudinal slip. */
  TYRE_LONGITUDINAL,
  /* Lateral force over lateral slip. */
  TYRE_LATERAL = TYRE_LONGITUDINAL + 10,
  /* Dynamic trail over contact length at zero slip, a ratio. */
  TYRE_TRAIL = TYRE_LATERAL + 10,
  /* Lateral slip at which the trail first vanishes, a ratio. */
  TYRE_TRAIL_ZERO = TYRE_TRAIL + 2,
  /* Lateral slip at which it ends, a ratio. */
  TYRE_TRAIL_END = TYRE_TRAIL_ZERO + 2,
  /* Longitudinal and lateral stiffness of the carcass, N/m. */
  TYRE_CARCASS_STIFFNESS = TYRE_TRAIL_END + 2,
  /* Longitudinal and lateral damping of the carcass, N s/m. */
  TYRE_CARCASS_DAMPING = TYRE_CARCASS_STIFFNESS + 2,
  /* Load at which the first number of each pair holds, N. */
  TYRE_NOMINAL_LOAD = TYRE_CARCASS_DAMPING + 2,
  /* Coefficient of friction of the road on which the curves hold. */
  TYRE_REFERENCE_FRICTION,
  /* Stiffness of the rim on the road, N/m. */
  TYRE_BOTTOMING_STIFFNESS,
  /* Multiple of the nominal load at which the curves are clamped. */
  TYRE_MAX_LOAD_FACTOR,
  /* Coefficient of rolling resistance. */
  TYRE_ROLLING_RESISTANCE,
  /* Multiplies the friction of the road. */
  TYRE_FRICTION_FACTOR,
  /* Camber thrust over cornering stiffness, a ratio: the lateral slip that has the force of a camber whose sine is
   * 1. */
  TYRE_CAMBER_SLIP,
  TYRE_REALS
};
enum {
  /* Torque against turning about the normal of the road. */
  TYRE_BORE = TYRE_REALS,
};
enum {
  /* Index of the road. */
  TYRE_ROAD,
  /* The number of bore torques. */
  TYRE_WITH_BORE,
  TYRE_INTEGERS
};
enum {
  /* Force of the road along the wheel's heading, N. */
  TYRE_OUT_LONGITUDINAL_FORCE,
  /* Force of the road to the left, N. */
  TYRE_OUT_LATERAL_FORCE,
  /* Force of the road along its normal, N. */
  TYRE_OUT_VERTICAL_FORCE,
  /* Moment about the road's normal, N m. */
  TYRE_OUT_ALIGNING_MOMENT,
  /* Longitudinal slip, positive when driven, between about -1 and 1. */
  TYRE_OUT_SLIP,
  /* Direction of travel from the wheel's heading, positive to the left, rad. */
  TYRE_OUT_SLIP_ANGLE,
  /* Radial deflection, m. */
  TYRE_OUT_DEFLECTION,
  /* Distance of the contact patch from the centre, m. */
  TYRE_OUT_LOADED_RADIUS,
  /* X of the contact point, earth; in the air of the road's nearest point in the wheel plane, m. */
  TYRE_OUT_CONTACT_X,
  /* Y of the contact point, earth; in the air of the road's nearest point in the wheel plane, m. */
  TYRE_OUT_CONTACT_Y,
  /* Z of the contact point, earth; in the air of the road's nearest point in the wheel plane, m. */
  TYRE_OUT_CONTACT_Z,
  /* Of the wheel plane from the road's normal, positive with the top right, rad. */
  TYRE_OUT_INCLINATION,
  /* X of the road's unit normal at the contact point, earth, upwards. */
  TYRE_OUT_NORMAL_X,
  /* Y of the road's unit normal at the contact point, earth, upwards. */
  TYRE_OUT_NORMAL_Y,
  /* Z of the road's unit normal at the contact point, earth, upwards. */
  TYRE_OUT_NORMAL_Z,
  /* About the contact point: rolling resistance, and Fx by its lever, N m. */
  TYRE_OUT_ROLLING_MOMENT,
  TYRE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field tyre_fields[] = {
  {ALI3_IS_POSITIVE, "the radius of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the bottoming radius of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stiffness of a tyre must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the damping of a tyre must not be negative"},
  {ALI3_IS_POSITIVE, "the slope of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slope of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max force of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max force of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max slip of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max slip of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide force of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide force of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide slip of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide slip of the longitudinal curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slope of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slope of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max force of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max force of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max slip of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the max slip of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide force of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide force of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide slip of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slide slip of the lateral curve of a tyre must be greater than zero"},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_POSITIVE, "the slip of zero trail of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the slip of zero trail of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the end slip of the trail of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the end slip of the trail of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the carcass stiffness of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the carcass stiffness of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the carcass damping of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the carcass damping of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the nominal load of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the reference friction of a tyre must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the bottoming stiffness of a tyre must not be negative"},
  {ALI3_IS_POSITIVE, "the max load factor of a tyre must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the rolling resistance of a tyre must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the friction factor of a tyre must not be negative"},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_POSITIVE, "the width of the bore torque of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stiffness of the bore torque of a tyre must be greater than zero"},
  {ALI3_IS_POSITIVE, "the damping of the bore torque of a tyre must be greater than zero"},
};
static const ali3_integer tyre_integers[] = {
  {ALI3_OF_ROADS, 0, INT32_MAX, 0, 0, "the road of a tyre names a road that does not exist"},
  {ALI3_OF_NUMBERS, 1, 1, 0, 0, "the number of bore torques of a tyre must be 1"},
};
#define ALI3_TYRE \
  .nsig = 7, .nreal = 41, .nreal_more = 3, .nint = 1, .nstate = 4, .nstate_more = 2, .nout = 16, \
  .fields = tyre_fields, .nfields = 44, .integers = tyre_integers, .nintegers = TYRE_INTEGERS
#endif
#endif
