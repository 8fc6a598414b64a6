/* Vectors of a state: placing, copying, backup and acceptance of a step. */
#ifndef ALI3_STATE_VECTORS_H
#define ALI3_STATE_VECTORS_H
#include "../instance.h"
#include "../system/pool.h"

/* Number of doubles of a state. */
size_t ali3_vector_count(const ali3_system *s);
/* Places the vectors of a state, one after the other. */
void ali3_vectors_place(const ali3_system *s, ali3_vectors *v, ali3_pool *pool);
/* Whether a state is finite; of the past only what the step added, as the rest was checked before. */
bool ali3_vectors_finite(const ali3_instance *in, const ali3_vectors *v);
/* Copies a whole state. */
void ali3_vectors_copy(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from);
/* Exchanges two states without a copy. */
void ali3_vectors_swap(ali3_vectors *one, ali3_vectors *other);
/* Copies the vectors that a method does not write: all except positions, velocities, accelerations and multipliers, and
 * the past of the last two if steps do not write it. */
void ali3_vectors_copy_unwritten(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from);
/* Stores in->now in in->stored.start, once per step, before it changes; restored after a failed step. */
void ali3_back_up(ali3_instance *in);
/* Makes in->next the state and returns ALI3_OK if it is finite and the road under it could be read; otherwise
 * ALI3_NOT_FINITE or ALI3_ROAD_LOST. */
ali3_status ali3_accept(ali3_instance *in);
#endif
