/* clang-format off */
/* Numbers of a spring-damper. Written by `python -m mbs.elements.fields_in_c` from SpringDamperTable. */
/* Signals: difference (3 or 2). */
#ifndef ALI3_SPRING_DAMPER_TABLE_FIELDS_H
#define ALI3_SPRING_DAMPER_TABLE_FIELDS_H
#include "element.h"

enum {
  /* Stiffness without a table, N/m. */
  STIFFNESS,
  /* Damping without a table, N s/m. */
  DAMPING,
  /* Length without stretch, m. */
  FREE_LENGTH,
  /* Factor on the forces of the spring. */
  STIFFNESS_FACTOR,
  /* Factor on the forces of the damper. */
  DAMPING_FACTOR,
  /* Bump and rebound stops. */
  STOPS,
  SPRING_DAMPER_TABLE_REALS = STOPS + 12
};
enum {
  /* Number of spring points; numbers of each: stretch, m; force, N; slope, N/m; energy from stretch 0, J. */
  SPRING_POINTS,
  /* Number of damper points; numbers of each: rate of the length, m/s; force, N; slope, N s/m. */
  DAMPER_POINTS,
  SPRING_DAMPER_TABLE_INTEGERS
};
enum {
  /* Distance of the two points, m. */
  SPRING_DAMPER_TABLE_OUT_LENGTH,
  /* Force of spring, damper and stops, tension positive, N. */
  SPRING_DAMPER_TABLE_OUT_FORCE,
  /* Rate of the length, m/s. */
  SPRING_DAMPER_TABLE_OUT_RATE,
  /* Force of the damper without spring and stops, tension positive, N. */
  SPRING_DAMPER_TABLE_OUT_DAMPER_FORCE,
  SPRING_DAMPER_TABLE_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field spring_damper_table_fields[] = {
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
static const ali3_integer spring_damper_table_integers[] = {
  {ALI3_OF_NUMBERS, 0, INT32_MAX, 4, 0, "the spring points of a spring-damper must be at least 0"},
  {ALI3_OF_NUMBERS, 0, INT32_MAX, 3, 0, "the damper points of a spring-damper must be at least 0"},
};
#define ALI3_SPRING_DAMPER_TABLE \
  .nsig = 3, .nsig_plane = 2, .nreal = 17, .nint = 2, .nout = 4, .fields = spring_damper_table_fields, \
  .nfields = 17, .integers = spring_damper_table_integers, \
  .nintegers = SPRING_DAMPER_TABLE_INTEGERS
#endif
#endif
