/* First guess of the increment: the present motion goes on with constant acceleration. Flexible bodies have modes that
 * vibrate faster than the step can follow; the trapezoidal rule lets their rates and accelerations ring, and with them
 * those of all that is tied to them, but not the positions. There the mean rates of the last two steps go on. */
#include "ali3_internal.h"

void ali3_predict(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  const ali3_vectors *from = &in->now;
  for (int32_t i = 0; i < S->size.nq; i++) in->D[i] = h * from->qd[i] + 0.5 * h * h * from->qdd[i];
  if (S->n_flexible > 0)
    for (int32_t i = 0; i < S->size.nq; i++) in->D[i] = h * (2.0 * from->mean[i] - from->mean_before[i]);
}

/* Keeps the mean rate of the step from in->now to in->next. */
void ali3_predict_accept(ali3_instance *in, double h) {
  if (in->system->n_flexible == 0) return;
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    in->next.mean[i] = in->D[i] / h;
    in->next.mean_before[i] = in->now.mean[i];
  }
}
