/* clang-format off */
/* Numbers of contact points. Written by `python -m mbs.elements.fields_in_c` from ContactPoints. */
/* Signals: origin (3), axes (9). */
#ifndef ALI3_CONTACT_POINTS_FIELDS_H
#define ALI3_CONTACT_POINTS_FIELDS_H
#include "element.h"

enum {
  /* K of one point, N/m. */
  STIFFNESS,
  /* Of a point that sticks, N/m. */
  STICK_STIFFNESS,
  /* Of a point that sticks, N s/m. */
  STICK_DAMPING,
  /* w, m. */
  ONSET,
  /* chi, s/m. */
  LOSS,
  /* Ratio of the coefficient of friction on a road to the friction of the road. */
  FRICTION_FACTOR,
  /* Radius of the spheres around the points, as of tubes or edges, m. */
  RADIUS,
  /* Least coefficient of restitution e, at fast impacts: ``chi d'`` saturates at 1/e - 1; 0: it does not. */
  RESTITUTION,
  CONTACT_POINTS_REALS
};
enum {
  /* Index of the road. */
  ROAD,
  /* Number of points; numbers of each: x, m; y, m; z, m; states of each: deflection 1 of the stick spring, m;
   * deflection 2 of the stick spring, m; rate 1 of it, m/s; rate 2 of it, m/s. */
  POINTS,
  CONTACT_POINTS_INTEGERS
};
enum {
  /* Sum of the normal forces of the road on the points, N. */
  CONTACT_POINTS_OUT_NORMAL_FORCE,
  /* Number of points that touch the road. */
  CONTACT_POINTS_OUT_TOUCHING,
  /* Force of the road on the body, earth axes, N. */
  CONTACT_POINTS_OUT_FORCE_X,
  /* Force of the road on the body, earth axes, N. */
  CONTACT_POINTS_OUT_FORCE_Y,
  /* Force of the road on the body, earth axes, N. */
  CONTACT_POINTS_OUT_FORCE_Z,
  /* Deepest penetration of a point, m. */
  CONTACT_POINTS_OUT_DEPTH,
  CONTACT_POINTS_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field contact_points_fields[] = {
  {ALI3_IS_POSITIVE, "the stiffness of contact points must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stick stiffness of contact points must be greater than zero"},
  {ALI3_IS_POSITIVE, "the stick damping of contact points must be greater than zero"},
  {ALI3_IS_POSITIVE, "the onset of contact points must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the loss of contact points must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the friction factor of contact points must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the radius of contact points must not be negative"},
  {ALI3_IS_FRACTION, "the restitution of contact points must be at least 0 and below 1"},
};
static const ali3_integer contact_points_integers[] = {
  {ALI3_OF_ROADS, 0, INT32_MAX, 0, 0, "the road of contact points names a road that does not exist"},
  {ALI3_OF_NUMBERS, 1, INT32_MAX, 3, 4, "the points of contact points must be at least 1"},
};
#define ALI3_CONTACT_POINTS \
  .nsig = 12, .nreal = 14, .nint = 2, .nout = 6, .fields = contact_points_fields, .nfields = 8, \
  .integers = contact_points_integers, .nintegers = CONTACT_POINTS_INTEGERS
#endif
#endif
