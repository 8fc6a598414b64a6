/* Whether a System has a memory beside q and qd. */
#ifndef ALI3_WITHOUT_MEMORY_H
#define ALI3_WITHOUT_MEMORY_H
#include "../system.h"

bool ali3_without_memory(const ali3_system *S);
#endif
