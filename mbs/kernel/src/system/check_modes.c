/* Assembly modes of a System: triads and modes of its loops. */
#include "../rows/assembly_mode.h"
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

enum { SIGNALS = 9, KIND = 9, RING = 10, ITEMS = ALI3_TRIAD_ITEMS };

static ali3_status check_loop(const ali3_system *s, int64_t loop, ali3_message m) {
  const int32_t first = s->mode_triad_ptr[loop], n = s->mode_triad_ptr[loop + 1] - first,
                cells = s->mode_cell_ptr[loop + 1] - s->mode_cell_ptr[loop];
  if (n % ITEMS != 0 || first % ITEMS != 0 || n > ALI3_MOST_TRIADS * ITEMS || cells % 2 != 0)
    return ali3_bad(m, "loop %lld has %d items of triads and %d of modes", (long long)loop, (int)n, (int)cells);
  for (int32_t k = first; k < first + n; k += ITEMS) {
    CHECK(ali3_check_indices(m, "mode_triad", s->mode_triad + k, SIGNALS, 0, s->size.nsig));
    for (int32_t i = 0; i < SIGNALS; i++) CHECK(ali3_check_independent(s, s->mode_triad[k + i], "an assembly mode", m));
    CHECK(ali3_check_indices(m, "mode_triad", s->mode_triad + k + KIND, 1, 0, 4));
    CHECK(ali3_check_indices(m, "mode_triad", s->mode_triad + k + RING, 1, 0, n / ITEMS));
  }
  return ali3_check_indices(m, "mode_cell", s->mode_cell + s->mode_cell_ptr[loop], cells, 0,
                            (int64_t)1 << 2 * ALI3_MOST_TRIADS);
}

ali3_status ali3_check_modes(const ali3_system *s, ali3_message m) {
  const int64_t loops = ali3_loop_count(s);
  if (s->n_mode_triad_ptr == 0) {
    CHECK(ali3_check_length(m, "mode_triad", s->n_mode_triad, 0));
    CHECK(ali3_check_length(m, "mode_cell_ptr", s->n_mode_cell_ptr, 0));
    CHECK(ali3_check_length(m, "mode_name_ptr", s->n_mode_name_ptr, 0));
    CHECK(ali3_check_length(m, "mode_cell", s->n_mode_cell, 0));
    return ali3_check_length(m, "mode_name", s->n_mode_name, 0);
  }
  CHECK(ali3_check_pointers(m, "mode_triad_ptr", s->mode_triad_ptr, s->n_mode_triad_ptr, loops, s->n_mode_triad));
  CHECK(ali3_check_pointers(m, "mode_cell_ptr", s->mode_cell_ptr, s->n_mode_cell_ptr, loops, s->n_mode_cell));
  for (int64_t loop = 0; loop < loops; loop++) CHECK(check_loop(s, loop, m));
  const int64_t names = s->n_mode_triad / ITEMS;
  CHECK(ali3_check_pointers(m, "mode_name_ptr", s->mode_name_ptr, s->n_mode_name_ptr, names, s->n_mode_name));
  return ali3_check_indices(m, "mode_name", s->mode_name, s->n_mode_name, 1, 256);
}
