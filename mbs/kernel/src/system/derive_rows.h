/* Derived data of rows when a System is loaded. */
#ifndef ALI3_DERIVE_ROWS_H
#define ALI3_DERIVE_ROWS_H
#include "../system.h"
#include "pool.h"

enum { ALI3_MIN_LENGTH = 8 }; /* least number of consecutive coordinates with a separate loop */

/* Places the derived arrays of rows. */
void ali3_rows_place(ali3_system *s, ali3_pool *p);
/* Fills them; requires the masses, by which angles have inertia. */
void ali3_rows_derive(ali3_system *s);
#endif
