/* Vectors of a state: placing, copying, backup and acceptance of a step. */
#ifndef ALI3_STATE_VECTORS_H
#define ALI3_STATE_VECTORS_H
#include "../instance.h"
#include "../system/pool.h"

size_t ali3_vector_count(const ali3_system *s); /* doubles in ali3_vectors */
void ali3_vectors_place(const ali3_system *s, ali3_vectors *v, ali3_pool *pool);
bool ali3_vectors_finite(const ali3_instance *in, const ali3_vectors *v);
void ali3_vectors_copy(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from);
void ali3_vectors_copy_unwritten(const ali3_instance *in, ali3_vectors *to, const ali3_vectors *from);
void ali3_back_up(ali3_instance *in);
ali3_status ali3_accept(ali3_instance *in);
#endif
