/* Mean accelerations and multipliers of past steps, which methods extrapolate. Times and steps in s. */
#ifndef ALI3_HISTORY_H
#define ALI3_HISTORY_H
#include "../instance.h"

/* Makes `method` the owner of the history of in->now; a new owner starts with `own` (nq) and no past steps. */
void ali3_history_own(ali3_instance *in, int32_t method, const double *own);
/* Acceleration a (nq) and multipliers lam (nc) `time_ahead` ahead of now, extrapolated from at most `most` past ones;
 * without a past those of the state. */
void ali3_history_predict(const ali3_instance *in, double time_ahead, int32_t most, double *a, double *lam);
/* Number of past steps, at most `most`, to extrapolate from: those that predict the last step best. */
int32_t ali3_history_order(const ali3_instance *in, int32_t most);
/* Writes the history after a completed step h to in->next; the caller writes the first mean acceleration and
 * multipliers. */
void ali3_history_shift(ali3_instance *in, double h);
/* The same, with the mean acceleration a (nq) and the multipliers in->next.lam. */
void ali3_history_append(ali3_instance *in, double h, const double *a);
/* Velocity v (nq) at the end of the step for the states of elements: linear through the mean velocities of this step
 * and the last. */
void ali3_history_velocity(const ali3_instance *in, double h, double *v);
#endif
