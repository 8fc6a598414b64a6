/* clang-format off */
/* Numbers of a drag. Written by `python -m mbs.elements.fields_in_c` from Drag. */
/* Signals: point (3 or 2). */
#ifndef ALI3_DRAG_FIELDS_H
#define ALI3_DRAG_FIELDS_H
#include "element.h"

enum {
  /* Drag coefficient times frontal area, m^2. */
  DRAG_AREA,
  /* Density of the air, kg/m^3. */
  AIR_DENSITY,
  DRAG_REALS
};
enum {
  /* Size of the drag, N. */
  DRAG_OUT_FORCE,
  DRAG_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field drag_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the drag area of a drag must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the air density of a drag must not be negative"},
};
#define ALI3_DRAG \
  .nsig = 3, .nsig_plane = 2, .nreal = 2, .nout = 1, .fields = drag_fields, .nfields = 2
#endif
#endif
