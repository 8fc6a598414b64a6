/* What the methods carry from step to step beside q, qd, qdd, and the start value that it gives: mean accelerations
 * and multipliers of past steps, extrapolated by the polynomial through their middles. */
#include <string.h>

#include "ali3_internal.h"

/* Number of past steps, at most `most`; a restored state may hold any number there. */
static int32_t past(const ali3_vectors *v, int32_t most) {
  const double count = v->memory[ALI3_MEMORY_COUNT];
  return count < (double)most ? (count > 0.0 ? (int32_t)count : 0) : most;
}

/* The memory belongs to `method`; a new owner starts from `own` (nq) and without a past. */
void ali3_history_own(ali3_instance *in, int32_t method, const double *own) {
  double *memory = in->now.memory;
  if (memory[ALI3_MEMORY_OWNER] == (double)method) return;
  memset(memory, 0, ALI3_MEMORY * sizeof *memory);
  memory[ALI3_MEMORY_OWNER] = (double)method;
  memcpy(in->now.own, own, (size_t)in->system->size.nq * sizeof *own);
}

/* Acceleration a (nq) and multipliers (nc) at `when` from now, extrapolated from at most `most` past ones; without a past
 * those of the state. */
void ali3_history_predict(const ali3_instance *in, double when, int32_t most, double *a, double *lam) {
  const ali3_vectors *v = &in->now;
  const int32_t nq = in->system->size.nq, nc = in->system->size.nc;
  const int32_t n = past(v, most);
  const double *time = v->memory + ALI3_MEMORY_TIME;
  if (n == 0) {
    memcpy(a, v->qdd, (size_t)nq * sizeof *a);
    memcpy(lam, v->lam, (size_t)nc * sizeof *lam);
    return;
  }
  memset(a, 0, (size_t)nq * sizeof *a);
  memset(lam, 0, (size_t)nc * sizeof *lam);
  for (int32_t k = 0; k < n; k++) {
    double weight = 1.0; /* Lagrange */
    for (int32_t j = 0; j < n; j++)
      if (j != k) weight *= (when - time[j]) / (time[k] - time[j]);
    const double *past_a = v->past_a + (int64_t)k * nq, *past_lam = v->past_lam + (int64_t)k * nc;
    for (int32_t i = 0; i < nq; i++) a[i] += weight * past_a[i];
    for (int32_t i = 0; i < nc; i++) lam[i] += weight * past_lam[i];
  }
}

/* in->next goes on from in->now with the step h just made: its mean acceleration a, its multipliers in->next.lam. */
void ali3_history_append(ali3_instance *in, double h, const double *a) {
  const ali3_vectors *from = &in->now, *to = &in->next;
  const size_t nq = (size_t)in->system->size.nq, nc = (size_t)in->system->size.nc;
  const int32_t n = past(from, ALI3_PAST);
  to->memory[ALI3_MEMORY_OWNER] = from->memory[ALI3_MEMORY_OWNER];
  to->memory[ALI3_MEMORY_COUNT] = n < ALI3_PAST ? n + 1 : n;
  to->memory[ALI3_MEMORY_TIME] = -0.5 * h;
  for (int32_t k = 1; k < ALI3_PAST; k++) to->memory[ALI3_MEMORY_TIME + k] = from->memory[ALI3_MEMORY_TIME + k - 1] - h;
  memcpy(to->past_a, a, nq * sizeof *a);
  memcpy(to->past_lam, to->lam, nc * sizeof *a);
  memcpy(to->past_a + nq, from->past_a, (ALI3_PAST - 1) * nq * sizeof *a);
  memcpy(to->past_lam + nc, from->past_lam, (ALI3_PAST - 1) * nc * sizeof *a);
}
