/* The step of methods/augmented_lagrangian.c with control of the iteration by lane: converged lanes keep D,
 * multipliers, tangent and forces, so that later iterations of other lanes do not change them. Lanes that fail are not
 * in group->good and repeat the step in their instances. */
#ifndef ALI3_LANE_STEP_H
#define ALI3_LANE_STEP_H
#ifdef ALI3_WIDTH
#include "../methods/ali3p.h"
#include "../methods/defect_correction.h"
#include "../methods/energy_watch.h"
#include "../methods/extrapolation.h"
#include "../methods/predict.h"
#include "../methods/projection.h"
#include "../rows/turning.h"

/* Lanes in which all n numbers are finite. */
static truth all_finite(const real *v, int32_t n) {
  real sum = {0}; /* v - v is 0 for finite v, otherwise NaN */
  for (int32_t i = 0; i < n; i++) sum += v[i] - v[i];
  return sum == 0.0;
}

/* Evaluates element e in all lanes: f, y, out, potential, idle and, if required, the tangent. */
static void evaluate_law(ali3_lane_group *g, int32_t e, real *f, bool tangent) {
  const ali3_system *S = g->system;
  const int32_t *signal = S->el_sig + S->el_sig_ptr[e], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
  const int32_t beside = S->el_beside[e];
  real u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS]; /* of an element whose signals are not contiguous */
  for (int32_t i = 0; beside < 0 && i < n; i++) u[i] = g->element.u[signal[i]], ud[i] = g->element.ud[signal[i]];
  ali3_element_args a = {.nsig = n,
                         .nreal = S->el_real_ptr[e + 1] - S->el_real_ptr[e],
                         .nint = S->el_int_ptr[e + 1] - S->el_int_ptr[e],
                         .nstate = S->el_state_ptr[e + 1] - S->el_state_ptr[e],
                         .nout = S->el_out_ptr[e + 1] - S->el_out_ptr[e],
                         .u = beside < 0 ? u : g->element.u + beside,
                         .ud = beside < 0 ? ud : g->element.ud + beside,
                         .y_old = g->now.y + S->el_state_ptr[e],
                         .y_new = g->next.y + S->el_state_ptr[e],
                         .h = g->h,
                         .reach = *g->reach,
                         .wC = g->rule.wC,
                         .wK = g->rule.c,
                         .real = g->el_real + S->el_real_ptr[e],
                         .integer = S->el_int + S->el_int_ptr[e],
                         .input = g->input,
                         .roads = g->road,
                         .f = f,
                         .S = tangent && S->el_front[e] >= 0 ? g->element.S + S->el_S_off[e] : NULL,
                         .out = g->out + S->el_out_ptr[e]};
  memset(a.f, 0, (size_t)n * sizeof *a.f);
  if (a.S != NULL) memset(a.S, 0, (size_t)(n * n) * sizeof *a.S);
  law_of(S->el_kind[e])(&a);
  g->potential[e] = a.potential;
  g->element.idle[e] = (truth){0} - a.idle;
}

/* Evaluates element e in the lanes of in->evaluated. */
static void evaluate_element(ali3_lane_group *in, int32_t e, real *f, bool tangent) {
  if (in->by_law[e])
    evaluate_law(in, e, f, tangent);
  else
    ali3_lane_element(in, e, f, tangent);
}

/* Evaluates the elements of some lanes; of the others only tangents may change, which they do not read again. */
static void evaluate_elements(ali3_lane_group *in, truth lanes, bool tangent) {
  const ali3_system *S = in->system;
  *in->evaluated = lanes;
  for (int32_t e = 0; e < S->size.ne; e++) evaluate_element(in, e, in->element.force + S->el_sig_ptr[e], tangent);
}

/* Outputs other than f are overwritten by the next iterate; converged lanes get the same values. */
void ali3_elements_defect(ali3_lane_group *in, double h, truth lanes, const real *q, const real *qd, real *r) {
  const ali3_system *S = in->system;
  real ud[ALI3_MAX_SIGNALS], f[ALI3_MAX_SIGNALS];
  (void)h;
  *in->evaluated = lanes;
  memset(r, 0, (size_t)S->size.nq * sizeof *r);
  ali3_active_signals(in, q, qd);
  for (int32_t e = 0; e < S->size.ne; e++) {
    if (S->el_front[e] < 0) continue;
    for (int32_t i = S->el_sig_ptr[e]; i < S->el_sig_ptr[e + 1]; i++)
      ud[i - S->el_sig_ptr[e]] = in->element.ud[S->el_sig[i]];
    evaluate_element(in, e, f, false);
    ali3_add_defect(in, e, ud, f, r);
  }
}

/* Generalised forces in->step.Q at in->next; tangents of elements if required. */
static void evaluate_forces(ali3_lane_group *in, truth lanes, bool tangent) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const real *q = in->next.q, *qd = in->next.qd;
  if (S->n_tabled > 0) {
    ali3_tabled_prepare(in, q);
    ali3_tabled_extend(in, q, qd, NULL, false);
    memset(in->tabled.force + nq, 0, (size_t)S->n_dependent * sizeof *q);
    q = in->tabled.extended[0], qd = in->tabled.extended[1];
  }
  ali3_active_signals(in, q, qd);
  real *Q = S->n_tabled > 0 ? in->tabled.force : in->step.Q; /* followed by those on dependents */
  memcpy(Q, in->mass.gravity, (size_t)nq * sizeof *Q);
  if (S->n_flexible > 0) {
    ali3_flexible_prepare(in, q);
    ali3_flexible_forces(in, q, qd, false, Q);
  }
  evaluate_elements(in, lanes, tangent);
  ali3_add_forces(in, in->element.force, Q);
  if (S->n_tabled > 0) ali3_tabled_forces(in, in->next.qd, in->step.Q);
}

/* Positions, rates, rows and the residual r = M (D - d0) - c Q of the iterate D. */
static void evaluate(ali3_lane_group *in, truth lanes, bool tangent) {
  const ali3_system *S = in->system;
  const double c = in->rule.c, rate = in->rule.rate;
  const real *D = in->step.D, *d0 = in->step.d0, *now = in->now.q, *hat = in->step.hat, *Q = in->step.Q;
  real *q = in->next.q, *qd = in->next.qd, *w = in->step.w, *r = in->step.r;
  for (int32_t i = 0; i < S->size.nq; i++) {
    q[i] = now[i] + D[i];
    qd[i] = rate * D[i] + hat[i];
    w[i] = D[i] - d0[i];
  }
  ali3_constraints(in, in->next.q, in->next.s, in->step.Phi, in->tangent.J);
  ali3_velocity_values(in, in->tangent.J, in->next.qd, rate, in->step.Phi);
  evaluate_forces(in, lanes, tangent);
  ali3_mass_times(in, w, r);
  for (int32_t i = 0; i < S->size.nq; i++) r[i] -= c * Q[i];
}

/* Largest of n values |x| factor, infinite if one is NaN; *worst: index of the first largest one, unchanged if it is 0.
 * Factors differ by lane or are common to all. */
static inline real largest_size(const real *x, const real *of_lanes, const double *of_all, int32_t n, truth *worst) {
  enum { CHAINS = 4 }; /* independent chains of comparisons hide their latency */
  real largest[CHAINS] = {0};
  truth has_nan = {0};
#define ALI3_SIZE(i) (ali3_abs(x[i]) * (of_all == NULL ? of_lanes[i] : ali3_same(of_all[i])))
  for (int32_t i = 0; i < n; i += CHAINS)
    for (int32_t k = 0; k < CHAINS && i + k < n; k++) {
      const real size = ALI3_SIZE(i + k);
      has_nan |= size != size;
      largest[k] = ali3_where(size > largest[k], size, largest[k]);
    }
  for (int k = 1; k < CHAINS; k++) largest[0] = ali3_where(largest[k] > largest[0], largest[k], largest[0]);
  const truth is_positive = largest[0] > 0.0;
  for (int32_t i = n - 1; i >= 0; i--) {
    const truth is_worst = (ALI3_SIZE(i) == largest[0]) & is_positive;
    *worst = (is_worst & i) | (~is_worst & *worst);
  }
#undef ALI3_SIZE
  return ali3_where(has_nan, ali3_same(HUGE_VAL), largest[0]);
}

/* Computes the residual with the multipliers and the violation; returns the lanes in which both are finite. */
static truth update_residual(ali3_lane_group *in) {
  const ali3_system *S = in->system;
  const double c = in->rule.c;
  const real *r = in->step.r;
  real *x = in->step.x;
  ali3_rows_transposed(S, in->tangent.J, in->next.lam, x);
  for (int32_t i = 0; i < S->size.nq; i++) x[i] = r[i] + c * x[i];
  *in->residual = largest_size(x, in->mass.floor_inverse, NULL, S->size.nq, in->worst_coordinate);
  *in->violation = largest_size(in->step.Phi, NULL, S->row_measure, S->size.nc, in->worst_row);
  return (*in->residual < 1e300) & (*in->violation < 1e300);
}

/* Lanes in which all rows hold within the tolerance. */
static truth rows_are_closed(const ali3_lane_group *in) {
  const ali3_system *S = in->system;
  truth open = {0};
  for (int32_t k = 0; k < S->size.nc; k++)
    open |= ~(ali3_abs(in->step.Phi[k]) * S->row_measure[k] <= S->fine * in->settings.tolerance_phi + S->row_round[k]);
  return ~open;
}

/* Assembles and factorises the tangent (23) of the present iterate for some lanes; the others keep the earlier one. */
static void tangent(ali3_lane_group *in, truth lanes, bool first) {
  const ali3_system *S = in->system;
  real *F = first ? in->tangent.F : in->tangent.F_new;
  *in->at_work = lanes;
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int64_t n = S->front_ptr[f + 1] - S->front_ptr[f];
    real *block = F + S->front_off[f];
    for (int64_t j = 0; j < n; j++) memset(block + j * n + j, 0, (size_t)(n - j) * sizeof *F);
  }
  for (int64_t k = 0; k < S->n_mass_col; k++)
    if (S->mass_pos[k] >= 0) F[S->mass_pos[k]] = in->mass.val[k];
  ali3_rows_square(in, in->tangent.J, in->rule.c * in->alpha, F);
  if (in->settings.geometric) ali3_geometric(in, in->next.q, in->next.s, in->next.lam, in->rule.c, F);
  if (S->n_flexible > 0) {
    ali3_flexible_tangent(in, 1.0, in->rule.wC, in->rule.c, F);
    for (int32_t i = 0; i < S->el_S_off[S->size.ne]; i++)
      in->element.S_made[i] = first ? in->element.S[i] : ali3_where(lanes, in->element.S[i], in->element.S_made[i]);
  }
  ali3_elements_tangent(in, F);
  if (S->n_tabled > 0) {
    ali3_tabled_tangent(in, 1.0, in->rule.c, F);
    ali3_tabled_elements_tangent(in, F);
  }
  ali3_factorise(in, F);
  if (first) { /* the next iterate overwrites J */
    real *here = in->tangent.J;
    in->tangent.J = in->tangent.J_made;
    in->tangent.J_made = here;
    return;
  }
  for (int32_t i = 0; i < S->size.nnz_rows; i++)
    in->tangent.J_made[i] = ali3_where(lanes, in->tangent.J[i], in->tangent.J_made[i]);
  for (int32_t i = 0; i < S->size.front_size; i++) in->tangent.F[i] = ali3_where(lanes, F[i], in->tangent.F[i]);
}

/* One Newton correction (21) and the multiplier update of some lanes; returns the lanes in which it is finite. */
static truth correct(ali3_lane_group *in, truth lanes, truth reused, truth accelerated, int32_t iteration) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const double c = in->rule.c, alpha = in->alpha;
  const real *Phi = in->step.Phi, *r = in->step.r, *w = in->step.w, *gamma = in->step.gamma;
  real *lam = in->next.lam, *mu = in->step.mu, *x = in->step.x, *change = in->step.lam, *D = in->step.D;
  *in->at_work = lanes;
  for (int32_t k = 0; k < nc; k++) mu[k] = ali3_where(reused, ali3_same(0.0), lam[k]) + alpha * Phi[k];
  ali3_rows_transposed(S, in->tangent.J_made, mu, in->step.w);
  for (int32_t i = 0; i < nq; i++) x[i] = -(ali3_where(reused, x[i], r[i]) + c * w[i]);
  ali3_solve(in, in->tangent.F, x);
  const truth finite = all_finite(x, nq);
  if (ali3_defect_corrected(S)) ali3_defect_correction(in, in->h, iteration, lanes & finite);
  ali3_rows_times(S, in->tangent.J_made, x, in->step.gamma);
  for (int32_t k = 0; k < nc; k++) change[k] = alpha * (Phi[k] + gamma[k]);
  ali3_accelerate(in, accelerated);
  for (int32_t k = 0; k < nc; k++) lam[k] = ali3_where(lanes, lam[k] + change[k], lam[k]);
  for (int32_t i = 0; i < nq; i++) D[i] = ali3_where(lanes, D[i] + x[i], D[i]);
  return finite;
}

/* Newton's iteration; sets in->good. */
static void newton(ali3_lane_group *in) {
  const double h = in->h;
  truth active = *in->lanes, reused = {0}, accelerated = {0};
  real last_residual = ali3_same(HUGE_VAL);
  *in->good = *in->singular = *in->iterations = reused;
  *in->reach = (real){0};
  evaluate(in, active, true);
  for (int32_t iteration = 0; iteration < in->settings.max_iterations && ali3_any(active); iteration++) {
    const truth outdated = active & ~reused;
    if (ali3_any(outdated)) tangent(in, outdated, iteration == 0);
    active &= ~*in->singular;
    active &= correct(in, active, reused, accelerated, iteration);
    *in->iterations -= active;
    evaluate(in, active, false);
    active &= update_residual(in);
    const truth converged =
        active & (*in->residual <= in->system->fine * in->settings.tolerance_r) & rows_are_closed(in);
    *in->good |= converged;
    active &= ~converged;
    reused = (*in->violation <= REUSE_VIOLATION * fmin(h * h, 1e-4 * in->system->fine)) &
             (*in->residual <= REUSE_RESIDUAL * last_residual);
    const truth decreasing = ali3_settles(in->system, iteration + 1) ? *in->residual <= last_residual : (truth){0};
    accelerated = reused | ~decreasing;
    *in->reach = ali3_where(decreasing, REACH * in->rule.rate * *in->residual, (real){0});
    last_residual = *in->residual;
    if (ali3_any(active & ~reused)) evaluate_elements(in, active & ~reused, true);
  }
}

/* Predicts D and the multipliers. */
static void predict(ali3_lane_group *in) {
  const int32_t nq = in->system->size.nq, nc = in->system->size.nc;
  const double h = in->h;
  truth extrapolates = {0};
  if (in->system->n_flexible > 0) {
    for (int32_t i = 0; i < nq; i++) in->step.D[i] = h * (2.0 * in->now.mean[i] - in->now.mean_before[i]);
    memcpy(in->next.lam, in->now.lam, (size_t)nc * sizeof *in->next.lam);
    return;
  }
  if (in->settings.predictor == ALI3_PREDICTOR_PARABOLA)
    extrapolates = ali3_history_smooth(in, ALI3_PARABOLA, h, false);
  if (ali3_any(extrapolates)) ali3_extrapolate(in, 0.5 * h, ALI3_PARABOLA, in->step.x, in->next.lam);
  for (int32_t k = 0; k < nc; k++) {
    const real lam = in->now.lam[k];
    in->next.lam[k] = lam + ALI3_MULTIPLIER_FRACTION * (ali3_where(extrapolates, in->next.lam[k], lam) - lam);
  }
  for (int32_t i = 0; i < nq; i++)
    in->step.D[i] = h * in->now.qd[i] + 0.5 * h * h * ali3_where(extrapolates, in->step.x[i], in->now.qdd[i]);
}

/* Sums of balance_squares of methods/energy_balance.c, in its order. */
static void sum_speed_squares(const ali3_lane_group *in, double h, const real *v0, const real *a, const real *v1,
                              real out[3]) {
  enum { FOUR = 4 };
  const real *m = in->mass.floor;
  const int32_t nq = in->system->size.nq;
  real speed[FOUR] = {0}, change[FOUR] = {0}, miss[FOUR] = {0};
  int32_t i = 0;
  for (; i + FOUR <= nq; i += FOUR)
    for (int k = 0; k < FOUR; k++) {
      const real w = m[i + k], v = v1[i + k], d = v - v0[i + k], e = d - h * a[i + k];
      speed[k] += w * v * v;
      change[k] += w * d * d;
      miss[k] += w * e * e;
    }
  out[0] = (speed[0] + speed[1]) + (speed[2] + speed[3]);
  out[1] = (change[0] + change[1]) + (change[2] + change[3]);
  out[2] = (miss[0] + miss[1]) + (miss[2] + miss[3]);
  for (; i < nq; i++) {
    const real d = v1[i] - v0[i], e = d - h * a[i];
    out[0] += m[i] * v1[i] * v1[i];
    out[1] += m[i] * d * d;
    out[2] += m[i] * e * e;
  }
}

/* A step of the lanes in in->lanes from in->now to in->next. */
static void step(ali3_lane_group *in) {
  const int32_t nq = in->system->size.nq;
  const double h = in->h;
  const ali3_rule rule = {.c = 0.25 * h * h, .rate = 2.0 / h, .wC = 0.5 * h};
  const double c = rule.c;
  in->rule = rule;
  predict(in);
  for (int32_t i = 0; i < nq; i++) {
    in->step.d0[i] = h * in->now.qd[i] + c * in->now.qdd[i];
    in->step.hat[i] = -in->now.qd[i];
  }
  newton(in);
  if (!ali3_any(*in->good)) return;
  for (int32_t i = 0; i < nq; i++) {
    in->next.qdd[i] = (in->step.D[i] - in->step.d0[i]) / c;
    in->mean_a[i] = 2.0 * (in->step.D[i] - h * in->now.qd[i]) / (h * h);
  }
  memcpy(in->newton_lam, in->next.lam, (size_t)in->system->size.nc * sizeof *in->newton_lam);
  ali3_constraint_rate(in, in->next.q, &in->next, in->step.Phit);
  const double left = ali3_allowed_round_off(in->system, c);
  real kinetic, work = ali3_constraint_work(in, h, in->guides);
  turning_rates(in, in->step.mu, in->step.Phit);
  *in->at_work = *in->good;
  *in->velocity_violation = ali3_project(in, c * in->alpha, in->step.Phit, in->next.qd, NULL, VELOCITY_TOLERANCE,
                                         left * rule.rate, MAX_SWEEPS, true);
  ali3_constraint_gamma(in, in->next.q, in->next.qd, &in->next, in->step.gamma);
  *in->at_work = *in->good;
  ali3_project(in, c * in->alpha, in->step.gamma, in->next.qdd, in->next.lam, ACCELERATION_TOLERANCE, left / c,
               MAX_SWEEPS, false);
  work += ali3_projection_work(in, &kinetic, in->end, in->open, in->guides) + 0.5 * h * *in->open_power;
  *in->work = work;
  *in->size = ali3_energy_size(in, h, kinetic);
  *in->weight = *in->mass.gravity_const;
  for (int32_t i = 0; i < nq; i++) *in->weight -= in->mass.gravity[i] * in->next.q[i];
  sum_speed_squares(in, h, in->now.qd, in->now.qdd, in->next.qd, in->squares);
  ali3_signal_displacements(in, in->ways);
}
#endif
#endif
