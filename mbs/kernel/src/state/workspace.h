/* The memory of an instance. */
#ifndef ALI3_WORKSPACE_H
#define ALI3_WORKSPACE_H
#include "../instance.h"
#include "../system/pool.h"

/* Number of entries of S B of the largest element: signals times coordinates. */
size_t ali3_signal_work(const ali3_system *s);
/* Places all arrays of an instance. */
void ali3_workspace_place(const ali3_system *loaded, ali3_instance *in, ali3_pool *pool);
#endif
