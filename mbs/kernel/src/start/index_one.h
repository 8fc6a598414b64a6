/* Solves the equations of index one for accelerations and multipliers; index_one.c describes the functions. */
#ifndef ALI3_INDEX_ONE_H
#define ALI3_INDEX_ONE_H
#include "../instance.h"

#define ALI3_INDEX_ONE_PENALTY 1e8 /* penalty for mass-normalised rows relative to M */
ali3_status ali3_index_one(ali3_instance *in, ali3_vectors *v);
ali3_status ali3_index_one_factorise(ali3_instance *in, const double *q);
ali3_status ali3_index_one_solve(ali3_instance *in, const double *Q, const double *b, double tolerance, double *x,
                                 double *lam);
#endif
