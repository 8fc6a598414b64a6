/* Tangents of lookup-table bodies and of the elements on them, added to fronts. Indices K and L are 0 for r and 1 to 3
 * for the axes of Y; x is a component along the axes of the earth, k along those of Y. Tangents of elements are B' S B
 * with B = d(signals)/dq: of groups with parts (ali3_lookup_parts) by the parts, of others signal by signal. */
#include <string.h>

#include "../algebra/fronts.h"
#include "../algebra/processor.h"
#include "../algebra/small_vectors.h"
#include "lookup.h"

enum { FIRST_PARAMETER = 12 }; /* index of the parameters in ali3_lookup.loc, after r and Y */

/* Adds wM M of all bodies of a base, and the geometric stiffness of gravity: -wK d2(g . X)/dY dp. */
ALI3_INLINED void add_base(const ali3_instance *in, int32_t b, double wM, double wK, real *F) {
  const ali3_system *S = in->system;
  const ali3_lookup_base *base = S->lookup_base + b;
  ali3_lookup_base_work *w = in->lookup.base + b;
  for (int k = 0; k < 3; k++)
    w->weight[k] = base->gravity[0] * w->axes[3 * k] + base->gravity[1] * w->axes[3 * k + 1] +
                   base->gravity[2] * w->axes[3 * k + 2];
  if (base->frame[0] < 0) return;
  for (int K = 0; K < 4; K++)
    for (int L = 0; L <= K; L++)
      for (int x = 0; x < 3; x++) F[base->at[3 * K + x][3 * L + x]] += wM * w->mass[K][L];
  for (int32_t p = base->first; p < base->end; p++) {
    const ali3_lookup_parameter_work *of = in->lookup.parameter + p;
    const int32_t *at = S->lookup_parameter[p].at;
    for (int i = 0; i < 12; i++) {
      real value = wM * of->turned[i];
      if (i >= 3) value -= wK * base->gravity[i % 3] * of->own[i / 3 - 1];
      F[at[i]] += value;
    }
  }
}

/* Adds the tangent of one item: wM M between its parameters, -wK f d2X/dq2 with the forces of elements and gravity. */
static void add_item(const ali3_instance *in, int32_t i, double wM, double wK, real *F) {
  const ali3_system *S = in->system;
  const ali3_lookup *c = S->lookup + i;
  const ali3_lookup_work *w = in->lookup.item + i;
  const int32_t size = S->front_ptr[c->front + 1] - S->front_ptr[c->front];
  const int n_par = c->count[1] > 1 ? 2 : 1;
  const bool body = c->n == ALI3_LOOKUP_BODY, heavy = ali3_lookup_heavy(c);
  const real *weight = body ? in->lookup.base[c->base].weight : NULL;
  real *block = F + S->front_off[c->front], f[12]; /* along Y */
  const real *axes = body ? in->lookup.base[c->base].axes : NULL;
  for (int i = 0; i < 12; i++) f[i] = heavy ? c->mass[i / 3] * weight[i % 3] : ali3_same(0.0);
  for (int32_t n = 0; body && n < c->n_seen; n++)
    for (int k = 0; k < 3; k++) f[3 * c->seen[n] + k] += ali3_dot(axes + 3 * k, w->force + 3 * c->seen[n]);
  if (!body) f[0] = w->force[0];
  for (int p = 0; p < n_par; p++) {
    const int32_t at = c->loc[FIRST_PARAMETER + p];
    for (int o = 0; o <= p; o++) {
      const real *second_derivative = w->value[ALI3_BY_AA + p + o];
      real sum = {0};
      for (int32_t k = 0; k < c->n; k++) sum += f[k] * second_derivative[k];
      real value = -wK * sum;
      if (heavy) value += wM * w->inertia[p + o];
      ali3_add_lower(block, size, at, c->loc[FIRST_PARAMETER + o], value);
    }
    if (!body || c->frame[0] < 0 || c->n_seen == 0) continue;
    for (int k = 0; k < 3; k++) {
      real sum[3] = {0};
      for (int32_t n = 0; n < c->n_seen; n++)
        for (int x = 0; x < 3; x++)
          sum[x] += w->force[3 * c->seen[n] + x] * w->value[ALI3_BY_A + p][3 * c->seen[n] + k];
      for (int x = 0; x < 3; x++) ali3_add_lower(block, size, c->loc[3 + 3 * k + x], at, -wK * sum[x]);
    }
  }
}

void ali3_lookup_tangent(const ali3_instance *in, double wM, double wK, real *F) {
  for (int32_t b = 0; b < in->system->n_lookup_base; b++) add_base(in, b, wM, wK, F);
  for (int32_t i = 0; i < in->system->n_lookup; i++) add_item(in, i, wM, wK, F);
}

/* Adds to the row of B of a signal its coefficient `value` of dependent d of an item, over the coordinates of the
 * group. */
ALI3_INLINED void add_dependent(const ali3_lookup *c, const ali3_lookup_work *w, const int32_t *slot, int32_t d,
                                double value, real *row) {
  row[slot[FIRST_PARAMETER]] += value * w->by[0][d];
  if (c->count[1] > 1) row[slot[FIRST_PARAMETER + 1]] += value * w->by[1][d];
  if (c->n != ALI3_LOOKUP_BODY || c->frame[0] < 0) return;
  const int32_t v = d / 3, x = d % 3;
  for (int k = 0; k < 3; k++) row[slot[3 + 3 * k + x]] += value * w->value[0][3 * v + k];
}

/* B (n x m) of the signals of a group by its coordinates. */
ALI3_INLINED void compute_B(const ali3_instance *in, const ali3_lookup_group *of, int32_t m, real *B) {
  const ali3_system *S = in->system;
  memset(B, 0, (size_t)(of->n_signal * m) * sizeof *B);
  for (int32_t i = 0; i < of->n_signal; i++)
    for (int32_t k = of->entry[i], end = k + of->n_entry[i]; k < end; k++) {
      const int32_t d = S->el_entry_dependent[k], local = S->el_entry_local[k];
      real *row = B + i * m;
      if (d < 0)
        row[local] += S->el_entry_value[k];
      else
        add_dependent(S->lookup + of->item[local], in->lookup.item + of->item[local], of->slot[local], d,
                      S->el_entry_value[k], row);
    }
}

/* Sum of the tangents of a group's elements by its signals, n x n; returns the lanes in which all elements are idle. */
ALI3_INLINED lane_mask sum_tangents(const ali3_instance *in, const ali3_lookup_group *of, real *sum) {
  const ali3_system *S = in->system;
  lane_mask idle = ali3_same(0.0) == 0.0;
  memset(sum, 0, (size_t)(of->n_signal * of->n_signal) * sizeof *sum);
  for (int32_t o = of->first; o < of->end; o++) {
    const int32_t e = S->lookup_order[o], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
    const int32_t *place = S->lookup_signal + S->el_sig_ptr[e];
    const real *from = in->element.S + S->el_S_off[e];
    const lane_mask idle_lanes = in->element.idle[e];
    if (!ali3_any(ali3_not(idle_lanes))) continue;
    idle &= idle_lanes;
    for (int32_t i = 0; i < n; i++) {
      real *row = sum + place[i] * of->n_signal;
      for (int32_t k = 0; k < n; k++) row[place[k]] = ali3_add_unless(idle_lanes, row[place[k]], from[i * n + k]);
    }
  }
  return idle;
}

/* Adds B' S B of the elements of a group without parts. */
ALI3_INLINED void add_undivided(ali3_instance *in, const ali3_lookup_group *of, real *F) {
  const ali3_system *S = in->system;
  const int32_t size = S->front_ptr[of->front + 1] - S->front_ptr[of->front];
  const int32_t n = of->n_signal, m = of->m;
  real *block = F + S->front_off[of->front], *sum = in->lookup.square, *B = sum + n * n, *SB = B + n * m;
  const lane_mask idle = sum_tangents(in, of, sum);
  if (!ali3_any(ali3_not(idle))) return;
  compute_B(in, of, m, B);
  memset(SB, 0, (size_t)(n * m) * sizeof *SB);
  for (int32_t i = 0; i < n; i++)
    for (int32_t k = 0; k < n; k++)
      for (int32_t j = 0; j < m; j++) SB[i * m + j] += sum[i * n + k] * B[k * m + j];
  for (int32_t j = 0; j < m; j++)
    for (int32_t i = j; i < m; i++) {
      real value = {0}, *to = block + (int64_t)of->loc[j] * size + of->loc[i];
      for (int32_t k = 0; k < n; k++) value += B[k * m + j] * SB[k * m + i];
      *to = ali3_add_unless(idle, *to, value);
    }
}

/* B of the parts of a group. */
ALI3_INLINED void compute_part_B(const ali3_instance *in, const ali3_lookup_group *of, ali3_lookup_parts *p) {
  const ali3_system *S = in->system;
  memset(p->share, 0, (size_t)of->n_vector * sizeof *p->share);
  memset(p->along, 0, (size_t)of->n_vector * sizeof *p->along);
  memset(p->slope, 0, (size_t)of->n_number * sizeof *p->slope);
  for (int32_t i = 0; i < of->n_vector; i++)
    for (int32_t k = of->entry[of->vector[i]], end = k + of->n_entry[of->vector[i]]; k < end; k++) {
      const int32_t d = S->el_entry_dependent[k], local = S->el_entry_local[k];
      const double value = S->el_entry_value[k];
      if (d < 0) {
        p->share[i][of->axis[local]] += value;
        continue;
      }
      const ali3_lookup_work *w = in->lookup.item + of->item[local];
      for (int K = 0; K < 3; K++) p->share[i][1 + K] += value * w->value[0][d + K];
      for (int q = 0; q < 2 && of->along[local][q] >= 0; q++)
        for (int x = 0; x < 3; x++) p->along[i][of->along[local][q]][x] += value * w->by[q][d + x];
    }
  for (int32_t i = 0; i < of->n_number; i++)
    for (int32_t k = of->entry[of->number[i]], end = k + of->n_entry[of->number[i]]; k < end; k++) {
      const int32_t local = S->el_entry_local[k];
      const double value = S->el_entry_value[k];
      if (S->el_entry_dependent[k] < 0) {
        p->slope[i][of->axis[local]] += value;
        continue;
      }
      const ali3_lookup_work *w = in->lookup.item + of->item[local];
      for (int q = 0; q < 2 && of->along[local][q] >= 0; q++) p->slope[i][of->along[local][q]] += value * w->by[q][0];
    }
}

/* to (n) += from, except in idle lanes. */
ALI3_INLINED void add_numbers(real *restrict to, const real *restrict from, lane_mask idle_lanes, bool some,
                              int32_t n) {
  if (!some)
    for (int32_t i = 0; i < n; i++) to[i] += from[i];
  else
    for (int32_t i = 0; i < n; i++) to[i] = ali3_add_unless(idle_lanes, to[i], from[i]);
}

/* Sum of the tangents of a group's elements by its parts, of numbers with vectors once; returns as `sum_tangents`. */
ALI3_INLINED lane_mask sum_part_tangents(const ali3_instance *in, const ali3_lookup_group *of, ali3_lookup_parts *p) {
  const ali3_system *S = in->system;
  lane_mask idle = ali3_same(0.0) == 0.0;
  for (int32_t i = 0; i < of->n_vector; i++)
    for (int32_t k = 0; k < of->beside[i].n; k++) memset(p->vectors[i][of->beside[i].at[k]], 0, sizeof(real[9]));
  memset(p->mixed, 0, (size_t)of->n_number * sizeof *p->mixed);
  memset(p->numbers, 0, (size_t)of->n_number * sizeof *p->numbers);
  for (int32_t o = of->first; o < of->end; o++) {
    const int32_t e = S->lookup_order[o], n = S->el_sig_ptr[e + 1] - S->el_sig_ptr[e];
    const int32_t *place = S->lookup_signal + S->el_sig_ptr[e];
    const real *from = in->element.S + S->el_S_off[e];
    const lane_mask idle_lanes = in->element.idle[e];
    const bool some = ali3_any(idle_lanes);
    if (!ali3_any(ali3_not(idle_lanes))) continue;
    idle &= idle_lanes;
    for (int32_t i = 0; i < n; i++) {
      const int32_t a = of->part[place[i]];
      for (int32_t k = 0; k < n; k++) {
        const int32_t b = of->part[place[k]];
        const real *at = from + i * n + k;
        if (a >= 0 && b >= 0)
          for (int x = 0; x < 3; x++) add_numbers(p->vectors[a][b] + 3 * x, at + x * n, idle_lanes, some, 3);
        else if (b >= 0)
          add_numbers(p->mixed[-1 - a][b], at, idle_lanes, some, 3);
        else if (a < 0)
          add_numbers(p->numbers[-1 - a] + (-1 - b), at, idle_lanes, some, 1);
        if (b >= 0) k += 2;
      }
      if (a >= 0) i += 2;
    }
  }
  return idle;
}

/* S B of the parts of a group. */
ALI3_INLINED void multiply_parts(const ali3_lookup_group *of, ali3_lookup_parts *p) {
  for (int32_t i = 0; i < of->n_vector; i++) {
    const ali3_lookup_list *beside = of->beside + i;
    for (int K = 0; of->base >= 0 && K < 4; K++) {
      real sum[9] = {0};
      for (int32_t n = 0; n < beside->n; n++) {
        const int32_t k = beside->at[n];
        if (K == 0 && !of->place[k]) continue;
        for (int x = 0; x < 9; x++) sum[x] += p->share[k][K] * p->vectors[i][k][x];
      }
      memcpy(p->by_share[i][K], sum, sizeof sum);
    }
    for (int32_t s = 0; s < of->n_single; s++) {
      real sum[3] = {0};
      for (int32_t n = 0; s < of->n_along && n < beside->n; n++) {
        const int32_t k = beside->at[n];
        for (int x = 0; x < 3; x++) sum[x] += ali3_dot(p->vectors[i][k] + 3 * x, p->along[k][s]);
      }
      for (int32_t k = 0; k < of->n_number; k++)
        for (int x = 0; x < 3; x++) sum[x] += p->mixed[k][i][x] * p->slope[k][s];
      memcpy(p->by_single[i][s], sum, sizeof sum);
    }
  }
  for (int32_t i = 0; i < of->n_number; i++)
    for (int32_t s = 0; s < of->n_single; s++) {
      real sum = {0};
      for (int32_t k = 0; s < of->n_along && k < of->n_vector; k++) sum += ali3_dot(p->mixed[i][k], p->along[k][s]);
      for (int32_t k = 0; k < of->n_number; k++) sum += p->numbers[i][k] * p->slope[k][s];
      p->number_by_single[i][s] = sum;
    }
}

/* Adds B' S B of the elements of a group with parts, except between the axes of its base, which is added to p->base. */
ALI3_INLINED void add_by_parts(ali3_instance *in, const ali3_lookup_group *of, ali3_lookup_parts *p, real *F) {
  const lane_mask idle = sum_part_tangents(in, of, p);
  const bool some = ali3_any(idle);
  if (!ali3_any(ali3_not(idle))) return;
  compute_part_B(in, of, p);
  multiply_parts(of, p);
  for (int K = 0; of->base >= 0 && K < 4; K++)
    for (int L = 0; L <= K; L++) {
      real sum[9] = {0};
      for (int32_t i = 0; i < of->n_vector; i++) {
        if (K == 0 && !of->place[i]) continue;
        for (int x = 0; x < 9; x++) sum[x] += p->share[i][K] * p->by_share[i][L][x];
      }
      add_numbers(p->base[K][L], sum, idle, some, 9);
    }
  for (int32_t s = 0; s < of->n_single; s++) {
    for (int K = 0; of->base >= 0 && K < 4; K++) {
      real sum[3] = {0};
      for (int32_t i = 0; i < of->n_vector; i++)
        for (int x = 0; x < 3 && (K > 0 || of->place[i]); x++) sum[x] += p->share[i][K] * p->by_single[i][s][x];
      for (int x = 0; x < 3; x++) add_numbers(F + of->to_base[s][3 * K + x], sum + x, idle, some, 1);
    }
    for (int32_t o = 0; o <= s; o++) {
      real sum = {0};
      for (int32_t i = 0; s < of->n_along && i < of->n_vector; i++) sum += ali3_dot(p->along[i][s], p->by_single[i][o]);
      for (int32_t i = 0; i < of->n_number; i++) sum += p->slope[i][s] * p->number_by_single[i][o];
      add_numbers(F + of->to_single[s][o], &sum, idle, some, 1);
    }
  }
}

/* Adds the entries between r and Y of a base, from the diagonal on. */
ALI3_INLINED void add_axes(const ali3_lookup_base *base, const ali3_lookup_parts *p, real *F) {
  for (int i = 0; i < 12; i++)
    for (int j = 0; j <= i; j++) F[base->at[i][j]] += p->base[i / 3][j / 3][3 * (i % 3) + j % 3];
}

ALI3_INLINED void lookup_elements_tangent(ali3_instance *in, real *F) {
  const ali3_system *S = in->system;
  ali3_lookup_parts *p = (ali3_lookup_parts *)in->lookup.square;
  int32_t base = -1; /* of p->base */
  for (int32_t g = 0; g < S->n_lookup_group; g++) {
    const ali3_lookup_group *of = S->lookup_group + g;
    const bool new_base = of->parted && of->base >= 0 && of->base != base;
    if (base >= 0 && (new_base || !of->parted)) add_axes(S->lookup_base + base, p, F), base = -1;
    if (new_base) memset(p->base, 0, sizeof p->base), base = of->base;
    if (of->parted)
      add_by_parts(in, of, p, F);
    else
      add_undivided(in, of, F);
  }
  if (base >= 0) add_axes(S->lookup_base + base, p, F);
}

ALI3_BY_PROCESSOR(in->system, void, lookup_elements_tangent, (ali3_instance * in, real *F), (in, F))
