/* Evaluations for tests and linearisation: rows, forces, tangent and steps of elements at given values. The state does
 * not change. */
#include <string.h>

#include "../algebra/finite.h"
#include "../elements/forces.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../methods/newton.h"
#include "../rows/constraints.h"
#include "../rows/driving_functions.h"
#include "../state/road_files.h"

static const double LONGEST_STEP = 1e6; /* s */

/* Copies n numbers; nothing if `to` is NULL. */
static void copy(double *to, const double *from, int64_t n) {
  if (to != NULL && n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

/* Copies coordinates to arrays with padding (`ali3_pool_padded`). */
static void copy_coordinates(ali3_vectors *work, const double *q, const double *qd, int64_t nq) {
  copy(work->q, q, nq);
  copy(work->qd, qd, nq);
}

ali3_status ali3_get_state(const ali3_instance *in, double *q, double *qd, double *qdd, double *lam, double *y) {
  if (in == NULL) return ALI3_BAD_ARGUMENT;
  const ali3_sizes *z = &in->system->size;
  copy(q, in->now.q, z->nq);
  copy(qd, in->now.qd, z->nq);
  copy(qdd, in->now.qdd, z->nq);
  copy(lam, in->now.lam, z->nc);
  copy(y, in->now.y, z->ny);
  return ALI3_OK;
}

ali3_status ali3_evaluate(ali3_instance *in, const double *q, const double *qd, const double *y, double t, double *phi,
                          double *jacobian_values, double *phi_t, double *gamma, double *force, double *outputs) {
  if (in == NULL || q == NULL || qd == NULL) return ALI3_BAD_ARGUMENT;
  const ali3_sizes *z = &in->system->size;
  if (!ali3_finite(q, z->nq) || !ali3_finite(qd, z->nq) || (y != NULL && !ali3_finite(y, z->ny)) || !(t - t == 0.0))
    return ALI3_BAD_ARGUMENT;
  ali3_vectors *work = &in->next;
  copy_coordinates(work, q, qd, z->nq);
  copy(work->s, in->now.s, z->ng);
  copy(work->sd, in->now.sd, z->ng);
  copy(work->sdd, in->now.sdd, z->ng);
  ali3_driving_time(in, work, t);
  ali3_constraints(in, work->q, work->s, in->step.Phi, in->tangent.J);
  ali3_constraint_rate(in, work->q, work, in->step.Phit);
  ali3_constraint_gamma(in, work->q, work->qd, work, in->step.gamma);
  const ali3_force_call call = {.q = work->q,
                                .qd = work->qd,
                                .y_old = y != NULL ? y : in->now.y,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = in->element.potential};
  ali3_roads_clear_read_errors(in);
  ali3_forces(in, &call);
  copy(phi, in->step.Phi, z->nc);
  copy(jacobian_values, in->tangent.J, z->nnz_rows);
  copy(phi_t, in->step.Phit, z->nc);
  copy(gamma, in->step.gamma, z->nc);
  copy(force, in->step.Q, z->nq);
  copy(outputs, in->element.out, z->nout);
  return ali3_roads_status(in);
}

/* Adds the lower triangles of the fronts to a dense symmetric matrix. */
static void expand_fronts(const ali3_instance *in, double *dense) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  memset(dense, 0, (size_t)nq * (size_t)nq * sizeof(double));
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f], *idx = S->front_idx + S->front_ptr[f];
    for (int32_t j = 0; j < n; j++)
      for (int32_t i = j; i < n; i++) {
        const double value = in->tangent.F[S->front_off[f] + (int64_t)j * n + i];
        dense[(int64_t)idx[i] * nq + idx[j]] += value;
        if (i != j) dense[(int64_t)idx[j] * nq + idx[i]] += value;
      }
  }
}

ali3_status ali3_mass_matrix(ali3_instance *in, const double *q, double *dense) {
  if (in == NULL || q == NULL || dense == NULL || !ali3_finite(q, in->system->size.nq)) return ALI3_BAD_ARGUMENT;
  copy(in->next.q, q, in->system->size.nq); /* see `copy_coordinates` */
  ali3_mass_to_fronts(in, in->tangent.F);
  ali3_bodies_prepare(in, in->next.q);
  ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
  expand_fronts(in, dense);
  return ALI3_OK;
}

ali3_status ali3_tangent(ali3_instance *in, double h, const double *lam, double *dense) {
  if (in == NULL || dense == NULL || !(h > 0.0) || !(h <= LONGEST_STEP)) return ALI3_BAD_ARGUMENT;
  if (lam != NULL && !ali3_finite(lam, in->system->size.nc)) return ALI3_BAD_ARGUMENT;
  const double c = 0.25 * h * h;
  const ali3_vectors *v = &in->now;
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = v->y,
                                .h = h,
                                .wC = 0.5 * h,
                                .wK = c,
                                .tangent = true,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = in->element.potential};
  ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
  ali3_roads_clear_read_errors(in);
  ali3_forces(in, &call);
  ali3_mass_to_fronts(in, in->tangent.F);
  ali3_rows_square(in, in->tangent.J, c * ali3_penalty(in, h), in->tangent.F);
  if (in->settings.geometric) ali3_geometric(in, v->q, v->s, lam != NULL ? lam : v->lam, c, in->tangent.F);
  ali3_forces_tangent(in, in->tangent.F);
  expand_fronts(in, dense);
  return ali3_roads_status(in);
}

ali3_status ali3_element_step(ali3_instance *in, const double *q, const double *qd, const double *y_old, double h,
                              double *y_new, double *force) {
  if (in == NULL || q == NULL || qd == NULL || !(h >= 0.0) || !(h <= LONGEST_STEP)) return ALI3_BAD_ARGUMENT;
  const ali3_sizes *z = &in->system->size;
  if (!ali3_finite(q, z->nq) || !ali3_finite(qd, z->nq) || (y_old != NULL && !ali3_finite(y_old, z->ny)))
    return ALI3_BAD_ARGUMENT;
  copy_coordinates(&in->next, q, qd, z->nq);
  const ali3_force_call call = {.q = in->next.q,
                                .qd = in->next.qd,
                                .y_old = y_old != NULL ? y_old : in->now.y,
                                .h = h,
                                .wC = 0.5 * h,
                                .wK = 0.25 * h * h,
                                .Q = in->step.Q,
                                .y_new = in->element.y,
                                .out = in->element.out,
                                .potential = in->element.potential};
  ali3_roads_clear_read_errors(in);
  ali3_forces(in, &call);
  copy(y_new, in->element.y, z->ny);
  copy(force, in->step.Q, z->nq);
  return ali3_roads_status(in);
}
