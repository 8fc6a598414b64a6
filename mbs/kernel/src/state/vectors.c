/* The vectors of a state: their places in one block, and copies of the whole block. */
#include <string.h>

#include "../algebra/finite.h"
#include "../instance.h"
#include "vectors.h"

double *ali3_take(double **pool, size_t n) {
  double *piece = *pool;
  *pool += n;
  return piece;
}

size_t ali3_vector_count(const ali3_system *s) {
  const ali3_sizes *z = &s->size;
  const size_t of_coordinates = 4 + ALI3_PAST + (s->n_flexible > 0 ? 2 : 0);
  return of_coordinates * (size_t)z->nq + (1 + ALI3_PAST) * (size_t)z->nc + 2 * (size_t)z->ny + 3 * (size_t)z->ng +
         (size_t)z->nout + (size_t)z->ne + (size_t)z->nu + (size_t)z->n_switch + (z->n_switch > 0 ? (size_t)z->nc : 0) +
         ALI3_MEMORY + 1 + 3 * (size_t)s->n_work + 3 * (size_t)s->n_work_force;
}

void ali3_vectors_place(const ali3_system *s, ali3_vectors *v, double **pool) {
  const ali3_sizes *z = &s->size;
  const size_t n_mean = s->n_flexible > 0 ? (size_t)z->nq : 0;
  v->q = ali3_take(pool, (size_t)z->nq); /* first: copies and saves start here */
  v->qd = ali3_take(pool, (size_t)z->nq);
  v->qdd = ali3_take(pool, (size_t)z->nq);
  v->lam = ali3_take(pool, (size_t)z->nc);
  v->y = ali3_take(pool, (size_t)z->ny);
  v->s = ali3_take(pool, (size_t)z->ng);
  v->sd = ali3_take(pool, (size_t)z->ng);
  v->sdd = ali3_take(pool, (size_t)z->ng);
  v->out = ali3_take(pool, (size_t)z->nout);
  v->potential = ali3_take(pool, (size_t)z->ne);
  v->used = ali3_take(pool, (size_t)z->nu);
  v->y_last = ali3_take(pool, (size_t)z->ny);
  v->h_last = ali3_take(pool, 1);
  v->on = ali3_take(pool, (size_t)z->n_switch);
  v->anchor = ali3_take(pool, z->n_switch > 0 ? (size_t)z->nc : 0);
  v->memory = ali3_take(pool, ALI3_MEMORY);
  v->own = ali3_take(pool, (size_t)z->nq);
  v->past_a = ali3_take(pool, ALI3_PAST * (size_t)z->nq);
  v->past_lam = ali3_take(pool, ALI3_PAST * (size_t)z->nc);
  v->mean = ali3_take(pool, n_mean);
  v->mean_before = ali3_take(pool, n_mean);
  v->work = ali3_take(pool, (size_t)s->n_work);
  v->stored = ali3_take(pool, (size_t)s->n_work);
  v->watched = ali3_take(pool, (size_t)s->n_work + (size_t)s->n_work_force);
  v->step_force = ali3_take(pool, (size_t)s->n_work_force);
  v->step_way = ali3_take(pool, (size_t)s->n_work_force);
}

void ali3_vectors_copy(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from) {
  memcpy(to->q, from->q, in->n_vector * sizeof(double));
}

/* Once a step, before anything changes in->now: what it goes back to when the step fails. */
void ali3_keep(ali3_instance *in) {
  if (in->kept) return;
  ali3_vectors_copy(in, &in->start, &in->now);
  in->kept = true;
}

/* in->next becomes the state when all of it is finite. */
ali3_status ali3_accept(ali3_instance *in) {
  if (!ali3_finite(in->next.q, (int64_t)in->n_vector)) return ALI3_NOT_FINITE;
  const ali3_vectors swap = in->now;
  in->now = in->next;
  in->next = swap;
  return ALI3_OK;
}
