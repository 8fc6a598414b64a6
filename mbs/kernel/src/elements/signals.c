/* From coordinates to the signals of elements, and from the tangents of signals back to coordinates. */
#include <string.h>

#include "../algebra/processor.h"
#include "../algebra/stretch.h"
#include "../instance.h"
#include "signals.h"

/* in->u, in->ud of the signals that elements use. */
void ali3_active_signals(ali3_instance *in, const real *q, const real *qd) {
  const ali3_system *S = in->system;
  const int32_t *ptr = S->sig_ptr, *col = S->sig_col;
  const double *val = S->sig_val;
  for (int32_t a = 0; a < S->n_active; a++) {
    const int32_t i = S->active_signal[a];
    real u = ali3_same(S->sig_const[i]), ud = {0};
    for (int32_t k = ptr[i]; k < ptr[i + 1]; k++) {
      const double v = val[k];
      u += v * q[col[k]];
      ud += v * qd[col[k]];
    }
    in->u[i] = u;
    in->ud[i] = ud;
  }
}

/* y += a x but for the idle lanes */
ALI3_INLINED void add_row(real *restrict y, const real *restrict x, double a, truth idle, int64_t n) {
#ifdef ALI3_WIDTH
  if (ali3_any(idle)) {
    for (int64_t i = 0; i < n; i++) y[i] = ali3_where(idle, y[i], y[i] + a * x[i]);
    return;
  }
#endif
  (void)idle;
  ali3_add_multiple(y, x, ali3_same(a), n);
}

/* Adds B' S B of every element to its front, B = d(signals)/d(coordinates), S from the last ali3_forces with a
 * tangent. */
ALI3_INLINED void elements_tangent(ali3_instance *in, real *F) {
  const ali3_system *S = in->system;
  const int32_t *signal = S->el_entry_signal, *local = S->el_entry_local;
  const double *entry = S->el_entry_value;
  real *restrict SB = in->SB; /* a row per signal, a column per coordinate of the element */
  for (int32_t e = 0; e < S->size.ne; e++) {
    const int32_t front = S->el_front[e];
    const truth idle = in->idle[e];
    if (front < 0 || !ali3_any(ali3_not(idle))) continue;
    const int32_t n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
    const int32_t m = S->el_coordinate_ptr[e + 1] - S->el_coordinate_ptr[e];
    const int32_t first = S->el_entry_ptr[e], end = S->el_entry_ptr[e + 1];
    if (m == 0) continue; /* on a tabled body */
    const int32_t *loc = S->el_coordinate_loc + S->el_coordinate_ptr[e];
    const int32_t size = S->front_ptr[front + 1] - S->front_ptr[front];
    int32_t apart = m - 1; /* coordinates before those that lie side by side up to the last */
    while (apart > 0 && loc[apart - 1] == loc[apart] - 1) apart--;
    real *block = F + S->front_off[front];
    memset(SB, 0, (size_t)(n * m) * sizeof *SB);
    for (int32_t k = first; k < end; k++) {
      const real *row = in->S + S->el_S_off[e] + signal[k] * n;
      const double value = entry[k];
      real *restrict to = SB + local[k];
      for (int32_t i = 0; i < n; i++) to[i * m] += row[i] * value;
    }
    for (int32_t k = first; k < end; k++) {
      const real *row = SB + signal[k] * m;
      const double value = entry[k];
      const int32_t j = local[k];
      real *restrict column = block + (int64_t)loc[j] * size;
      int32_t i = j;
      for (; i < apart; i++) column[loc[i]] = ali3_add_unless(idle, column[loc[i]], value * row[i]);
      add_row(column + loc[m - 1] - (m - 1) + i, row + i, value, idle, m - i);
    }
  }
}

ALI3_BY_PROCESSOR(in->system, void, elements_tangent, (ali3_instance * in, real *F), (in, F))
