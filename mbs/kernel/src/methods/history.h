/* History that methods keep from step to step. */
#ifndef ALI3_HISTORY_H
#define ALI3_HISTORY_H
#include "../instance.h"

void ali3_history_own(ali3_instance *in, int32_t method, const double *own);
void ali3_history_predict(const ali3_instance *in, double when, int32_t most, double *a, double *lam);
int32_t ali3_history_order(const ali3_instance *in, int32_t most);
void ali3_history_shift(ali3_instance *in, double h);
void ali3_history_append(ali3_instance *in, double h, const double *a);
void ali3_history_velocity(const ali3_instance *in, double h, double *v);
#endif
