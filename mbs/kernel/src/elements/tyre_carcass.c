/* Carcass of tyres: the theta rule of a step, deflections, and the tangent's damping. */
#include "tyre_carcass.h"

#include "../algebra/elementary.h"
#include "element_math.h"

void ali3_tyre_carcass_at(const ali3_element_args *a, int i, real c, real d, real g, ali3_tyre_carcass *carcass,
                          ali3_tyre_force *force) {
  const real theta = ali3_theta(a->h, c / (d + g)), b = a->h * theta;
  carcass->stiffness[i] = c;
  carcass->damping[i] = d;
  carcass->offset[i] = c * (a->y_old[i] + a->h * (1.0 - theta) * a->y_old[2 + i]);
  carcass->D[i] = d + b * c;
  force->safe[i] = ALI3_SECANT_FRACTION * carcass->D[i] * (g / (g + carcass->D[i]));
}

void ali3_tyre_deflect(ali3_element_args *a, const ali3_tyre_carcass *carcass, const real F[2]) {
  const real none = {0};
  for (int i = 0; i < 2; i++) {
    a->y_new[i] = a->y_old[i];
    a->y_new[2 + i] = (F[i] - carcass->offset[i]) / carcass->D[i];
    if (!(a->h > 0.0)) continue;
    a->y_new[i] = (F[i] - carcass->damping[i] * a->y_new[2 + i]) / carcass->stiffness[i];
    const lane_mask negligible = ali3_abs(a->y_new[i]) < ALI3_NEGLIGIBLE; /* after a long time in the air */
    a->y_new[i] = ali3_where(negligible, none, a->y_new[i]);
    a->y_new[2 + i] = ali3_where(negligible, none, a->y_new[2 + i]);
  }
}

/* Nearest positive semidefinite matrix; C holds xx, xy, yy. */
static void make_semidefinite(real C[3]) {
  const real mean = 0.5 * (C[0] + C[2]), half = 0.5 * (C[0] - C[2]), split = ali3_hypot(half, C[1]);
  const lane_mask semidefinite = mean >= split, splits = split > 0.0;
  if (!ali3_any(ali3_not(semidefinite))) return;
  const real none = {0}, top = ali3_where(mean + split > 0.0, mean + split, none);
  const real cosine = ali3_where(splits, half / split, none), sine = ali3_where(splits, C[1] / split, none);
  C[0] = ali3_where(semidefinite, C[0], 0.5 * top * (1.0 + cosine));
  C[1] = ali3_where(semidefinite, C[1], 0.5 * top * sine);
  C[2] = ali3_where(semidefinite, C[2], 0.5 * top * (1.0 - cosine));
}

void ali3_tyre_damping(const ali3_tyre_force *force, real C[3]) {
  const real(*J)[2] = force->J, *safe = force->safe;
  C[0] = -J[0][0] - safe[0], C[1] = -0.5 * (J[0][1] + J[1][0]), C[2] = -J[1][1] - safe[1];
  make_semidefinite(C);
  C[0] += safe[0];
  C[2] += safe[1];
}
