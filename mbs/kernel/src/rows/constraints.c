/* Phi, Phi_q, Phi_t, gamma and the geometric term of the rows: short loops over their quadratic terms. */
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/processor.h"
#include "../algebra/real.h"
#include "../algebra/stretch.h"
#include "../instance.h"
#include "constraints.h"
#include "guide_terms.h"
#include "switch_rows.h"
#include "velocity_rows.h"

/* A scene that is not tied to the ground does not feel a translation, but its squares of coordinates do lose digits
 * far from the origin: there the rows are evaluated at a shifted copy. */
static const real *near_origin(ali3_instance *in, const real *q) {
  const ali3_system *S = in->system;
  const double *direction[3] = {S->pose_x, S->pose_y, S->pose_z};
  const int32_t witness[3] = {S->shift_x, S->shift_y, S->shift_z};
  const real *from = q;
  for (int d = 0; d < 3; d++) {
    if (witness[d] < 0) continue;
    const real way = 64.0 * ali3_floor(q[witness[d]] / direction[d][witness[d]] / 64.0 + 0.5);
    if (!ali3_any(way != 0.0)) continue;
    for (int32_t i = 0; i < S->size.nq; i++)
      in->shifted[i] = ali3_where(way != 0.0, from[i] - way * direction[d][i], from[i]);
    from = in->shifted;
  }
  return from;
}

/* Adds the terms t to end - 1 of three neighbouring entries of Phi_q to them, of points: with three neighbours each.
 * Returns the first term of the next three. */
static inline int32_t add_points(const ali3_system *S, int32_t t, int32_t end, const real *q, ali3_three *entry) {
  ALI3_SHORT
  for (; t < end; t += 3) ali3_three_add_each(entry, S->hess_val + t, q + S->hess_col[t]);
  return t;
}

/* The terms of three neighbouring entries, each with a coordinate of its own. */
static inline void add_terms(const ali3_system *S, int32_t i, const real *q, real entry[3]) {
  const int32_t *col = S->hess_col + S->hess_ptr[i], *end = S->hess_col + S->hess_ptr[i + 3];
  const double *hess = S->hess_val + S->hess_ptr[i];
  real x = entry[0], y = entry[1], z = entry[2];
  ALI3_SHORT
  for (; col < end; col += 3, hess += 3) {
    x += hess[0] * q[col[0]];
    y += hess[1] * q[col[1]];
    z += hess[2] * q[col[2]];
  }
  entry[0] = x, entry[1] = y, entry[2] = z;
}

/* Entries i to i + n - 1 of Phi_q, a stretch, go to `out`: their constants and their terms, of which three are added while
 * an entry is in hand. */
static inline void put_stretch(const ali3_system *S, int32_t i, int32_t n, const real *q, real *restrict out) {
  const int32_t terms = S->hess_ptr[i + 1] - S->hess_ptr[i], *col = S->hess_col + S->hess_ptr[i];
  const double *restrict hess = S->hess_val + S->hess_ptr[i], *restrict lin = S->row_lin + i;
  int32_t t = 0;
  if (terms >= 3) {
    const double *restrict second = hess + n, *restrict third = second + n;
    const real x = q[col[0]], y = q[col[n]], z = q[col[2 * n]];
    ALI3_BY_FOURS
    for (int32_t k = 0; k < n; k++) out[k] = ((lin[k] + hess[k] * x) + second[k] * y) + third[k] * z;
    t = 3;
  } else {
    for (int32_t k = 0; k < n; k++) out[k] = ali3_same(lin[k]);
  }
  for (; t < terms; t++) {
    const double *restrict one = hess + (int64_t)t * n;
    const real x = q[col[t * n]];
    ALI3_BY_FOURS
    for (int32_t k = 0; k < n; k++) out[k] += one[k] * x;
  }
}

/* A sum with the terms of entry i, of which many may lie side by side. */
ALI3_INLINED real add_run(const ali3_system *S, int32_t i, const real *q, real sum) {
  const int32_t run = S->hess_run[i], end = S->hess_ptr[i + 1];
  ALI3_SHORT
  for (int32_t t = S->hess_ptr[i]; t < run; t++) sum += S->hess_val[t] * q[S->hess_col[t]];
  return run < end ? sum + ali3_numbers_from_far(S->hess_val + run, q + S->hess_col[run], end - run) : sum;
}

/* The terms of a stretch of n entries from i on, twice with the rates qd. */
static inline real stretch_gamma(const ali3_system *S, int32_t i, int32_t n, const real *qd) {
  const int32_t first = S->hess_ptr[i], terms = S->hess_ptr[i + 1] - first;
  real sum = {0};
  for (int32_t t = first; t < first + terms * n; t += n)
    sum += ali3_numbers_from_far(S->hess_val + t, qd + S->row_col[i], n) * qd[S->hess_col[t]];
  return sum;
}

/* `singles`: rows may have entries of a term each at most. */
ALI3_INLINED void all_rows(ali3_instance *in, const real *q, const real *s, real *Phi, real *J, bool singles) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->row_ptr, *col = S->row_col;
  const double *row_lin = S->row_lin;
  if (S->size.has_pose) q = near_origin(in, q);
  const bool generated = ALI3_GENERATED(S, rows, (row_lin, S->row_const, S->hess_val, q, Phi, J));
  for (int32_t k = generated ? S->size.nc : 0; k < S->size.nc; k++) {
    real value = {0};
    int32_t i = ptr[k];
    const int32_t single = singles && S->row_single[k] ? ptr[k + 1] : i;
    ALI3_SHORT
    for (; i < single; i++) {
      const double lin = row_lin[i];
      const real sum = lin + S->single_val[i] * q[S->single_col[i]];
      J[i] = sum;
      value += (sum + lin) * q[col[i]];
    }
    const int32_t triples = S->row_triples[k] ? ptr[k + 1] : i;
    if (triples > i && S->row_triples[k] == ALI3_POINTS)
      for (int32_t t = S->hess_ptr[i]; i < triples; i += 3) {
        ali3_three lin, entry;
        ali3_three_begin(&lin, row_lin + i);
        entry = lin;
        t = add_points(S, t, S->hess_ptr[i + 3], q, &entry);
        ali3_three_put_first(J + i, &entry);
        ali3_three_plus(&entry, &lin);
        value = ali3_three_sum(value, &entry, q + col[i]);
      }
    for (; i < triples; i += 3) {
      const double *lin = row_lin + i;
      real entry[3] = {ali3_same(lin[0]), ali3_same(lin[1]), ali3_same(lin[2])};
      add_terms(S, i, q, entry);
      for (int d = 0; d < 3; d++) J[i + d] = entry[d];
      const real both[3] = {entry[0] + lin[0], entry[1] + lin[1], entry[2] + lin[2]};
      value = ali3_triple_sum(value, both, q + col[i]);
    }
    for (; i < S->row_stretch[k]; i++) {
      const double lin = row_lin[i];
      const real sum = add_run(S, i, q, ali3_same(lin));
      J[i] = sum;
      value += (sum + lin) * q[col[i]];
    }
    const int32_t first = i;
    i = ptr[k + 1];
    if (i > first) put_stretch(S, first, i - first, q, J + first);
    if (i > first) value += ali3_sum_product_from_far(J + first, row_lin + first, q + col[first], i - first);
    Phi[k] = S->row_const[k] + 0.5 * value;
  }
  guide_values(S, q, s, Phi, J);
  for (int64_t i = 0; i < S->n_angle_row; i++) {
    const real theta = q[S->angle_theta_col[i]], cosine = ali3_cos(theta), sine = ali3_sin(theta);
    real along = {0}, across = {0}; /* C and S */
    for (int32_t t = S->angle_ptr[i]; t < S->angle_ptr[i + 1]; t++) {
      const ali3_angle_term *x = &S->angle[t];
      const real qa = value_of(q, x->a), qb = value_of(q, x->b);
      const real h = cosine * x->hs - sine * x->hc;
      along += x->hc * qa * qb;
      across += x->hs * qa * qb;
      if (x->a >= 0) J[x->ja] += h * qb;
      if (x->b >= 0) J[x->jb] += h * qa;
    }
    Phi[S->angle_row[i]] += cosine * across - sine * along;
    J[S->angle_theta_j[i]] -= sine * across + cosine * along;
  }
  if (S->n_velocity_row > 0) ali3_velocity_jacobian(in, q, Phi, J);
  if (S->size.n_switch > 0) ali3_switch_rows(in, Phi, J);
}

ALI3_INLINED void rigid_rows(ali3_instance *in, const real *q, const real *s, real *Phi, real *J) {
  all_rows(in, q, s, Phi, J, false);
}

ALI3_INLINED void flexible_rows(ali3_instance *in, const real *q, const real *s, real *Phi, real *J) {
  all_rows(in, q, s, Phi, J, true);
}

ALI3_BY_PROCESSOR(in->system, void, rigid_rows, (ali3_instance * in, const real *q, const real *s, real *Phi, real *J),
                  (in, q, s, Phi, J))

ALI3_BY_PROCESSOR(in->system, void, flexible_rows,
                  (ali3_instance * in, const real *q, const real *s, real *Phi, real *J), (in, q, s, Phi, J))

/* The coordinates at which rows are evaluated. */
const real *ali3_near_origin(ali3_instance *in, const real *q) {
  return in->system->size.has_pose ? near_origin(in, q) : q;
}

void ali3_constraints(ali3_instance *in, const real *q, const real *s, real *Phi, real *J) {
  (in->system->n_flexible > 0 ? ali3_flexible_rows : ali3_rigid_rows)(in, q, s, Phi, J);
}

/* Phit = d Phi / dt */
void ali3_constraint_rate(ali3_instance *in, const real *q, const ali3_vectors *guides, real *Phit) {
  const ali3_system *S = in->system;
  memset(Phit, 0, (size_t)S->size.nc * sizeof *Phit);
  if (S->n_gterm_row == 0) return;
  if (S->size.has_pose) q = near_origin(in, q);
  guide_rates(S, q, guides, Phit);
  if (S->size.n_switch > 0) ali3_switch_values(in, Phit);
}

/* gamma = d(Phi_q)/dt qd + d(Phi_t)/dt, so that Phi'' = Phi_q qdd + gamma. */
ALI3_INLINED void all_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *guides, real *gamma,
                            bool singles) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->row_ptr, *col = S->row_col;
  if (S->size.has_pose) q = near_origin(in, q);
  const bool generated = ALI3_GENERATED(S, gamma, (S->hess_val, qd, gamma));
  for (int32_t k = generated ? S->size.nc : 0; k < S->size.nc; k++) {
    real value = {0};
    int32_t i = ptr[k];
    const int32_t single = singles && S->row_single[k] ? ptr[k + 1] : i;
    ALI3_SHORT
    for (; i < single; i++) value += S->single_val[i] * qd[S->single_col[i]] * qd[col[i]];
    const int32_t triples = S->row_triples[k] ? ptr[k + 1] : i;
    if (triples > i && S->row_triples[k] == ALI3_POINTS)
      for (int32_t t = S->hess_ptr[i]; i < triples; i += 3) {
        ali3_three entry = {0};
        t = add_points(S, t, S->hess_ptr[i + 3], qd, &entry);
        value = ali3_three_sum(value, &entry, qd + col[i]);
      }
    for (; i < triples; i += 3) {
      real entry[3] = {ali3_same(0.0), ali3_same(0.0), ali3_same(0.0)};
      add_terms(S, i, qd, entry);
      value = ali3_triple_sum(value, entry, qd + col[i]);
    }
    for (; i < S->row_stretch[k]; i++) value += add_run(S, i, qd, ali3_same(0.0)) * qd[col[i]];
    if (i < ptr[k + 1]) value += stretch_gamma(S, i, ptr[k + 1] - i, qd);
    gamma[k] = value;
  }
  guide_gamma(S, q, qd, guides, gamma);
  for (int64_t i = 0; i < S->n_angle_row; i++) {
    const real theta = q[S->angle_theta_col[i]], rate = qd[S->angle_theta_col[i]], cosine = ali3_cos(theta),
               sine = ali3_sin(theta);
    real value = {0}, first = {0}, second = {0}; /* of cos S - sin C: with theta's rates, mixed, own */
    for (int32_t t = S->angle_ptr[i]; t < S->angle_ptr[i + 1]; t++) {
      const ali3_angle_term *x = &S->angle[t];
      const real qa = value_of(q, x->a), qb = value_of(q, x->b);
      const real va = rate_of(qd, x->a), vb = rate_of(qd, x->b);
      const real h = cosine * x->hs - sine * x->hc;
      value += h * qa * qb;
      first -= (sine * x->hs + cosine * x->hc) * (va * qb + qa * vb);
      second += 2.0 * h * va * vb;
    }
    gamma[S->angle_row[i]] += second + 2.0 * rate * first - rate * rate * value;
  }
  if (S->n_velocity_row > 0) ali3_velocity_gamma(in, qd, gamma);
  if (S->size.n_switch > 0) ali3_switch_values(in, gamma);
}

ALI3_INLINED void rigid_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *guides,
                              real *gamma) {
  all_gamma(in, q, qd, guides, gamma, false);
}

ALI3_INLINED void flexible_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *guides,
                                 real *gamma) {
  all_gamma(in, q, qd, guides, gamma, true);
}

ALI3_BY_PROCESSOR(in->system, void, rigid_gamma,
                  (ali3_instance * in, const real *q, const real *qd, const ali3_vectors *guides, real *gamma),
                  (in, q, qd, guides, gamma))

ALI3_BY_PROCESSOR(in->system, void, flexible_gamma,
                  (ali3_instance * in, const real *q, const real *qd, const ali3_vectors *guides, real *gamma),
                  (in, q, qd, guides, gamma))

void ali3_constraint_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *guides, real *gamma) {
  (in->system->n_flexible > 0 ? ali3_flexible_gamma : ali3_rigid_gamma)(in, q, qd, guides, gamma);
}

/* The terms of the stretch of row k, which are columns of its front. */
static inline void stretch_geometric(const ali3_system *S, int32_t k, real factor, real *F) {
  const int32_t i = S->row_stretch[k], n = S->row_ptr[k + 1] - i, first = S->hess_ptr[i];
  for (int32_t t = first; t < S->hess_ptr[i + 1] * n - first * (n - 1); t += n) {
    const double *restrict hess = S->hess_val + t;
    real *restrict column = F + S->stretch_pos[t];
    ALI3_BY_FOURS
    for (int32_t j = 0; j < n; j++) column[j] += factor * hess[j];
  }
}

/* F += weight * sum_k lam_k d2(Phi_k)/dq2, lower triangles. */
ALI3_INLINED void geometric(ali3_instance *in, const real *q, const real *s, const real *lam, double weight, real *F) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->quad_ptr, *pos = S->quad_pos;
  const double *second = S->quad_second;
  if (S->size.has_pose) q = near_origin(in, q);
  for (int32_t k = 0; k < S->size.nc; k++) {
    const real factor = weight * lam[k];
    if (S->quad_end[k] < ptr[k + 1]) stretch_geometric(S, k, factor, F);
    for (int32_t t = ptr[k]; t < S->quad_end[k]; t++) F[pos[t]] += factor * second[t];
  }
  guide_geometric(S, s, lam, weight, F);
  for (int64_t i = 0; i < S->n_angle_row; i++) {
    const real theta = q[S->angle_theta_col[i]], factor = weight * lam[S->angle_row[i]];
    const real cosine = factor * ali3_cos(theta), sine = factor * ali3_sin(theta);
    real value = {0};
    for (int32_t t = S->angle_ptr[i]; t < S->angle_ptr[i + 1]; t++) {
      const ali3_angle_term *x = &S->angle[t];
      const real qa = value_of(q, x->a), qb = value_of(q, x->b);
      const real h = cosine * x->hs - sine * x->hc, mixed = -(sine * x->hs + cosine * x->hc);
      value += h * qa * qb;
      if (x->pos >= 0) F[x->pos] += x->a == x->b ? 2.0 * h : h;
      if (x->pos_a >= 0) F[x->pos_a] += mixed * qb;
      if (x->pos_b >= 0) F[x->pos_b] += mixed * qa;
    }
    F[S->angle_theta_pos[i]] -= value;
  }
}

ALI3_BY_PROCESSOR(in->system, void, geometric,
                  (ali3_instance * in, const real *q, const real *s, const real *lam, double weight, real *F),
                  (in, q, s, lam, weight, F))

/* Three columns of weight J' J, of entries j to j + 2 of a row of triples that ends before `end`. */
ALI3_INLINED void add_triple(real *block, int64_t n, const real *J, int32_t j, int32_t end, const int32_t *loc,
                             double weight) {
  const real x = weight * J[j], y = weight * J[j + 1], z = weight * J[j + 2];
  real *restrict a = block + loc[j] * n, *restrict b = a + n, *restrict c = b + n;
  const int32_t own = loc[j];
  a[own] += x * J[j];
  a[own + 1] += x * J[j + 1];
  a[own + 2] += x * J[j + 2];
  b[own + 1] += y * J[j + 1];
  b[own + 2] += y * J[j + 2];
  c[own + 2] += z * J[j + 2];
  for (int32_t i = j + 3; i < end; i += 3) {
    ali3_triple_add(a + loc[i], J + i, x);
    ali3_triple_add(b + loc[i], J + i, y);
    ali3_triple_add(c + loc[i], J + i, z);
  }
}

/* target += the multiples of four rows, in turn while an entry is in hand. */
ALI3_INLINED void add_four(real *restrict target, const real *restrict a, const real *restrict b,
                           const real *restrict c, const real *restrict d, const real *f, int64_t count) {
  ALI3_BY_FOURS
  for (int64_t i = 0; i < count; i++)
    target[i] = (((target[i] + f[0] * a[i]) + f[1] * b[i]) + f[2] * c[i]) + f[3] * d[i];
}

/* Weight J' J of four rows with the same stretch: in columns of the stretch one after the other while an entry is in
 * hand. */
ALI3_INLINED void square_of_four(const ali3_system *S, const int32_t *rows, const real *J, double weight, real *block,
                                 int64_t n) {
  const int32_t *ptr = S->row_ptr, *first = S->row_stretch, *loc = S->row_loc, k = rows[0];
  const int32_t length = ptr[k + 1] - first[k];
  for (const int32_t *at = rows; at < rows + 4; at++)
    for (int32_t row = *at, j = ptr[row]; j < first[row]; j++) {
      real *restrict column = block + (int64_t)loc[j] * n;
      const real factor = weight * J[j];
      for (int32_t i = j; i < first[row]; i++) column[loc[i]] += factor * J[i];
      ali3_add_multiple(column + loc[first[row]], J + first[row], factor, length);
    }
  const real *a = J + first[k], *b = J + first[rows[1]], *c = J + first[rows[2]], *d = J + first[rows[3]];
  for (int64_t j = 0; j < length; j++) {
    const real factor[4] = {weight * a[j], weight * b[j], weight * c[j], weight * d[j]};
    int64_t from = j < 3 ? j : ali3_by_fours_below(j, length);
    ALI3_OPAQUE(from);
    real *column = block + (loc[first[k]] + j) * n + loc[first[k]] + from;
    add_four(column, a + from, b + from, c + from, d + from, factor, length - from);
  }
}

/* F += weight * J' J, front by front and row by row; a wide row is spread over its front so that columns are
 * contiguous. */
ALI3_INLINED void rows_square(ali3_instance *in, const real *J, double weight, real *F) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->row_ptr, *loc = S->row_loc;
  real *restrict spread = in->local;
  for (int32_t at = 0; at < S->size.nc; at++) {
    const int32_t k = S->front_row[at], f = S->row_front[k], n = S->front_ptr[f + 1] - S->front_ptr[f],
                  end = ptr[k + 1];
    real *block = F + S->front_off[f];
    if (S->row_alike[at] >= 4) {
      square_of_four(S, S->front_row + at, J, weight, block, n);
      at += 3;
      continue;
    }
    if (S->row_triples[k]) {
      for (int32_t j = ptr[k]; j < end; j += 3) add_triple(block, n, J, j, end, loc, weight);
      continue;
    }
    if (S->row_wide[k]) {
      const int32_t last = loc[end - 1] + 1;
      for (int32_t i = loc[ptr[k]]; i < last; i++) spread[i] = ali3_same(0.0);
      for (int32_t i = ptr[k]; i < end; i++) spread[loc[i]] = J[i];
      for (int32_t j = ptr[k]; j < end; j++) {
        const int32_t from = loc[j];
        real *restrict column = block + (int64_t)from * n;
        const real factor = weight * J[j];
        for (int32_t i = from; i < last; i++) column[i] += factor * spread[i];
      }
      continue;
    }
    for (int32_t j = ptr[k]; j < end; j++) {
      real *column = block + (int64_t)loc[j] * n;
      const real factor = weight * J[j];
      ALI3_SHORT
      for (int32_t i = j; i < end; i++) column[loc[i]] += factor * J[i];
    }
  }
}

ALI3_BY_PROCESSOR(in->system, void, rows_square, (ali3_instance * in, const real *J, double weight, real *F),
                  (in, J, weight, F))

/* F += weight * A' J, whole blocks. */
void ali3_rows_product(ali3_instance *in, const real *A, const real *J, double weight, real *F) {
  const ali3_system *S = in->system;
  for (int32_t k = 0; k < S->size.nc; k++) {
    const int32_t f = S->row_front[k], n = S->front_ptr[f + 1] - S->front_ptr[f], end = S->row_ptr[k + 1];
    real *block = F + S->front_off[f];
    for (int32_t j = S->row_ptr[k]; j < end; j++) {
      real *column = block + (int64_t)S->row_loc[j] * n;
      const real factor = weight * J[j];
      ALI3_SHORT
      for (int32_t i = S->row_ptr[k]; i < end; i++) column[S->row_loc[i]] += factor * A[i];
    }
  }
}

/* `stretches`: rows end with modes side by side, which are one sum of four. */
ALI3_INLINED void times(const ali3_system *S, const real *J, const real *x, real *out, bool stretches) {
  const int32_t *end = S->row_ptr + 1, *col = S->row_col, *stretch = S->row_stretch;
  const unsigned char *triples = S->row_triples;
  for (int32_t k = 0, i = 0, nc = S->size.nc; k < nc; k++) {
    const int32_t last = end[k];
    real sum = {0};
    if (triples[k]) {
      ALI3_SHORT
      for (; i < last; i += 3) sum = ali3_points_sum(sum, J + i, x + col[i]);
    } else {
      ALI3_SHORT
      for (const int32_t first = stretches ? stretch[k] : last; i < first; i++) sum += J[i] * x[col[i]];
      if (stretches && i < last) sum += ali3_product_from_far(J + i, x + col[i], last - i);
      i = last;
    }
    out[k] = sum;
  }
}

ALI3_INLINED void rows_times(const ali3_system *S, const real *J, const real *x, real *out) {
  if (ALI3_GENERATED(S, rows_times, (J, x, out))) return;
  if (S->n_flexible > 0)
    times(S, J, x, out, true);
  else
    times(S, J, x, out, false);
}

ALI3_BY_PROCESSOR(S, void, rows_times, (const ali3_system *S, const real *J, const real *x, real *out), (S, J, x, out))

ALI3_INLINED void rows_times_both(const ali3_system *S, const real *J, const real *x, const real *y, real *out_x,
                                  real *out_y) {
  if (ALI3_GENERATED(S, rows_times, (J, x, out_x)) && ALI3_GENERATED(S, rows_times, (J, y, out_y))) return;
  const int32_t *ptr = S->row_ptr, *col = S->row_col, *stretch = S->n_flexible > 0 ? S->row_stretch : ptr + 1;
  for (int32_t k = 0; k < S->size.nc; k++) {
    real sum_x = {0}, sum_y = {0};
    int32_t i = ptr[k];
    const int32_t triples = S->row_triples[k] ? ptr[k + 1] : i;
    ALI3_SHORT
    for (; i < triples; i += 3) {
      sum_x = ali3_points_sum(sum_x, J + i, x + col[i]);
      sum_y = ali3_points_sum(sum_y, J + i, y + col[i]);
    }
    ALI3_SHORT
    for (; i < stretch[k]; i++) {
      sum_x += J[i] * x[col[i]];
      sum_y += J[i] * y[col[i]];
    }
    if (i < ptr[k + 1]) {
      sum_x += ali3_product_from_far(J + i, x + col[i], ptr[k + 1] - i);
      sum_y += ali3_product_from_far(J + i, y + col[i], ptr[k + 1] - i);
    }
    out_x[k] = sum_x, out_y[k] = sum_y;
  }
}

/* The same of x and y with entries loaded once. */
ALI3_BY_PROCESSOR(S, void, rows_times_both,
                  (const ali3_system *S, const real *J, const real *x, const real *y, real *out_x, real *out_y),
                  (S, J, x, y, out_x, out_y))

/* Row by row. `stretches`: rows end with modes side by side. */
ALI3_INLINED void transposed_by_rows(const ali3_system *S, const real *J, const real *w, real *out, bool stretches) {
  const int32_t *ptr = S->row_ptr, *col = S->row_col, *end = ptr + 1, *stretch = stretches ? S->row_stretch : end;
  memset(out, 0, (size_t)S->size.nq * sizeof *out);
  for (int32_t k = 0; k < S->size.nc; k++) {
    const real weight = w[k];
    int32_t i = ptr[k];
    const int32_t triples = S->row_triples[k] ? ptr[k + 1] : i;
    ALI3_SHORT
    for (; i < triples; i += 3) ali3_triple_add(out + col[i], J + i, weight);
    ALI3_SHORT
    for (; i < stretch[k]; i++) out[col[i]] += J[i] * weight;
    if (stretches && i < end[k]) ali3_add_multiple(out + col[i], J + i, weight, end[k] - i);
  }
}

/* Coordinate by coordinate, in the order of the rows: a sum stays in hand. */
ALI3_INLINED void transposed_by_columns(const ali3_system *S, const real *J, const real *w, real *restrict out) {
  const int32_t *ptr = S->column_ptr, *entry = S->column_entry, *row = S->column_row;
  for (int32_t i = 0; i < S->size.nq; i++) {
    const int32_t end = ptr[i + 1];
    int32_t k = ptr[i];
    if (S->column_triple[i]) {
      ali3_three three = {0};
      ALI3_SHORT
      for (; k < end; k++) ali3_three_add(&three, J + entry[k], w[row[k]]);
      ali3_three_put_first(out + i, &three);
      i += 2;
      continue;
    }
    real sum = {0};
    ALI3_SHORT
    for (; k < end; k++) sum += J[entry[k]] * w[row[k]];
    out[i] = sum;
  }
}

ALI3_INLINED void rows_transposed(const ali3_system *S, const real *J, const real *w, real *out) {
  if (ALI3_GENERATED(S, rows_transposed, (J, w, out))) return;
  if (S->by_columns)
    transposed_by_columns(S, J, w, out);
  else if (S->n_flexible > 0)
    transposed_by_rows(S, J, w, out, true);
  else
    transposed_by_rows(S, J, w, out, false);
}

ALI3_BY_PROCESSOR(S, void, rows_transposed, (const ali3_system *S, const real *J, const real *w, real *out),
                  (S, J, w, out))
