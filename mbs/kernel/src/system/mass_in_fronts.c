/* Mass matrix in front storage, the initial value of each tangent, and its diagonal, made positive for massless
 * coordinates. */
#include <math.h>
#include <string.h>

#include "../lookup/lookup.h"
#include "../system.h"
#include "loading.h"

bool ali3_same_values(const int32_t *ptr, const double *val, int32_t i) {
  const double *row = val + ptr[i];
  const int32_t n = ptr[i + 1] - ptr[i];
  for (int32_t k = 0; k < n; k++)
    if (row[n + k] != row[k] || row[2 * n + k] != row[k]) return false;
  return true;
}

bool ali3_mass_isotropic(const ali3_system *s, const double *val) {
  for (int32_t i = 0; i < s->size.nq; i++)
    if (s->mass_alike[i] == 0 && !ali3_same_values(s->mass_ptr, val, i)) return false;
  return true;
}

/* Raises the floor to the masses of lookup-table bodies on a base, which may be lighter itself. */
static void raise_floor(const ali3_system *s, double *floor) {
  for (int32_t i = 0; i < s->n_lookup; i++) {
    const double *m = s->tabled_mass + ALI3_LOOKUP_MOMENTS * (int64_t)i;
    const int32_t *frame = s->tabled_frame + 12 * (int64_t)i;
    for (int k = 0; frame[0] >= 0 && k < 12; k++) {
      const double value = k < 3 ? m[0] : m[3 + k / 3]; /* the mass, then second moments */
      if (floor[frame[k]] < value) floor[frame[k]] = value;
    }
  }
}

void ali3_mass_in_fronts(const ali3_system *s, const double *val, double *front, double *floor, double *floor_inverse,
                         double *missing) {
  const int32_t nq = s->size.nq;
  double sum = 0.0;
  int32_t positive = 0;
  memset(front, 0, (size_t)s->size.front_size * sizeof(double));
  for (int64_t k = 0; k < s->n_mass_col; k++)
    if (s->mass_pos[k] >= 0) front[s->mass_pos[k]] = val[k];
  for (int32_t i = 0; i < nq; i++) {
    floor[i] = front[s->diagonal_pos[i]];
    if (floor[i] > 0.0) {
      sum += floor[i];
      positive++;
    }
  }
  /* massless coordinates are angles: their floor is the inertia of a mean mass at the scale of the drawing */
  const double mean = positive > 0 ? sum / positive : 1.0, typical = s->fine * s->fine * mean;
  for (int32_t i = 0; i < nq; i++) {
    const bool massless = !(floor[i] > 1e-12 * fmin(typical, mean));
    missing[i] = massless ? typical : 0.0;
    if (massless) floor[i] = typical;
  }
  raise_floor(s, floor);
  for (int32_t i = 0; i < nq; i++) floor_inverse[i] = 1.0 / floor[i];
}
