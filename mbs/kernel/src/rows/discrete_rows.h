/* Discrete derivatives of the rows. */
#ifndef ALI3_DISCRETE_ROWS_H
#define ALI3_DISCRETE_ROWS_H
#include "../instance.h"

void ali3_discrete_rows(ali3_instance *in, const double *D, const double *q1, const ali3_vectors *from,
                        const ali3_vectors *to);
#endif
