/* Assembly modes of closed loops. */
#ifndef ALI3_ASSEMBLY_MODE_H
#define ALI3_ASSEMBLY_MODE_H
#include "../instance.h"

static inline int64_t ali3_loop_count(const ali3_system *S) {
  return S->n_mode_triad_ptr > 0 ? S->n_mode_triad_ptr - 1 : 0;
}

static inline int64_t ali3_triad_count(const ali3_system *S) { return S->n_mode_triad / ALI3_TRIAD_ITEMS; }

void ali3_mode_angles(ali3_instance *in, const double *q);
int32_t ali3_mode_left(const ali3_instance *in, int64_t loop);
#endif
