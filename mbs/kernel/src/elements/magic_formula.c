/* Magic Formula: forces and moments of a tyre with their derivatives by the slips. */
#include "magic_formula.h"

#include <math.h>
#include <stdbool.h>

#include "../algebra/elementary.h"

#define PI 3.14159265358979323846
#define LEAST_SHARE 0.05 /* least factor by camber: a large camber must not reverse friction or stiffness */
#define NO_SLIP 1e-9
#define RELAXES_ALONG 0.5 /* radii: relaxation length of a file with neither stiffness nor relaxation length */
#define RELAXES_ACROSS 1.0

/* A value with its derivatives by longitudinal slip and by the tangent of the slip angle. */
typedef struct {
  double v, k, t;
} dual;

static dual constant(double v) { return (dual){v, 0.0, 0.0}; }
static dual chain(dual x, double v, double slope) { return (dual){v, slope * x.k, slope * x.t}; }
static dual add(dual a, dual b) { return (dual){a.v + b.v, a.k + b.k, a.t + b.t}; }
static dual plus(dual a, double b) { return (dual){a.v + b, a.k, a.t}; }
static dual times(dual a, double b) { return (dual){a.v * b, a.k * b, a.t * b}; }
static dual product(dual a, dual b) { return (dual){a.v * b.v, a.k * b.v + a.v * b.k, a.t * b.v + a.v * b.t}; }
static dual arctan(dual x) { return chain(x, ali3_atan2(x.v, 1.0), 1.0 / (1.0 + x.v * x.v)); }
static dual sine(dual x) { return chain(x, ali3_sin(x.v), ali3_cos(x.v)); }
static dual cosine(dual x) { return chain(x, ali3_cos(x.v), -ali3_sin(x.v)); }

static double sign(double x) { return x < 0.0 ? -1.0 : 1.0; }
static double at_most_one(double e) { return e < 1.0 ? e : 1.0; }
static double at_least_share(double x) { return x > LEAST_SHARE ? x : LEAST_SHARE; }

/* C atan(B x - E (B x - atan(B x))) */
static dual shape(dual B, double C, double E, dual x) {
  const dual z = product(B, x);
  if (E == 0.0) return times(arctan(z), C);
  return times(arctan(add(times(z, 1.0 - E), times(arctan(z), E))), C);
}

/* cos(atan(x)) */
static dual fall(dual x) {
  const double size2 = 1.0 + x.v * x.v, value = 1.0 / sqrt(size2);
  return chain(x, value, -x.v * value / size2);
}

/* y/x where both vanish together with the slope `limit`. */
static dual secant(dual y, dual x, double limit) {
  if (fabs(x.v) < NO_SLIP) return constant(limit);
  const double value = y.v / x.v;
  return (dual){value, (y.k - value * x.k) / x.v, (y.t - value * x.t) / x.v};
}

typedef struct { /* one direction at pure slip: coefficients of 4.E9 and 4.E19, longitudinal or lateral */
  double B, C, E, D, K, H, V, mu; /* H, V: shifts */
  dual slip, base, force; /* shifted slip, force without and with V */
} pure;

typedef struct { /* values by load, pressure and camber */
  double nominal, dfz, dpi;
  bool book; /* equations of the book: version 6.1 and later */
  double star; /* gamma* of 4.E4; PAC2002: the camber angle */
  double slowing; /* factor on friction by the sliding speed, 4.E7 */
} terms;

static terms terms_of(const ali3_magic_state *s) {
  const double *c = s->c, nominal = s->nominal_load * c[ALI3_MF_LFZO];
  const bool book = s->version >= ALI3_MAGIC_61;
  return (terms){
      nominal, (s->load - nominal) / nominal,          s->pressure,
      book,    book ? ali3_sin(s->camber) : s->camber, 1.0 / (1.0 + c[ALI3_MF_LMUV] * s->slide / c[ALI3_MF_LONGVL])};
}

/* 4.E8: shifts follow friction less on a slippery road. */
static double shift_friction(const terms *q, double factor) {
  return q->book ? 10.0 * factor / (1.0 + 9.0 * factor) : factor;
}

static void curve(pure *p) {
  const dual arg = shape(constant(p->B), p->C, p->E, p->slip);
  p->base = times(sine(arg), p->D);
  p->force = plus(p->base, p->V);
}

/* Longitudinal force at pure slip, 4.E9 to 4.E18. */
static pure longitudinal(const ali3_magic_state *s, const terms *q, dual kappa) {
  const double *c = s->c, dfz = q->dfz, dpi = q->dpi, gamma = q->star * (q->book ? 1.0 : c[ALI3_MF_LGAX]);
  const double factor = c[ALI3_MF_LMUX] * s->friction[0] * q->slowing;
  pure p;
  p.C = c[ALI3_MF_PCX1] * c[ALI3_MF_LCX];
  p.mu = (c[ALI3_MF_PDX1] + c[ALI3_MF_PDX2] * dfz) * (1.0 + c[ALI3_MF_PPX3] * dpi + c[ALI3_MF_PPX4] * dpi * dpi) *
         at_least_share(1.0 - c[ALI3_MF_PDX3] * gamma * gamma) * factor;
  p.D = p.mu * s->load;
  p.K = s->load * (c[ALI3_MF_PKX1] + c[ALI3_MF_PKX2] * dfz) * ali3_exp(c[ALI3_MF_PKX3] * dfz) *
        (1.0 + c[ALI3_MF_PPX1] * dpi + c[ALI3_MF_PPX2] * dpi * dpi) * c[ALI3_MF_LKX] * s->stiffness[0];
  p.B = p.K / (p.C * p.D);
  p.H = s->moving * (c[ALI3_MF_PHX1] + c[ALI3_MF_PHX2] * dfz) * c[ALI3_MF_LHX];
  p.V = s->moving * s->load * (c[ALI3_MF_PVX1] + c[ALI3_MF_PVX2] * dfz) * c[ALI3_MF_LVX] * shift_friction(q, factor);
  p.slip = plus(kappa, p.H);
  p.E = at_most_one((c[ALI3_MF_PEX1] + c[ALI3_MF_PEX2] * dfz + c[ALI3_MF_PEX3] * dfz * dfz) *
                    (1.0 - c[ALI3_MF_PEX4] * sign(p.slip.v)) * c[ALI3_MF_LEX]);
  curve(&p);
  return p;
}

/* Lateral force at pure slip, 4.E19 to 4.E30; PAC2002 writes the shifts by camber as PHY3 and PVY3. */
static pure lateral(const ali3_magic_state *s, const terms *q, double camber, dual alpha) {
  const double *c = s->c, dfz = q->dfz, dpi = q->dpi, gamma = camber * (q->book ? 1.0 : c[ALI3_MF_LGAY]);
  const double factor = c[ALI3_MF_LMUY] * s->friction[1] * q->slowing, shifts = shift_friction(q, factor);
  const double at = (c[ALI3_MF_PKY2] + c[ALI3_MF_PKY5] * gamma * gamma) * (1.0 + c[ALI3_MF_PPY2] * dpi);
  pure p;
  p.C = c[ALI3_MF_PCY1] * c[ALI3_MF_LCY];
  p.mu = (c[ALI3_MF_PDY1] + c[ALI3_MF_PDY2] * dfz) * (1.0 + c[ALI3_MF_PPY3] * dpi + c[ALI3_MF_PPY4] * dpi * dpi) *
         at_least_share(1.0 - c[ALI3_MF_PDY3] * gamma * gamma) * factor;
  p.D = p.mu * s->load;
  p.K = c[ALI3_MF_PKY1] * q->nominal * (1.0 + c[ALI3_MF_PPY1] * dpi) *
        at_least_share(1.0 - c[ALI3_MF_PKY3] * fabs(gamma)) *
        ali3_sin(c[ALI3_MF_PKY4] * ali3_atan2(s->load / q->nominal, at)) * c[ALI3_MF_LKY] * s->stiffness[1];
  p.B = p.K / (p.C * p.D);
  const double camber_thrust =
      s->load * (c[ALI3_MF_PVY3] + c[ALI3_MF_PVY4] * dfz) * gamma * c[ALI3_MF_LKYC] * shifts * s->moving;
  const double camber_shift = q->book ? (s->load * (c[ALI3_MF_PKY6] + c[ALI3_MF_PKY7] * dfz) *
                                             (1.0 + c[ALI3_MF_PPY5] * dpi) * c[ALI3_MF_LKYC] * gamma * s->moving -
                                         camber_thrust) /
                                            p.K
                                      : c[ALI3_MF_PHY3] * gamma * c[ALI3_MF_LKYC] * s->moving;
  p.H = s->moving * (c[ALI3_MF_PHY1] + c[ALI3_MF_PHY2] * dfz) * c[ALI3_MF_LHY] + camber_shift;
  p.V = s->moving * s->load * (c[ALI3_MF_PVY1] + c[ALI3_MF_PVY2] * dfz) * c[ALI3_MF_LVY] * shifts + camber_thrust;
  p.slip = plus(alpha, p.H);
  p.E = at_most_one(
      (c[ALI3_MF_PEY1] + c[ALI3_MF_PEY2] * dfz) *
      (1.0 + c[ALI3_MF_PEY5] * gamma * gamma - (c[ALI3_MF_PEY3] + c[ALI3_MF_PEY4] * gamma) * sign(p.slip.v)) *
      c[ALI3_MF_LEY]);
  curve(&p);
  return p;
}

/* Weight of combined slip: cos(C atan(...)) at the shifted slip, divided by its value at the shift alone; 4.E51 and
 * 4.E59. */
static dual weight(dual B, double C, double E, dual slip, double shift) {
  const dual top = cosine(shape(B, C, E, plus(slip, shift)));
  if (shift == 0.0) return top;
  const dual bottom = cosine(shape(B, C, E, constant(shift)));
  return product(top, chain(bottom, 1.0 / bottom.v, -1.0 / (bottom.v * bottom.v)));
}

/* Weight of the longitudinal force by the slip angle, 4.E51 to 4.E57. */
static dual longitudinal_weight(const ali3_magic_state *s, const terms *q, dual kappa, dual alpha) {
  const double *c = s->c, gamma = q->book ? q->star : 0.0;
  const dual B =
      times(fall(times(kappa, c[ALI3_MF_RBX2])), (c[ALI3_MF_RBX1] + c[ALI3_MF_RBX3] * gamma * gamma) * c[ALI3_MF_LXAL]);
  return weight(B, c[ALI3_MF_RCX1], at_most_one(c[ALI3_MF_REX1] + c[ALI3_MF_REX2] * q->dfz), alpha, c[ALI3_MF_RHX1]);
}

/* Weight of the lateral force by the longitudinal slip, 4.E59 to 4.E65. */
static dual lateral_weight(const ali3_magic_state *s, const terms *q, double camber, dual kappa, dual alpha) {
  const double *c = s->c, gamma = q->book ? camber : 0.0;
  const dual B = times(fall(times(plus(alpha, -c[ALI3_MF_RBY3]), c[ALI3_MF_RBY2])),
                       (c[ALI3_MF_RBY1] + c[ALI3_MF_RBY4] * gamma * gamma) * c[ALI3_MF_LYKA]);
  return weight(B, c[ALI3_MF_RCY1], at_most_one(c[ALI3_MF_REY1] + c[ALI3_MF_REY2] * q->dfz), kappa,
                c[ALI3_MF_RHY1] + c[ALI3_MF_RHY2] * q->dfz);
}

/* Lateral force induced by longitudinal slip, 4.E66, 4.E67. */
static dual induced(const ali3_magic_state *s, const terms *q, const pure *y, dual kappa, dual alpha) {
  const double *c = s->c;
  const double size =
      s->moving * y->D * c[ALI3_MF_LVYKA] * (c[ALI3_MF_RVY1] + c[ALI3_MF_RVY2] * q->dfz + c[ALI3_MF_RVY3] * q->star);
  if (size == 0.0) return constant(0.0);
  return times(
      product(fall(times(alpha, c[ALI3_MF_RVY4])), sine(times(arctan(times(kappa, c[ALI3_MF_RVY6])), c[ALI3_MF_RVY5]))),
      size);
}

/* Factor of the friction ellipse of PAC2002 (FE_METHOD) on the force of direction `own`: of the ratio of both slips and
 * the share that the other direction has of its ellipse. */
static dual ellipse(const pure *own, const pure *other, dual own_slip, dual other_slip) {
  const dual use = times(own->base, 1.0 / other->D); /* actual over maximal friction */
  const double own2 = own_slip.v * own_slip.v + NO_SLIP * NO_SLIP;
  const dual inverse_square = (dual){1.0 / own2, -2.0 * own_slip.v * own_slip.k / (own2 * own2),
                                     -2.0 * own_slip.v * own_slip.t / (own2 * own2)};
  const dual x = product(product(product(use, use), product(other_slip, other_slip)), inverse_square);
  const double size = 1.0 + x.v, value = 1.0 / sqrt(size);
  return chain(x, value, -0.5 * value / size);
}

/* Equivalent slip of the trail and of the residual moment, including longitudinal slip; 4.E77, 4.E78. */
static double equivalent(const terms *q, double slip, double ratio, double kappa) {
  const double along = ratio * kappa;
  if (q->book) return sign(slip) * sqrt(slip * slip + along * along);
  const double tangent = ali3_sin(slip) / ali3_cos(slip);
  return sign(slip) * ali3_atan2(sqrt(tangent * tangent + along * along), 1.0);
}

/* Aligning moment, trail and arm, 4.E71 to 4.E78. lateral_force: without the induced part, and without camber from 6.1
 * on. */
static void aligning(const ali3_magic_state *s, const terms *q, const pure *x, const pure *y, double kappa,
                     double alpha, double cosine_alpha, double lateral_force, ali3_magic_force *out) {
  const double *c = s->c, dfz = q->dfz, gamma = q->star * (q->book ? 1.0 : c[ALI3_MF_LGAZ]), radius = s->radius;
  const double friction = c[ALI3_MF_LMUY] * s->friction[1] * q->slowing;
  const double stiffness = c[ALI3_MF_LKY] * s->stiffness[1] / friction, sense = s->direction * s->moving;
  const double tilt = q->book ? fabs(gamma) : gamma, ratio = s->combined == ALI3_MAGIC_WEIGHTED ? x->K / y->K : 0.0;
  const double shift = c[ALI3_MF_QHZ1] + c[ALI3_MF_QHZ2] * dfz + (c[ALI3_MF_QHZ3] + c[ALI3_MF_QHZ4] * dfz) * gamma;
  const double at = alpha + shift, ar = alpha + y->H + y->V / y->K;
  const double B = (c[ALI3_MF_QBZ1] + c[ALI3_MF_QBZ2] * dfz + c[ALI3_MF_QBZ3] * dfz * dfz) *
                   (1.0 + c[ALI3_MF_QBZ4] * gamma + c[ALI3_MF_QBZ5] * fabs(gamma) + c[ALI3_MF_QBZ6] * gamma * gamma) *
                   stiffness;
  const double D = s->load * radius / q->nominal * (c[ALI3_MF_QDZ1] + c[ALI3_MF_QDZ2] * dfz) *
                   (1.0 - c[ALI3_MF_PPZ1] * q->dpi) * (1.0 + c[ALI3_MF_QDZ3] * tilt + c[ALI3_MF_QDZ4] * gamma * gamma) *
                   c[ALI3_MF_LTR] * sense;
  const double E = at_most_one(
      (c[ALI3_MF_QEZ1] + c[ALI3_MF_QEZ2] * dfz + c[ALI3_MF_QEZ3] * dfz * dfz) *
      (1.0 + (c[ALI3_MF_QEZ4] + c[ALI3_MF_QEZ5] * gamma) * (2.0 / PI) * ali3_atan2(B * c[ALI3_MF_QCZ1] * at, 1.0)));
  const dual equivalent_slip = constant(equivalent(q, at, ratio, kappa));
  out->trail = D * cosine(shape(constant(B), c[ALI3_MF_QCZ1], E, equivalent_slip)).v * cosine_alpha;
  const double Br = c[ALI3_MF_QBZ9] * stiffness + c[ALI3_MF_QBZ10] * y->B * y->C;
  const double Dr = s->load * radius * friction * sense *
                    ((c[ALI3_MF_QDZ6] + c[ALI3_MF_QDZ7] * dfz) * c[ALI3_MF_LRES] +
                     ((c[ALI3_MF_QDZ8] + c[ALI3_MF_QDZ9] * dfz) * (1.0 + c[ALI3_MF_PPZ2] * q->dpi) +
                      (c[ALI3_MF_QDZ10] + c[ALI3_MF_QDZ11] * dfz) * fabs(gamma)) *
                         gamma * c[ALI3_MF_LKZC]);
  const double residual = Dr * fall(constant(Br * equivalent(q, ar, ratio, kappa))).v * cosine_alpha;
  out->arm = s->moving * radius * c[ALI3_MF_LS] *
             (c[ALI3_MF_SSZ1] + c[ALI3_MF_SSZ2] * out->F[1] / q->nominal +
              (c[ALI3_MF_SSZ3] + c[ALI3_MF_SSZ4] * dfz) * q->star);
  out->Mz = -out->trail * lateral_force + residual + out->arm * out->F[0];
}

/* Overturning moment, 4.E69, N m; QSX12 to QSX14 are of version 6.2. As in 4.E70, LFZO does not scale the nominal
 * load. */
static double overturning(const ali3_magic_state *s, const terms *q, double Fy) {
  const double *c = s->c, gamma = s->camber, lateral_ratio = Fy / s->nominal_load, load = s->load / s->nominal_load;
  const double term =
      c[ALI3_MF_QSX4] == 0.0
          ? 0.0
          : c[ALI3_MF_QSX4] *
                ali3_cos(c[ALI3_MF_QSX5] * ali3_atan2(c[ALI3_MF_QSX6] * load * c[ALI3_MF_QSX6] * load, 1.0)) *
                ali3_sin(c[ALI3_MF_QSX7] * gamma + c[ALI3_MF_QSX8] * ali3_atan2(c[ALI3_MF_QSX9] * lateral_ratio, 1.0));
  const double of_load = c[ALI3_MF_QSX1] * c[ALI3_MF_LVMX] -
                         c[ALI3_MF_QSX2] * gamma * (1.0 + c[ALI3_MF_PPMX1] * q->dpi) -
                         c[ALI3_MF_QSX12] * gamma * fabs(gamma) + c[ALI3_MF_QSX3] * lateral_ratio + term +
                         c[ALI3_MF_QSX10] * ali3_atan2(c[ALI3_MF_QSX11] * load, 1.0) * gamma;
  return s->moving * s->radius * c[ALI3_MF_LMX] *
         (s->load * of_load + Fy * (c[ALI3_MF_QSX13] + c[ALI3_MF_QSX14] * fabs(gamma)));
}

/* ln(x) for x > 0, the same on every platform */
static double logarithm(double x) {
  int exponent;
  const double mantissa = frexp(x, &exponent), z = (mantissa - 1.0) / (mantissa + 1.0), z2 = z * z;
  double sum = 0.0;
  for (int k = 41; k > 0; k -= 2) sum = sum * z2 + 1.0 / k;
  return 2.0 * z * sum + exponent * 0.69314718055994531;
}

/* x^p for x > 0 */
static double power(double x, double p) { return p == 0.0 ? 1.0 : ali3_exp(p * logarithm(x)); }

/* Moment of rolling resistance, N m, >= 0: 4.E70 for PAC2002; from 6.1 on eq. (A48) of Besselink et al., which divides
 * by the nominal load, so its power of the load is less by one. Without QSY7 that of PAC2002. */
static double rolling(const ali3_magic_state *s, const terms *q, double Fx) {
  const double *c = s->c, gamma2 = s->camber * s->camber, load = s->load / s->nominal_load;
  const double v = s->speed / c[ALI3_MF_LONGVL], by_load = c[ALI3_MF_QSY7] - (q->book && c[ALI3_MF_QSY7] != 0.0);
  const double sum = c[ALI3_MF_QSY1] + c[ALI3_MF_QSY2] * Fx / s->nominal_load + c[ALI3_MF_QSY3] * v +
                     c[ALI3_MF_QSY4] * v * v * v * v + (c[ALI3_MF_QSY5] + c[ALI3_MF_QSY6] * load) * gamma2;
  const double moment =
      sum * s->load * s->radius * c[ALI3_MF_LMY] * power(load, by_load) * power(1.0 + q->dpi, c[ALI3_MF_QSY8]);
  return moment > 0.0 ? moment : 0.0; /* outside its range a fit could become negative and drive the wheel */
}

/* Carcass stiffness, N/m: from the stiffnesses of the file (Besselink et al., eqs. 13 and 14), otherwise slip stiffness
 * over relaxation length of the file, otherwise over an assumed one. */
static void carcass_stiffness(const ali3_magic_state *s, const terms *q, const pure *x, const pure *y, double out[2]) {
  const double *c = s->c, dfz = q->dfz, load = s->load / q->nominal;
  const double along = load * (c[ALI3_MF_PTX1] + c[ALI3_MF_PTX2] * dfz) * ali3_exp(-c[ALI3_MF_PTX3] * dfz) * s->radius *
                       c[ALI3_MF_LSGKP];
  const double across = c[ALI3_MF_PTY1] * ali3_sin(2.0 * ali3_atan2(load, c[ALI3_MF_PTY2])) *
                        at_least_share(1.0 - c[ALI3_MF_PKY3] * fabs(s->camber)) * s->radius * c[ALI3_MF_LFZO] *
                        c[ALI3_MF_LSGAL];
  const double lengths[2] = {along, across}, slip[2] = {x->K, fabs(y->K)};
  const double default_lengths[2] = {RELAXES_ALONG * s->radius * load, RELAXES_ACROSS * s->radius * load};
  for (int i = 0; i < 2; i++) {
    const double stiffness = c[i ? ALI3_MF_LATERAL_STIFFNESS : ALI3_MF_LONGITUDINAL_STIFFNESS];
    const double *factors = &c[i ? ALI3_MF_PCFY1 : ALI3_MF_PCFX1];
    if (stiffness > 0.0)
      out[i] =
          stiffness * at_least_share((1.0 + factors[0] * dfz + factors[1] * dfz * dfz) * (1.0 + factors[2] * q->dpi));
    else
      out[i] = slip[i] / (lengths[i] > LEAST_SHARE * default_lengths[i] ? lengths[i] : default_lengths[i]);
  }
}

void ali3_magic_forces(const ali3_magic_state *s, double kappa, double tangent, ali3_magic_force *out) {
  const terms q = terms_of(s);
  const double cosine_alpha = 1.0 / sqrt(1.0 + tangent * tangent);
  const dual slip = {kappa, 1.0, 0.0}, tangential = {tangent, 0.0, 1.0};
  const dual alpha = q.book ? tangential : arctan(tangential); /* 4.E3 */
  const pure x = longitudinal(s, &q, slip), y = lateral(s, &q, q.star, alpha);
  dual factor[2] = {constant(1.0), constant(1.0)}, term = constant(0.0);
  if (s->combined == ALI3_MAGIC_WEIGHTED) {
    factor[0] = longitudinal_weight(s, &q, slip, alpha);
    factor[1] = lateral_weight(s, &q, q.star, slip, alpha);
    term = induced(s, &q, &y, slip, alpha);
  } else if (s->combined == ALI3_MAGIC_ELLIPSE) {
    const dual along = plus(slip, x.H + x.V / x.K), across = sine(plus(alpha, y.H + y.V / y.K));
    factor[0] = ellipse(&x, &y, along, across);
    factor[1] = ellipse(&y, &x, across, along);
  }
  const dual force[2] = {product(x.force, factor[0]), add(product(y.force, factor[1]), term)};
  const dual ratio = secant(alpha, tangential, 1.0);
  const dual combined_weight = constant(factor[1].v);
  for (int i = 0; i < 2; i++) /* a weight that is negative at large slips must not make the carcass unstable */
    if (!(factor[i].v > LEAST_SHARE)) factor[i] = constant(LEAST_SHARE);
  const dual per_slip[2] = {product(secant(x.base, x.slip, x.K), factor[0]),
                            product(product(secant(y.base, y.slip, y.K), factor[1]), ratio)};
  for (int i = 0; i < 2; i++) {
    const double sense = i ? sign(y.K) : 1.0, value = sense * per_slip[i].v;
    out->F[i] = force[i].v;
    out->J[i][0] = force[i].k, out->J[i][1] = force[i].t;
    out->secant[i] = value > 0.0 ? value : 0.0;
    out->secant_slope[i][0] = value > 0.0 ? sense * per_slip[i].k : 0.0;
    out->secant_slope[i][1] = value > 0.0 ? sense * per_slip[i].t : 0.0;
  }
  out->cornering = fabs(y.K);
  out->peak[0] = fabs(x.D) + fabs(x.V), out->peak[1] = fabs(y.D) + fabs(y.V);
  carcass_stiffness(s, &q, &x, &y, out->carcass);
  double trail_force = out->F[1] - term.v; /* 4.E74 */
  if (q.book && q.star != 0.0) {
    const pure upright = lateral(s, &q, 0.0, constant(alpha.v));
    const dual weight_level = s->combined == ALI3_MAGIC_WEIGHTED
                                  ? lateral_weight(s, &q, 0.0, constant(kappa), constant(alpha.v))
                                  : combined_weight;
    trail_force = upright.force.v * weight_level.v;
  }
  aligning(s, &q, &x, &y, kappa, alpha.v, cosine_alpha, trail_force, out);
}

void ali3_magic_moments(const ali3_magic_state *s, const double acting[2], ali3_magic_force *out) {
  const terms q = terms_of(s);
  out->Mx = overturning(s, &q, acting[1]);
  out->My = rolling(s, &q, acting[0]);
  out->Mz += out->arm * (acting[0] - out->F[0]) - out->trail * (acting[1] - out->F[1]);
}

double ali3_magic_rolling_radius(const ali3_magic_state *s, double free_radius, double stiffness, double deflection,
                                 double harder) {
  const double *c = s->c;
  if (c[ALI3_MF_DREFF] == 0.0 && c[ALI3_MF_FREFF] == 0.0) return free_radius - deflection / 3.0;
  const double unit = s->nominal_load / stiffness, depth = harder * deflection / unit;
  return free_radius - unit * (c[ALI3_MF_DREFF] * ali3_atan2(c[ALI3_MF_BREFF] * depth, 1.0) + c[ALI3_MF_FREFF] * depth);
}
