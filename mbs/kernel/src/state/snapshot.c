/* Snapshot of the state, inputs and parameters in memory, for steps that are undone. It is restored to the same
 * instance, so it needs neither header nor checksum nor the checks of ali3_state_restore. */
#include <string.h>

#include "../instance.h"
#include "parameters.h"
#include "snapshot.h"
#include "vectors.h"

/* Number of doubles in a snapshot. */
static size_t number_count(const ali3_system *s) {
  return ali3_vector_count(s) + (size_t)s->size.nu + (size_t)s->size.np;
}

size_t ali3_snapshot_size(const ali3_system *s) {
  return s != NULL ? sizeof(ali3_snapshot_head) + number_count(s) * sizeof(double) : 0;
}

static void copy(double *to, const double *from, size_t n) {
  if (n > 0) memcpy(to, from, n * sizeof(double));
}

void ali3_snapshot_take(const ali3_instance *in, void *snapshot) {
  if (in == NULL || snapshot == NULL) return;
  const size_t nu = (size_t)in->system->size.nu, np = (size_t)in->system->size.np;
  ali3_snapshot_head *head = snapshot;
  double *vector = (double *)(head + 1);
  head->report = in->report;
  head->t_base = in->clock.base;
  head->h_last = in->clock.h;
  head->count = in->clock.count;
  copy(vector, in->now.q, in->stored.n);
  copy(vector + in->stored.n, in->inputs.set, nu);
  copy(vector + in->stored.n + nu, in->parameters.value, np);
}

void ali3_snapshot_restore(ali3_instance *in, const void *snapshot) {
  if (in == NULL || snapshot == NULL) return;
  const size_t nu = (size_t)in->system->size.nu, np = (size_t)in->system->size.np;
  const ali3_snapshot_head *head = snapshot;
  const double *vector = (const double *)(head + 1), *parameter = vector + in->stored.n + nu;
  in->report = head->report;
  in->clock.base = head->t_base;
  in->clock.h = head->h_last;
  in->clock.count = head->count;
  in->branch.known = false; /* its angles are of a later position */
  copy(in->now.q, vector, in->stored.n);
  copy(in->inputs.set, vector + in->stored.n, nu);
  if (np == 0 || memcmp(in->parameters.value, parameter, np * sizeof(double)) == 0) return;
  copy(in->parameters.value, parameter, np);
  ali3_parameters_apply(in); /* these values are valid, as they were applied before */
}
