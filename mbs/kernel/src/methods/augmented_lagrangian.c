/* One ALi3-P step: trapezoidal rule (17), (18) in the increment D = q_(n+1) - q_n, Newton on (19), (20), projections
 * (24), (25). */
#include <math.h>
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/processor.h"
#include "../elements/forces.h"
#include "../flexible/mass.h"
#include "../instance.h"
#include "../method.h"
#include "../rows/constraints.h"
#include "../rows/driving_functions.h"
#include "../rows/violation.h"
#include "../state/vectors.h"
#include "../state/work.h"
#include "abrupt_force.h"
#include "ali3p.h"
#include "check_method.h"
#include "contact_event.h"
#include "energy_balance.h"
#include "energy_watch.h"
#include "generalised_alpha.h"
#include "input_jump.h"
#include "newton.h"
#include "predict.h"
#include "steps.h"

/* Request for the forces at the end of the step, or of one of its iterates. */
static ali3_force_call end_call(ali3_instance *in, double h, bool tangent, bool iterate) {
  ali3_force_call call = ali3_forces_at(in, &in->next);
  call.h = h;
  call.wC = in->rule.wC;
  call.wK = in->rule.c;
  call.tangent = tangent;
  call.iterate = iterate;
  return call;
}

/* Positions, rates, rows, forces and residual of the present D. */
ALI3_INLINED void evaluate(ali3_instance *in, double h, bool tangent) {
  const ali3_force_call call = end_call(in, h, tangent, true);
  place_iterate(in);
  ali3_forces(in, &call);
  find_residual(in);
}

/* Writes the size of the residual with the multipliers to the report; false: it is not finite. */
ALI3_INLINED bool report_residual(ali3_instance *in) {
  add_row_forces(in);
  return ali3_measure_residual(in, in->step.x);
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
    const ali3_status status = reused ? ALI3_OK : tangent(in, alpha);
    if (status != ALI3_OK) return ali3_newton_failure(in, status);
    if (!correct(in, h, alpha, true, in->report.last_iterations, reused, accelerated)) return ALI3_NOT_FINITE;
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
    /* forces are known well enough after one correction, see decision 175 */
    if (in->report.last_iterations == 1 && ali3_divides(in, request, true)) return ALI3_UNRESOLVED;
    last_violation = in->report.violation;
    reused = settings->update == ALI3_UPDATE_LINEARISED &&
             in->report.violation <= REUSE_VIOLATION * fmin(h * h, 1e-4 * fine) &&
             in->report.residual <= REUSE_RESIDUAL * last_residual; /* (16) converges too slowly for more */
    const bool settles = ali3_settles(in->system, in->report.last_iterations) && in->report.residual <= last_residual;
    accelerated = reused || !settles;
    last_residual = in->report.residual;
    if (reused) continue;
    ali3_force_call call = end_call(in, h, true, true); /* again, now with tangents, as a tangent is needed */
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

/* Projections and the energy error of the step; *driving_work: J. */
ALI3_INLINED ali3_status end_rates(ali3_instance *in, const ali3_request *request, double alpha, double *driving_work) {
  const double h = request->h;
  if (!in->settings.project) {
    if (in->system->n_driving_work > 0) ali3_constraint_work(in, h, driving_work);
    in->report.velocity_violation =
        ali3_project(in, in->rule.c * alpha, in->step.Phit, in->next.qd, NULL, 0.0, 0.0, 0, false);
    return ALI3_OK;
  }
  const step_energy e = project_rates(in, h, alpha, true, in->report.open_power, &in->report.velocity_violation);
  *driving_work = e.driving_work;
  return ali3_energy_watch(in, request, e.error, e.kinetic, e.end, e.open);
}

/* One step of ALi3-P, or of generalised-alpha. */
ALI3_INLINED ali3_status augmented_lagrangian(ali3_instance *in, const ali3_request *request) {
  const double h = request->h;
  const ali3_system *S = in->system;
  const double alpha = ali3_penalty(in, h);
  ali3_vectors *from = &in->now, *to = &in->next;
  const bool generalised_alpha = in->settings.method == ALI3_METHOD_GENERALISED_ALPHA || ali3_damped_start(in, h);
  ali3_status status = check_turn(in, h);
  if (status == ALI3_OK) status = ali3_input_jump(in, h);
  if (status != ALI3_OK) return status;
  ali3_driving_step(in, from, to, request->t, h);
  const bool from_past = ali3_predict_step(in, request, true);
  if (generalised_alpha)
    ali3_alpha_rule(in, h);
  else
    trapezoidal(in, h);
  memcpy(to->used, in->inputs.set, (size_t)S->size.nu * sizeof(double));
  memcpy(to->y_last, from->y, (size_t)S->size.ny * sizeof(double));
  /* derivatives of a step follow the trapezoidal rule, also in a damped start */
  to->h_last[0] = in->settings.method == ALI3_METHOD_GENERALISED_ALPHA ? 0.0 : h;
  status = ali3_newton(in, request, alpha);
  const bool failed = status != ALI3_OK && status != ALI3_UNRESOLVED;
  if (failed && from_past) { /* near a singular position extrapolated multipliers may prevent convergence */
    ali3_predict_step(in, request, false);
    status = ali3_newton(in, request, alpha);
  }
  if (status != ALI3_OK) return status;
  find_accelerations(in);
  if (generalised_alpha)
    ali3_alpha_accept(in, h);
  else
    to->history[ALI3_HISTORY_OWNER] = ALI3_METHOD_ALI3P;
  const ali3_force_call call = end_call(in, h, false, false);
  ali3_forces_accept(in, &call);
  if (ali3_contact_event(in, request, from, to) || ali3_divides(in, request, false)) return ALI3_UNRESOLVED;
  ali3_predict_rates(in, h);
  ali3_predict_accept(in, h); /* before the projection: the next step needs the multipliers of the balance (20) */
  ali3_constraint_rate(in, to->q, to, in->step.Phit);
  double driving_work = 0.0;
  status = end_rates(in, request, alpha, &driving_work);
  if (status != ALI3_OK) return status;
  ali3_driving_work(in, to, driving_work);
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
                                       .has_driving_work = ali3_always,
                                       .owner = ALI3_METHOD_ALI3P,
                                       .fills = true,
                                       .locates_events = true,
                                       .round_off = ALI3_ROUND_OFF_INDEX_3};

const ali3_method ali3_method_generalised_alpha = {.step = ali3_augmented_lagrangian,
                                                   .motion = ali3_balance_step,
                                                   .has_balance = projects,
                                                   .balance_decides = true,
                                                   .has_driving_work = projects,
                                                   .owner = ALI3_METHOD_GENERALISED_ALPHA,
                                                   .locates_events = true,
                                                   .round_off = ALI3_ROUND_OFF_INDEX_3};
