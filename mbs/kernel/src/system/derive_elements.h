/* Derived data of elements and their signals when a System is loaded. */
#ifndef ALI3_DERIVE_ELEMENTS_H
#define ALI3_DERIVE_ELEMENTS_H
#include "../system.h"

enum { ALI3_TRIPLE = 3 };

bool ali3_is_triple(const int32_t *ptr, const int32_t *col, const double *val, int32_t i);
void ali3_elements_derive(ali3_system *s);
void ali3_work_derive(ali3_system *s);
#endif
