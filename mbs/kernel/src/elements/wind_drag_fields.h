/* clang-format off */
/* Numbers of a drag. Written by `python -m mbs.elements.fields_in_c` from WindDrag. */
/* Signals: point (3). */
#ifndef ALI3_WIND_DRAG_FIELDS_H
#define ALI3_WIND_DRAG_FIELDS_H
#include "element.h"

enum {
  /* Drag coefficient times frontal area, m^2. */
  DRAG_AREA,
  /* Density of the air, kg/m^3. */
  AIR_DENSITY,
  WIND_DRAG_REALS
};
enum {
  /* Index of an input, the speed of the air. */
  WIND_SPEED,
  /* Index of an input, the heading of the air. */
  WIND_HEADING,
  WIND_DRAG_INTEGERS
};
enum {
  /* Size of the drag, N. */
  WIND_DRAG_OUT_FORCE,
  WIND_DRAG_OUTPUTS
};
#ifndef ALI3_WIDTH
static const ali3_field wind_drag_fields[] = {
  {ALI3_IS_NOT_NEGATIVE, "the drag area of a drag must not be negative"},
  {ALI3_IS_NOT_NEGATIVE, "the air density of a drag must not be negative"},
};
static const ali3_integer wind_drag_integers[] = {
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the speed of the air of a drag names an input that does not exist"},
  {ALI3_OF_INPUTS, 0, INT32_MAX, 0, 0, "the heading of the air of a drag names an input that does not exist"},
};
#define ALI3_WIND_DRAG \
  .nsig = 3, .nreal = 2, .nint = 2, .nout = 1, .fields = wind_drag_fields, .nfields = 2, \
  .integers = wind_drag_integers, .nintegers = WIND_DRAG_INTEGERS
#endif
#endif
