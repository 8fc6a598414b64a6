/* Derives from a System file the arrays of the kernel's loops: mass matrix in front storage, flexible bodies; calls the
 * derivations of the other files. */
#include <math.h>
#include <string.h>

#include "../algebra/processor.h"
#include "../elements/element.h"
#include "../elements/element_batches.h"
#include "../system.h"
#include "../tree/tree.h"
#include "check.h"
#include "derive_elements.h"
#include "derive_lookup.h"
#include "derive_rows.h"
#include "loading.h"
#include "message.h"
#include "pool.h"
#include "sensor_types.h"

enum { MAX_SIGNAL_ENTRIES = 1 << 26 };

/* Places the derived arrays; n_entry: entries of the signals of all elements. */
static void place_arrays(ali3_system *s, ali3_pool *p, size_t n_entry) {
  const size_t nq = (size_t)s->size.nq, ne = (size_t)s->size.ne;
  ali3_rows_place(s, p);
  s->front_mass = ali3_pool_items(p, (size_t)s->size.front_size, sizeof(double));
  s->mass_floor = ali3_pool_items(p, nq, sizeof(double));
  s->mass_floor_inverse = ali3_pool_items(p, nq, sizeof(double));
  s->mass_missing = ali3_pool_items(p, nq, sizeof(double));
  s->mass_alike = ali3_pool_items(p, nq, sizeof(int32_t));
  s->mass_stretch = ali3_pool_items(p, nq, 2 * sizeof(int32_t));
  s->mass_mirror = ali3_pool_items(p, (size_t)s->n_mass_col, sizeof(int32_t));
  s->diagonal_pos = ali3_pool_items(p, nq, sizeof(int32_t));
  s->el_kind = ali3_pool_items(p, ne, sizeof *s->el_kind);
  s->el_size = ali3_pool_items(p, ne, sizeof *s->el_size);
  s->contact = ali3_pool_items(p, ne, sizeof *s->contact);
  s->el_S_off = ali3_pool_items(p, ne + 1, sizeof(int32_t));
  s->work_of = ali3_pool_items(p, ne, sizeof(int32_t));
  s->work_element = ali3_pool_items(p, ne, sizeof(int32_t));
  s->work_ptr = ali3_pool_items(p, ne + 1, sizeof(int32_t));
  s->el_entry_ptr = ali3_pool_items(p, ne + 1, sizeof(int32_t));
  s->el_entry_local = ali3_pool_items(p, n_entry, sizeof(int32_t));
  s->el_entry_value = ali3_pool_items(p, n_entry, sizeof(double));
  s->el_coordinate_ptr = ali3_pool_items(p, ne + 1, sizeof(int32_t));
  s->el_coordinate_loc = ali3_pool_items(p, n_entry, sizeof(int32_t));
  s->el_apart = ali3_pool_items(p, ne, sizeof(int32_t));
  s->active_signal = ali3_pool_items(p, (size_t)s->size.nsig, sizeof(int32_t));
  s->active_triple = ali3_pool_items(p, (size_t)s->size.nsig, 1);
  s->el_triple = ali3_pool_items(p, (size_t)s->n_el_sig, 1);
  s->batch = ali3_pool_items(p, 2 * ne, sizeof(int32_t));
  s->alone = ali3_pool_items(p, ne, sizeof(int32_t));
  s->el_in_batch = ali3_pool_items(p, ne, 1);
  s->el_beside = ali3_pool_items(p, ne, sizeof(int32_t));
  s->flex_square = ali3_pool_items(p, (size_t)s->n_flexible + 1, sizeof(int32_t));
  ali3_lookup_place(s, p, n_entry);
  s->tree = s->n_tree_parent > 0 ? ali3_pool_items(p, 1, sizeof *s->tree) : NULL;
}

/* Longest stretch of consecutive columns of a row, first entry and end; empty if it is short. */
static void longest_stretch(const int32_t *col, int32_t begin, int32_t end, int32_t *stretch) {
  stretch[0] = stretch[1] = end;
  for (int32_t i = begin, first = begin; i < end; i++) {
    if (i > first && col[i] != col[i - 1] + 1) first = i;
    if (i + 1 - first >= ALI3_MIN_LENGTH && i + 1 - first > stretch[1] - stretch[0])
      stretch[0] = first, stretch[1] = i + 1;
  }
}

/* Rows of the mass matrix with equal columns and stretches of consecutive columns, where there are modes; triples, and
 * the transposed entries. */
static void derive_mass_rows(ali3_system *s) {
  const bool modes = s->n_flexible > 0;
  const int32_t *ptr = s->mass_ptr, *col = s->mass_col;
  for (int32_t i = s->size.nq - 1; i >= 0; i--) {
    const int32_t n = ptr[i + 1] - ptr[i];
    const bool alike = modes && i + 1 < s->size.nq && ptr[i + 2] - ptr[i + 1] == n &&
                       memcmp(col + ptr[i], col + ptr[i + 1], (size_t)n * sizeof *col) == 0;
    s->mass_alike[i] = alike ? s->mass_alike[i + 1] + 1 : 1;
    longest_stretch(col, modes ? ptr[i] : ptr[i + 1], ptr[i + 1], s->mass_stretch + 2 * (int64_t)i);
    if (i + 2 < s->size.nq && ali3_is_triple(ptr, col, s->mass_val, i)) s->mass_alike[i] = 0;
    for (int32_t k = ptr[i]; k < ptr[i + 1]; k++) {
      const int32_t j = col[k];
      s->mass_mirror[k] = ptr[j] + ali3_find(col + ptr[j], ptr[j + 1] - ptr[j], i);
    }
  }
}

/* Diagonal entries in front storage, the mass matrix in it, and the acceleration by gravity, s->fall. */
static void derive_mass(ali3_system *s) {
  derive_mass_rows(s);
  for (int32_t i = 0, f = 0; i < s->size.nq; i++) {
    while (i >= s->front_col[f + 1]) f++;
    const int32_t n = s->front_ptr[f + 1] - s->front_ptr[f], local = i - s->front_col[f];
    s->diagonal_pos[i] = s->front_off[f] + local * n + local;
  }
  ali3_mass_in_fronts(s, s->mass_val, s->front_mass, s->mass_floor, s->mass_floor_inverse, s->mass_missing);
  double square = 0.0, mass = 0.0;
  for (int32_t i = 0; i < s->size.nq; i++) {
    if (s->gravity_force[i] == 0.0) continue;
    square += s->gravity_force[i] * s->gravity_force[i] * s->mass_floor_inverse[i];
    mass += s->mass_floor[i];
  }
  s->fall = mass > 0.0 ? sqrt(square / mass) : 0.0;
}

/* Offsets of matrices of flexible bodies, their largest number of modes, and the largest K_jj / M_jj, s->flex_rate. */
static void derive_flexible(ali3_system *s) {
  s->flex_square[0] = 0;
  for (int32_t b = 0; b < s->n_flexible; b++) {
    const int32_t n = s->flex_mode_ptr[b + 1] - s->flex_mode_ptr[b];
    s->flex_square[b + 1] = s->flex_square[b] + n * n;
    if (n > s->max_modes) s->max_modes = n;
    for (int32_t j = 0; j < n; j++) {
      const double mass = s->front_mass[s->diagonal_pos[s->flex_mode[s->flex_mode_ptr[b] + j]]];
      const double rate = mass > 0.0 ? s->flex_K[s->flex_square[b] + (int64_t)j * (n + 1)] / mass : 0.0;
      if (rate > s->flex_rate) s->flex_rate = rate;
    }
  }
}

/* Index, or -1. */
static int32_t first_nonzero(const double *v, int32_t n) {
  for (int32_t i = 0; i < n; i++)
    if (v[i] != 0.0) return i;
  return -1;
}

ali3_status ali3_system_derive(ali3_system *s, ali3_message m) {
  int64_t n_entry = 0;
  for (int64_t i = 0; i < s->n_el_sig; i++) n_entry += s->sig_ptr[s->el_sig[i] + 1] - s->sig_ptr[s->el_sig[i]];
  if (n_entry > MAX_SIGNAL_ENTRIES || (int64_t)s->size.ne * ALI3_MAX_SIGNALS * ALI3_MAX_SIGNALS > MAX_SIGNAL_ENTRIES)
    return ali3_bad(m, "the elements have %lld signal entries", (long long)n_entry);
  ali3_pool pool = {NULL, 0};
  place_arrays(s, &pool, (size_t)n_entry);
  s->derived = s->memory.allocate(1, pool.used > 0 ? pool.used : 1);
  if (s->derived == NULL) return ALI3_NO_MEMORY;
  pool.block = s->derived;
  pool.used = 0;
  place_arrays(s, &pool, (size_t)n_entry);
  s->has_avx2 = ali3_processor_lanes() > 2;
  s->fine = s->n_fineness > 0 ? s->fineness[0] : 1.0; /* used by the following derivations */
  derive_mass(s);
  ali3_rows_derive(s);
  ali3_elements_derive(s);
  ali3_batches_derive(s);
  derive_flexible(s);
  const ali3_status lookup = ali3_lookup_derive(s, m);
  if (lookup != ALI3_OK) return lookup;
  ali3_work_derive(s);
  if (s->tree != NULL) ali3_tree_derive(s, s->tree);
  for (int32_t i = 0; i < s->size.ns; i++) {
    const int32_t reads = ali3_sensor_types[s->sen_type[i]].reads;
    s->senses_rows = s->senses_rows || reads == ALI3_READS_ROWS || reads == ALI3_READS_SOLVER;
  }
  s->shift_x = s->shift_y = s->shift_z = -1;
  if (s->size.has_pose) {
    s->shift_x = first_nonzero(s->pose_x, s->size.nq);
    s->shift_y = first_nonzero(s->pose_y, s->size.nq);
    s->shift_z = first_nonzero(s->pose_z, s->size.nq);
  }
  return ALI3_OK;
}
