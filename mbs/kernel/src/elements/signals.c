/* Signals of elements from coordinates; forces and tangents of signals transformed back to coordinates. */
#include <string.h>

#include "../algebra/number_pairs.h"
#include "../algebra/processor.h"
#include "../instance.h"
#include "signals.h"

enum { WRITTEN_OUT = 7 }; /* number of signals (tyre, brake, bearing) for which loops are unrolled */

/* Computes in->element.u and in->element.ud of the signals that elements use. */
ALI3_INLINED void active_signals(ali3_instance *in, const real *q, const real *qd) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->sig_ptr, *col = S->sig_col;
  const double *val = S->sig_val;
  if (ALI3_GENERATED(S, signals, (val, S->sig_const, q, qd, in->element.u, in->element.ud))) return;
  for (int32_t a = 0; a < S->n_active; a++) {
    const int32_t i = S->active_signal[a];
    real u = ali3_same(S->sig_const[i]), ud = {0};
    for (int32_t k = ptr[i]; k < ptr[i + 1]; k++) {
      const double v = val[k];
      u += v * q[col[k]];
      ud += v * qd[col[k]];
    }
    in->element.u[i] = u;
    in->element.ud[i] = ud;
  }
}

ALI3_BY_PROCESSOR(in->system, void, active_signals, (ali3_instance * in, const real *q, const real *qd), (in, q, qd))

/* Q += generalised forces of all elements except idle ones; f: their forces on their signals. */
void ali3_add_forces(const ali3_instance *in, const real *f, real *Q) {
  const ali3_system *S = in->system;
  if (ALI3_GENERATED(S, forces, (S->sig_val, in->element.idle, f, Q))) return;
  for (int32_t e = 0; e < S->size.ne; e++) {
    const lane_mask idle = in->element.idle[e];
    const bool some = ali3_any(idle);
    if (some && !ali3_any(ali3_not(idle))) continue;
    for (int32_t i = S->el_sig_ptr[e]; i < S->el_sig_ptr[e + 1]; i++) {
      const int32_t signal = S->el_sig[i];
      for (int32_t k = S->sig_ptr[signal]; k < S->sig_ptr[signal + 1]; k++) {
        real *entry = Q + S->sig_col[k];
        const real sum = *entry + S->sig_val[k] * f[i];
        *entry = some ? ali3_where(idle, *entry, sum) : sum;
      }
    }
  }
}

/* y += a x except in idle lanes. */
ALI3_INLINED void add_row(real *restrict y, const real *restrict x, double a, lane_mask idle, int64_t n) {
#ifdef ALI3_WIDTH
  if (ali3_any(idle)) {
    for (int64_t i = 0; i < n; i++) y[i] = ali3_where(idle, y[i], y[i] + a * x[i]);
    return;
  }
#endif
  (void)idle;
  ali3_add_multiple(y, x, ali3_same(a), n);
}

/* An element in its front: n signals and m coordinates at rows `loc`, which are contiguous from index `apart` on. */
typedef struct {
  int32_t n, m, apart, size;
  const int32_t *loc;
  real *block;
} place;

/* Place of element e in its front. */
static inline place place_of(const ali3_system *S, int32_t e, real *F) {
  const int32_t front = S->el_front[e], first = S->el_coordinate_ptr[e];
  place p = {.n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e],
             .m = S->el_coordinate_ptr[e + 1] - first,
             .apart = S->el_apart[e],
             .size = S->front_ptr[front + 1] - S->front_ptr[front],
             .loc = S->el_coordinate_loc + first,
             .block = F + S->front_off[front]};
  return p;
}

/* Adds value times a row of S B to a coordinate's column of B' S B, from the diagonal on. */
ALI3_INLINED void add_column(const place *p, int32_t j, const real *row, double value, lane_mask idle) {
  real *restrict column = p->block + (int64_t)p->loc[j] * p->size;
  int32_t i = j;
  for (; i < p->apart; i++) column[p->loc[i]] = ali3_add_unless(idle, column[p->loc[i]], value * row[i]);
  add_row(column + p->loc[p->m - 1] - (p->m - 1) + i, row + i, value, idle, p->m - i);
}

/* add_column for the three coordinates of a point with three rows at once; starts at the diagonal of the first column
 * or a few entries above, which are never read. */
ALI3_INLINED void add_columns_of_point(const place *p, int32_t j, const real *row, const double *value,
                                       int32_t stride) {
  const int32_t from = j > p->apart ? p->apart + ali3_padded_start(j - p->apart, p->m - p->apart) : p->apart;
  real *restrict a = p->block + (int64_t)p->loc[j] * p->size, *restrict b = a + p->size, *restrict c = b + p->size;
  const real *restrict x = row, *restrict y = x + p->m, *restrict z = y + p->m;
  const double first = value[0], second = value[stride], third = value[2 * stride];
  for (int32_t i = j; i < p->apart; i++) {
    const int32_t row_index = p->loc[i];
    a[row_index] += first * x[i];
    b[row_index] += second * y[i];
    c[row_index] += third * z[i];
  }
  const int64_t shift = p->loc[p->m - 1] - (p->m - 1);
  int64_t i = from;
  a += shift, b += shift, c += shift;
#ifndef ALI3_WIDTH
  ALI3_SHORT
  for (; i + 3 < p->m; i += 4) {
    *(ali3_double4 *)(a + i) += first * *(const ali3_double4 *)(x + i);
    *(ali3_double4 *)(b + i) += second * *(const ali3_double4 *)(y + i);
    *(ali3_double4 *)(c + i) += third * *(const ali3_double4 *)(z + i);
  }
#endif
  ALI3_SHORT
  for (; i < p->m; i++) {
    a[i] += first * x[i];
    b[i] += second * y[i];
    c[i] += third * z[i];
  }
}

/* SB = S B of element e, one row per signal, one column per coordinate. */
ALI3_INLINED void tangent_times(const ali3_system *S, int32_t e, const place *p, int32_t n, const real *T,
                                real *restrict SB) {
  const int32_t m = p->m, *signal = S->el_sig + S->el_sig_ptr[e];
  memset(SB, 0, (size_t)(n * m) * sizeof *SB);
  for (int32_t s = 0, k = S->el_entry_ptr[e]; s < n; s++)
    for (const int32_t end = k + S->sig_ptr[signal[s] + 1] - S->sig_ptr[signal[s]]; k < end; k++)
      for (int32_t i = 0; i < n; i++) SB[i * m + S->el_entry_local[k]] += T[i * n + s] * S->el_entry_value[k];
}

/* Adds B' S B of every element to its front; B = d(signals)/d(coordinates), S from the last ali3_forces with a
 * tangent. */
ALI3_INLINED void elements_tangent(ali3_instance *in, real *F) {
  const ali3_system *S = in->system;
  const int32_t *local = S->el_entry_local;
  const double *value = S->el_entry_value;
  real *SB = in->element.SB;
  for (int32_t e = 0; e < S->size.ne; e++) {
    const lane_mask idle = in->element.idle[e];
    if (S->el_front[e] < 0 || !ali3_any(ali3_not(idle))) continue;
    const place p = place_of(S, e, F);
    if (p.m == 0) continue; /* all coordinates belong to a lookup-table body */
    if (p.n == WRITTEN_OUT)
      tangent_times(S, e, &p, WRITTEN_OUT, in->element.S + S->el_S_off[e], SB);
    else
      tangent_times(S, e, &p, p.n, in->element.S + S->el_S_off[e], SB);
    for (int32_t s = 0, k = S->el_entry_ptr[e]; s < p.n; s++) {
      const int32_t position = S->el_sig_ptr[e] + s, signal = S->el_sig[position];
      const int32_t count = S->sig_ptr[signal + 1] - S->sig_ptr[signal], end = k + count;
      const bool triple = S->el_triple[position] && !ali3_any(idle);
      for (; k < end; k++) {
        if (triple)
          add_columns_of_point(&p, local[k], SB + s * p.m, value + k, count);
        else
          add_column(&p, local[k], SB + s * p.m, value[k], idle);
      }
      if (triple) k += 2 * count, s += 2;
    }
  }
}

ALI3_BY_PROCESSOR(in->system, void, elements_tangent, (ali3_instance * in, real *F), (in, F))
