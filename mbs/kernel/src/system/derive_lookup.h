/* Derived data of lookup-table bodies when a System is loaded. */
#ifndef ALI3_DERIVE_LOOKUP_H
#define ALI3_DERIVE_LOOKUP_H
#include "../system.h"
#include "message.h"
#include "pool.h"

/* Whether element e has signals of dependent coordinates. */
bool ali3_on_lookup(const ali3_system *s, int32_t e);
/* Places the derived arrays; n_entry: entries of all signals of elements. */
void ali3_lookup_place(ali3_system *s, ali3_pool *p, size_t n_entry);
/* Fills them; ALI3_BAD_FILE with a message if a table is not in one front, or an element depends on more tables and
 * coordinates than a group holds. */
ali3_status ali3_lookup_derive(ali3_system *s, ali3_message m);
#endif
