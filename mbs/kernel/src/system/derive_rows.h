/* Derived data of rows when a System is loaded. */
#ifndef ALI3_DERIVE_ROWS_H
#define ALI3_DERIVE_ROWS_H
#include "../system.h"
#include "pool.h"

enum { ALI3_MIN_LENGTH = 8 }; /* least number of consecutive coordinates with a separate loop */

void ali3_rows_place(ali3_system *s, ali3_pool *p);
void ali3_rows_derive(ali3_system *s);
#endif
