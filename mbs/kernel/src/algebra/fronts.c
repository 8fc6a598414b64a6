/* Multifrontal L D L' of the tangent: dense column-major fronts, no pivoting, Schur complements added into the parent.
 * In the columns of its pivots a factorised front holds L below the diagonal and 1/D on it. */
#include "fronts.h"

#include "../instance.h"
#include "front_block.h"
#include "processor.h"

enum { PANELS = 3 };     /* eliminated from a column at once: twelve factors in sixteen registers */
_Static_assert(PANELS *PANEL <= ALI3_LOCAL, "columns of panels go to in->tangent.local");
enum { FOUR_SUMS = 16 }; /* coordinates of a front from which back substitution uses four sums */

#ifdef ALI3_WIDTH
typedef real group; /* consecutive entries of a column in one vector */
#else
typedef ali3_double4 group;
#endif
enum { GROUP = sizeof(group) / sizeof(real) };

/* Subtracts L_jp times each unscaled column p of packed panels, whose ends are in `end`, from columns j to last - 1:
 * one sum for each panel, so that an entry is loaded once. `panel` has L. */
ALI3_INLINED void subtract_panels(real *block, const real *panel, int32_t panels, int64_t n, int64_t j, int64_t last,
                                  const group *const *end) {
  for (; j < last; j++) {
    const int64_t from = ali3_padded_start_unclipped(j, n);
    group *restrict target = (group *)(block + j * n + from);
    real f[PANELS * PANEL];
    for (int32_t k = 0; k < panels * PANEL; k++) f[k] = panel[k * n + j];
    ALI3_SHORT
    for (int64_t offset = (from - n) / GROUP * PANEL; offset < 0; offset += PANEL) {
      group sum = *target;
      ALI3_UNROLLED
      for (int32_t k = 0; k < panels; k++) {
        const group *c = end[k] + offset;
        sum -= (f[4 * k] * c[0] + f[4 * k + 1] * c[1]) + (f[4 * k + 2] * c[2] + f[4 * k + 3] * c[3]);
      }
      *target++ = sum;
    }
  }
}

/* Eliminates pivot p alone: subtracts multiples of its column from the later ones, then scales it to a column of L. */
ALI3_INLINED ali3_status eliminate_one(ali3_instance *in, real *block, int32_t first, int32_t p, int32_t n) {
  real *restrict pivot = block + (int64_t)p * n;
  const ali3_status status = ali3_check_pivot(in, first + p, pivot[p]);
  if (status != ALI3_OK) return status;
  const real inverse = 1.0 / pivot[p];
  for (int32_t j = p + 1; j < n; j++) {
    real *restrict column = block + (int64_t)j * n;
    const real factor = pivot[j] * inverse;
    ALI3_EACH(ali3_padded_start(j, n), n, ALI3_AT(column) -= factor * ALI3_AT(pivot))
  }
  ALI3_EACH(ali3_padded_start(p + 1, n), n, ALI3_AT(pivot) *= inverse)
  pivot[p] = inverse;
  return ALI3_OK;
}

/* Factorises the triangle of a panel to the triangle of L with 1/D; factor[p][k]: L_pk of its unscaled columns. */
ALI3_INLINED ali3_status factorise_triangle(ali3_instance *in, int32_t pivot, real *panel, int64_t n,
                                            real factor[PANEL][PANEL]) {
  for (int32_t p = 0; p < PANEL; p++) {
    for (int32_t k = 0; k < p; k++) factor[p][k] = panel[k * n + p] * factor[k][k];
    for (int32_t i = p; i < PANEL; i++)
      for (int32_t k = 0; k < p; k++) panel[p * n + i] -= factor[p][k] * panel[k * n + i];
    const ali3_status status = ali3_check_pivot(in, pivot + p, panel[p * n + p]);
    if (status != ALI3_OK) return status;
    factor[p][p] = 1.0 / panel[p * n + p];
  }
  return ALI3_OK;
}

/* Factorises the columns of a panel among themselves in one pass: unscaled columns are written to `packed`, a group of
 * each in turn, scaled ones to the panel. Returns the end of the packed data. */
ALI3_INLINED group *factorise_whole_panel(ali3_instance *in, int32_t pivot, real *panel, int32_t start, int64_t n,
                                          group *packed, ali3_status *status) {
  real factor[PANEL][PANEL];
  *status = factorise_triangle(in, pivot, panel + start, n, factor);
  if (*status != ALI3_OK) return packed;
  for (int64_t i = ali3_padded_start_unclipped(start + PANEL, n); i < n; i += GROUP, packed += PANEL) {
    ALI3_UNROLLED
    for (int32_t p = 0; p < PANEL; p++) {
      group *offset = (group *)(panel + p * n + i);
      packed[p] = *offset;
      for (int32_t k = 0; k < p; k++) packed[p] -= factor[p][k] * packed[k];
      *offset = packed[p] * factor[p][p];
    }
  }
  for (int32_t p = 0; p < PANEL; p++)
    for (int32_t k = 0; k <= p; k++) panel[k * n + start + p] = factor[p][k];
  return packed;
}

/* Eliminates whole panels of pivots, the first at `start`; a later column is loaded once for all of them. */
ALI3_INLINED ali3_status eliminate_panels(ali3_instance *in, real *block, int32_t first, int32_t start, int32_t panels,
                                          int32_t n) {
  real *panel = block + (int64_t)start * n;
  const group *end[PANELS];
  group *packed = (group *)in->tangent.local;
  ALI3_UNROLLED
  for (int32_t k = 0; k < panels; k++) {
    const int32_t p = start + k * PANEL;
    ali3_status status;
    if (k > 0) subtract_panels(block, panel, k, n, p, p + PANEL, end);
    end[k] = packed = factorise_whole_panel(in, first + p, block + (int64_t)p * n, p, n, packed, &status);
    if (status != ALI3_OK) return status;
  }
  subtract_panels(block, panel, panels, n, start + panels * PANEL, n, end);
  return ALI3_OK;
}

/* Eliminates the n_pivot pivots of a front of n coordinates, panel by panel. */
ALI3_INLINED ali3_status eliminate(ali3_instance *in, real *block, int32_t first, int32_t n_pivot, int32_t n) {
  ali3_status status = ALI3_OK;
  int32_t p = 0;
  for (; p + PANELS * PANEL <= n_pivot && status == ALI3_OK; p += PANELS * PANEL)
    status = eliminate_panels(in, block, first, p, PANELS, n);
  for (; p + PANEL <= n_pivot && status == ALI3_OK; p += PANEL) status = eliminate_panels(in, block, first, p, 1, n);
  for (; p < n_pivot && status == ALI3_OK; p++) status = eliminate_one(in, block, first, p, n);
  return status;
}

/* Adds the Schur complement of a front to its parent, two columns at a time. */
ALI3_INLINED void assemble(const real *block, const int32_t *map, int32_t n_pivot, int32_t n, real *parent,
                           int32_t parent_n) {
  int32_t j = n_pivot;
  for (; j + 1 < n && map[n - 1] - map[j] != n - 1 - j; j += 2) {
    const real *restrict column = block + (int64_t)j * n, *restrict other = column + n;
    real *restrict target = parent + (int64_t)map[j] * parent_n, *restrict second =
                                                                     parent + (int64_t)map[j + 1] * parent_n;
    target[map[j]] += column[j];
    for (int32_t i = j + 1; i < n; i++) {
      const int32_t offset = map[i];
      target[offset] += column[i];
      second[offset] += other[i];
    }
  }
  for (; j < n; j++) /* contiguous in the parent too */
    ali3_add(parent + (int64_t)map[j] * parent_n + map[j], block + (int64_t)j * n + j, n - j);
}

#ifndef ALI3_WIDTH
/* Factorises by generated code. */
static ali3_status factorise_generated(ali3_instance *in, double *F) {
  double pivot;
  const int32_t bad = in->system->generated.factorise(F, in->mass.floor, &in->report.negative_pivots, &pivot);
  return bad < 0 ? ALI3_OK : ali3_check_pivot(in, bad, pivot);
}
#endif

ALI3_INLINED ali3_status factorise(ali3_instance *in, real *F) {
  const ali3_system *S = in->system;
  ALI3_COUNT(in, factorizations);
  ALI3_COUNT_ANEW(in, negative_pivots);
#ifndef ALI3_WIDTH
  if (S->generated.factorise != NULL) return factorise_generated(in, F);
#endif
  for (int32_t f = 0; f < S->size.nf; f++) {
    const int32_t first = S->front_col[f], n_pivot = S->front_col[f + 1] - first,
                  n = S->front_ptr[f + 1] - S->front_ptr[f], parent = S->front_parent[f];
    real *block = F + S->front_off[f];
    const ali3_status status = eliminate(in, block, first, n_pivot, n);
    if (status != ALI3_OK) return status;
    if (parent >= 0)
      assemble(block, S->front_map + S->front_ptr[f], n_pivot, n, F + S->front_off[parent],
               S->front_ptr[parent + 1] - S->front_ptr[parent]);
  }
  return ALI3_OK;
}

/* Back substitution for the pivots of a front, by two sums or, in a large one, four. */
ALI3_INLINED void substitute_pivots(const real *block, real *restrict x, int64_t n_pivot, int64_t n, bool four) {
  for (int64_t p = n_pivot - 1; p >= 0; p--) {
    const real *after = block + p * n + p + 1, *y = x + p + 1;
    const real sum = four ? ali3_product_backward(after, y, n - p - 1) : ali3_product_in_two(after, y, n - p - 1);
    x[p] = x[p] * after[-1] - sum;
  }
}

/* Solves in place: b becomes the solution. */
ALI3_INLINED void solve(ali3_instance *in, const real *F, real *b) {
  const ali3_system *S = in->system;
  ALI3_COUNT(in, solves);
  if (ALI3_GENERATED(S, solve, (F, b))) return;
  for (int32_t f = 0; f < S->size.nf; f++) {
    real *x = ali3_front_unknowns(in, f, 1, b);
    ali3_front_forward(F + S->front_off[f], x, S->front_col[f + 1] - S->front_col[f],
                       S->front_ptr[f + 1] - S->front_ptr[f]);
    ali3_front_put_back(in, f, 1, x, true, b);
  }
  for (int32_t f = S->size.nf - 1; f >= 0; f--) {
    const int32_t n_pivot = S->front_col[f + 1] - S->front_col[f], n = S->front_ptr[f + 1] - S->front_ptr[f];
    real *x = ali3_front_unknowns(in, f, 1, b);
    if (n < FOUR_SUMS)
      substitute_pivots(F + S->front_off[f], x, n_pivot, n, false);
    else
      substitute_pivots(F + S->front_off[f], x, n_pivot, n, true);
    ali3_front_put_back(in, f, 1, x, false, b);
  }
}

ALI3_BY_PROCESSOR(in->system, ali3_status, factorise, (ali3_instance * in, real *F), (in, F))

ALI3_BY_PROCESSOR(in->system, void, solve, (ali3_instance * in, const real *F, real *b), (in, F, b))
