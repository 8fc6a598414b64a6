/* Tangents of tabled bodies and of elements on them, into fronts. */
#include <string.h>

#include "../algebra/fronts.h"
#include "../algebra/processor.h"
#include "tabled.h"

enum { FIRST_PARAMETER = 12, CHUNK = ALI3_TABLED_CHUNK };

/* wM M of all bodies of a base, and what the weight changes in Q: -wK d2(g . X)/dY dp. */
static void add_base(const ali3_instance *in, int32_t b, double wM, double wK, real *F) {
  const ali3_system *S = in->system;
  const ali3_tabled_base *base = S->tabled_base + b;
  const ali3_tabled_base_work *w = in->tabled_base + b;
  const int32_t size = S->front_ptr[base->front + 1] - S->front_ptr[base->front];
  real *block = F + S->front_off[base->front];
  if (base->frame[0] < 0) return;
  for (int K = 0; K < 4; K++)
    for (int L = 0; L <= K; L++)
      for (int x = 0; x < 3; x++)
        ali3_add_lower(block, size, base->loc[3 * K + x], base->loc[3 * L + x], wM * w->mass[K][L]);
  for (int32_t p = base->first; p < base->end; p++) {
    const ali3_tabled_parameter_work *of = in->tabled_parameter + p;
    const int32_t at = S->tabled_parameter[p].loc;
    for (int i = 0; i < 12; i++) {
      real value = wM * of->turned[i];
      if (i >= 3) value -= wK * base->gravity[i % 3] * of->own[i / 3 - 1];
      ali3_add_lower(block, size, base->loc[i], at, value);
    }
  }
}

/* Of one item: wM M between its parameters, -wK f d2X/dq2 with the force of elements and the weight. */
static void add_item(const ali3_instance *in, int32_t i, double wM, double wK, real *F) {
  const ali3_system *S = in->system;
  const ali3_tabled *c = S->tabled + i;
  const ali3_tabled_work *w = in->tabled + i;
  const int32_t size = S->front_ptr[c->front + 1] - S->front_ptr[c->front];
  const int n_par = c->count[1] > 1 ? 2 : 1;
  const bool body = c->n == ALI3_TABLED_BODY, heavy = ali3_tabled_heavy(c);
  real *block = F + S->front_off[c->front], f[12]; /* along Y */
  const real *axes = body ? in->tabled_base[c->base].axes : NULL;
  memset(f, 0, sizeof f);
  for (int v = 0; body && v < 4; v++)
    for (int k = 0; heavy && k < 3; k++)
      f[3 * v + k] = c->mass[v] *
                     (axes[3 * k] * c->gravity[0] + axes[3 * k + 1] * c->gravity[1] + axes[3 * k + 2] * c->gravity[2]);
  for (int32_t n = 0; body && n < c->n_seen; n++) {
    const real *force = w->force + 3 * c->seen[n];
    for (int k = 0; k < 3; k++)
      f[3 * c->seen[n] + k] += axes[3 * k] * force[0] + axes[3 * k + 1] * force[1] + axes[3 * k + 2] * force[2];
  }
  if (!body) f[0] = w->force[0];
  for (int p = 0; p < n_par; p++) {
    const int32_t at = c->loc[FIRST_PARAMETER + p];
    for (int o = 0; o <= p; o++) {
      const real *bent = w->value[ALI3_BY_AA + p + o];
      real sum = {0};
      for (int32_t k = 0; k < c->n; k++) sum += f[k] * bent[k];
      real value = -wK * sum;
      if (heavy) value += wM * w->inertia[p + o];
      ali3_add_lower(block, size, at, c->loc[FIRST_PARAMETER + o], value);
    }
    if (!body || c->frame[0] < 0 || c->n_seen == 0) continue;
    for (int k = 0; k < 3; k++)
      for (int x = 0; x < 3; x++) {
        real sum = {0};
        for (int32_t n = 0; n < c->n_seen; n++)
          sum += w->force[3 * c->seen[n] + x] * w->value[ALI3_BY_A + p][3 * c->seen[n] + k];
        ali3_add_lower(block, size, c->loc[3 + 3 * k + x], at, -wK * sum);
      }
  }
}

void ali3_tabled_tangent(const ali3_instance *in, double wM, double wK, real *F) {
  for (int32_t b = 0; b < in->system->n_tabled_base; b++) add_base(in, b, wM, wK, F);
  for (int32_t i = 0; i < in->system->n_tabled; i++) add_item(in, i, wM, wK, F);
}

/* Row of B of a signal: its coefficient `value` of dependent d of an item, over the coordinates of the group. */
ALI3_INLINED void spread(const ali3_tabled *c, const ali3_tabled_work *w, const int32_t *slot, int32_t d, double value,
                         real *row) {
  row[slot[FIRST_PARAMETER]] += value * w->by[0][d];
  if (c->count[1] > 1) row[slot[FIRST_PARAMETER + 1]] += value * w->by[1][d];
  if (c->n != ALI3_TABLED_BODY || c->frame[0] < 0) return;
  const int32_t v = d / 3, x = d % 3;
  if (v == 0) row[slot[x]] += value;
  for (int k = 0; k < 3; k++) row[slot[3 + 3 * k + x]] += value * w->value[0][3 * v + k];
}

/* B, n x m: the signals of a group by its coordinates, made of its tables. */
ALI3_INLINED void rows_of(const ali3_instance *in, const ali3_tabled_group *of, int32_t m, real *B) {
  const ali3_system *S = in->system;
  memset(B, 0, (size_t)(of->n_signal * m) * sizeof *B);
  for (int32_t i = 0; i < of->n_signal; i++)
    for (int32_t k = of->entry[i], end = k + of->n_entry[i]; k < end; k++) {
      const int32_t d = S->el_entry_dependent[k], local = S->el_entry_local[k];
      real *row = B + i * m;
      if (d < 0)
        row[local] += S->el_entry_value[k];
      else
        spread(S->tabled + of->item[local], in->tabled + of->item[local], of->slot[local], d, S->el_entry_value[k],
               row);
    }
}

/* Sum of the tangents of a group's elements by its signals, n x n; returns whether none has any. */
ALI3_INLINED truth sum_of(const ali3_instance *in, const ali3_tabled_group *of, real *sum) {
  const ali3_system *S = in->system;
  truth idle = ali3_same(0.0) == 0.0;
  memset(sum, 0, (size_t)(of->n_signal * of->n_signal) * sizeof *sum);
  for (int32_t o = of->first; o < of->end; o++) {
    const int32_t e = S->tabled_order[o], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
    const int32_t *place = S->tabled_signal + S->el_sig_ptr[e];
    const real *from = in->S + S->el_S_off[e];
    const truth still = in->idle[e];
    if (!ali3_any(ali3_not(still))) continue;
    idle &= still;
    for (int32_t i = 0; i < n; i++) {
      real *row = sum + place[i] * of->n_signal;
      for (int32_t k = 0; k < n; k++) row[place[k]] = ali3_add_unless(still, row[place[k]], from[i * n + k]);
    }
  }
  return idle;
}

/* to (m, from `first` on) = sum of the rows in the list by their factors, which are `step` apart. */
ALI3_INLINED void blend(const ali3_tabled_list *list, int32_t m, int32_t first, const real *factor, int32_t step,
                        const real *restrict rows, real *restrict to) {
  for (int32_t at = first / CHUNK * CHUNK; at < m; at += CHUNK) {
    real sum[CHUNK];
    for (int k = 0; k < CHUNK; k++) sum[k] = ali3_same(0.0);
    for (int32_t i = 0; i < list->n; i++) {
      const real f = factor[list->signal[i] * step], *restrict row = rows + list->signal[i] * m + at;
      for (int k = 0; k < CHUNK; k++) sum[k] += f * row[k];
    }
    for (int k = 0; k < CHUNK; k++) to[at + k] = sum[k];
  }
}

/* B' S B of the elements of a group. */
ALI3_INLINED void add_group(ali3_instance *in, const ali3_tabled_group *of, real *F) {
  const ali3_system *S = in->system;
  const int32_t size = S->front_ptr[of->front + 1] - S->front_ptr[of->front];
  const int32_t n = of->n_signal, m = ali3_tabled_stride(of);
  real *block = F + S->front_off[of->front], *sum = in->tabled_square, *B = sum + n * n, *SB = B + n * m,
       *row = SB + n * m;
  const truth idle = sum_of(in, of, sum);
  if (!ali3_any(ali3_not(idle))) return;
  rows_of(in, of, m, B);
  for (int32_t i = 0; i < n; i++) blend(of->beside + i, m, 0, sum + i * n, 1, B, SB + i * m);
  for (int32_t j = 0; j < of->m; j++) {
    real *column = block + (int64_t)of->loc[j] * size;
    blend(of->moved + j, m, j, B + j, m, SB, row);
    for (int32_t i = j; i < of->m; i++) column[of->loc[i]] = ali3_add_unless(idle, column[of->loc[i]], row[i]);
  }
}

ALI3_INLINED void tabled_elements_tangent(ali3_instance *in, real *F) {
  for (int32_t g = 0; g < in->system->n_tabled_group; g++) add_group(in, in->system->tabled_group + g, F);
}

ALI3_BY_PROCESSOR(in->system, void, tabled_elements_tangent, (ali3_instance * in, real *F), (in, F))
