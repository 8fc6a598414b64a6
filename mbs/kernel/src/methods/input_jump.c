/* Accelerations and multipliers at the start of a step where inputs jump: the trapezoidal rule uses them, and those
 * before the jump would delay every force by half a step. A driving function that follows an input has a continuous
 * rate and needs no change. */
#include <string.h>

#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../start/index_one.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "input_jump.h"

/* Evaluates forces at in->now with given inputs, and the states of elements, whose rates depend on them. */
static void evaluate_forces(ali3_instance *in, const double *input, double *Q, double *y, double *potential) {
  const ali3_vectors *v = &in->now;
  const ali3_force_call call = {
      .q = v->q, .qd = v->qd, .y_old = v->y, .Q = Q, .y_new = y, .out = in->element.out, .potential = potential};
  in->inputs.forces = input;
  ali3_forces(in, &call);
  in->inputs.forces = in->inputs.set;
}

static void add(double *to, const double *change, int32_t n) {
  for (int32_t i = 0; i < n; i++) to[i] += change[i];
}

/* Computes the changes of accelerations, in->step.x, and multipliers, in->step.lam, at in->now by a change of inputs;
 * *force_changes false: no force changes and nothing is solved. `force` receives the forces of elements with work
 * sensors before, in->watch.now has those after it; in->next.y and in->element.y have the states of elements. M x +
 * Phi_q' lam = change of Q, Phi_q x = 0 by the penalty, with the tangent of the trapezoidal rule for flexible bodies,
 * whose unresolved modes would oscillate otherwise. */
static ali3_status input_change(ali3_instance *in, double h, const double *before, const double *after, double *force,
                                bool *force_changes) {
  const ali3_system *S = in->system;
  const ali3_vectors *v = &in->now;
  const int32_t nq = S->size.nq;
  evaluate_forces(in, before, in->step.x, in->next.y, in->next.potential); /* overwritten by the next step */
  for (int32_t i = 0; i < S->n_work_force; i++) force[i] = in->watch.now[S->n_work + i];
  evaluate_forces(in, after, in->step.Q, in->element.y, in->element.potential);
  ali3_work_of_inputs(in, in->next.potential, in->element.potential);
  *force_changes = memcmp(in->step.x, in->step.Q, (size_t)nq * sizeof(double)) != 0;
  if (!*force_changes) return ALI3_OK;
  for (int32_t i = 0; i < nq; i++) in->step.x[i] = in->step.Q[i] - in->step.x[i];
  ali3_constraints(in, v->q, v->s, in->step.Phi, in->tangent.J);
  ali3_mass_to_fronts(in, in->tangent.F);
  ali3_rows_square(in, in->tangent.J, ALI3_INDEX_ONE_PENALTY, in->tangent.F);
  if (S->n_flexible + S->n_lookup > 0) ali3_bodies_tangent(in, 1.0, 0.5 * h, 0.25 * h * h, in->tangent.F);
  const ali3_status status = ali3_factorise(in, in->tangent.F);
  if (status != ALI3_OK) return status;
  ali3_solve(in, in->tangent.F, in->step.x);
  ali3_rows_times(S, in->tangent.J, in->step.x, in->step.lam);
  for (int32_t k = 0; k < S->size.nc; k++) in->step.lam[k] *= ALI3_INDEX_ONE_PENALTY;
  return ALI3_OK;
}

ali3_status ali3_input_jump(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  ali3_vectors *v = &in->now;
  double *before = in->stored.direction.step_force, *work_force = v->watched + S->n_work;
  bool force_changes;
  if (!ali3_inputs_jump(in)) return ALI3_OK;
  ali3_back_up(in);
  const ali3_status status = input_change(in, h, v->used, in->inputs.begin, before, &force_changes);
  if (status != ALI3_OK) return status;
  /* by the change only: Newton's iteration used states of elements half a step earlier */
  for (int32_t i = 0; i < S->n_work_force; i++) work_force[i] += in->watch.now[S->n_work + i] - before[i];
  memcpy(v->used, in->inputs.begin, (size_t)S->size.nu * sizeof(double));
  if (!force_changes) return ALI3_OK;
  add(v->qdd, in->step.x, nq);
  add(v->lam, in->step.lam, nc);
  for (int32_t i = 0; i < S->size.ny; i++) v->y[i] += in->element.y[i] - in->next.y[i];
  if (v->history[ALI3_HISTORY_OWNER] == (double)ALI3_METHOD_GENERALISED_ALPHA) add(v->own, in->step.x, nq);
  for (int k = 0; k < ALI3_PAST && v->history[ALI3_HISTORY_COUNT] > 0.0; k++) {
    add(v->past_a + (int64_t)k * nq, in->step.x, nq);
    add(v->past_lam + (int64_t)k * nc, in->step.lam, nc);
  }
  return ALI3_OK;
}
