/* Terms that forces and moments of the Magic Formula have in common (magic_formula.c, magic_moments.c). */
#ifndef ALI3_MAGIC_TERMS_H
#define ALI3_MAGIC_TERMS_H
#include <math.h>
#include <stdbool.h>

#include "../algebra/elementary.h"
#include "magic_formula.h"

#define MIN_FACTOR 0.05 /* of camber, load and pressure: large ones must not reverse friction or stiffness */

/* Dual number: value v, derivatives k, t with respect to longitudinal slip and tan(slip angle). */
typedef struct {
  double v, k, t;
} dual;

/* Functions of dual numbers; chain: a function with value v and slope at x. */
static inline dual constant(double v) { return (dual){v, 0.0, 0.0}; }
static inline dual chain(dual x, double v, double slope) { return (dual){v, slope * x.k, slope * x.t}; }
static inline dual add(dual a, dual b) { return (dual){a.v + b.v, a.k + b.k, a.t + b.t}; }
static inline dual add_constant(dual a, double b) { return (dual){a.v + b, a.k, a.t}; }
static inline dual scale(dual a, double b) { return (dual){a.v * b, a.k * b, a.t * b}; }
static inline dual multiply(dual a, dual b) { return (dual){a.v * b.v, a.k * b.v + a.v * b.k, a.t * b.v + a.v * b.t}; }
static inline dual arctan(dual x) { return chain(x, ali3_atan2(x.v, 1.0), 1.0 / (1.0 + x.v * x.v)); }
static inline dual sine(dual x) { return chain(x, ali3_sin(x.v), ali3_cos(x.v)); }
static inline dual cosine(dual x) { return chain(x, ali3_cos(x.v), -ali3_sin(x.v)); }

/* 1 for x = 0. */
static inline double sign(double x) { return x < 0.0 ? -1.0 : 1.0; }
static inline double at_most_one(double e) { return e < 1.0 ? e : 1.0; }
static inline double at_least_min_factor(double x) { return x > MIN_FACTOR ? x : MIN_FACTOR; }

/* C atan(B x - E (B x - atan(B x))) */
static inline dual magic_argument(dual B, double C, double E, dual x) {
  const dual z = multiply(B, x);
  if (E == 0.0) return scale(arctan(z), C);
  return scale(arctan(add(scale(z, 1.0 - E), scale(arctan(z), E))), C);
}

/* cos(atan(x)) */
static inline dual cos_atan(dual x) {
  const double size2 = 1.0 + x.v * x.v, value = 1.0 / sqrt(size2);
  return chain(x, value, -x.v * value / size2);
}

/* One direction at pure slip: coefficients of 4.E9 and 4.E19, longitudinal or lateral. */
typedef struct {
  double B, C, E, D, K, SH, SV;
  dual slip, force_without_SV, force; /* slip: with SH */
} pure_slip;

typedef struct {
  double nominal, dfz, dpi; /* nominal load, N; relative deviations of load and pressure */
  bool is_mf6; /* version 6.1 or later */
  double gamma_star; /* 4.E4; PAC2002: the camber angle */
  double sliding_factor; /* on friction by the sliding speed, 4.E7 */
} operating_point;

/* Quantities that both directions use. */
static inline operating_point make_operating_point(const ali3_magic_state *s) {
  const double *c = s->c, nominal = s->nominal_load * c[ALI3_MF_LFZO];
  const bool is_mf6 = s->version >= ALI3_MAGIC_61;
  return (operating_point){.nominal = nominal,
                           .dfz = (s->load - nominal) / nominal,
                           .dpi = s->pressure,
                           .is_mf6 = is_mf6,
                           .gamma_star = is_mf6 ? ali3_sin(s->camber) : s->camber,
                           .sliding_factor = 1.0 / (1.0 + c[ALI3_MF_LMUV] * s->slide / c[ALI3_MF_LONGVL])};
}

/* Aligning moment, trail and lever of the longitudinal force, 4.E71 to 4.E78. trail_force: lateral force, N, that acts
 * at the trail. */
void ali3_magic_aligning_moment(const ali3_magic_state *s, const operating_point *op, const pure_slip *x,
                                const pure_slip *y, double kappa, double alpha, double cosine_alpha, double trail_force,
                                ali3_magic_force *out);
#endif
