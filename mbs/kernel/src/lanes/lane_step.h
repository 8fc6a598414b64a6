/* An ALi3-P step (../methods/ali3p.h) with control of the iteration by lane: converged lanes keep D,
 * multipliers, tangent and forces, so that later iterations of other lanes do not change them. Lanes that fail are not
 * in group->good and repeat the step in their instances. */
#ifndef ALI3_LANE_STEP_H
#define ALI3_LANE_STEP_H
#ifdef ALI3_WIDTH
#include "../methods/ali3p.h"

/* Evaluates element e in all lanes: f, y, out, potential, idle and, if required, the tangent. */
static void evaluate_law(ali3_lane_group *g, int32_t e, real *f, bool tangent) {
  const ali3_system *S = g->system;
  const int32_t *signal = S->el_sig + S->el_sig_ptr[e], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
  const int32_t beside = S->el_beside[e];
  real u[ALI3_MAX_SIGNALS], ud[ALI3_MAX_SIGNALS]; /* of an element whose signals are not contiguous */
  for (int32_t i = 0; beside < 0 && i < n; i++) u[i] = g->element.u[signal[i]], ud[i] = g->element.ud[signal[i]];
  ali3_element_args a = {.nsig = n,
                         .nreal = S->el_parameter_ptr[e + 1] - S->el_parameter_ptr[e],
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
                         .real = g->el_parameter + S->el_parameter_ptr[e],
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
  g->element.idle[e] = (lane_mask){0} - a.idle;
}

/* Evaluates element e in the lanes of in->evaluated. */
static void evaluate_element(ali3_lane_group *in, int32_t e, real *f, bool tangent) {
  if (in->by_law[e])
    evaluate_law(in, e, f, tangent);
  else
    ali3_lane_element(in, e, f, tangent);
}

/* Evaluates the elements of some lanes; of the others only tangents may change, which they do not read again. */
static void evaluate_elements(ali3_lane_group *in, lane_mask lanes, bool tangent) {
  const ali3_system *S = in->system;
  *in->evaluated = lanes;
  for (int32_t e = 0; e < S->size.ne; e++) evaluate_element(in, e, in->element.force + S->el_sig_ptr[e], tangent);
}

/* Outputs other than f are overwritten by the next iterate; converged lanes get the same values. */
void ali3_elements_defect(ali3_lane_group *in, double h, lane_mask lanes, const real *q, const real *qd, real *r) {
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
static void evaluate_forces(ali3_lane_group *in, lane_mask lanes, bool tangent) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const real *q = in->next.q, *qd = in->next.qd;
  if (S->n_lookup > 0) {
    ali3_lookup_prepare(in, q);
    ali3_lookup_extend(in, q, qd, NULL, false);
    memset(in->lookup.force + nq, 0, (size_t)S->n_dependent * sizeof *q);
    q = in->lookup.extended[0], qd = in->lookup.extended[1];
  }
  ali3_active_signals(in, q, qd);
  real *Q = S->n_lookup > 0 ? in->lookup.force : in->step.Q; /* followed by those on dependents */
  memcpy(Q, in->mass.gravity, (size_t)nq * sizeof *Q);
  if (S->n_flexible > 0) {
    ali3_flexible_prepare(in, q);
    ali3_flexible_forces(in, q, qd, false, Q);
  }
  evaluate_elements(in, lanes, tangent);
  ali3_add_forces(in, in->element.force, Q);
  if (S->n_lookup > 0) ali3_lookup_forces(in, in->next.qd, in->step.Q);
}

/* Positions, rates, rows, forces and residual of the iterate D. */
static void evaluate(ali3_lane_group *in, lane_mask lanes, bool tangent) {
  place_iterate(in);
  evaluate_forces(in, lanes, tangent);
  find_residual(in);
}

/* Largest of n values |x| factor, infinite if one is NaN; *worst: index of the first largest one, unchanged if it is 0.
 * Factors differ by lane or are common to all. */
static inline real largest_size(const real *x, const real *of_lanes, const double *of_all, int32_t n,
                                lane_mask *worst) {
  enum { CHAINS = 4 }; /* independent chains of comparisons hide their latency */
  real largest[CHAINS] = {0};
  lane_mask has_nan = {0};
#define ALI3_SIZE(i) (ali3_abs(x[i]) * (of_all == NULL ? of_lanes[i] : ali3_same(of_all[i])))
  for (int32_t i = 0; i < n; i += CHAINS)
    for (int32_t k = 0; k < CHAINS && i + k < n; k++) {
      const real size = ALI3_SIZE(i + k);
      has_nan |= size != size;
      largest[k] = ali3_where(size > largest[k], size, largest[k]);
    }
  for (int k = 1; k < CHAINS; k++) largest[0] = ali3_where(largest[k] > largest[0], largest[k], largest[0]);
  const lane_mask is_positive = largest[0] > 0.0;
  for (int32_t i = n - 1; i >= 0; i--) {
    const lane_mask is_worst = (ALI3_SIZE(i) == largest[0]) & is_positive;
    *worst = (is_worst & i) | (~is_worst & *worst);
  }
#undef ALI3_SIZE
  return ali3_where(has_nan, ali3_same(HUGE_VAL), largest[0]);
}

/* Sizes of the residual with the multipliers and of the violation; returns the lanes in which both are finite. */
static lane_mask update_residual(ali3_lane_group *in) {
  const ali3_system *S = in->system;
  add_row_forces(in);
  *in->residual = largest_size(in->step.x, in->mass.floor_inverse, NULL, S->size.nq, in->worst_coordinate);
  *in->violation = largest_size(in->step.Phi, NULL, S->row_measure, S->size.nc, in->worst_row);
  return (*in->residual < 1e300) & (*in->violation < 1e300);
}

/* Lanes in which all rows hold within the tolerance. */
static lane_mask rows_are_closed(const ali3_lane_group *in) {
  const ali3_system *S = in->system;
  lane_mask open = {0};
  for (int32_t k = 0; k < S->size.nc; k++)
    open |= ~(ali3_abs(in->step.Phi[k]) * S->row_measure[k] <= S->fine * in->settings.tolerance_phi + S->row_round[k]);
  return ~open;
}

/* Assembles and factorises the tangent (23) of the present iterate for some lanes; the others keep the earlier one. */
static void tangent(ali3_lane_group *in, lane_mask lanes, bool first) {
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
  if (S->n_lookup > 0) {
    ali3_lookup_tangent(in, 1.0, in->rule.c, F);
    ali3_lookup_elements_tangent(in, F);
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

/* Newton's iteration; sets in->good. */
static void newton(ali3_lane_group *in) {
  const double h = in->h;
  lane_mask active = *in->lanes, reused = {0}, accelerated = {0};
  real last_residual = ali3_same(HUGE_VAL);
  *in->good = *in->singular = *in->iterations = reused;
  *in->reach = (real){0};
  evaluate(in, active, true);
  for (int32_t iteration = 0; iteration < in->settings.max_iterations && ali3_any(active); iteration++) {
    const lane_mask outdated = active & ~reused;
    if (ali3_any(outdated)) tangent(in, outdated, iteration == 0);
    active &= ~*in->singular;
    active &= correct(in, h, in->alpha, active, iteration, reused, accelerated);
    *in->iterations -= active;
    evaluate(in, active, false);
    active &= update_residual(in);
    const lane_mask converged =
        active & (*in->residual <= in->system->fine * in->settings.tolerance_r) & rows_are_closed(in);
    *in->good |= converged;
    active &= ~converged;
    for (int32_t l = 0; iteration == 0 && l < ALI3_WIDTH; l++)
      if (active[l] && ali3_lane_is_abrupt(in, l)) active[l] = 0;
    reused = (*in->violation <= REUSE_VIOLATION * fmin(h * h, 1e-4 * in->system->fine)) &
             (*in->residual <= REUSE_RESIDUAL * last_residual);
    const lane_mask decreasing =
        ali3_settles(in->system, iteration + 1) ? *in->residual <= last_residual : (lane_mask){0};
    accelerated = reused | ~decreasing;
    *in->reach = ali3_where(decreasing, REACH * in->rule.rate * *in->residual, (real){0});
    last_residual = *in->residual;
    if (ali3_any(active & ~reused)) evaluate_elements(in, active & ~reused, true);
  }
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
  predict(in, h, true, false);
  trapezoidal(in, h);
  newton(in);
  if (!ali3_any(*in->good)) return;
  find_accelerations(in);
  for (int32_t i = 0; i < nq; i++) in->mean_a[i] = 2.0 * (in->step.D[i] - h * in->now.qd[i]) / (h * h);
  memcpy(in->newton_lam, in->next.lam, (size_t)in->system->size.nc * sizeof *in->newton_lam);
  ali3_constraint_rate(in, in->next.q, &in->next, in->step.Phit);
  const step_energy e = project_rates(in, h, in->alpha, *in->good, *in->open_power, in->velocity_violation);
  *in->work = e.error;
  *in->end = e.end;
  *in->open = e.open;
  *in->driving_work = e.driving_work;
  *in->size = ali3_energy_size(in, h, e.kinetic);
  *in->weight = *in->mass.gravity_const;
  for (int32_t i = 0; i < nq; i++) *in->weight -= in->mass.gravity[i] * in->next.q[i];
  sum_speed_squares(in, h, in->now.qd, in->now.qdd, in->next.qd, in->squares);
  ali3_signal_displacements(in, in->ways);
}
#endif
#endif
