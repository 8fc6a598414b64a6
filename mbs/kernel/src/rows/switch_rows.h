/* Rows that are switched on or off; one that is off is zero, with its rates and its part of a tangent. */
#ifndef ALI3_SWITCH_ROWS_H
#define ALI3_SWITCH_ROWS_H
#include "../algebra/real.h"
#include "../instance.h"

/* Whether row k belongs to a switch that is off. */
bool ali3_row_is_off(const ali3_instance *in, int32_t k);
/* Subtracts the anchors from Phi (nc); clears Phi and J of rows that are off. */
void ali3_switch_rows(const ali3_instance *in, real *Phi, real *J);
/* Clears the numbers (nc) of rows that are off. */
void ali3_switch_values(const ali3_instance *in, real *v);
#endif
