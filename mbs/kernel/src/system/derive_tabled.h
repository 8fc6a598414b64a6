/* Derived data of tabled bodies when a System is loaded. */
#ifndef ALI3_DERIVE_TABLED_H
#define ALI3_DERIVE_TABLED_H
#include "../system.h"
#include "message.h"
#include "pool.h"

bool ali3_on_tabled(const ali3_system *s, int32_t e); /* whether element e has signals of dependent coordinates */
void ali3_tabled_place(ali3_system *s, ali3_pool *p, size_t n_entry);
ali3_status ali3_tabled_derive(ali3_system *s, ali3_message m);
#endif
