/* What inputs that are held over the last step do to its end: (19) and (20) linearised at the converged step and solved
 * with the factorised tangent (23), then the projections (24), (25) linearised.
 * The tangent leaves out the unsymmetric part of the elements, so the linear system is solved in corrections; its
 * residual, the change of rows and forces along a direction, comes from differences of those two alone. */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../flexible/flexible_body.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../methods/input_jump.h"
#include "../methods/newton.h"
#include "../rows/constraints.h"
#include "../rows/guides.h"
#include "../rows/velocity_rows.h"
#include "../sensors/sensors.h"
#include "../state/road_files.h"
#include "../state/vectors.h"

enum { POSITION, VELOCITY, ACCELERATION, MOST_CORRECTIONS = 60, SWEEPS = 2 };
static const double PART = 1e-5; /* of an input's range: the difference taken */
static const double FINE = 1e-9, COARSE = 1e-5; /* last correction relative to the result: wanted, accepted */

typedef struct {
  double h, c, alpha;
  double plus, minus; /* ends of the difference, PART or 0 where an input may not go further */
} linear_step;

/* At now + part * direction: in->x = M(q) qdd + Phi_q' lam - Q, in->Phi = the rows of a stage, out_work and
 * potential_work; qdd are the present ones, and without flexible bodies, whose M changes, its term is left out. */
static void look(ali3_instance *in, const linear_step *step, double part, int stage) {
  const ali3_system *S = in->system;
  const double *now = in->now.q, *direction = in->direction.q;
  ali3_vectors *at = &in->next;
  for (size_t i = 0; i < in->n_vector; i++) at->q[i] = now[i] + part * direction[i];
  memcpy(in->input, at->used, (size_t)S->size.nu * sizeof(double));
  ali3_constraints(in, at->q, at->s, in->Phi, in->J);
  if (stage == POSITION) {
    ali3_velocity_values(in, in->J, at->qd, 2.0 / step->h, in->Phi);
    const ali3_force_call call = {.q = at->q,
                                  .qd = at->qd,
                                  .y_old = in->now.y_last,
                                  .h = step->h,
                                  .wC = 0.5 * step->h,
                                  .wK = step->c,
                                  .Q = in->Q,
                                  .y_new = in->y_work,
                                  .out = in->out_work,
                                  .potential = in->potential_work};
    ali3_forces(in, &call);
    ali3_rows_transposed(S, in->J, at->lam, in->x);
    for (int32_t i = 0; i < S->size.nq; i++) in->x[i] -= in->Q[i];
    if (S->n_flexible == 0) return;
    ali3_mass_times(in, in->now.qdd, in->w);
    for (int32_t i = 0; i < S->size.nq; i++) in->x[i] += in->w[i];
    return;
  }
  ali3_rows_times(S, in->J, stage == VELOCITY ? at->qd : at->qdd, in->Phi);
  if (stage == VELOCITY)
    ali3_constraint_rate(in, at->q, at, in->Phit);
  else
    ali3_constraint_gamma(in, at->q, at->qd, at, in->Phit);
  for (int32_t k = 0; k < S->size.nc; k++) in->Phi[k] += in->Phit[k];
}

static void copy(double *to, const double *from, int32_t n) {
  if (n > 0) memcpy(to, from, (size_t)n * sizeof(double));
}

static void difference(double *first, const double *second, int32_t n, double span) {
  for (int32_t i = 0; i < n; i++) first[i] = (first[i] - second[i]) / span;
}

/* Changes along the tangent: in->r of M qdd + Phi_q' lam - Q at present qdd, in->mu of the rows. */
static void changes(ali3_instance *in, const linear_step *step, int stage) {
  const ali3_sizes *z = &in->system->size;
  const int32_t n_watched = in->system->n_work + in->system->n_work_force;
  look(in, step, step->plus, stage);
  copy(in->r, in->x, z->nq);
  copy(in->mu, in->Phi, z->nc);
  if (stage == POSITION) {
    copy(in->direction.out, in->out_work, z->nout);
    copy(in->direction.potential, in->potential_work, z->ne);
    copy(in->direction.watched, in->watched, n_watched);
  }
  look(in, step, step->minus, stage);
  const double span = step->plus - step->minus;
  difference(in->r, in->x, z->nq, span);
  difference(in->mu, in->Phi, z->nc, span);
  if (stage != POSITION) return;
  difference(in->direction.out, in->out_work, z->nout, span);
  difference(in->direction.potential, in->potential_work, z->ne, span);
  difference(in->direction.watched, in->watched, n_watched, span);
}

/* Filtered guides: ali3_guides_step differentiated with respect to an input that is held over the step. */
static void guides(ali3_instance *in, double h) {
  const ali3_system *S = in->system;
  ali3_vectors *d = &in->direction;
  for (int32_t g = 0; g < S->size.ng; g++) {
    if (S->guide_type[g] == ALI3_GUIDE_OF_TIME) continue;
    const double w = in->guide_real[S->guide_real_ptr[g]], demand = ali3_guide_demand(in, g, in->now.used);
    const bool held = ali3_guide_held(in, g, demand) != demand; /* then it does not follow */
    const double target = held ? 0.0 : ali3_guide_demand(in, g, d->used), decay = ali3_exp(-w * h);
    d->s[g] = target - target * (1.0 + w * h) * decay;
    d->sd[g] = w * w * h * target * decay;
    d->sdd[g] = w * w * (target - d->s[g]) - 2.0 * w * d->sd[g];
  }
}

/* in->d0 and direction.step_force: what the inputs do to accelerations and watched forces at the start of the step, whose
 * place and velocity are those of the end with its accelerations turned back. */
static ali3_status start(ali3_instance *in, const linear_step *step) {
  const ali3_system *S = in->system;
  const double h = step->h, span = step->plus - step->minus;
  double *before = in->input_from, *behind = in->input_to, *force = in->direction.step_force;
  bool jumps;
  memset(in->d0, 0, (size_t)S->size.nq * sizeof(double));
  for (int32_t i = 0; i < S->size.nu; i++) {
    before[i] = in->now.used[i] + step->minus * in->direction.used[i];
    behind[i] = in->now.used[i] + step->plus * in->direction.used[i];
  }
  ali3_vectors_copy(in, &in->whole, &in->now);
  for (int32_t i = 0; i < S->size.nq; i++) {
    in->now.q[i] += h * (0.5 * h * in->now.qdd[i] - in->now.qd[i]);
    in->now.qd[i] -= h * in->now.qdd[i];
  }
  copy(in->now.y, in->now.y_last, S->size.ny);
  const ali3_status status = ali3_input_change(in, h, before, behind, force, &jumps);
  ali3_vectors_copy(in, &in->now, &in->whole);
  for (int32_t i = 0; i < S->n_work_force; i++) force[i] = (in->watched[S->n_work + i] - force[i]) / span;
  for (int32_t i = 0; i < S->size.nq && jumps; i++) in->d0[i] = in->x[i] / span;
  return status;
}

static ali3_status factorise(ali3_instance *in, const linear_step *step) {
  const ali3_system *S = in->system;
  const ali3_vectors *v = &in->now;
  const ali3_force_call call = {.q = v->q,
                                .qd = v->qd,
                                .y_old = v->y_last,
                                .h = step->h,
                                .wC = 0.5 * step->h,
                                .wK = step->c,
                                .tangent = true,
                                .Q = in->Q,
                                .y_new = in->y_work,
                                .out = in->out_work,
                                .potential = in->potential_work};
  ali3_constraints(in, v->q, v->s, in->Phi, in->J_tangent);
  ali3_roads_forgive(in);
  ali3_forces(in, &call);
  if (ali3_roads_status(in) != ALI3_OK) return ALI3_ROAD_LOST;
  memcpy(in->F, in->front_mass, (size_t)S->size.front_size * sizeof(double));
  ali3_rows_square(in, in->J_tangent, step->c * step->alpha, in->F);
  if (in->settings.geometric) ali3_geometric(in, v->q, v->s, v->lam, step->c, in->F);
  ali3_forces_tangent(in, in->F);
  return ali3_factorise(in, in->F);
}

/* One correction of the tangent's q and lam; returns its size relative to q. */
static double correct(ali3_instance *in, const linear_step *step) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  ali3_vectors *d = &in->direction;
  double last = 0.0, size = 0.0;
  changes(in, step, POSITION);
  ali3_flexible_prepare(in, in->now.q);
  for (int32_t i = 0; i < nq; i++) in->hat[i] = d->q[i] - step->c * in->d0[i];
  ali3_mass_times(in, in->hat, in->w);
  for (int32_t k = 0; k < nc; k++) in->mu[k] *= step->alpha;
  ali3_rows_transposed(S, in->J_tangent, in->mu, in->x);
  for (int32_t i = 0; i < nq; i++) in->x[i] = -(in->w[i] + step->c * (in->r[i] + in->x[i]));
  ali3_solve(in, in->F, in->x);
  ali3_rows_times(S, in->J_tangent, in->x, in->gamma);
  for (int32_t k = 0; k < nc; k++) d->lam[k] += in->mu[k] + step->alpha * in->gamma[k];
  for (int32_t i = 0; i < nq; i++) {
    d->q[i] += in->x[i];
    d->qd[i] = 2.0 / step->h * d->q[i];
    last = fmax(last, fabs(in->x[i]));
    size = fmax(size, fabs(d->q[i]));
  }
  if (!ali3_finite(d->q, nq)) return HUGE_VAL;
  return size > 0.0 ? last / size : 0.0;
}

/* The projection of a rate, linearised; accelerations take the multipliers along, as in ali3_project. */
static void project(ali3_instance *in, const linear_step *step, double *rate, int stage) {
  const ali3_system *S = in->system;
  for (int sweep = 0; sweep < SWEEPS; sweep++) {
    changes(in, step, stage);
    for (int32_t k = 0; k < S->size.nc; k++) in->mu[k] *= step->c * step->alpha;
    ali3_rows_transposed(S, in->J_tangent, in->mu, in->x);
    ali3_solve(in, in->F, in->x);
    for (int32_t i = 0; i < S->size.nq; i++) rate[i] -= in->x[i];
    if (stage != ACCELERATION) continue;
    ali3_rows_times(S, in->J_tangent, in->x, in->gamma);
    for (int32_t k = 0; k < S->size.nc; k++) in->direction.lam[k] += in->mu[k] - step->c * step->alpha * in->gamma[k];
  }
}

static ali3_status solve(ali3_instance *in, const linear_step *step) {
  ali3_vectors *d = &in->direction;
  guides(in, step->h);
  ali3_status status = start(in, step);
  if (status == ALI3_OK) status = factorise(in, step);
  if (status != ALI3_OK) return status;
  double relative = HUGE_VAL;
  for (int i = 0; i < MOST_CORRECTIONS && relative > FINE; i++) {
    const double before = relative;
    relative = correct(in, step);
    if (i > 2 && relative <= COARSE && relative > 0.5 * before) break; /* down to the noise of the differences */
  }
  if (!(relative <= COARSE)) return ALI3_NOT_CONVERGED;
  changes(in, step, POSITION); /* element outputs that belong to the last correction */
  for (int32_t i = 0; i < in->system->size.nq; i++) d->qdd[i] = d->q[i] / step->c - in->d0[i];
  if (in->settings.project) {
    project(in, step, d->qd, VELOCITY);
    project(in, step, d->qdd, ACCELERATION);
  }
  return ali3_finite(d->q, (int64_t)in->n_vector) ? ALI3_OK : ALI3_NOT_FINITE;
}

/* The direction in parts of the inputs' ranges goes to the tangent; returns the scale taken out of it. */
static double scale_direction(ali3_instance *in, const double *direction, linear_step *step) {
  const ali3_system *S = in->system;
  double scale = 0.0;
  for (int32_t i = 0; i < S->size.nu; i++) {
    const double range = S->input_max[i] - S->input_min[i];
    scale = fmax(scale, fabs(direction[i]) / (range > 0.0 && range < 1e300 ? range : 1.0));
  }
  step->plus = PART;
  step->minus = -PART;
  for (int32_t i = 0; i < S->size.nu && scale > 0.0; i++) {
    const double d = direction[i] / scale, up = in->now.used[i] + PART * d, down = in->now.used[i] - PART * d;
    in->direction.used[i] = d;
    if (up < S->input_min[i] || up > S->input_max[i]) step->plus = 0.0;
    if (down < S->input_min[i] || down > S->input_max[i]) step->minus = 0.0;
  }
  if (step->plus == step->minus) step->plus = PART; /* at two ends at once */
  return scale;
}

ali3_status ali3_input_derivative(ali3_instance *in, const double *direction, double *out) {
  if (in == NULL || direction == NULL || out == NULL || !ali3_finite(direction, in->system->size.nu))
    return ALI3_BAD_ARGUMENT;
  if (!in->initialised || !(in->now.h_last[0] > 0.0)) return ALI3_NOT_INITIALISED;
  const ali3_sizes *z = &in->system->size;
  const ali3_report report = in->report;
  const double h = in->now.h_last[0];
  linear_step step = {h, 0.25 * h * h, ali3_penalty(in, h), 0.0, 0.0};
  memset(in->direction.q, 0, in->n_vector * sizeof(double));
  memset(out, 0, (size_t)z->ns * sizeof(double));
  const double scale = scale_direction(in, direction, &step);
  if (!(scale > 0.0)) return ALI3_OK;
  copy(in->input_work, in->input, z->nu);
  copy(in->input, in->now.used, z->nu);
  const ali3_status status = solve(in, &step);
  copy(in->input, in->input_work, z->nu);
  in->report = report;
  if (status != ALI3_OK) return status;
  ali3_sensors_derivative(in, out);
  for (int32_t i = 0; i < z->ns; i++) out[i] *= scale;
  return ALI3_OK;
}
