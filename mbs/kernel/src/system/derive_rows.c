/* Derives, when a System is loaded, the terms of its rows with their positions, in the order of the loops. */
#include "derive_rows.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "../rows/violation.h"
#include "derive_elements.h"

enum { MAX_TERMS = 32, MAX_IN_TURN = 2048 };

void ali3_rows_place(ali3_system *s, ali3_pool *p) {
  const size_t na = (size_t)s->n_angle_row;
  s->hess_ptr = ali3_pool_items(p, (size_t)s->n_row_col + 1, sizeof(int32_t));
  s->hess_col = ali3_pool_items(p, 2 * (size_t)s->n_quad_a, sizeof(int32_t));
  s->hess_val = ali3_pool_items(p, 2 * (size_t)s->n_quad_a + 1, sizeof(double)); /* as ali3_pool_padded */
  s->row_round = ali3_pool_items(p, (size_t)s->size.nc, sizeof(double));
  s->row_triples = ali3_pool_items(p, (size_t)s->size.nc, 1);
  s->row_stretch = ali3_pool_items(p, (size_t)s->size.nc, sizeof(int32_t));
  s->hess_run = ali3_pool_items(p, (size_t)s->n_row_col, sizeof(int32_t));
  s->front_row_ptr = ali3_pool_items(p, (size_t)s->size.nf + 1, sizeof(int32_t));
  s->front_row = ali3_pool_items(p, (size_t)s->size.nc, sizeof(int32_t));
  s->row_alike = ali3_pool_items(p, (size_t)s->size.nc, sizeof(int32_t));
  s->quad_end = ali3_pool_items(p, (size_t)s->size.nc, sizeof(int32_t));
  s->stretch_pos = ali3_pool_items(p, 2 * (size_t)s->n_quad_a, sizeof(int32_t));
  s->quad = ali3_pool_items(p, (size_t)s->n_quad_a, sizeof *s->quad);
  s->quad_pos = ali3_pool_items(p, (size_t)s->n_quad_a, sizeof(int32_t));
  s->quad_second = ali3_pool_items(p, (size_t)s->n_quad_a, sizeof(double));
  s->angle = ali3_pool_items(p, (size_t)s->n_angle_a, sizeof *s->angle);
  s->angle_theta_col = ali3_pool_items(p, na, sizeof(int32_t));
  s->angle_theta_j = ali3_pool_items(p, na, sizeof(int32_t));
  s->angle_theta_pos = ali3_pool_items(p, na, sizeof(int32_t));
  s->gterm = ali3_pool_items(p, (size_t)s->n_gterm_row, sizeof *s->gterm);
  s->turning = ali3_pool_items(p, na, sizeof(int32_t));
  s->driven_row = ali3_pool_items(p, (size_t)s->size.nc, sizeof(int32_t));
  s->velocity = ali3_pool_items(p, (size_t)s->n_velocity_a, sizeof *s->velocity);
}

/* Front storage index of the product of entries i >= j of the Jacobian in row k. */
static int32_t row_pos(const ali3_system *s, int32_t k, int32_t i, int32_t j) {
  const int32_t f = s->row_front[k], n = s->front_ptr[f + 1] - s->front_ptr[f];
  const int32_t li = s->row_loc[i], lj = s->row_loc[j];
  return s->front_off[f] + (li > lj ? lj * n + li : li * n + lj);
}

/* Term h q_a q_b of row k from local indices a, b; -1: no factor. */
static ali3_term make_term(const ali3_system *s, int32_t k, int32_t a, int32_t b, double h) {
  ali3_term t = {.a = -1, .b = -1, .ja = -1, .jb = -1, .pos = -1, .h = h};
  if (a >= 0) {
    t.ja = s->row_ptr[k] + a;
    t.a = s->row_col[t.ja];
  }
  if (b >= 0) {
    t.jb = s->row_ptr[k] + b;
    t.b = s->row_col[t.jb];
    t.pos = row_pos(s, k, t.ja, t.jb);
  }
  return t;
}

/* Terms of rows, driving functions, angles and rows on velocities. */
static void derive_rows(ali3_system *s) {
  for (int32_t k = 0; k < s->size.nc; k++)
    for (int32_t t = s->quad_ptr[k]; t < s->quad_ptr[k + 1]; t++)
      s->quad[t] = make_term(s, k, s->quad_a[t], s->quad_b[t], s->quad_h[t]);
  for (int64_t t = 0; t < s->n_gterm_row; t++) {
    const int32_t k = s->gterm_row[t];
    const ali3_driving_term g = {.term = make_term(s, k, s->gterm_a[t], s->gterm_b[t], s->gterm_h[t]),
                                 .row = k,
                                 .driving = s->gterm_guide[t],
                                 .power = s->gterm_power[t]};
    s->gterm[t] = g;
  }
  for (int32_t k = 0; k < s->size.nc; k++) {
    bool driven = false;
    for (int64_t t = 0; t < s->n_gterm_row; t++) driven |= s->gterm_row[t] == k;
    if (driven) s->driven_row[s->n_driven++] = k;
  }
  for (int64_t i = 0; i < s->n_velocity_row; i++)
    for (int32_t t = s->velocity_ptr[i]; t < s->velocity_ptr[i + 1]; t++)
      s->velocity[t] = make_term(s, s->velocity_row[i], s->velocity_a[t], s->velocity_b[t], s->velocity_h[t]);
  for (int64_t i = 0; i < s->n_angle_row; i++) {
    const int32_t k = s->angle_row[i], theta = s->row_ptr[k] + s->angle_theta[i];
    s->angle_theta_j[i] = theta;
    s->angle_theta_col[i] = s->row_col[theta];
    s->angle_theta_pos[i] = row_pos(s, k, theta, theta);
    for (int32_t t = s->angle_ptr[i]; t < s->angle_ptr[i + 1]; t++) {
      const ali3_term base = make_term(s, k, s->angle_a[t], s->angle_b[t], 0.0);
      const ali3_angle_term term = {.a = base.a,
                                    .b = base.b,
                                    .ja = base.ja,
                                    .jb = base.jb,
                                    .pos = base.pos,
                                    .pos_a = base.ja < 0 ? -1 : row_pos(s, k, theta, base.ja),
                                    .pos_b = base.jb < 0 ? -1 : row_pos(s, k, theta, base.jb),
                                    .hc = s->angle_hc[t],
                                    .hs = s->angle_hs[t]};
      s->angle[t] = term;
    }
  }
}

/* Whether row k only defines an angle, and its coordinate has inertia or is in another row with others. */
static bool has_other_effects(const ali3_system *s, int32_t k, int32_t theta) {
  bool affects = s->mass_floor[theta] > 0.0 && s->mass_missing[theta] == 0.0;
  for (int32_t i = s->row_ptr[k]; i < s->row_ptr[k + 1]; i++)
    if (s->row_lin[i] != 0.0) return false;
  if (s->row_const[k] != 0.0 || s->quad_ptr[k] < s->quad_ptr[k + 1]) return false;
  for (int32_t other = 0; other < s->size.nc && !affects; other++)
    for (int32_t i = s->row_ptr[other]; i < s->row_ptr[other + 1]; i++)
      affects |= other != k && s->row_col[i] == theta && s->row_ptr[other + 1] - s->row_ptr[other] > 1;
  return affects;
}

/* Lists the angles with inertia or other rows. */
static void derive_turning(ali3_system *s) {
  for (int32_t i = 0; i < s->n_angle_row; i++)
    if (has_other_effects(s, s->angle_row[i], s->angle_theta_col[i])) s->turning[s->n_turning++] = i;
}

static const double DECIDES = 1e-12; /* m: a smaller round-off is negligible relative to the tolerances of rows */

/* Largest magnitude of the coordinates of row k, applied to all of them, as a moved scene may have it in any component
 * of a vector. */
static double largest_of_row(const ali3_system *s, int32_t k) {
  double largest = 0.0;
  for (int32_t i = s->row_ptr[k]; i < s->row_ptr[k + 1]; i++) largest = fmax(largest, fabs(s->q0[s->row_col[i]]));
  return largest;
}

/* Round-off of the sum of a row's terms, which limits convergence: of squares of coordinates far from the origin, or of
 * a large scene. */
static void derive_round(ali3_system *s) {
  for (int32_t k = 0; k < s->size.nc; k++) {
    const double largest = largest_of_row(s, k);
    double magnitude = fabs(s->row_const[k]);
    for (int32_t i = s->row_ptr[k]; i < s->row_ptr[k + 1]; i++) magnitude += fabs(s->row_lin[i]) * largest;
    for (int32_t t = s->quad_ptr[k]; t < s->quad_ptr[k + 1]; t++) magnitude += fabs(s->quad[t].h) * largest * largest;
    const double unit = 4.0 * DBL_EPSILON * s->row_measure[k];
    s->row_round[k] = unit * magnitude > DECIDES ? unit * magnitude : unit * ali3_row_sum(s, k, s->q0);
  }
  for (int64_t i = 0; i < s->n_velocity_row; i++) s->row_round[s->velocity_row[i]] = 0.0; /* no positions in it */
  s->largest_round = 0.0;
  for (int32_t k = 0; k < s->size.nc; k++) s->largest_round = fmax(s->largest_round, s->row_round[k]);
}

/* Whether the coordinates of row k are triples of consecutive ones with equal numbers of terms. */
static bool in_triples(const ali3_system *s, int32_t k) {
  const int32_t *ptr = s->hess_ptr, *col = s->row_col, end = s->row_ptr[k + 1];
  if ((end - s->row_ptr[k]) % ALI3_TRIPLE != 0) return false;
  for (int32_t i = s->row_ptr[k]; i < end; i += ALI3_TRIPLE) {
    const int32_t terms = ptr[i + 1] - ptr[i];
    if (terms > MAX_TERMS || ptr[i + 2] - ptr[i + 1] != terms || ptr[i + 3] - ptr[i + 2] != terms) return false;
    if (col[i + 1] != col[i] + 1 || col[i + 2] != col[i] + 2) return false;
  }
  return true;
}

/* Whether the second factors of the terms of a row of triples are triples as well. */
static bool has_point_factors(const ali3_system *s, int32_t k) {
  const int32_t *ptr = s->hess_ptr, *col = s->hess_col;
  for (int32_t i = s->row_ptr[k]; i < s->row_ptr[k + 1]; i += ALI3_TRIPLE)
    for (int32_t x = ptr[i], y = ptr[i + 1], z = ptr[i + 2]; x < ptr[i + 1]; x++, y++, z++)
      if (col[y] != col[x] + 1 || col[z] != col[x] + 2) return false;
  return true;
}

/* First entry of the stretch of row k; the end of the row if it were short. */
static int32_t find_stretch(const ali3_system *s, int32_t k) {
  const int32_t *ptr = s->hess_ptr, *col = s->hess_col, end = s->row_ptr[k + 1];
  int32_t i = end - 1;
  for (; i > s->row_ptr[k]; i--) {
    const int32_t terms = ptr[i + 1] - ptr[i];
    if (s->row_col[i - 1] != s->row_col[i] - 1 || ptr[i] - ptr[i - 1] != terms || (end - i + 1) * terms > MAX_IN_TURN ||
        memcmp(col + ptr[i - 1], col + ptr[i], (size_t)terms * sizeof *col) != 0)
      break;
  }
  return end - i < ALI3_MIN_LENGTH ? end : i;
}

/* Interleaves the terms of `count` entries with `terms` terms each, stored one entry after the other from `first`
 * on. */
static void interleave(ali3_system *s, int32_t first, int32_t count, int32_t terms) {
  int32_t col[MAX_IN_TURN];
  double val[MAX_IN_TURN];
  memcpy(col, s->hess_col + first, (size_t)(count * terms) * sizeof *col);
  memcpy(val, s->hess_val + first, (size_t)(count * terms) * sizeof *val);
  for (int32_t t = 0; t < terms; t++)
    for (int32_t i = 0; i < count; i++) {
      s->hess_col[first + count * t + i] = col[i * terms + t];
      s->hess_val[first + count * t + i] = val[i * terms + t];
    }
}

/* Second derivatives of the rows, sorted by the entry of Phi_q they contribute to. */
static void derive_hessian(ali3_system *s) {
  memset(s->hess_ptr, 0, ((size_t)s->n_row_col + 1) * sizeof(int32_t));
  for (int64_t t = 0; t < s->n_quad_a; t++) {
    s->hess_ptr[s->quad[t].ja + 1]++;
    if (s->quad[t].a != s->quad[t].b) s->hess_ptr[s->quad[t].jb + 1]++;
  }
  for (int64_t i = 0; i < s->n_row_col; i++) s->hess_ptr[i + 1] += s->hess_ptr[i];
  for (int64_t t = 0; t < s->n_quad_a; t++) { /* moves hess_ptr[i] to the end of entry i, the start of i + 1 */
    const ali3_term x = s->quad[t];
    const int32_t at = s->hess_ptr[x.ja]++;
    s->hess_col[at] = x.b;
    s->hess_val[at] = x.a == x.b ? 2.0 * x.h : x.h;
    if (x.a == x.b) continue;
    const int32_t mirror = s->hess_ptr[x.jb]++;
    s->hess_col[mirror] = x.a;
    s->hess_val[mirror] = x.h;
  }
  for (int64_t i = s->n_row_col; i > 0; i--) s->hess_ptr[i] = s->hess_ptr[i - 1];
  s->hess_ptr[0] = 0;
  for (int32_t k = 0; k < s->size.nc; k++) {
    s->row_triples[k] = in_triples(s, k);
    if (s->row_triples[k] && has_point_factors(s, k)) s->row_triples[k] = ALI3_POINTS;
    for (int32_t i = s->row_ptr[k]; s->row_triples[k] == ALI3_POINTS && i < s->row_ptr[k + 1]; i += ALI3_TRIPLE)
      interleave(s, s->hess_ptr[i], ALI3_TRIPLE, s->hess_ptr[i + 1] - s->hess_ptr[i]);
    const bool none = s->row_triples[k] || s->n_flexible == 0;
    const int32_t first = none ? s->row_ptr[k + 1] : find_stretch(s, k);
    s->row_stretch[k] = first;
    if (first < s->row_ptr[k + 1])
      interleave(s, s->hess_ptr[first], s->row_ptr[k + 1] - first, s->hess_ptr[first + 1] - s->hess_ptr[first]);
  }
}

/* Whether row `next` is in the front of row k and has the same stretch. */
static bool same_stretch(const ali3_system *s, int32_t k, int32_t next) {
  const int32_t first = s->row_stretch[k], other = s->row_stretch[next];
  return s->row_front[next] == s->row_front[k] && s->row_ptr[next + 1] - other == s->row_ptr[k + 1] - first &&
         s->row_loc[first] == s->row_loc[other];
}

/* Rows front by front, and how many rows in turn have the same stretch. */
static void derive_alike_rows(ali3_system *s) {
  int32_t *end = s->front_row_ptr + 1; /* ends of fronts; initially their starts, advanced with each row */
  const int32_t n = s->size.nc, nf = s->size.nf;
  for (int32_t k = 0; k < n; k++)
    if (s->row_front[k] + 1 < nf) end[s->row_front[k] + 1]++;
  for (int32_t f = 1; f < nf; f++) end[f] += end[f - 1];
  for (int32_t k = 0; k < n; k++) s->front_row[end[s->row_front[k]]++] = k;
  for (int32_t at = n - 1; at >= 0; at--) {
    const int32_t k = s->front_row[at];
    s->row_alike[at] = s->row_stretch[k] < s->row_ptr[k + 1];
    if (s->row_alike[at] > 0 && at + 1 < n && same_stretch(s, k, s->front_row[at + 1]))
      s->row_alike[at] += s->row_alike[at + 1];
  }
}

/* Whether term x of row k has one factor in its stretch and is below the other in the front; *entry: entry of the
 * stretch. */
static bool in_stretch(const ali3_system *s, int32_t k, const ali3_term *x, int32_t *entry) {
  const int32_t first = s->row_stretch[k], other = x->ja < x->jb ? x->ja : x->jb;
  *entry = x->ja < x->jb ? x->jb : x->ja;
  return *entry >= first && other < first && s->row_loc[other] < s->row_loc[first];
}

/* Moves the terms of row k with its stretch to the end, if they are complete. */
static void derive_stretch_terms(ali3_system *s, int32_t k) {
  const int32_t begin = s->quad_ptr[k], end = s->quad_ptr[k + 1], first = s->row_stretch[k];
  const int32_t n = s->row_ptr[k + 1] - first;
  const int32_t terms = n > 0 ? s->hess_ptr[first + 1] - s->hess_ptr[first] : 0;
  int32_t matching = 0, entry = 0;
  s->quad_end[k] = end;
  for (int32_t t = begin; t < end; t++) matching += in_stretch(s, k, &s->quad[t], &entry);
  if (matching == 0 || matching != n * terms) return;
  s->quad_end[k] = end - matching;
  int32_t next_other = begin;
  for (int32_t t = begin; t < end; t++) {
    const ali3_term x = s->quad[t];
    if (!in_stretch(s, k, &x, &entry)) {
      s->quad[t] = s->quad[next_other];
      s->quad[next_other++] = x;
    } else if (entry == first) {
      const int32_t partner = x.ja == first ? x.b : x.a;
      for (int32_t m = 0; m < terms; m++)
        if (s->hess_col[s->hess_ptr[first] + m * n] == partner) s->stretch_pos[s->hess_ptr[first] + m * n] = x.pos;
    }
  }
}

/* First terms of each entry of row k from which its coordinates are consecutive. */
static void derive_runs(ali3_system *s, int32_t k) {
  const bool any = s->row_stretch[k] < s->row_ptr[k + 1];
  for (int32_t i = s->row_ptr[k]; i < s->row_ptr[k + 1]; i++) {
    const int32_t end = s->hess_ptr[i + 1];
    int32_t t = end - 1;
    while (t > s->hess_ptr[i] && s->hess_col[t - 1] == s->hess_col[t] - 1) t--;
    s->hess_run[i] = any && end - t >= ALI3_MIN_LENGTH ? t : end;
  }
}

/* Terms of stretches, and all others with their second derivatives. */
static void derive_stretches(ali3_system *s) {
  for (int32_t k = 0; k < s->size.nc; k++) {
    derive_runs(s, k);
    derive_stretch_terms(s, k);
  }
  derive_alike_rows(s);
  for (int64_t t = 0; t < s->n_quad_a; t++) {
    const ali3_term *x = &s->quad[t];
    s->quad_pos[t] = x->pos;
    s->quad_second[t] = x->a == x->b ? 2.0 * x->h : x->h;
  }
}

void ali3_rows_derive(ali3_system *s) {
  derive_rows(s);
  derive_round(s);
  derive_hessian(s);
  derive_stretches(s);
  derive_turning(s);
}
