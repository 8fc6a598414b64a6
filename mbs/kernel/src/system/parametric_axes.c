/* Wheel axes that parameters set. The file of such a System has entries for every direction of a wheel's signals. The
 * System as loaded (lean) drops those that are zero as drawn, so that they cost nothing; `turned` keeps them, for
 * instances with other axes. */
#include <math.h>
#include <string.h>

#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"
#include "pool.h"

enum { FRAME = ALI3_AXIS_SIGNALS }; /* signals of the frame of a wheel: three vectors */
static const double STEEPEST = 1.4; /* rad: inclination of an axis from the level, short of upright */
static const double LARGEST_AZIMUTH = 7.0; /* rad: above a whole turn */

const char *ali3_check_axis(const double *real) {
  return fabs(real[0]) <= LARGEST_AZIMUTH && fabs(real[1]) <= STEEPEST ? NULL
                                                                       : "the axis of a wheel must not stand upright";
}

/* Whether signal `to` has all coordinates of `from`. */
static bool has_all(const ali3_system *s, int32_t to, int32_t from) {
  const int32_t first = s->sig_ptr[to], n = s->sig_ptr[to + 1] - first;
  for (int32_t k = s->sig_ptr[from]; k < s->sig_ptr[from + 1]; k++)
    if (ali3_find(s->sig_col + first, n, s->sig_col[k]) < 0) return false;
  return true;
}

/* Checks that signals and, without a table, the mass matrix have entries for all directions of axis k. */
static ali3_status check_room(const ali3_system *s, int64_t k, ali3_message m) {
  const int32_t *frame = s->axis_frame + FRAME * k, *signal = s->axis_signal + FRAME * k;
  const bool has_table = s->axis_table[k] >= 0;
  for (int i = 0; i < FRAME; i++)
    for (int j = i % 3; j < FRAME; j += 3) { /* the same component of all three vectors */
      if (!has_all(s, signal[i], frame[j]))
        return ali3_bad(m, "the signals of axis %d have no room for all directions", (int)k);
      if (!has_table && !ali3_mass_has_room(s, frame[i], frame[j]))
        return ali3_bad(m, "the mass matrix has no entry for the wheel of axis %d", (int)k);
    }
  return ALI3_OK;
}

ali3_status ali3_check_axes(const ali3_system *s, ali3_message m) {
  for (int64_t k = 0; k < s->n_axis_inertia; k++)
    for (int i = 0; i < FRAME && s->axis_table[k] < 0; i++)
      CHECK(ali3_check_independent(s, s->axis_frame[FRAME * k + i], "a wheel whose axis has no table", m));
  for (int64_t k = 0; k < s->n_axis_inertia; k++) CHECK(check_room(s, k, m));
  if (s->n_axis_inertia > 0 && s->n_tree_parent > 0)
    return ali3_bad(m, "a parameter writes the axis of a wheel of a tree");
  return ALI3_OK;
}

/* Arrays of the System without the entries that are zero as drawn, by their names in it. */
typedef struct {
  int32_t *sig_ptr, *sig_col, *el_loc_ptr, *el_loc;
  double *sig_val;
  bool *written; /* nsig: whether axes write the signal */
} lean;

/* Places the arrays of the lean System in a pool. */
static void place_arrays(const ali3_system *s, ali3_pool *p, lean *to) {
  const size_t nsig = (size_t)s->size.nsig, entries = (size_t)s->n_sig_col;
  to->sig_val = ali3_pool_items(p, entries, sizeof(double));
  to->sig_ptr = ali3_pool_items(p, nsig + 1, sizeof(int32_t));
  to->sig_col = ali3_pool_items(p, entries, sizeof(int32_t));
  to->el_loc_ptr = ali3_pool_items(p, (size_t)s->size.ne + 1, sizeof(int32_t));
  to->el_loc = ali3_pool_items(p, (size_t)s->n_el_loc, sizeof(int32_t));
  to->written = ali3_pool_items(p, nsig, sizeof(bool));
}

/* Whether entry k of a signal is kept. */
static bool is_kept(const ali3_system *s, const lean *to, int32_t signal, int32_t k) {
  return !to->written[signal] || s->sig_val[k] != 0.0;
}

/* Fills the places of the coordinates of elements in their fronts; returns their number. */
static int32_t fill_places(const ali3_system *s, lean *to) {
  int32_t n = 0;
  for (int32_t e = 0; e < s->size.ne; e++) {
    const int32_t *loc = s->el_loc + s->el_loc_ptr[e];
    for (int32_t i = s->el_sig_ptr[e]; i < s->el_sig_ptr[e + 1]; i++)
      for (int32_t k = s->sig_ptr[s->el_sig[i]]; k < s->sig_ptr[s->el_sig[i] + 1]; k++, loc++)
        if (is_kept(s, to, s->el_sig[i], k)) to->el_loc[n++] = *loc;
    to->el_loc_ptr[e + 1] = n;
  }
  return n;
}

/* Fills the signals; returns the number of their entries. */
static int32_t fill_signals(const ali3_system *s, lean *to) {
  int32_t n = 0;
  for (int32_t i = 0; i < s->size.nsig; i++) {
    for (int32_t k = s->sig_ptr[i]; k < s->sig_ptr[i + 1]; k++) {
      if (!is_kept(s, to, i, k)) continue;
      to->sig_col[n] = s->sig_col[k];
      to->sig_val[n++] = s->sig_val[k];
    }
    to->sig_ptr[i + 1] = n;
  }
  return n;
}

/* Fills the arrays of the lean System and makes them those of s. */
static void drop_zeros(ali3_system *s, lean *to) {
  for (int64_t i = 0; i < s->n_axis_signal; i++) to->written[s->axis_signal[i]] = true;
  const int32_t n_place = fill_places(s, to), n_entry = fill_signals(s, to);
  s->sig_ptr = to->sig_ptr;
  s->sig_col = to->sig_col;
  s->sig_val = to->sig_val;
  s->el_loc_ptr = to->el_loc_ptr;
  s->el_loc = to->el_loc;
  s->n_sig_col = s->n_sig_val = n_entry;
  s->n_el_loc = n_place;
}

ali3_status ali3_system_turn(ali3_system *s, ali3_message m) {
  ali3_pool pool = {NULL, 0};
  lean to;
  if (s->n_axis_inertia == 0) return ALI3_OK;
  ali3_system *turned = s->memory.allocate(1, sizeof *turned);
  if (turned == NULL) return ALI3_NO_MEMORY;
  *turned = *s;
  s->turned = turned;
  CHECK(ali3_system_derive(turned, m));
  place_arrays(s, &pool, &to);
  s->lean = s->memory.allocate(1, pool.used);
  if (s->lean == NULL) return ALI3_NO_MEMORY;
  pool.block = s->lean;
  pool.used = 0;
  place_arrays(s, &pool, &to);
  drop_zeros(s, &to);
  return ALI3_OK;
}
