/* Forces at the ports of rigid bodies from a motion of the same model without ports. Positions, velocities,
 * accelerations and multipliers are copied from it; the port forces are the residual of M qdd + Phi_q' lam = Q. */
#include <string.h>

#include "../algebra/finite.h"
#include "../elements/forces.h"
#include "../elements/road.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../state/parameters.h"

static void copy(double *to, const double *from, int64_t n) {
  if (n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

/* Whether the coordinates of `target` map from the coordinates of `source`, and the rest of both states has equal
 * sizes. */
static bool same_model(const ali3_system *target, const ali3_system *source) {
  const ali3_sizes *a = &target->size, *b = &source->size;
  return target->n_ported_ptr == (int64_t)b->nq + 1 && target->n_ported_lam_ptr == (int64_t)b->nc + 1 &&
         a->nu == b->nu && a->np == b->np && a->ng == b->ng && a->ne == b->ne && a->ny == b->ny && a->nout == b->nout &&
         a->n_switch == b->n_switch && target->nr == source->nr;
}

/* q = T q' + constants of the model without ports, and its rates: T is read once for all. */
static void map_coordinates(const ali3_system *S, const ali3_vectors *from, ali3_vectors *to) {
  const size_t size = (size_t)S->size.nq * sizeof(double);
  double *restrict q = to->q, *restrict qd = to->qd, *restrict qdd = to->qdd;
  memcpy(q, S->ported_const, size);
  memset(qd, 0, size);
  memset(qdd, 0, size);
  for (int64_t j = 0; j < S->n_ported_ptr - 1; j++) {
    const double position = from->q[j], velocity = from->qd[j], acceleration = from->qdd[j];
    for (int32_t k = S->ported_ptr[j]; k < S->ported_ptr[j + 1]; k++) {
      const int32_t i = S->ported_row[k];
      const double share = S->ported_val[k];
      q[i] += share * position;
      qd[i] += share * velocity;
      qdd[i] += share * acceleration;
    }
  }
}

/* Multipliers of the rows from the multipliers of the model without ports; 0 for rows of ports. */
static void map_multipliers(const ali3_system *S, const double *from, double *restrict to) {
  memset(to, 0, (size_t)S->size.nc * sizeof(double));
  for (int64_t j = 0; j < S->n_ported_lam_ptr - 1; j++)
    for (int32_t k = S->ported_lam_ptr[j]; k < S->ported_lam_ptr[j + 1]; k++)
      to[S->ported_lam_row[k]] += S->ported_lam_val[k] * from[j];
}

/* Copies the state of the model without ports, except the multipliers of ports. */
static ali3_status copy_state(ali3_instance *in, const ali3_instance *source) {
  const ali3_system *S = in->system;
  const ali3_sizes *z = &S->size;
  const ali3_vectors *from = &source->now;
  ali3_vectors *v = &in->now;
  if (z->np > 0 && memcmp(in->parameters.value, source->parameters.value, (size_t)z->np * sizeof(double)) != 0 &&
      !ali3_parameters_set_all(in, source->parameters.value))
    return ALI3_BAD_ARGUMENT;
  map_coordinates(S, from, v);
  map_multipliers(S, from->lam, v->lam);
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

/* Computes the forces as at the end of the last step, or at a start. */
static void end_forces(ali3_instance *in) {
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

/* Multipliers of the ports from the residual of the equations of motion without them. */
static void solve_port_multipliers(ali3_instance *in) {
  const ali3_system *S = in->system;
  double *residual = in->step.r;
  ali3_constraints(in, in->now.q, in->now.s, in->step.Phi, in->tangent.J);
  ali3_rows_transposed(S, in->tangent.J, in->now.lam, in->step.x);
  ali3_mass_times(in, in->now.qdd, residual);
  for (int32_t i = 0; i < S->size.nq; i++) residual[i] = in->step.Q[i] - residual[i] - in->step.x[i];
  for (int32_t r = 0; r < S->size.nc; r++)
    for (int32_t k = S->ported_force_ptr[r]; k < S->ported_force_ptr[r + 1]; k++)
      in->now.lam[r] += S->ported_force_val[k] * residual[S->ported_force_col[k]];
}

ali3_status ali3_ports_follow(ali3_instance *in, const ali3_instance *source) {
  if (in == NULL || source == NULL || !same_model(in->system, source->system)) return ALI3_BAD_ARGUMENT;
  if (!source->start.initialised) return ALI3_NOT_INITIALISED;
  const ali3_status status = copy_state(in, source);
  if (status != ALI3_OK) return status;
  memcpy(in->roads.used, source->roads.used,
         (size_t)in->system->nr * sizeof *in->roads.used); /* uses its tiles, which are in memory */
  end_forces(in);
  memcpy(in->roads.used, in->roads.own, (size_t)in->system->nr * sizeof *in->roads.used);
  solve_port_multipliers(in);
  return ali3_finite(in->now.lam, in->system->size.nc) ? ALI3_OK : ALI3_NOT_FINITE;
}
