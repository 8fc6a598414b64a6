/* Phi, Phi_q, Phi_t, gamma and the geometric term of the rows: short loops over their quadratic terms. */
#include <string.h>

#include "../algebra/elementary.h"
#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../algebra/real.h"
#include "../instance.h"
#include "constraints.h"
#include "driving_terms.h"
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
      in->step.shifted[i] = ali3_where(way != 0.0, from[i] - way * direction[d][i], from[i]);
    from = in->step.shifted;
  }
  return from;
}

/* Adds the terms t to end - 1 of three neighbouring entries of Phi_q to them, of points: with three neighbours each.
 * Returns the first term of the next three. Entry by entry a step has 13.5 % (spatial chain) to 15.1 % (lane change,
 * 10 ms) more instructions. */
static inline int32_t add_points(const ali3_system *S, int32_t t, int32_t end, const real *q, ali3_three *entry) {
  ALI3_SHORT
  for (; t < end; t += 3) ali3_three_add_each(entry, S->hess_val + t, q + S->hess_col[t]);
  return t;
}

/* Entries i to i + n - 1 of Phi_q, a stretch, go to `out`: their constants and their terms, of which three are added
 * while an entry is in hand. */
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
  return run < end ? sum + ali3_shared_product_backward(S->hess_val + run, q + S->hess_col[run], end - run) : sum;
}

/* The terms of a stretch of n entries, the first is i, twice with the rates qd. */
static inline real stretch_gamma(const ali3_system *S, int32_t i, int32_t n, const real *qd) {
  const int32_t first = S->hess_ptr[i], terms = S->hess_ptr[i + 1] - first;
  real sum = {0};
  for (int32_t t = first; t < first + terms * n; t += n)
    sum += ali3_shared_product_backward(S->hess_val + t, qd + S->row_col[i], n) * qd[S->hess_col[t]];
  return sum;
}

/* Phi_q = row_lin + hess q and Phi = row_const + (row_lin + Phi_q) q / 2, then what driving functions, angles and
 * rates add. */
ALI3_INLINED void constraints(ali3_instance *in, const real *q, const real *s, real *Phi, real *J) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->row_ptr, *col = S->row_col;
  const double *row_lin = S->row_lin;
  if (S->size.has_pose) q = near_origin(in, q);
  const bool generated = ALI3_GENERATED(S, rows, (row_lin, S->row_const, S->hess_val, q, Phi, J));
  for (int32_t k = generated ? S->size.nc : 0; k < S->size.nc; k++) {
    real value = {0};
    int32_t i = ptr[k];
    if (S->row_triples[k] == ALI3_POINTS)
      for (int32_t t = S->hess_ptr[i]; i < ptr[k + 1]; i += 3) {
        ali3_three lin, entry;
        ali3_three_begin(&lin, row_lin + i);
        entry = lin;
        t = add_points(S, t, S->hess_ptr[i + 3], q, &entry);
        ali3_three_put(J + i, &entry);
        ali3_three_plus(&entry, &lin);
        value = ali3_three_sum(value, &entry, q + col[i]);
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
    if (i > first) value += ali3_sum_product_backward(J + first, row_lin + first, q + col[first], i - first);
    Phi[k] = S->row_const[k] + 0.5 * value;
  }
  driving_values(S, q, s, Phi, J);
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

ALI3_BY_PROCESSOR(in->system, void, constraints, (ali3_instance * in, const real *q, const real *s, real *Phi, real *J),
                  (in, q, s, Phi, J))

const real *ali3_near_origin(ali3_instance *in, const real *q) {
  return in->system->size.has_pose ? near_origin(in, q) : q;
}

void ali3_constraint_rate(ali3_instance *in, const real *q, const ali3_vectors *driving, real *Phit) {
  const ali3_system *S = in->system;
  memset(Phit, 0, (size_t)S->size.nc * sizeof *Phit);
  if (S->n_gterm_row == 0) return;
  if (S->size.has_pose) q = near_origin(in, q);
  driving_rates(S, q, driving, Phit);
  if (S->size.n_switch > 0) ali3_switch_values(in, Phit);
}

/* gamma = d(Phi_q)/dt qd + d(Phi_t)/dt, so that Phi'' = Phi_q qdd + gamma. */
ALI3_INLINED void constraint_gamma(ali3_instance *in, const real *q, const real *qd, const ali3_vectors *driving,
                                   real *gamma) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->row_ptr, *col = S->row_col;
  if (S->size.has_pose) q = near_origin(in, q);
  const bool generated = ALI3_GENERATED(S, gamma, (S->hess_val, qd, gamma));
  for (int32_t k = generated ? S->size.nc : 0; k < S->size.nc; k++) {
    real value = {0};
    int32_t i = ptr[k];
    if (S->row_triples[k] == ALI3_POINTS)
      for (int32_t t = S->hess_ptr[i]; i < ptr[k + 1]; i += 3) {
        ali3_three entry = {0};
        t = add_points(S, t, S->hess_ptr[i + 3], qd, &entry);
        value = ali3_three_sum(value, &entry, qd + col[i]);
      }
    for (; i < S->row_stretch[k]; i++) value += add_run(S, i, qd, ali3_same(0.0)) * qd[col[i]];
    if (i < ptr[k + 1]) value += stretch_gamma(S, i, ptr[k + 1] - i, qd);
    gamma[k] = value;
  }
  driving_gamma(S, q, qd, driving, gamma);
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

ALI3_BY_PROCESSOR(in->system, void, constraint_gamma,
                  (ali3_instance * in, const real *q, const real *qd, const ali3_vectors *driving, real *gamma),
                  (in, q, qd, driving, gamma))

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
  driving_geometric(S, s, lam, weight, F);
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
