/* Magic Formula: moments of a tyre, and its effective rolling radius. Numbers of equations: see magic_formula.h. */
#include <math.h>
#include <stdbool.h>

#include "../algebra/elementary.h"
#include "magic_formula.h"
#include "magic_terms.h"

#define PI 3.14159265358979323846

typedef struct { /* terms that the trail and the residual moment have in common */
  double gamma, lambda_mu, stiffness, direction, cosine_alpha; /* direction: of travel, 0 at rest */
  double longitudinal; /* longitudinal slip times the ratio of both slip stiffnesses */
} aligning_terms;

/* Slip of the trail and of the residual moment, longitudinal slip included; 4.E77, 4.E78. */
static double find_equivalent_slip(const operating_point *op, const aligning_terms *m, double slip) {
  if (op->is_mf6) return sign(slip) * sqrt(slip * slip + m->longitudinal * m->longitudinal);
  const double tangent = ali3_sin(slip) / ali3_cos(slip);
  return sign(slip) * ali3_atan2(sqrt(tangent * tangent + m->longitudinal * m->longitudinal), 1.0);
}

/* Pneumatic trail, m. */
static double evaluate_trail(const ali3_magic_state *s, const operating_point *op, const aligning_terms *m,
                             double alpha) {
  const double *c = s->c, dfz = op->dfz, gamma = m->gamma, camber = op->is_mf6 ? fabs(gamma) : gamma;
  const double shift = c[ALI3_MF_QHZ1] + c[ALI3_MF_QHZ2] * dfz + (c[ALI3_MF_QHZ3] + c[ALI3_MF_QHZ4] * dfz) * gamma;
  const double alpha_t = alpha + shift;
  const double B = (c[ALI3_MF_QBZ1] + c[ALI3_MF_QBZ2] * dfz + c[ALI3_MF_QBZ3] * dfz * dfz) *
                   (1.0 + c[ALI3_MF_QBZ4] * gamma + c[ALI3_MF_QBZ5] * fabs(gamma) + c[ALI3_MF_QBZ6] * gamma * gamma) *
                   m->stiffness;
  const double D = s->load * s->radius / op->nominal * (c[ALI3_MF_QDZ1] + c[ALI3_MF_QDZ2] * dfz) *
                   (1.0 - c[ALI3_MF_PPZ1] * op->dpi) *
                   (1.0 + c[ALI3_MF_QDZ3] * camber + c[ALI3_MF_QDZ4] * gamma * gamma) * c[ALI3_MF_LTR] * m->direction;
  const double E = at_most_one((c[ALI3_MF_QEZ1] + c[ALI3_MF_QEZ2] * dfz + c[ALI3_MF_QEZ3] * dfz * dfz) *
                               (1.0 + (c[ALI3_MF_QEZ4] + c[ALI3_MF_QEZ5] * gamma) * (2.0 / PI) *
                                          ali3_atan2(B * c[ALI3_MF_QCZ1] * alpha_t, 1.0)));
  const dual slip = constant(find_equivalent_slip(op, m, alpha_t));
  return D * cosine(magic_argument(constant(B), c[ALI3_MF_QCZ1], E, slip)).v * m->cosine_alpha;
}

/* Residual moment, N m. */
static double evaluate_residual_moment(const ali3_magic_state *s, const operating_point *op, const aligning_terms *m,
                                       const pure_slip *y, double alpha) {
  const double *c = s->c, dfz = op->dfz, alpha_r = alpha + y->SH + y->SV / y->K;
  const double B = c[ALI3_MF_QBZ9] * m->stiffness + c[ALI3_MF_QBZ10] * y->B * y->C;
  const double D = s->load * s->radius * m->lambda_mu * m->direction *
                   ((c[ALI3_MF_QDZ6] + c[ALI3_MF_QDZ7] * dfz) * c[ALI3_MF_LRES] +
                    ((c[ALI3_MF_QDZ8] + c[ALI3_MF_QDZ9] * dfz) * (1.0 + c[ALI3_MF_PPZ2] * op->dpi) +
                     (c[ALI3_MF_QDZ10] + c[ALI3_MF_QDZ11] * dfz) * fabs(m->gamma)) *
                        m->gamma * c[ALI3_MF_LKZC]);
  return D * cos_atan(constant(B * find_equivalent_slip(op, m, alpha_r))).v * m->cosine_alpha;
}

void ali3_magic_aligning_moment(const ali3_magic_state *s, const operating_point *op, const pure_slip *x,
                                const pure_slip *y, double kappa, double alpha, double cosine_alpha, double trail_force,
                                ali3_magic_force *out) {
  const double *c = s->c, lambda_mu = c[ALI3_MF_LMUY] * s->friction[1] * op->sliding_factor;
  const double stiffness_ratio = s->combined == ALI3_MAGIC_WEIGHTED ? x->K / y->K : 0.0;
  const aligning_terms m = {.gamma = op->gamma_star * (op->is_mf6 ? 1.0 : c[ALI3_MF_LGAZ]),
                            .lambda_mu = lambda_mu,
                            .stiffness = c[ALI3_MF_LKY] * s->stiffness[1] / lambda_mu,
                            .direction = s->direction * s->moving,
                            .cosine_alpha = cosine_alpha,
                            .longitudinal = stiffness_ratio * kappa};
  out->trail = evaluate_trail(s, op, &m, alpha);
  out->arm = s->moving * s->radius * c[ALI3_MF_LS] *
             (c[ALI3_MF_SSZ1] + c[ALI3_MF_SSZ2] * out->F[1] / op->nominal +
              (c[ALI3_MF_SSZ3] + c[ALI3_MF_SSZ4] * op->dfz) * op->gamma_star);
  out->Mz = -out->trail * trail_force + evaluate_residual_moment(s, op, &m, y, alpha) + out->arm * out->F[0];
}

/* Overturning moment, 4.E69, N m; QSX12 to QSX14 are of version 6.2. As in 4.E70, LFZO does not scale the nominal
 * load. */
static double evaluate_overturning_moment(const ali3_magic_state *s, const operating_point *op, double Fy) {
  const double *c = s->c, gamma = s->camber, lateral_ratio = Fy / s->nominal_load, load = s->load / s->nominal_load;
  const double term =
      c[ALI3_MF_QSX4] == 0.0
          ? 0.0
          : c[ALI3_MF_QSX4] *
                ali3_cos(c[ALI3_MF_QSX5] * ali3_atan2(c[ALI3_MF_QSX6] * load * c[ALI3_MF_QSX6] * load, 1.0)) *
                ali3_sin(c[ALI3_MF_QSX7] * gamma + c[ALI3_MF_QSX8] * ali3_atan2(c[ALI3_MF_QSX9] * lateral_ratio, 1.0));
  const double coefficient = c[ALI3_MF_QSX1] * c[ALI3_MF_LVMX] -
                             c[ALI3_MF_QSX2] * gamma * (1.0 + c[ALI3_MF_PPMX1] * op->dpi) -
                             c[ALI3_MF_QSX12] * gamma * fabs(gamma) + c[ALI3_MF_QSX3] * lateral_ratio + term +
                             c[ALI3_MF_QSX10] * ali3_atan2(c[ALI3_MF_QSX11] * load, 1.0) * gamma;
  return s->moving * s->radius * c[ALI3_MF_LMX] *
         (s->load * coefficient + Fy * (c[ALI3_MF_QSX13] + c[ALI3_MF_QSX14] * fabs(gamma)));
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

/* Rolling resistance moment, N m, >= 0: 4.E70 for PAC2002 and without QSY7; otherwise eq. (A48) of Besselink et al.,
 * whose exponent of the load is reduced by one because the sum is multiplied by the load here. */
static double evaluate_rolling_resistance(const ali3_magic_state *s, const operating_point *op, double Fx) {
  const double *c = s->c, gamma2 = s->camber * s->camber, load = s->load / s->nominal_load;
  const double v = s->speed / c[ALI3_MF_LONGVL];
  const double load_exponent = op->is_mf6 && c[ALI3_MF_QSY7] != 0.0 ? c[ALI3_MF_QSY7] - 1.0 : c[ALI3_MF_QSY7];
  const double sum = c[ALI3_MF_QSY1] + c[ALI3_MF_QSY2] * Fx / s->nominal_load + c[ALI3_MF_QSY3] * v +
                     c[ALI3_MF_QSY4] * v * v * v * v + (c[ALI3_MF_QSY5] + c[ALI3_MF_QSY6] * load) * gamma2;
  const double moment =
      sum * s->load * s->radius * c[ALI3_MF_LMY] * power(load, load_exponent) * power(1.0 + op->dpi, c[ALI3_MF_QSY8]);
  return moment > 0.0 ? moment : 0.0; /* outside its range a fit could become negative and drive the wheel */
}

void ali3_magic_moments(const ali3_magic_state *s, const double acting[2], ali3_magic_force *out) {
  const operating_point op = make_operating_point(s);
  out->Mx = evaluate_overturning_moment(s, &op, acting[1]);
  out->My = evaluate_rolling_resistance(s, &op, acting[0]);
  out->Mz += out->arm * (acting[0] - out->F[0]) - out->trail * (acting[1] - out->F[1]);
}

double ali3_magic_rolling_radius(const ali3_magic_state *s, double free_radius, double stiffness, double deflection,
                                 double stiffness_ratio) {
  const double *c = s->c;
  if (c[ALI3_MF_DREFF] == 0.0 && c[ALI3_MF_FREFF] == 0.0) return free_radius - deflection / 3.0;
  const double nominal_deflection = s->nominal_load / stiffness;
  const double relative_deflection = stiffness_ratio * deflection / nominal_deflection;
  return free_radius -
         nominal_deflection * (c[ALI3_MF_DREFF] * ali3_atan2(c[ALI3_MF_BREFF] * relative_deflection, 1.0) +
                               c[ALI3_MF_FREFF] * relative_deflection);
}
