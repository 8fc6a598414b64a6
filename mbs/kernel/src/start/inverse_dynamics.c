/* What a rigid body carries at its ports while the same model runs without them: the motion is that of the model without
 * ports, and the equations of index one, with a row for each component of a port, give the forces there. */
#include <string.h>

#include "../elements/forces.h"
#include "../elements/road.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../state/parameters.h"
#include "index_one.h"

static const double TOLERANCE = 1e-10; /* relative, of accelerations and multipliers */

static void copy(double *to, const double *from, int64_t n) {
  if (n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

/* Whether `ported` tells its coordinates by those of `without`, and all else that a state has is the same. */
static bool same_model(const ali3_system *ported, const ali3_system *without) {
  const ali3_sizes *a = &ported->size, *b = &without->size;
  return ported->n_ported_ptr == (int64_t)b->nq + 1 && a->nu == b->nu && a->np == b->np && a->ng == b->ng &&
         a->ne == b->ne && a->ny == b->ny && a->nout == b->nout && a->n_switch == b->n_switch &&
         ported->nr == without->nr;
}

/* to = T from + offset; offset may be NULL: of rates. */
static void follow(const ali3_system *S, const double *from, const double *offset, double *to) {
  for (int32_t i = 0; i < S->size.nq; i++) to[i] = offset != NULL ? offset[i] : 0.0;
  for (int64_t j = 0; j + 1 < S->n_ported_ptr; j++)
    for (int32_t k = S->ported_ptr[j]; k < S->ported_ptr[j + 1]; k++)
      to[S->ported_row[k]] += S->ported_val[k] * from[j];
}

/* The state of the model without ports, but for accelerations and multipliers. */
static ali3_status take_state(ali3_instance *in, const ali3_instance *without) {
  const ali3_system *S = in->system;
  const ali3_sizes *z = &S->size;
  const ali3_vectors *from = &without->now;
  ali3_vectors *v = &in->now;
  if (z->np > 0 && memcmp(in->parameters.value, without->parameters.value, (size_t)z->np * sizeof(double)) != 0) {
    copy(in->parameters.value, without->parameters.value, z->np);
    if (ali3_parameters_apply(in) != ALI3_OK) return ALI3_BAD_ARGUMENT;
  }
  follow(S, from->q, S->ported_const, v->q);
  follow(S, from->qd, NULL, v->qd);
  copy(v->y, from->y, z->ny);
  copy(v->y_last, from->y_last, z->ny);
  copy(v->s, from->s, z->ng);
  copy(v->sd, from->sd, z->ng);
  copy(v->sdd, from->sdd, z->ng);
  copy(v->on, from->on, z->n_switch);
  copy(v->used, from->used, z->nu);
  copy(in->inputs.set, from->used, z->nu);
  v->h_last[0] = from->h_last[0];
  in->start.initialised = 1;
  return ALI3_OK;
}

/* Forces as at the end of the last step, or at a start. */
static void forces(ali3_instance *in) {
  ali3_vectors *v = &in->now;
  const bool stepped = v->h_last[0] > 0.0;
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = stepped ? v->y_last : v->y,
                                .h = v->h_last[0],
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = v->out,
                                .potential = v->potential};
  ali3_forces(in, &call);
}

ali3_status ali3_ports_follow(ali3_instance *in, const ali3_instance *without) {
  if (in == NULL || without == NULL || !same_model(in->system, without->system)) return ALI3_BAD_ARGUMENT;
  if (!without->start.initialised) return ALI3_NOT_INITIALISED;
  ali3_vectors *v = &in->now;
  ali3_status status = take_state(in, without);
  if (status != ALI3_OK) return status;
  memcpy(in->roads.used, without->roads.used,
         (size_t)in->system->nr * sizeof *in->roads.used); /* tiles that are in memory */
  forces(in);
  memcpy(in->roads.used, in->roads.own, (size_t)in->system->nr * sizeof *in->roads.used);
  ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
  ali3_constraint_gamma(in, v->q, v->qd, v, in->step.gamma);
  status = ali3_index_one_factorise(in, v->q);
  return status == ALI3_OK ? ali3_index_one_solve(in, in->step.Q, in->step.gamma, TOLERANCE, v->qdd, v->lam) : status;
}
