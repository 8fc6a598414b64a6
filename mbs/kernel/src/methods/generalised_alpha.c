/* The integration rule of generalised-alpha, and the damped start of flexible systems, which is its most damped
 * form. */
#include <string.h>

#include "../instance.h"
#include "../method.h"
#include "generalised_alpha.h"
#include "history.h"

enum { DAMPED_STEPS = 6 };
/* Error of the velocity after the damped steps over h (qdd - own) of the last one, for smooth accelerations of rate j:
 * the first step has an error h^2 j / 2 as it has one acceleration, and an error h j of `own`, which halves in each
 * step: that of the velocity is h^2 j (1/4 + 1/8 + ... + 1/64), and qdd - own is h j (1 - 1/16). */
static const double VELOCITY_ERROR = (0.5 + 31.0 / 64.0) / (15.0 / 16.0);
static const double UNRESOLVED = 2.0; /* step times frequency of a mode, rad */

/* Coefficients of generalised-alpha of Chung and Hulbert in the form of Arnold and Bruels: an algorithmic acceleration
 * a (in->now.own) with (1 - am) a1 + am a0 = (1 - af) qdd1 + af qdd0; the balance of forces holds at the end of the
 * step. */
typedef struct {
  double am, af, beta, gamma;
} ali3_alpha;

/* Coefficients by spectral radius at infinite frequency (Chung and Hulbert). */
static ali3_alpha coefficients(double rho) {
  const double am = (2.0 * rho - 1.0) / (rho + 1.0), af = rho / (rho + 1.0), gamma = 0.5 + af - am;
  const ali3_alpha x = {.am = am, .af = af, .beta = 0.25 * (gamma + 0.5) * (gamma + 0.5), .gamma = gamma};
  return x;
}

/* Whether the next step is one of the damped start. At a start, light nodes of flexible bodies have the accelerations
 * of loads under which they have not deformed yet; with a step that does not resolve the fastest mode the trapezoidal
 * rule would let them oscillate, the damped steps remove this. */
bool ali3_damped_start(const ali3_instance *in, double h) {
  return in->system->n_flexible > 0 && h * h * in->system->flex_rate > UNRESOLVED * UNRESOLVED &&
         in->settings.method == ALI3_METHOD_ALI3P && in->settings.project && in->report.steps < DAMPED_STEPS;
}

/* The first damped step uses one acceleration, that at its end. */
static bool is_first_damped(const ali3_instance *in, double h) {
  return ali3_damped_start(in, h) && in->report.steps == 0;
}

/* Spectral radius at infinite frequency of the next step. */
static double spectral_radius(const ali3_instance *in, double h) {
  return ali3_damped_start(in, h) ? 0.0 : in->settings.rho_infinity;
}

void ali3_alpha_rule(ali3_instance *in, double h) {
  const ali3_alpha x = coefficients(spectral_radius(in, h));
  const double c = (1.0 - x.af) * x.beta * h * h / (1.0 - x.am), rate = x.gamma / (x.beta * h);
  const ali3_rule rule = {.c = c, .rate = rate, .wC = c * rate};
  const ali3_vectors *from = &in->now;
  in->rule = rule;
  for (int32_t g = 0; g < in->system->size.ng; g++) in->driving.follows[g] = 0.0; /* multipliers are not averaged */
  ali3_history_own(in, ALI3_METHOD_GENERALISED_ALPHA, from->qdd);
  if (is_first_damped(in, h)) {
    const ali3_rule first = {.c = 0.5 * h * h, .rate = 2.0 / h, .wC = h};
    in->rule = first;
    for (int32_t i = 0; i < in->system->size.nq; i++) {
      in->step.d0[i] = h * from->qd[i];
      in->step.hat[i] = -from->qd[i];
    }
    return;
  }
  const bool last = ali3_damped_start(in, h) && in->report.steps == DAMPED_STEPS - 1;
  for (int32_t i = 0; i < in->system->size.nq; i++) {
    const double explicit_part = h * from->qd[i] + (0.5 - x.beta) * h * h * from->own[i];
    in->step.d0[i] = explicit_part - c * (x.am * from->own[i] - x.af * from->qdd[i]) / (1.0 - x.af);
    in->step.hat[i] = from->qd[i] + (1.0 - x.gamma) * h * from->own[i] -
                      x.gamma / x.beta * (from->qd[i] + (0.5 - x.beta) * h * from->own[i]);
    if (last) in->step.hat[i] -= VELOCITY_ERROR * h * (from->qdd[i] - from->own[i]);
  }
}

void ali3_alpha_accept(ali3_instance *in, double h) {
  const double beta = coefficients(spectral_radius(in, h)).beta;
  const bool first = is_first_damped(in, h);
  memcpy(in->next.history, in->now.history, ALI3_HISTORY * sizeof(double));
  for (int32_t i = 0; i < in->system->size.nq; i++)
    in->next.own[i] =
        first ? (in->step.D[i] - in->step.d0[i]) / in->rule.c
              : (in->step.D[i] - h * in->now.qd[i] - (0.5 - beta) * h * h * in->now.own[i]) / (beta * h * h);
}
