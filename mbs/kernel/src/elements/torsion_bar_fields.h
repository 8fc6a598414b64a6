/* clang-format off */
/* Numbers of a torsion bar. Written by `python -m mbs.elements.fields_in_c` from TorsionBar. */
/* Signals: wheel (1), pinion (1). */
#ifndef ALI3_TORSION_BAR_FIELDS_H
#define ALI3_TORSION_BAR_FIELDS_H
#include "element.h"

enum {
  /* Torsional stiffness of column and torsion bar, N m/rad. */
  STIFFNESS,
  /* Torsional damping of column and torsion bar, N m s/rad. */
  DAMPING,
  /* Torque of the power assistance on the pinion per torque of the torsion bar, a ratio, while it is far below its
   * limit. */
  ASSISTANCE,
  /* Largest torque of the power assistance on the pinion, N m. */
  ASSISTANCE_LIMIT,
  TORSION_BAR_REALS
};
enum {
  /* Torque of the bar on the pinion, N m. */
  TORSION_BAR_OUT_TORQUE,
  /* Torque of the assistance on the pinion, N m. */
  TORSION_BAR_OUT_ASSISTANCE,
  TORSION_BAR_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field torsion_bar_fields[] = {
  {ALI3_IS_POSITIVE, "the stiffness of a torsion bar must be greater than zero"},
  {ALI3_IS_NOT_NEGATIVE, "the damping of a torsion bar must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the assistance of a torsion bar must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the assistance limit of a torsion bar must not be negative"},
};
#define ALI3_TORSION_BAR \
  .nsig = 2, .nreal = 4, .nout = 2, .fields = torsion_bar_fields, .nfields = 4
#endif
#endif
