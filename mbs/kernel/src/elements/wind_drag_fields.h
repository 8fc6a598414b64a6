/* clang-format off */
/* Numbers of a drag. Written by `python -m mbs.elements.fields_in_c` from WindDrag. */
/* Signals: point (3). */
/* Outputs: force (N), size of the drag */
#ifndef ALI3_WIND_DRAG_FIELDS_H
#define ALI3_WIND_DRAG_FIELDS_H
#include "element.h"

enum {
  /* Drag coefficient times frontal area, m^2. */
  DRAG_AREA,
  /* kg/m^3. */
  AIR_DENSITY,
  WIND_DRAG_REALS
};
#ifndef ALI3_WIDTH
static const ali3_field wind_drag_fields[WIND_DRAG_REALS] = {
  {ALI3_IS_NOT_NEGATIVE, "the drag area of a drag must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the air density of a drag must not be negative"},
};
#define ALI3_WIND_DRAG .fields = wind_drag_fields, .nfields = WIND_DRAG_REALS, \
  .nsig = 3, .nreal = WIND_DRAG_REALS, .nstate = 0, .nout = 1
#endif
#endif
