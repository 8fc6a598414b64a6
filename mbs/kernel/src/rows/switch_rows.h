/* Rows that are switched on or off. */
#ifndef ALI3_SWITCH_ROWS_H
#define ALI3_SWITCH_ROWS_H
#include "../instance.h"

void ali3_switch_rows(const ali3_instance *in, double *Phi, double *J);
void ali3_switch_values(const ali3_instance *in, double *v);
#endif
