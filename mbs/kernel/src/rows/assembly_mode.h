/* Assembly modes of closed loops. */
#ifndef ALI3_ASSEMBLY_MODE_H
#define ALI3_ASSEMBLY_MODE_H
#include "../instance.h"

int64_t ali3_loop_count(const ali3_system *S);
int64_t ali3_triad_count(const ali3_system *S);
void ali3_mode_angles(ali3_instance *in, const double *q);
int32_t ali3_mode_left(const ali3_instance *in, int64_t loop);
#endif
