/* Derived data of elements and their signals when a System is loaded. */
#ifndef ALI3_DERIVE_ELEMENTS_H
#define ALI3_DERIVE_ELEMENTS_H
#include "../system.h"

enum { ALI3_TRIPLE = 3 };

/* Whether rows i to i + 2 of a sparse matrix have equal values in columns that increase by one from row to row, without
 * common columns. */
bool ali3_is_triple(const int32_t *ptr, const int32_t *col, const double *val, int32_t i);
/* Derives the arrays of elements and of the signals that they use. */
void ali3_elements_derive(ali3_system *s);
/* Lists the elements with sensed work, in ascending order. */
void ali3_work_derive(ali3_system *s);
#endif
