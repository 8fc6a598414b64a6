/* The memory of an instance. */
#ifndef ALI3_WORKSPACE_H
#define ALI3_WORKSPACE_H
#include "../instance.h"
#include "../system/pool.h"

size_t ali3_signal_work(const ali3_system *s);
void ali3_workspace_place(const ali3_system *s, ali3_instance *in, ali3_pool *pool);
#endif
