/* clang-format off */
/* Numbers of a spring-damper. Written by `python -m mbs.elements.fields_in_c` from ScalarSpringDamper. */
/* Signals: coordinate (1). */
#ifndef ALI3_SCALAR_SPRING_DAMPER_FIELDS_H
#define ALI3_SCALAR_SPRING_DAMPER_FIELDS_H
#include "element.h"

enum {
  /* N m/rad on an angle, N/m on a length. */
  STIFFNESS,
  /* N m s/rad or N s/m. */
  DAMPING,
  /* Value without spring force, rad or m. */
  FREE_VALUE,
  /* Constant generalised force, N m or N. */
  CONSTANT,
  /* Factor on the stiffness, for parameters. */
  STIFFNESS_FACTOR,
  /* Factor on the damping, for parameters. */
  DAMPING_FACTOR,
  SCALAR_SPRING_DAMPER_REALS
};
enum {
  /* Generalised force on the coordinate, N m. */
  SCALAR_SPRING_DAMPER_OUT_FORCE,
  SCALAR_SPRING_DAMPER_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field scalar_spring_damper_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the stiffness of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the damping of a spring-damper must not be negative"},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_ANY, ""},
  {ALI3_IS_NOT_NEGATIVE, "the stiffness factor of a spring-damper must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the damping factor of a spring-damper must not be negative"},
};
#define ALI3_SCALAR_SPRING_DAMPER \
  .nsig = 1, .nreal = 6, .nout = 1, .fields = scalar_spring_damper_fields, .nfields = 6
#endif
#endif
