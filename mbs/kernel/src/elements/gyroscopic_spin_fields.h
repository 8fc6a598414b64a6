/* clang-format off */
/* Numbers of a spinning wheel. Written by `python -m mbs.elements.fields_in_c` from GyroscopicSpin. */
/* Signals: f (3), g (3), spin (1). */
#ifndef ALI3_GYROSCOPIC_SPIN_FIELDS_H
#define ALI3_GYROSCOPIC_SPIN_FIELDS_H
#include "element.h"

enum {
  /* Moment of inertia about the axis, kg m^2. */
  SPIN_INERTIA,
  GYROSCOPIC_SPIN_REALS
};
#ifndef ALI3_WIDTH
static const ali3_field gyroscopic_spin_fields[] = {
  {ALI3_IS_POSITIVE, "the spin inertia of a spinning wheel must be greater than zero"},
};
#define ALI3_GYROSCOPIC_SPIN \
  .nsig = 7, .nreal = 1, .fields = gyroscopic_spin_fields, .nfields = 1
#endif
#endif
