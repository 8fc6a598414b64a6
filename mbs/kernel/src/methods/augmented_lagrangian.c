/* One ALi3-P step: trapezoidal rule (17), (18) in the increment D = q_(n+1) - q_n, Newton on (19), (20), projections
 * (24), (25). */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/finite.h"
#include "../algebra/fronts.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../elements/forces.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/guides.h"
#include "../rows/turning.h"
#include "../rows/velocity_rows.h"
#include "../rows/violation.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "abrupt_force.h"
#include "ali3p.h"
#include "check_method.h"
#include "contact_event.h"
#include "defect_correction.h"
#include "energy_balance.h"
#include "energy_watch.h"
#include "generalised_alpha.h"
#include "input_jump.h"
#include "newton.h"
#include "predict.h"
#include "projection.h"
#include "steps.h"

/* Arguments for the forces of the present iterate. */
static ali3_force_call iterate_call(ali3_instance *in, double h, bool tangent) {
  ali3_vectors *to = &in->next;
  return (ali3_force_call){.q = to->q,
                           .qd = to->qd,
                           .y_old = in->now.y,
                           .h = h,
                           .wC = in->rule.wC,
                           .wK = in->rule.c,
                           .tangent = tangent,
                           .iterate = true,
                           .Q = in->step.Q,
                           .y_new = to->y,
                           .out = to->out,
                           .potential = to->potential};
}

/* Positions, rates, rows, forces and residual r = M (D - d0) + c (Phi_q' lam - Q) of (20) for the present D and lam. */
ALI3_INLINED void evaluate(ali3_instance *in, double h, bool tangent) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const double c = in->rule.c, rate = in->rule.rate, *from = in->now.q, *D = in->step.D, *d0 = in->step.d0,
               *hat = in->step.hat;
  ali3_vectors *to = &in->next;
  double *q = to->q, *qd = to->qd, *w = in->step.w, *r = in->step.r, *Q = in->step.Q;
  ALI3_EACH(0, nq, ALI3_AT(q) = ALI3_AT(from) + ALI3_AT(D); ALI3_AT(qd) = rate * ALI3_AT(D) + ALI3_AT(hat);
            ALI3_AT(w) = ALI3_AT(D) - ALI3_AT(d0))
  ali3_constraints(in, to->q, to->s, in->step.Phi, in->tangent.J);
  if (in->system->n_velocity_row > 0) ali3_velocity_values(in, in->tangent.J, to->qd, rate, in->step.Phi);
  const ali3_force_call call = iterate_call(in, h, tangent);
  ali3_forces(in, &call);
  ali3_mass_times(in, w, r);
  ALI3_EACH(0, nq, ALI3_AT(r) -= c * ALI3_AT(Q))
}

/* Writes the size of the residual with the multipliers to the report; false: it is not finite. */
ALI3_INLINED bool report_residual(ali3_instance *in) {
  const double c = in->rule.c, *r = in->step.r;
  double *x = in->step.x;
  ali3_rows_transposed(in->system, in->tangent.J, in->next.lam, x);
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(x) = ALI3_AT(r) + c * ALI3_AT(x))
  return ali3_measure_residual(in, x);
}

/* The tangent (23) of the present iterate, by generated code. */
static void assemble_generated(ali3_instance *in, double alpha) {
  const ali3_system *S = in->system;
  const ali3_tangent_parts parts = {.front_mass = in->mass.front,
                                    .J = in->tangent.J,
                                    .lam = in->next.lam,
                                    .s = in->next.s,
                                    .hess_val = S->hess_val,
                                    .gterm_h = S->gterm_h,
                                    .angle_hc = S->angle_hc,
                                    .angle_hs = S->angle_hs,
                                    .q = ali3_near_origin(in, in->next.q),
                                    .cosine = ali3_cos,
                                    .sine = ali3_sin,
                                    .sig_val = S->sig_val,
                                    .S = in->element.S,
                                    .idle = in->element.idle,
                                    .square = in->rule.c * alpha,
                                    .geometric = in->rule.c};
  S->generated.tangent(&parts, in->tangent.F);
}

/* Writes the tangent (23) to the fronts. */
static void assemble(ali3_instance *in, double alpha) {
  if (in->system->generated.tangent != NULL && in->settings.geometric) {
    assemble_generated(in, alpha);
    return;
  }
  ali3_mass_to_fronts(in, in->tangent.F);
  ali3_rows_square(in, in->tangent.J, in->rule.c * alpha, in->tangent.F);
  if (in->settings.geometric) ali3_geometric(in, in->next.q, in->next.s, in->next.lam, in->rule.c, in->tangent.F);
  ali3_forces_tangent(in, in->tangent.F);
}

/* Assembles and factorises the tangent. */
static ali3_status tangent(ali3_instance *in, double alpha) {
  const ali3_system *S = in->system;
  assemble(in, alpha);
  double *J = in->tangent.J;
  in->tangent.J = in->tangent.J_made;
  in->tangent.J_made = J;
  if (ali3_defect_corrected(S)) { /* T_e of defect_correction.c */
    double *here = in->element.S;
    in->element.S = in->element.S_made;
    in->element.S_made = here;
  }
  return ali3_factorise(in, in->tangent.F);
}

/* One Newton correction (21) and the multiplier update. `reused`: the tangent belongs to an earlier iterate, and
 * in->step.x has the reported residual. `accelerated`: the correction is combined with the one before it. The penalty
 * uses the Phi_q of the tangent, as it would amplify the part of a later Phi_q outside its range. */
ALI3_INLINED ali3_status correct(ali3_instance *in, double h, double alpha, int32_t iteration, bool reused,
                                 bool accelerated) {
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq, nc = S->size.nc;
  const double c = in->rule.c;
  double *lam = in->next.lam, *mu = in->step.mu, *x = in->step.x, *D = in->step.D, *change = in->step.lam;
  const double *residual = reused ? x : in->step.r, *Phi = in->step.Phi, *w = in->step.w, *opening = in->step.gamma;
  if (reused)
    ALI3_EACH(0, nc, ALI3_AT(mu) = 0.0 + alpha * ALI3_AT(Phi))
  else
    ALI3_EACH(0, nc, ALI3_AT(mu) = ALI3_AT(lam) + alpha * ALI3_AT(Phi))
  ali3_rows_transposed(S, in->tangent.J_made, mu, in->step.w);
  ALI3_EACH(0, nq, ALI3_AT(x) = -(ALI3_AT(residual) + c * ALI3_AT(w)))
  ali3_solve(in, in->tangent.F, x);
  if (!ali3_finite_inlined(x, nq)) return ALI3_NOT_FINITE;
  if (ali3_defect_corrected(S)) ali3_defect_correction(in, h, iteration, true);
  if (in->settings.update == ALI3_UPDATE_LINEARISED) {
    ali3_rows_times(S, in->tangent.J_made, x, in->step.gamma);
    ALI3_EACH(0, nc, ALI3_AT(change) = alpha * (ALI3_AT(Phi) + ALI3_AT(opening)))
    ali3_accelerate(in, accelerated);
    ali3_add(lam, change, nc);
  }
  ali3_add(D, x, nq);
  return ALI3_OK;
}

/* Accepts the last iterate at the limit of iterations, unless its residual or violation is large. */
static ali3_status accept_capped(ali3_instance *in) {
  const double residual = fmax(in->report.residual, in->report.violation);
  if (residual > ALI3_LOST * in->system->fine) return ALI3_NOT_CONVERGED;
  in->bound.capped = true;
  in->bound.capped_residual = residual;
  return ALI3_OK;
}

/* Newton's iteration. With a limit for the whole step, a part of the step has its part of it, but not more than
 * without. */
ALI3_INLINED ali3_status newton(ali3_instance *in, const ali3_request *request, double alpha) {
  const double h = request->h;
  const ali3_settings *settings = &in->settings;
  const bool limited = settings->step_iterations > 0;
  const int64_t share = request->iterations_end - in->report.iterations, own_limit = settings->max_iterations;
  const int64_t most_iterations = limited && share < own_limit ? share : own_limit;
  bool reused = false, accelerated = false;
  const double fine = in->system->fine;
  double last_residual = HUGE_VAL, last_violation = HUGE_VAL;
  evaluate(in, h, true);
  in->report.last_iterations = 0;
  while (in->report.last_iterations < most_iterations) {
    ali3_status status = reused ? ALI3_OK : tangent(in, alpha);
    if (status == ALI3_OK) status = correct(in, h, alpha, in->report.last_iterations, reused, accelerated);
    if (status != ALI3_OK) return ali3_newton_failure(in, status);
    in->report.iterations++;
    in->report.last_iterations++;
    if (in->report.last_iterations > in->report.max_iterations) in->report.max_iterations = in->report.last_iterations;
    evaluate(in, h, false);
    if (settings->update == ALI3_UPDATE_PAPER) /* (16) */
      for (int32_t k = 0; k < in->system->size.nc; k++) in->next.lam[k] += alpha * in->step.Phi[k];
    if (!report_residual(in)) return ALI3_NOT_FINITE;
    if (in->report.residual <= fine * settings->tolerance_r) {
      if (ali3_closed(in->system, in->step.Phi, fine * settings->tolerance_phi)) return ALI3_OK;
      if (in->report.violation > CLOSES * last_violation && /* far from the origin no iteration reduces it further */
          ali3_closed_at(in->system, in->step.Phi, in->next.q, fine * settings->tolerance_phi))
        return ALI3_OK;
    }
    last_violation = in->report.violation;
    reused = settings->update == ALI3_UPDATE_LINEARISED &&
             in->report.violation <= REUSE_VIOLATION * fmin(h * h, 1e-4 * fine) &&
             in->report.residual <= REUSE_RESIDUAL * last_residual; /* (16) converges too slowly for more */
    const bool settles = ali3_settles(in->system, in->report.last_iterations) && in->report.residual <= last_residual;
    accelerated = reused || !settles;
    last_residual = in->report.residual;
    if (reused) continue;
    ali3_force_call call = iterate_call(in, h, true); /* again, now with tangents, as a tangent is needed */
    if (settles) call.reach = REACH * in->rule.rate * in->report.residual;
    ali3_elements_forces(in, &call);
  }
  if (most_iterations > 0 && in->report.residual <= fine * settings->tolerance_r &&
      ali3_closed_at(in->system, in->step.Phi, in->next.q, fine * settings->tolerance_phi))
    return ALI3_OK; /* far from the origin no iteration reduces it further */
  return limited && most_iterations > 0 ? accept_capped(in) : ALI3_NOT_CONVERGED;
}

ALI3_BY_PROCESSOR(in->system, ali3_status, newton, (ali3_instance * in, const ali3_request *request, double alpha),
                  (in, request, alpha))

/* Trapezoidal rule (17), (18). */
ALI3_INLINED void trapezoidal(ali3_instance *in, double h) {
  const ali3_rule rule = {.c = 0.25 * h * h, .rate = 2.0 / h, .wC = 0.5 * h};
  in->rule = rule;
  const double *qd = in->now.qd, *qdd = in->now.qdd;
  double *d0 = in->step.d0, *hat = in->step.hat;
  ALI3_EACH(0, in->system->size.nq, ALI3_AT(d0) = h * ALI3_AT(qd) + rule.c * ALI3_AT(qdd); ALI3_AT(hat) = -ALI3_AT(qd))
}

/* ALI3_TURNS_TOO_FAR if an angle turns too far in the step for its rows, unless the iterations of a step are
 * limited. */
ALI3_INLINED ali3_status check_turn(ali3_instance *in, double h) {
  const double turn_rate = in->settings.project ? fastest_turn(in) : 0.0;
  if (turn_rate * h > MAX_TURN && in->settings.step_iterations == 0) {
    in->report.fastest_rate = turn_rate;
    return ALI3_TURNS_TOO_FAR;
  }
  in->bound.capped |= turn_rate * h > MAX_TURN;
  return ALI3_OK;
}

/* Projections (24), (25) of velocities and accelerations, and the energy error of the step; *guide_work: J. */
ALI3_INLINED ali3_status project_rates(ali3_instance *in, const ali3_request *request, double alpha,
                                       double *guide_work) {
  const double h = request->h, c = in->rule.c;
  ali3_vectors *to = &in->next;
  if (!in->settings.project) {
    if (in->system->n_guide_work > 0) ali3_constraint_work(in, h, guide_work);
    in->report.velocity_violation = ali3_project(in, c * alpha, in->step.Phit, to->qd, NULL, 0.0, 0.0, 0, false);
    return ALI3_OK;
  }
  const double limit = ali3_allowed_round_off(in->system, c);
  double kinetic, end, open_power, work = ali3_constraint_work(in, h, guide_work);
  turning_rates(in, in->step.mu, in->step.Phit);
  in->report.velocity_violation = ali3_project(in, c * alpha, in->step.Phit, to->qd, NULL, VELOCITY_TOLERANCE,
                                               limit * in->rule.rate, MAX_SWEEPS, true);
  ali3_constraint_gamma(in, to->q, to->qd, to, in->step.gamma);
  ali3_project(in, c * alpha, in->step.gamma, to->qdd, to->lam, ACCELERATION_TOLERANCE, limit / c, MAX_SWEEPS, false);
  /* includes the work in this step of the forces that the last (25) left unbalanced */
  work += ali3_projection_work(in, &kinetic, &end, &open_power, guide_work) + 0.5 * h * in->report.open_power;
  return ali3_energy_watch(in, request, work, kinetic, end, open_power);
}

/* One step of ALi3-P, or of generalised-alpha. */
ALI3_INLINED ali3_status augmented_lagrangian(ali3_instance *in, const ali3_request *request) {
  const double h = request->h;
  const ali3_system *S = in->system;
  const int32_t nq = S->size.nq;
  const double alpha = ali3_penalty(in, h);
  ali3_vectors *from = &in->now, *to = &in->next;
  const bool generalised_alpha = in->settings.method == ALI3_METHOD_GENERALISED_ALPHA || ali3_damped_start(in, h);
  ali3_status status = check_turn(in, h);
  if (status == ALI3_OK) status = ali3_input_jump(in, h);
  if (status != ALI3_OK) return status;
  ali3_guides_step(in, from, to, request->t, h);
  const bool from_past = ali3_predict(in, request, true);
  if (generalised_alpha)
    ali3_alpha_rule(in, h);
  else
    trapezoidal(in, h);
  const double c = in->rule.c;
  memcpy(to->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  memcpy(to->y_last, from->y, (size_t)S->size.ny * sizeof(double));
  /* derivatives of a step follow the trapezoidal rule, also in a damped start */
  to->h_last[0] = in->settings.method == ALI3_METHOD_GENERALISED_ALPHA ? 0.0 : h;
  status = ali3_newton(in, request, alpha);
  if (status != ALI3_OK && from_past) { /* near a singular position extrapolated multipliers may prevent convergence */
    ali3_predict(in, request, false);
    status = ali3_newton(in, request, alpha);
  }
  if (status != ALI3_OK) return status;
  const double *D = in->step.D, *d0 = in->step.d0;
  double *qdd = to->qdd;
  ALI3_EACH(0, nq, ALI3_AT(qdd) = (ALI3_AT(D) - ALI3_AT(d0)) / c)
  if (generalised_alpha)
    ali3_alpha_accept(in, h);
  else
    to->history[ALI3_HISTORY_OWNER] = ALI3_METHOD_ALI3P;
  const ali3_force_call call = {.q = to->q,
                                .qd = to->qd,
                                .y_old = from->y,
                                .h = h,
                                .wC = in->rule.wC,
                                .wK = c,
                                .Q = in->step.Q,
                                .y_new = to->y,
                                .out = to->out,
                                .potential = to->potential};
  ali3_forces_accept(in, &call);
  if (ali3_contact_event(in, request) || ali3_divides(in, request)) return ALI3_UNRESOLVED;
  ali3_predict_rates(in, h);
  ali3_predict_accept(in, h); /* before the projection: the next step needs the multipliers of the balance (20) */
  ali3_constraint_rate(in, to->q, to, in->step.Phit);
  double guide_work = 0.0;
  status = project_rates(in, request, alpha, &guide_work);
  if (status != ALI3_OK) return status;
  ali3_guides_work(in, to, guide_work);
  ali3_work_step(in, 0.5);
  return ali3_accept(in);
}

ALI3_BY_PROCESSOR(in->system, ali3_status, augmented_lagrangian, (ali3_instance * in, const ali3_request *request),
                  (in, request))

static bool projects(const ali3_instance *in) { return in->settings.project; }

const ali3_method ali3_method_ali3p = {.step = ali3_augmented_lagrangian,
                                       .motion = ali3_balance_step,
                                       .has_balance = projects,
                                       .balance_decides = true,
                                       .has_guides_work = ali3_always,
                                       .owner = ALI3_METHOD_ALI3P,
                                       .fills = true,
                                       .round_off = ALI3_ROUND_OFF_INDEX_3};

const ali3_method ali3_method_generalised_alpha = {.step = ali3_augmented_lagrangian,
                                                   .motion = ali3_balance_step,
                                                   .has_balance = projects,
                                                   .balance_decides = true,
                                                   .has_guides_work = projects,
                                                   .owner = ALI3_METHOD_GENERALISED_ALPHA,
                                                   .round_off = ALI3_ROUND_OFF_INDEX_3};
