/* Newton's iteration on the stages of Radau IIA. The tangent is the exact one of all stages together: rows that are
 * redundant are so in a different combination at each stage, and one Phi_q for all stages would turn the multipliers of
 * that combination into forces. */
#include <math.h>
#include <string.h>

#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../elements/forces.h"
#include "../elements/signals.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../rows/constraints.h"
#include "../rows/driving_functions.h"
#include "../rows/violation.h"
#include "newton.h"
#include "radau.h"

enum { REFINEMENTS = 3 };
static const double SLOW_RATIO = 0.3;         /* ratio of two errors above which the tangent is computed again */
static const double REFINED = 1e-2;       /* of the tolerances: below it refinement ends */
/* Largest remaining error and round-off, relative to accelerations. */
static const double ERROR_FRACTION = 1e-5, ROUND_OFF = 1e-12;
static const double STALL_LIMIT = 1e-9; /* below it a stalled iteration is round-off */

/* Residuals of stage i, nq. */
static double *stage_residual(const ali3_instance *in, int i) { return stage_acceleration(in, STAGES + i); }

void ali3_radau_set_stage(ali3_instance *in, double t, double h, int i) {
  const ali3_vectors *from = &in->now;
  ali3_vectors *to = &in->next;
  const double *restrict a0 = stage_acceleration(in, 0), *restrict a1 = stage_acceleration(in, 1),
                         *restrict a2 = stage_acceleration(in, 2);
  for (int32_t k = 0; k < in->system->size.nq; k++) {
    to->qd[k] = from->qd[k] + h * (A[i][0] * a0[k] + A[i][1] * a1[k] + A[i][2] * a2[k]);
    to->q[k] = from->q[k] + h * (node[i] * from->qd[k] + h * (A2[i][0] * a0[k] + A2[i][1] * a1[k] + A2[i][2] * a2[k]));
  }
  in->inputs.forces = in->inputs.stage + (int64_t)i * in->system->size.nu;
  ali3_driving_time(in, to, t - (1.0 - node[i]) * h);
}

/* Forces at in->next; tangents of elements for weights above 0. */
static void evaluate_forces(ali3_instance *in, double wC, double wK) {
  ali3_force_call call = ali3_forces_at(in, &in->next);
  call.wC = wC;
  call.wK = wK;
  call.tangent = wC + wK > 0.0;
  ali3_forces(in, &call);
}

/* Rows and residuals r_i = M a_i + Phi_q' lam_i - Q of all stages; the report has the worst. False: not finite. */
static bool evaluate(ali3_instance *in, double t, double h) {
  const ali3_system *S = in->system;
  double largest = 0.0, open = 0.0;
  for (int i = 0; i < STAGES; i++) { /* ascending, as a stage may overwrite the number after its own */
    double *Phi = stage_rows(in, in->radau.Phi, i), *J = stage_entries(in, in->radau.J, i), *r = stage_residual(in, i);
    ali3_radau_set_stage(in, t, h, i);
    ali3_constraints(in, in->next.q, in->next.s, Phi, J);
    evaluate_forces(in, 0.0, 0.0);
    if (S->n_work > 0) memcpy(stage_power(in, i), in->watch.now, (size_t)S->n_work * sizeof(double));
    ali3_mass_times(in, stage_acceleration(in, i), r);
    ali3_rows_transposed(S, J, stage_rows(in, in->radau.lam, i), in->step.x);
    for (int32_t k = 0; k < S->size.nq; k++) {
      r[k] += in->step.x[k] - in->step.Q[k];
      const double size = 0.5 * h * h * fabs(r[k]) * in->mass.floor_inverse[k];
      if (!(size <= largest) && largest == largest) { /* a NaN stays */
        largest = size;
        in->report.worst_coordinate = k;
      }
    }
    int32_t worst = 0;
    const double violation = ali3_violation(S, Phi, &worst);
    if (!(violation <= open) && open == open) {
      open = violation;
      in->report.worst_row = worst;
    }
  }
  in->report.iterations += STAGES;
  in->report.residual = largest;
  in->report.violation = open;
  return largest < 1e300 && open < 1e300;
}

/* Writes blocks (stage, k) of the tangent of all stages, M + h A_ik C + h^2 (A^2)_ik K, from the fronts of one
 * stage. */
static void add_stage_blocks(ali3_instance *in, double h, int stage) {
  const ali3_system *S = in->system;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t n = S->front_ptr[f + 1] - S->front_ptr[f];
    const double *M = in->tangent.F + S->front_off[f], *C = in->radau.F_C + S->front_off[f],
                 *K = in->radau.F_K + S->front_off[f];
    double *block = in->radau.F + (int64_t)STAGES * STAGES * S->front_off[f];
    for (int k = 0; k < STAGES; k++) {
      const double wM = k == stage ? 1.0 : 0.0, wC = h * A[stage][k], wK = h * h * A2[stage][k];
      for (int32_t j = 0; j < n; j++)
        for (int32_t i = j; i < n; i++) {
          const int64_t at = (int64_t)j * n + i;
          const double value = wM * M[at] + wC * C[at] + wK * K[at];
          block[(int64_t)(STAGES * j + k) * STAGES * n + STAGES * i + stage] = value;
          block[(int64_t)(STAGES * i + k) * STAGES * n + STAGES * j + stage] = value;
        }
    }
  }
}

/* Factorises the tangent of the present stages; in->tangent.F, in->radau.F_C, in->radau.F_K are left with those of the
 * last stage. */
static ali3_status factorise(ali3_instance *in, double t, double h, double alpha) {
  const ali3_system *S = in->system;
  const size_t size = (size_t)S->size.front_size * sizeof(double);
  const bool flexible = S->n_flexible > 0;
  memcpy(in->radau.J_made, in->radau.J, STAGES * (size_t)S->size.nnz_rows * sizeof(double));
  for (int i = 0; i < STAGES; i++) {
    ali3_radau_set_stage(in, t, h, i);
    ali3_mass_to_fronts(in, in->tangent.F);
    memset(in->radau.F_C, 0, size);
    memset(in->radau.F_K, 0, size);
    evaluate_forces(in, 1.0, 0.0);
    ali3_elements_tangent(in, in->radau.F_C);
    evaluate_forces(in, 0.0, 1.0);
    ali3_elements_tangent(in, in->radau.F_K);
    if (flexible) {
      ali3_bodies_tangent(in, 1.0, 0.0, 0.0, in->tangent.F);
      ali3_bodies_tangent(in, 0.0, 1.0, 0.0, in->radau.F_C);
      ali3_bodies_tangent(in, 0.0, 0.0, 1.0, in->radau.F_K);
    }
    if (in->settings.geometric)
      ali3_geometric(in, in->next.q, in->next.s, stage_rows(in, in->radau.lam, i), 1.0, in->radau.F_K);
    ali3_rows_square(in, stage_entries(in, in->radau.J, i), alpha, in->radau.F_K);
    add_stage_blocks(in, h, i);
  }
  return ali3_factorise_lu(in, STAGES, in->radau.F);
}

/* in->step.w = sum_k (A^2)_ik x_k of the interleaved corrections x. */
static void sum_corrections(ali3_instance *in, int i) {
  for (int32_t k = 0; k < in->system->size.nq; k++) {
    const double *x = in->radau.x + STAGES * (int64_t)k;
    in->step.w[k] = A2[i][0] * x[0] + A2[i][1] * x[1] + A2[i][2] * x[2];
  }
}

/* Size of accelerations in the metric of the masses; stage i of coordinate k is at v[k * coordinate_stride + i *
 * stage_stride]. */
static double acceleration_size(const ali3_instance *in, const double *v, int64_t coordinate_stride,
                                int64_t stage_stride) {
  double square = 0.0;
  for (int32_t k = 0; k < in->system->size.nq; k++)
    for (int i = 0; i < STAGES; i++) {
      const double x = v[k * coordinate_stride + i * stage_stride];
      square += in->mass.floor[k] * x * x;
    }
  return sqrt(square);
}

/* One Newton correction. *change: size of the correction relative to the accelerations. */
static ali3_status correct(ali3_instance *in, double h, double alpha, double *change) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  for (int i = 0; i < STAGES; i++) {
    const double *Phi = stage_rows(in, in->radau.Phi, i), *r = stage_residual(in, i);
    for (int32_t k = 0; k < nc; k++) in->step.mu[k] = alpha * Phi[k];
    ali3_rows_transposed(S, stage_entries(in, in->radau.J_made, i), in->step.mu, in->step.x);
    for (int32_t k = 0; k < nq; k++) in->radau.x[STAGES * k + i] = -(r[k] + in->step.x[k]);
  }
  ali3_solve_lu(in, STAGES, in->radau.F, in->radau.x);
  if (!ali3_finite(in->radau.x, STAGES * (int64_t)nq)) return ALI3_NOT_FINITE;
  for (int i = 0; i < STAGES; i++) {
    double *lam = stage_rows(in, in->radau.lam, i), *a = stage_acceleration(in, i);
    const double *Phi = stage_rows(in, in->radau.Phi, i);
    sum_corrections(in, i);
    ali3_rows_times(S, stage_entries(in, in->radau.J_made, i), in->step.w, in->step.mu);
    for (int32_t k = 0; k < nc; k++) lam[k] += alpha * (Phi[k] + h * h * in->step.mu[k]);
    for (int32_t k = 0; k < nq; k++) a[k] += in->radau.x[STAGES * k + i];
  }
  const double size = acceleration_size(in, in->step.stage, 1, nq);
  *change = size > 0.0 ? acceleration_size(in, in->radau.x, STAGES, 1) / size : 0.0;
  return ALI3_OK;
}

/* Largest violation of the rows at the stages, m. */
static double largest_opening(const ali3_instance *in) {
  double largest = 0.0;
  for (int i = 0; i < STAGES; i++) largest = fmax(largest, ali3_opening(in->system, stage_rows(in, in->radau.Phi, i)));
  return largest;
}

ali3_status ali3_radau_newton(ali3_instance *in, double t, double h, double alpha, bool extrapolated) {
  const ali3_settings *settings = &in->settings;
  const double residual_limit = in->system->fine * settings->tolerance_r,
               opening_limit = in->system->fine * settings->tolerance_phi;
  double last_error, change = 0.0, limit = ROUND_OFF;
  bool new_tangent = true;
  int32_t refinements = 0;
  if (!evaluate(in, t, h)) return ALI3_NOT_FINITE;
  last_error = fmax(in->report.residual / residual_limit, largest_opening(in) / opening_limit);
  for (int32_t iteration = 0; iteration < settings->max_iterations; iteration++) {
    ali3_status status = new_tangent ? factorise(in, t, h, alpha) : ALI3_OK;
    if (status == ALI3_OK) status = correct(in, h, alpha, &change);
    if (status != ALI3_OK) return ali3_newton_failure(in, status);
    if (!evaluate(in, t, h)) return ALI3_NOT_FINITE;
    const double r = in->report.residual / residual_limit, v = largest_opening(in) / opening_limit;
    const double size = fmax(r, v), remaining = size < last_error ? change * size / last_error : change;
    if (iteration == 0 && extrapolated) limit = fmax(ROUND_OFF, ERROR_FRACTION * change * change);
    if (r <= REFINED && v <= REFINED && remaining <= limit) return ALI3_OK;
    const bool slow = iteration > 0 && size > SLOW_RATIO * last_error;
    if (size <= 1.0 && (refinements++ == REFINEMENTS || (slow && (new_tangent || remaining <= STALL_LIMIT))))
      return ALI3_OK;
    new_tangent = slow;
    last_error = size;
  }
  return ALI3_NOT_CONVERGED;
}

void ali3_radau_remove_redundant(ali3_instance *in, double h, double alpha) {
  const ali3_system *S = in->system;
  for (int i = 0; i < STAGES; i++) {
    ali3_rows_transposed(S, stage_entries(in, in->radau.J_made, i), stage_rows(in, in->radau.lam, i), in->step.x);
    for (int32_t k = 0; k < S->size.nq; k++) in->radau.x[STAGES * k + i] = in->step.x[k];
  }
  ali3_solve_lu(in, STAGES, in->radau.F, in->radau.x);
  for (int i = 0; i < STAGES; i++) {
    double *lam = stage_rows(in, in->radau.lam, i);
    sum_corrections(in, i);
    ali3_rows_times(S, stage_entries(in, in->radau.J_made, i), in->step.w, lam);
    for (int32_t k = 0; k < S->size.nc; k++) lam[k] *= alpha * h * h;
  }
}
