/* Vectors of a state: their positions in one block, and copies of the whole block. */
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "road_files.h"
#include "vectors.h"

void ali3_vectors_place(const ali3_system *s, ali3_vectors *v, ali3_pool *pool) {
  const ali3_sizes *z = &s->size;
  const size_t n_mean = s->n_flexible > 0 ? (size_t)z->nq : 0;
  v->q = ali3_pool_numbers(pool, (size_t)z->nq); /* first: copies and saves start here */
  v->qd = ali3_pool_numbers(pool, (size_t)z->nq);
  v->qdd = ali3_pool_numbers(pool, (size_t)z->nq);
  v->lam = ali3_pool_numbers(pool, (size_t)z->nc);
  v->y = ali3_pool_numbers(pool, (size_t)z->ny);
  v->s = ali3_pool_numbers(pool, (size_t)z->ng);
  v->sd = ali3_pool_numbers(pool, (size_t)z->ng);
  v->sdd = ali3_pool_numbers(pool, (size_t)z->ng);
  v->out = ali3_pool_numbers(pool, (size_t)z->nout);
  v->potential = ali3_pool_numbers(pool, (size_t)z->ne);
  v->used = ali3_pool_numbers(pool, (size_t)z->nu);
  v->y_last = ali3_pool_numbers(pool, (size_t)z->ny);
  v->h_last = ali3_pool_numbers(pool, 1);
  v->on = ali3_pool_numbers(pool, (size_t)z->n_switch);
  v->anchor = ali3_pool_numbers(pool, z->n_switch > 0 ? (size_t)z->nc : 0);
  v->history = ali3_pool_numbers(pool, ALI3_HISTORY);
  v->own = ali3_pool_numbers(pool, (size_t)z->nq);
  v->past_a = ali3_pool_numbers(pool, ALI3_PAST * (size_t)z->nq);
  v->past_lam = ali3_pool_numbers(pool, ALI3_PAST * (size_t)z->nc);
  v->mean = ali3_pool_numbers(pool, n_mean);
  v->mean_before = ali3_pool_numbers(pool, n_mean);
  v->work = ali3_pool_numbers(pool, (size_t)s->n_work + (size_t)s->n_driving_work);
  v->stored = ali3_pool_numbers(pool, (size_t)s->n_work);
  v->watched = ali3_pool_numbers(pool, (size_t)s->n_work + (size_t)s->n_work_force);
  v->step_force = ali3_pool_numbers(pool, (size_t)s->n_work_force);
  v->step_displacement = ali3_pool_numbers(pool, (size_t)s->n_work_force);
  v->by_inputs = ali3_pool_numbers(pool, (size_t)s->n_input_work);
}

size_t ali3_vector_count(const ali3_system *s) {
  ali3_vectors v;
  ali3_pool pool = {.block = NULL, .used = 0};
  ali3_vectors_place(s, &v, &pool);
  return pool.used / sizeof(double);
}

void ali3_vectors_copy(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from) {
  memcpy(to->q, from->q, in->stored.n * sizeof(double));
}

void ali3_vectors_swap(ali3_vectors *one, ali3_vectors *other) {
  const ali3_vectors first = *one;
  *one = *other;
  *other = first;
}

void ali3_vectors_copy_unwritten(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from) {
  const double *end = from->q + in->stored.n, *past_end = from->past_lam + (int64_t)ALI3_PAST * in->system->size.nc;
  const bool past = in->system->n_flexible > 0 && from->history[ALI3_HISTORY_COUNT] > 0.0;
  memcpy(to->y, from->y, (size_t)((past ? end : from->past_a) - from->y) * sizeof(double));
  if (!past) memcpy(to->q + (past_end - from->q), past_end, (size_t)(end - past_end) * sizeof(double));
}

void ali3_back_up(ali3_instance *in) {
  if (in->stored.backed_up) return;
  ali3_vectors_copy(in, &in->stored.start, &in->now);
  in->stored.backed_up = true;
}

/* Whether a state is finite; of the past only what the step added, as the rest was checked before. */
ALI3_INLINED bool vectors_finite(const ali3_instance *in, const ali3_vectors *v) {
  const int64_t nq = in->system->size.nq, nc = in->system->size.nc;
  const double *rest = v->past_lam + ALI3_PAST * nc;
  const double *const begin[] = {v->q, v->past_lam, rest};
  const double *const end[] = {v->past_a + nq, v->past_lam + nc, v->q + in->stored.n};
  for (int k = 0; k < 3; k++)
    if (!ali3_finite_inlined(begin[k], end[k] - begin[k])) return false;
  return true;
}

ALI3_BY_PROCESSOR(in->system, bool, vectors_finite, (const ali3_instance *in, const ali3_vectors *v), (in, v))

ali3_status ali3_accept(ali3_instance *in) {
  if (!ali3_vectors_finite(in, &in->next)) return ALI3_NOT_FINITE;
  if (ali3_roads_status(in) != ALI3_OK) return ALI3_ROAD_LOST;
  ali3_vectors_swap(&in->now, &in->next);
  return ALI3_OK;
}
