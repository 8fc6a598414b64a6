/* One ALi3-P step: trapezoidal rule (17), (18) in the increment D = q_(n+1) - q_n, Newton on (19), (20), projections
 * (24), (25). */
#include <math.h>
#include <string.h>

#include "ali3_internal.h"

enum { QUIET_STEPS = 6, MAX_SWEEPS = 3 };
static const double UNRESOLVED = 2.0; /* step times frequency of a mode, rad */
/* Relative violations at which projections end: velocities at round-off; accelerations only steer the next
 * prediction. */
static const double VELOCITY_TOLERANCE = 1e-12, ACCELERATION_TOLERANCE = 1e-9;
static const double MOST_STIFF = 100.0; /* a higher penalty would only bring round-off */

bool ali3_finite(const double *v, int64_t n) {
  double sum = 0.0; /* x - x is 0 for finite x, NaN else */
  for (int64_t i = 0; i < n; i++) sum += v[i] - v[i];
  return sum == 0.0;
}

void ali3_mass_times(const ali3_instance *in, const double *x, double *out) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->size.nq; i++) {
    double sum = 0.0;
    for (int32_t k = S->mass_ptr[i]; k < S->mass_ptr[i + 1]; k++) sum += S->mass_val[k] * x[S->mass_col[k]];
    out[i] = sum;
  }
  if (S->n_flexible > 0) ali3_flexible_mass_times(in, x, out);
}

/* The rows are mass-normalised, so alpha is a squared frequency and alpha h^2 a pure number. Where flexible bodies
 * resist a row rather by their stiffness, K h^2/4 against M, the multipliers need a higher penalty to converge as fast. */
double ali3_penalty(const ali3_instance *in, double h) {
  const ali3_settings *s = &in->settings;
  const double stiff = 0.25 * h * h * in->system->flex_rate;
  return s->alpha > 0.0 ? s->alpha : (1.0 + (stiff < MOST_STIFF ? stiff : MOST_STIFF)) / (s->eps_rel * h * h);
}

double ali3_violation(const ali3_system *S, const double *Phi, int32_t *worst) {
  double largest = 0.0;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const double v = fabs(Phi[k]) * S->row_measure[k];
    if (!(v <= largest) && largest == largest) { /* a NaN stays */
      largest = v;
      *worst = k;
    }
  }
  return largest;
}

bool ali3_closed(const ali3_system *S, const double *Phi, double tolerance) {
  for (int32_t k = 0; k < S->size.nc; k++)
    if (!(fabs(Phi[k]) * S->row_measure[k] <= tolerance + S->row_round[k])) return false;
  return true;
}

/* v -= T^-1 factor Phi_q' (Phi_q v + b) until the violation is round-off: (24), (25) in correction form. The Phi_q'
 * that spreads the correction is that of the tangent: the penalty would amplify what a later one has outside its
 * range. The violation is judged at the converged position. Returns it. With accelerations in v, lam (or NULL) takes
 * the multipliers along: T x = Phi_q' mu is (T - factor Phi_q' Phi_q) x = Phi_q' (mu - factor Phi_q x). */
double ali3_project(ali3_instance *in, double factor, const double *b, double *v, double *lam, double tolerance,
                    int32_t sweeps) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  for (int32_t sweep = 0;; sweep++) {
    double violation = 0.0, scale = 0.0;
    ali3_rows_times(S, in->J, v, in->mu);
    for (int32_t k = 0; k < nc; k++) {
      in->mu[k] += b[k];
      const double size = fabs(in->mu[k]) * S->row_measure[k];
      if (size > violation) violation = size;
    }
    for (int32_t i = 0; i < nq; i++)
      if (fabs(v[i]) > scale) scale = fabs(v[i]);
    if (sweep == sweeps || violation <= tolerance * scale) return violation;
    for (int32_t k = 0; k < nc; k++) in->mu[k] *= factor;
    ali3_rows_transposed(S, in->J_tangent, in->mu, in->x);
    ali3_solve(in, in->F, in->x);
    for (int32_t i = 0; i < nq; i++) v[i] -= in->x[i];
    if (lam == NULL) continue;
    ali3_rows_times(S, in->J_tangent, in->x, in->lam);
    for (int32_t k = 0; k < nc; k++) lam[k] += in->mu[k] - factor * in->lam[k];
  }
}

/* Positions, rates, rows, forces and residual r = M (D - d0) + c (Phi_q' lam - Q) of (20) for the present D and lam. */
static void evaluate(ali3_instance *in, double h, bool tangent) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const double c = in->rule.c, rate = in->rule.rate;
  ali3_vectors *to = &in->next;
  for (int32_t i = 0; i < nq; i++) {
    to->q[i] = in->now.q[i] + in->D[i];
    to->qd[i] = rate * in->D[i] + in->hat[i];
    in->w[i] = in->D[i] - in->d0[i];
  }
  ali3_constraints(in, to->q, to->s, in->Phi, in->J);
  const ali3_force_call call = {to->q,   to->qd, in->now.y, h,       in->rule.wC,  c,
                                tangent, in->Q,  to->y,     to->out, to->potential};
  ali3_forces(in, &call);
  ali3_mass_times(in, in->w, in->r);
  for (int32_t i = 0; i < nq; i++) in->r[i] -= c * in->Q[i];
}

/* Residual with the multipliers; fills the report. Returns false when something is not finite. */
static bool judge(ali3_instance *in) {
  const ali3_system *S = in->system;
  const double c = in->rule.c;
  double largest = 0.0;
  ali3_rows_transposed(S, in->J, in->next.lam, in->x);
  for (int32_t i = 0; i < S->size.nq; i++) {
    const double size = fabs(in->r[i] + c * in->x[i]) * S->mass_floor_inverse[i];
    if (!(size <= largest) && largest == largest) { /* a NaN stays */
      largest = size;
      in->report.worst_coordinate = i;
    }
  }
  in->report.residual = largest;
  in->report.violation = ali3_violation(S, in->Phi, &in->report.worst_row);
  return in->report.residual < 1e300 && in->report.violation < 1e300;
}

/* One Newton correction (21) with the tangent (23) and the multiplier update. */
static ali3_status correct(ali3_instance *in, double alpha, int32_t iteration) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const double c = in->rule.c;
  double *lam = in->next.lam;
  memcpy(in->F, S->front_mass, (size_t)S->size.front_size * sizeof(double));
  ali3_rows_square(in, in->J, c * alpha, in->F);
  if (in->settings.geometric) ali3_geometric(in, in->next.q, in->next.s, lam, c, in->F);
  ali3_forces_tangent(in, in->F);
  const ali3_status status = ali3_factorise(in, in->F);
  if (status != ALI3_OK) return status;
  for (int32_t k = 0; k < nc; k++) in->mu[k] = lam[k] + alpha * in->Phi[k];
  ali3_rows_transposed(S, in->J, in->mu, in->x);
  for (int32_t i = 0; i < nq; i++) in->x[i] = -(in->r[i] + c * in->x[i]);
  ali3_solve(in, in->F, in->x);
  if (!ali3_finite(in->x, nq)) return ALI3_NOT_FINITE;
  if (in->settings.update == ALI3_UPDATE_LINEARISED) {
    ali3_rows_times(S, in->J, in->x, in->gamma);
    for (int32_t k = 0; k < nc; k++) in->lam[k] = alpha * (in->Phi[k] + in->gamma[k]);
    ali3_accelerate(in, iteration);
    for (int32_t k = 0; k < nc; k++) lam[k] += in->lam[k];
  }
  for (int32_t i = 0; i < nq; i++) in->D[i] += in->x[i];
  return ALI3_OK;
}

static ali3_status newton(ali3_instance *in, double h, double alpha, int32_t *iterations) {
  const ali3_settings *settings = &in->settings;
  evaluate(in, h, true);
  for (*iterations = 0; *iterations < settings->max_iterations;) {
    const ali3_status status = correct(in, alpha, *iterations);
    if (status != ALI3_OK) return status;
    ++*iterations;
    double *J = in->J;
    in->J = in->J_tangent;
    in->J_tangent = J;
    evaluate(in, h, true);
    if (settings->update == ALI3_UPDATE_PAPER) /* (16) */
      for (int32_t k = 0; k < in->system->size.nc; k++) in->next.lam[k] += alpha * in->Phi[k];
    if (!judge(in)) return ALI3_NOT_FINITE;
    if (in->report.residual <= settings->tolerance_r && ali3_closed(in->system, in->Phi, settings->tolerance_phi))
      return ALI3_OK;
  }
  return ALI3_NOT_CONVERGED;
}

/* Trapezoidal rule (17), (18). */
static void trapezoidal(ali3_instance *in, double h) {
  const ali3_rule rule = {0.25 * h * h, 2.0 / h, 0.5 * h};
  in->rule = rule;
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    in->d0[i] = h * in->now.qd[i] + rule.c * in->now.qdd[i];
    in->hat[i] = -in->now.qd[i];
  }
}

/* Generalised-alpha of Chung and Hulbert in the form of Arnold and Bruels: an algorithmic acceleration a (in->now.own)
 * with (1 - am) a1 + am a0 = (1 - af) qdd1 + af qdd0; the balance of forces holds at the end of the step. */
typedef struct {
  double am, af, beta, gamma;
} ali3_alpha;

static ali3_alpha alpha_of(double rho) {
  const double am = (2.0 * rho - 1.0) / (rho + 1.0), af = rho / (rho + 1.0), gamma = 0.5 + af - am;
  const ali3_alpha x = {am, af, 0.25 * (gamma + 0.5) * (gamma + 0.5), gamma};
  return x;
}

/* At a start, light nodes of flexible bodies have the accelerations of loads they have not bent under yet. Where the
 * step does not resolve the fastest mode, the trapezoidal rule would let that ring: the first steps have no memory of
 * it at high frequencies. */
static bool quiet_start(const ali3_instance *in, double h) {
  return in->system->n_flexible > 0 && h * h * in->system->flex_rate > UNRESOLVED * UNRESOLVED &&
         in->settings.method == ALI3_METHOD_ALI3P && in->settings.project && in->report.steps < QUIET_STEPS;
}

static double rho_of(const ali3_instance *in, double h) { return quiet_start(in, h) ? 0.0 : in->settings.rho_infinity; }

static void generalised_alpha(ali3_instance *in, double h) {
  const ali3_alpha x = alpha_of(rho_of(in, h));
  const double c = (1.0 - x.af) * x.beta * h * h / (1.0 - x.am), rate = x.gamma / (x.beta * h);
  const ali3_rule rule = {c, rate, c * rate};
  const ali3_vectors *from = &in->now;
  in->rule = rule;
  ali3_history_own(in, ALI3_METHOD_GENERALISED_ALPHA, from->qdd);
  if (quiet_start(in, h) && in->report.steps == 0) { /* one acceleration, that at its end, for the whole first step */
    const ali3_rule first = {0.5 * h * h, 2.0 / h, h};
    in->rule = first;
    for (int32_t i = 0; i < in->system->size.nq; i++) {
      in->d0[i] = h * from->qd[i];
      in->hat[i] = -from->qd[i];
    }
    return;
  }
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    const double known = h * from->qd[i] + (0.5 - x.beta) * h * h * from->own[i];
    in->d0[i] = known - c * (x.am * from->own[i] - x.af * from->qdd[i]) / (1.0 - x.af);
    in->hat[i] = from->qd[i] + (1.0 - x.gamma) * h * from->own[i] -
                 x.gamma / x.beta * (from->qd[i] + (0.5 - x.beta) * h * from->own[i]);
  }
}

static void algorithmic_acceleration(ali3_instance *in, double h) {
  const double beta = alpha_of(rho_of(in, h)).beta;
  const bool first = quiet_start(in, h) && in->report.steps == 0;
  memcpy(in->next.memory, in->now.memory, ALI3_MEMORY * sizeof(double));
  for (int32_t i = 0; i < in->system->size.nq; i++)
    in->next.own[i] = first ? (in->D[i] - in->d0[i]) / in->rule.c
                            : (in->D[i] - h * in->now.qd[i] - (0.5 - beta) * h * h * in->now.own[i]) / (beta * h * h);
}

/* From in->now to in->next; in->now changes only when the step is good. t is the time at its end. */
static ali3_status attempt(ali3_instance *in, double t, double h) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const double alpha = ali3_penalty(in, h);
  ali3_vectors *from = &in->now, *to = &in->next;
  const bool is_alpha = in->settings.method == ALI3_METHOD_GENERALISED_ALPHA || quiet_start(in, h);
  int32_t iterations = 0;
  ali3_guides_step(in, from, to, t, h);
  ali3_switch_carry(in);
  ali3_predict(in, h);
  if (is_alpha)
    generalised_alpha(in, h);
  else
    trapezoidal(in, h);
  const double c = in->rule.c;
  memcpy(to->lam, from->lam, (size_t)S->size.nc * sizeof(double));
  memcpy(to->used, in->input, (size_t)S->size.nu * sizeof(double));
  memcpy(to->y_last, from->y, (size_t)S->size.ny * sizeof(double));
  /* derivatives of a step are those of the trapezoidal rule, also in a quiet start */
  to->h_last[0] = in->settings.method == ALI3_METHOD_GENERALISED_ALPHA ? 0.0 : h;
  const ali3_status status = newton(in, h, alpha, &iterations);
  in->report.iterations += iterations;
  in->report.last_iterations = iterations;
  if (iterations > in->report.max_iterations) in->report.max_iterations = iterations;
  if (status != ALI3_OK) return status;
  for (int32_t i = 0; i < nq; i++) to->qdd[i] = (in->D[i] - in->d0[i]) / c;
  if (is_alpha)
    algorithmic_acceleration(in, h);
  else
    to->memory[ALI3_MEMORY_OWNER] = ALI3_METHOD_ALI3P;
  const ali3_force_call call = {to->q, to->qd, from->y, h, in->rule.wC, c, false, in->Q, to->y, to->out, to->potential};
  ali3_forces_accept(in, &call);
  ali3_predict_accept(in, h);
  ali3_constraint_rate(in, to->q, to, in->Phit);
  if (in->settings.project) {
    in->report.velocity_violation = ali3_project(in, c * alpha, in->Phit, to->qd, NULL, VELOCITY_TOLERANCE, MAX_SWEEPS);
    ali3_constraint_gamma(in, to->q, to->qd, to, in->gamma);
    ali3_project(in, c * alpha, in->gamma, to->qdd, to->lam, ACCELERATION_TOLERANCE, MAX_SWEEPS);
  } else {
    in->report.velocity_violation = ali3_project(in, c * alpha, in->Phit, to->qd, NULL, 0.0, 0);
  }
  if (!ali3_finite(to->q, (int64_t)in->n_vector)) return ALI3_NOT_FINITE;
  const ali3_vectors swap = in->now;
  in->now = in->next;
  in->next = swap;
  return ALI3_OK;
}

static ali3_status by_method(ali3_instance *in, double t, double h) {
  switch (in->settings.method) {
  case ALI3_METHOD_ENERGY_MOMENTUM:
    return ali3_energy_momentum(in, t, h, in->now.used, 0.5, !in->quiet);
  case ALI3_METHOD_ENERGY_MOMENTUM_4:
    return ali3_composition(in, t, h);
  case ALI3_METHOD_RUNGE_KUTTA_8:
    return ali3_runge_kutta(in, t, h);
  default:
    return attempt(in, t, h);
  }
}

/* A step to time t, in halves where it does not converge. */
ali3_status ali3_advance(ali3_instance *in, double t, double h, int32_t depth) {
  const ali3_status status = by_method(in, t, h);
  if (status == ALI3_OK || depth <= 0) return status;
  in->report.halvings++;
  const ali3_status first = ali3_advance(in, t - 0.5 * h, 0.5 * h, depth - 1);
  return first == ALI3_OK ? ali3_advance(in, t, 0.5 * h, depth - 1) : first;
}
