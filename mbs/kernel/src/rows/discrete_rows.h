/* Discrete derivatives of the rows. */
#ifndef ALI3_DISCRETE_ROWS_H
#define ALI3_DISCRETE_ROWS_H
#include "../instance.h"

/* Writes the discrete derivative of the rows, (row pattern) A with A D = Phi(to) - Phi(from), to in->discrete.A, from
 * Phi_q at the start, in->discrete.J0, and at the end q1, in->tangent.J; D (nq): change of q; from, to: states with the
 * driving functions. */
void ali3_discrete_rows(ali3_instance *in, const double *D, const double *q1, const ali3_vectors *from,
                        const ali3_vectors *to);
#endif
