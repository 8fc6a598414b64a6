/* Solves the equations of index one, M qdd + Phi_q' lam = Q, Phi_q qdd = -gamma, for accelerations and multipliers. The
 * functions return ALI3_OK, or the status of a factorization that failed or of a result that is not finite. */
#ifndef ALI3_INDEX_ONE_H
#define ALI3_INDEX_ONE_H
#include "../instance.h"

#define ALI3_INDEX_ONE_PENALTY 1e8 /* alpha: penalty of mass-normalised rows relative to M */

/* Computes v->qdd (nq) and v->lam (nc) at v->q, v->qd and the driving functions of v, iterated from their present
 * values. */
ali3_status ali3_index_one(ali3_instance *in, ali3_vectors *v);
/* Factorises in->tangent.F = M(q) + alpha Phi_q' Phi_q, with Phi_q in in->tangent.J. */
ali3_status ali3_index_one_factorise(ali3_instance *in, const double *q);
/* Solves M x + Phi_q' lam = Q, Phi_q x = -b by corrections with that matrix, from x = 0 (nq) and lam = 0 (nc) to a
 * relative tolerance or in the largest number of iterations, which is no failure. Q (nq), b (nc). */
ali3_status ali3_index_one_solve(ali3_instance *in, const double *Q, const double *b, double tolerance, double *x,
                                 double *lam);
#endif
