/* Assembly modes of closed loops. */
#ifndef ALI3_ASSEMBLY_MODE_H
#define ALI3_ASSEMBLY_MODE_H
#include "../instance.h"

/* Number of closed loops with assembly modes. */
static inline int64_t ali3_loop_count(const ali3_system *S) {
  return S->n_mode_triad_ptr > 0 ? S->n_mode_triad_ptr - 1 : 0;
}

/* Number of joints of these loops at which an angle is watched. */
static inline int64_t ali3_triad_count(const ali3_system *S) { return S->n_mode_triad / ALI3_TRIAD_ITEMS; }

/* Writes signed squares of the sines and cosines of all triads at q to in->branch.sine and in->branch.cosine. */
void ali3_mode_angles(ali3_instance *in, const double *q);
/* The triad of a loop, counted in it, that belongs to none of its modes by in->branch.sine and in->branch.cosine, or
 * -1. */
int32_t ali3_find_mode_misfit(const ali3_instance *in, int64_t loop);
#endif
