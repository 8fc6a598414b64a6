/* Magic Formula: forces of a tyre with their derivatives with respect to the slips. Numbers of equations: see
 * magic_formula.h. */
#include "magic_formula.h"

#include <math.h>
#include <stdbool.h>

#include "../algebra/elementary.h"
#include "magic_terms.h"

#define MIN_WEIGHT 0.05 /* of combined slip, in the damping of the carcass: it must stay stable at large slips */
#define MIN_LENGTH_RATIO 0.05 /* of a relaxation length to the default one, which is taken below it */
#define SMALL_SLIP 1e-9 /* below it a secant is the tangent; keeps the ratio of slips finite */
/* Default relaxation lengths, radii, of a file with neither stiffness nor relaxation length. */
#define DEFAULT_LONGITUDINAL_RELAXATION 0.5
#define DEFAULT_LATERAL_RELAXATION 1.0

/* y/x, which tends to `limit` where both vanish. */
static dual secant(dual y, dual x, double limit) {
  if (fabs(x.v) < SMALL_SLIP) return constant(limit);
  const double value = y.v / x.v;
  return (dual){value, (y.k - value * x.k) / x.v, (y.t - value * x.t) / x.v};
}

/* 4.E8 with A_mu = 10: shifts vanish more slowly than friction. */
static double find_shift_friction(const operating_point *op, double lambda_mu) {
  return op->is_mf6 ? 10.0 * lambda_mu / (1.0 + 9.0 * lambda_mu) : lambda_mu;
}

/* Force from coefficients and slip, 4.E9, 4.E19. */
static void evaluate_sine_curve(pure_slip *p) {
  const dual arg = magic_argument(constant(p->B), p->C, p->E, p->slip);
  p->force_without_SV = scale(sine(arg), p->D);
  p->force = add_constant(p->force_without_SV, p->SV);
}

/* Longitudinal force at pure slip, 4.E9 to 4.E18. */
static pure_slip evaluate_longitudinal_force(const ali3_magic_state *s, const operating_point *op, dual kappa) {
  const double *c = s->c, dfz = op->dfz, dpi = op->dpi, gamma = op->gamma_star * (op->is_mf6 ? 1.0 : c[ALI3_MF_LGAX]);
  const double lambda_mu = c[ALI3_MF_LMUX] * s->friction[0] * op->sliding_factor;
  pure_slip p;
  p.C = c[ALI3_MF_PCX1] * c[ALI3_MF_LCX];
  const double mu = (c[ALI3_MF_PDX1] + c[ALI3_MF_PDX2] * dfz) *
                    (1.0 + c[ALI3_MF_PPX3] * dpi + c[ALI3_MF_PPX4] * dpi * dpi) *
                    at_least_min_factor(1.0 - c[ALI3_MF_PDX3] * gamma * gamma) * lambda_mu;
  p.D = mu * s->load;
  p.K = s->load * (c[ALI3_MF_PKX1] + c[ALI3_MF_PKX2] * dfz) * ali3_exp(c[ALI3_MF_PKX3] * dfz) *
        (1.0 + c[ALI3_MF_PPX1] * dpi + c[ALI3_MF_PPX2] * dpi * dpi) * c[ALI3_MF_LKX] * s->stiffness[0];
  p.B = p.K / (p.C * p.D);
  p.SH = s->moving * (c[ALI3_MF_PHX1] + c[ALI3_MF_PHX2] * dfz) * c[ALI3_MF_LHX];
  p.SV = s->moving * s->load * (c[ALI3_MF_PVX1] + c[ALI3_MF_PVX2] * dfz) * c[ALI3_MF_LVX] *
         find_shift_friction(op, lambda_mu);
  p.slip = add_constant(kappa, p.SH);
  p.E = at_most_one((c[ALI3_MF_PEX1] + c[ALI3_MF_PEX2] * dfz + c[ALI3_MF_PEX3] * dfz * dfz) *
                    (1.0 - c[ALI3_MF_PEX4] * sign(p.slip.v)) * c[ALI3_MF_LEX]);
  evaluate_sine_curve(&p);
  return p;
}

/* Lateral force at pure slip, 4.E19 to 4.E30; PAC2002 writes the shifts by camber as PHY3 and PVY3. */
static pure_slip evaluate_lateral_force(const ali3_magic_state *s, const operating_point *op, double camber,
                                        dual alpha) {
  const double *c = s->c, dfz = op->dfz, dpi = op->dpi, gamma = camber * (op->is_mf6 ? 1.0 : c[ALI3_MF_LGAY]);
  const double lambda_mu = c[ALI3_MF_LMUY] * s->friction[1] * op->sliding_factor,
               shift_factor = find_shift_friction(op, lambda_mu);
  const double peak_load = (c[ALI3_MF_PKY2] + c[ALI3_MF_PKY5] * gamma * gamma) * (1.0 + c[ALI3_MF_PPY2] * dpi);
  pure_slip p;
  p.C = c[ALI3_MF_PCY1] * c[ALI3_MF_LCY];
  const double mu = (c[ALI3_MF_PDY1] + c[ALI3_MF_PDY2] * dfz) *
                    (1.0 + c[ALI3_MF_PPY3] * dpi + c[ALI3_MF_PPY4] * dpi * dpi) *
                    at_least_min_factor(1.0 - c[ALI3_MF_PDY3] * gamma * gamma) * lambda_mu;
  p.D = mu * s->load;
  p.K = c[ALI3_MF_PKY1] * op->nominal * (1.0 + c[ALI3_MF_PPY1] * dpi) *
        at_least_min_factor(1.0 - c[ALI3_MF_PKY3] * fabs(gamma)) *
        ali3_sin(c[ALI3_MF_PKY4] * ali3_atan2(s->load / op->nominal, peak_load)) * c[ALI3_MF_LKY] * s->stiffness[1];
  p.B = p.K / (p.C * p.D);
  const double camber_thrust =
      s->load * (c[ALI3_MF_PVY3] + c[ALI3_MF_PVY4] * dfz) * gamma * c[ALI3_MF_LKYC] * shift_factor * s->moving;
  const double camber_shift = op->is_mf6 ? (s->load * (c[ALI3_MF_PKY6] + c[ALI3_MF_PKY7] * dfz) *
                                                (1.0 + c[ALI3_MF_PPY5] * dpi) * c[ALI3_MF_LKYC] * gamma * s->moving -
                                            camber_thrust) /
                                               p.K
                                         : c[ALI3_MF_PHY3] * gamma * c[ALI3_MF_LKYC] * s->moving;
  p.SH = s->moving * (c[ALI3_MF_PHY1] + c[ALI3_MF_PHY2] * dfz) * c[ALI3_MF_LHY] + camber_shift;
  p.SV =
      s->moving * s->load * (c[ALI3_MF_PVY1] + c[ALI3_MF_PVY2] * dfz) * c[ALI3_MF_LVY] * shift_factor + camber_thrust;
  p.slip = add_constant(alpha, p.SH);
  p.E = at_most_one(
      (c[ALI3_MF_PEY1] + c[ALI3_MF_PEY2] * dfz) *
      (1.0 + c[ALI3_MF_PEY5] * gamma * gamma - (c[ALI3_MF_PEY3] + c[ALI3_MF_PEY4] * gamma) * sign(p.slip.v)) *
      c[ALI3_MF_LEY]);
  evaluate_sine_curve(&p);
  return p;
}

/* Weight of combined slip: cos(C atan(...)) at the shifted slip, divided by its value at the shift alone; 4.E51 and
 * 4.E59. */
static dual evaluate_weight(dual B, double C, double E, dual slip, double shift) {
  const dual numerator = cosine(magic_argument(B, C, E, add_constant(slip, shift)));
  if (shift == 0.0) return numerator;
  const dual denominator = cosine(magic_argument(B, C, E, constant(shift)));
  return multiply(numerator, chain(denominator, 1.0 / denominator.v, -1.0 / (denominator.v * denominator.v)));
}

/* Weight of the longitudinal force by the slip angle, 4.E51 to 4.E57. */
static dual evaluate_longitudinal_weight(const ali3_magic_state *s, const operating_point *op, dual kappa, dual alpha) {
  const double *c = s->c, gamma = op->is_mf6 ? op->gamma_star : 0.0;
  const dual B = scale(cos_atan(scale(kappa, c[ALI3_MF_RBX2])),
                       (c[ALI3_MF_RBX1] + c[ALI3_MF_RBX3] * gamma * gamma) * c[ALI3_MF_LXAL]);
  return evaluate_weight(B, c[ALI3_MF_RCX1], at_most_one(c[ALI3_MF_REX1] + c[ALI3_MF_REX2] * op->dfz), alpha,
                         c[ALI3_MF_RHX1]);
}

/* Weight of the lateral force by the longitudinal slip, 4.E59 to 4.E65. */
static dual evaluate_lateral_weight(const ali3_magic_state *s, const operating_point *op, double camber, dual kappa,
                                    dual alpha) {
  const double *c = s->c, gamma = op->is_mf6 ? camber : 0.0;
  const dual B = scale(cos_atan(scale(add_constant(alpha, -c[ALI3_MF_RBY3]), c[ALI3_MF_RBY2])),
                       (c[ALI3_MF_RBY1] + c[ALI3_MF_RBY4] * gamma * gamma) * c[ALI3_MF_LYKA]);
  return evaluate_weight(B, c[ALI3_MF_RCY1], at_most_one(c[ALI3_MF_REY1] + c[ALI3_MF_REY2] * op->dfz), kappa,
                         c[ALI3_MF_RHY1] + c[ALI3_MF_RHY2] * op->dfz);
}

/* Lateral force induced by longitudinal slip, 4.E66, 4.E67. */
static dual induced_lateral_force(const ali3_magic_state *s, const operating_point *op, const pure_slip *y, dual kappa,
                                  dual alpha) {
  const double *c = s->c;
  const double D_VyK = s->moving * y->D * c[ALI3_MF_LVYKA] *
                       (c[ALI3_MF_RVY1] + c[ALI3_MF_RVY2] * op->dfz + c[ALI3_MF_RVY3] * op->gamma_star);
  if (D_VyK == 0.0) return constant(0.0);
  return scale(multiply(cos_atan(scale(alpha, c[ALI3_MF_RVY4])),
                        sine(scale(arctan(scale(kappa, c[ALI3_MF_RVY6])), c[ALI3_MF_RVY5]))),
               D_VyK);
}

/* Factor of the friction ellipse of PAC2002 (FE_METHOD) on the force `own`: 1 / sqrt(1 + (F_own s_other / (D_other
 * s_own))^2), with F_own at pure slip. */
static dual evaluate_ellipse(const pure_slip *own, const pure_slip *other, dual own_slip, dual other_slip) {
  const dual friction_ratio = scale(own->force_without_SV, 1.0 / other->D);
  const double own2 = own_slip.v * own_slip.v + SMALL_SLIP * SMALL_SLIP;
  const dual inverse_square = (dual){1.0 / own2, -2.0 * own_slip.v * own_slip.k / (own2 * own2),
                                     -2.0 * own_slip.v * own_slip.t / (own2 * own2)};
  const dual x =
      multiply(multiply(multiply(friction_ratio, friction_ratio), multiply(other_slip, other_slip)), inverse_square);
  const double sum = 1.0 + x.v, value = 1.0 / sqrt(sum);
  return chain(x, value, -0.5 * value / sum);
}

/* Carcass stiffness, N/m: from the stiffnesses of the file (Besselink et al., eqs. 13 and 14), otherwise slip stiffness
 * divided by the relaxation length of the file, or by a default one. */
static void write_carcass_stiffness(const ali3_magic_state *s, const operating_point *op, const pure_slip *x,
                                    const pure_slip *y, double out[2]) {
  const double *c = s->c, dfz = op->dfz, load = s->load / op->nominal;
  const double stiffness[2] = {c[ALI3_MF_LONGITUDINAL_STIFFNESS], c[ALI3_MF_LATERAL_STIFFNESS]};
  const double *factors[2] = {&c[ALI3_MF_PCFX1], &c[ALI3_MF_PCFY1]};
  const double slip_stiffness[2] = {x->K, fabs(y->K)};
  const double lengths[2] = {load * (c[ALI3_MF_PTX1] + c[ALI3_MF_PTX2] * dfz) * ali3_exp(-c[ALI3_MF_PTX3] * dfz) *
                                 s->radius * c[ALI3_MF_LSGKP],
                             c[ALI3_MF_PTY1] * ali3_sin(2.0 * ali3_atan2(load, c[ALI3_MF_PTY2])) *
                                 at_least_min_factor(1.0 - c[ALI3_MF_PKY3] * fabs(s->camber)) * s->radius *
                                 c[ALI3_MF_LFZO] * c[ALI3_MF_LSGAL]};
  const double default_lengths[2] = {DEFAULT_LONGITUDINAL_RELAXATION * s->radius * load,
                                     DEFAULT_LATERAL_RELAXATION * s->radius * load};
  for (int i = 0; i < 2; i++) {
    const double *factor = factors[i];
    if (stiffness[i] > 0.0)
      out[i] = stiffness[i] *
               at_least_min_factor((1.0 + factor[0] * dfz + factor[1] * dfz * dfz) * (1.0 + factor[2] * op->dpi));
    else
      out[i] =
          slip_stiffness[i] / (lengths[i] > MIN_LENGTH_RATIO * default_lengths[i] ? lengths[i] : default_lengths[i]);
  }
}

/* Combined slip: factors on the forces at pure slip, and the induced lateral force. */
static void combine(const ali3_magic_state *s, const operating_point *op, const pure_slip *x, const pure_slip *y,
                    dual kappa, dual alpha, dual factor[2], dual *induced) {
  factor[0] = factor[1] = constant(1.0);
  *induced = constant(0.0);
  if (s->combined == ALI3_MAGIC_WEIGHTED) {
    factor[0] = evaluate_longitudinal_weight(s, op, kappa, alpha);
    factor[1] = evaluate_lateral_weight(s, op, op->gamma_star, kappa, alpha);
    *induced = induced_lateral_force(s, op, y, kappa, alpha);
  } else if (s->combined == ALI3_MAGIC_ELLIPSE) {
    const dual along = add_constant(kappa, x->SH + x->SV / x->K);
    const dual across = sine(add_constant(alpha, y->SH + y->SV / y->K));
    factor[0] = evaluate_ellipse(x, y, along, across);
    factor[1] = evaluate_ellipse(y, x, across, along);
  }
}

/* Secant of the force of a direction without shifts, for the damping of the carcass. */
static dual find_damping_secant(const pure_slip *p, dual factor) {
  const dual weight = factor.v > MIN_WEIGHT ? factor : constant(MIN_WEIGHT);
  return multiply(secant(p->force_without_SV, p->slip, p->K), weight);
}

/* Force i with its derivatives and secant; `direction`: sign of its slip stiffness. */
static void write_force(ali3_magic_force *out, int i, dual force, dual per_slip, double direction) {
  const double value = direction * per_slip.v;
  out->F[i] = force.v;
  out->J[i][0] = force.k;
  out->J[i][1] = force.t;
  out->secant[i] = value > 0.0 ? value : 0.0;
  out->secant_slope[i][0] = value > 0.0 ? direction * per_slip.k : 0.0;
  out->secant_slope[i][1] = value > 0.0 ? direction * per_slip.t : 0.0;
}

/* Lateral force that acts at the trail, N: without the induced part, 4.E74, from 6.1 without camber. */
static double find_trail_force(const ali3_magic_state *s, const operating_point *op, double Fy, double induced,
                               double kappa, double alpha, double factor) {
  if (!op->is_mf6 || op->gamma_star == 0.0) return Fy - induced;
  const pure_slip upright = evaluate_lateral_force(s, op, 0.0, constant(alpha));
  if (s->combined == ALI3_MAGIC_WEIGHTED)
    factor = evaluate_lateral_weight(s, op, 0.0, constant(kappa), constant(alpha)).v;
  return upright.force.v * factor;
}

void ali3_magic_forces(const ali3_magic_state *s, double kappa, double tangent, ali3_magic_force *out) {
  const operating_point op = make_operating_point(s);
  const double cosine_alpha = 1.0 / sqrt(1.0 + tangent * tangent);
  const dual slip = {kappa, 1.0, 0.0}, tangential = {tangent, 0.0, 1.0};
  const dual alpha = op.is_mf6 ? tangential : arctan(tangential); /* 4.E3 */
  const dual alpha_per_tangent = secant(alpha, tangential, 1.0);
  const pure_slip x = evaluate_longitudinal_force(s, &op, slip),
                  y = evaluate_lateral_force(s, &op, op.gamma_star, alpha);
  dual factor[2], induced;
  combine(s, &op, &x, &y, slip, alpha, factor, &induced);
  write_force(out, 0, multiply(x.force, factor[0]), find_damping_secant(&x, factor[0]), 1.0);
  write_force(out, 1, add(multiply(y.force, factor[1]), induced),
              multiply(find_damping_secant(&y, factor[1]), alpha_per_tangent), sign(y.K));
  out->cornering = fabs(y.K);
  out->peak[0] = fabs(x.D) + fabs(x.SV);
  out->peak[1] = fabs(y.D) + fabs(y.SV);
  write_carcass_stiffness(s, &op, &x, &y, out->carcass);
  const double at_trail = find_trail_force(s, &op, out->F[1], induced.v, kappa, alpha.v, factor[1].v);
  ali3_magic_aligning_moment(s, &op, &x, &y, kappa, alpha.v, cosine_alpha, at_trail, out);
}
