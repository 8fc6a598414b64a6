/* Checks the assembly modes of a System: triads and modes of its loops. */
#include "../rows/assembly_mode.h"
#include "../system.h"
#include "check.h"
#include "loading.h"
#include "message.h"

enum { SIGNALS = 9, KIND = 9, RING = 10, ITEMS = ALI3_TRIAD_ITEMS };

/* Checks triads and modes of a loop. */
static ali3_status check_loop(const ali3_system *s, int64_t loop, ali3_message m) {
  const int32_t first = s->mode_triad_ptr[loop], n = s->mode_triad_ptr[loop + 1] - first,
                cells = s->mode_cell_ptr[loop + 1] - s->mode_cell_ptr[loop];
  if (n % ITEMS != 0 || first % ITEMS != 0 || n > ALI3_MAX_TRIADS * ITEMS || cells % 2 != 0)
    return ali3_bad(m, "loop %lld has %d items of triads and %d of modes", (long long)loop, (int)n, (int)cells);
  for (int32_t k = first; k < first + n; k += ITEMS) {
    CHECK(ali3_check_indices(m, "mode_triad", s->mode_triad + k, SIGNALS, 0, s->size.nsig));
    for (int32_t i = 0; i < SIGNALS; i++) CHECK(ali3_check_independent(s, s->mode_triad[k + i], "an assembly mode", m));
    CHECK(ali3_check_indices(m, "mode_triad", s->mode_triad + k + KIND, 1, 0, 4));
    CHECK(ali3_check_indices(m, "mode_triad", s->mode_triad + k + RING, 1, 0, n / ITEMS));
  }
  return ALI3_OK;
}

ali3_status ali3_check_modes(const ali3_system *s, ali3_message m) {
  for (int64_t loop = 0; loop < ali3_loop_count(s); loop++) CHECK(check_loop(s, loop, m));
  return ALI3_OK;
}
