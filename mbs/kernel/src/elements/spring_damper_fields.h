/* clang-format off */
/* Numbers of a spring-damper. Written by `python -m mbs.elements.fields_in_c` from SpringDamper. */
/* Signals: difference (3 or 2). */
#ifndef ALI3_SPRING_DAMPER_FIELDS_H
#define ALI3_SPRING_DAMPER_FIELDS_H
#include "element.h"

enum {
  /* N/m. */
  STIFFNESS,
  /* N s/m. */
  DAMPING,
  /* Length without spring force, m. */
  FREE_LENGTH,
  /* Factor on the stiffness, for a parameter; not on the stops. */
  STIFFNESS_FACTOR,
  /* Factor on the damping, for a parameter; not on the stops. */
  DAMPING_FACTOR,
  /* Bump and rebound stops. */
  STOPS,
  SPRING_DAMPER_REALS = 9
};
enum {
  /* Distance of the two points, m. */
  SPRING_DAMPER_OUT_LENGTH,
  /* Force of spring, damper and stops, tension positive, N. */
  SPRING_DAMPER_OUT_FORCE,
  /* Rate of the length, m/s. */
  SPRING_DAMPER_OUT_RATE,
  /* Force of the damper without spring and stops, tension positive, N. */
  SPRING_DAMPER_OUT_DAMPER_FORCE,
  SPRING_DAMPER_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field spring_damper_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the stiffness of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the damping of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the free length of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the stiffness factor of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the damping factor of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the bump length of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the bump stiffness of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the rebound length of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the rebound stiffness of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the bump progression of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the rebound progression of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the bump travel of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the rebound travel of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the metal stiffness of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the metal onset of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the bump loss of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the rebound loss of a spring-damper must not be negative"},
};
#define ALI3_SPRING_DAMPER \
  .nsig = 3, .nsig_plane = 2, .nreal = 9, .nreal_more = 8, .nout = 4, .fields = spring_damper_fields, \
  .nfields = 17
#endif
#endif
