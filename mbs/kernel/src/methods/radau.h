/* Stages of Radau IIA: tableau, arrays and Newton's iteration; for radau.c and radau_newton.c. */
#ifndef ALI3_RADAU_H
#define ALI3_RADAU_H
#include <stdbool.h>

#include "../instance.h"

enum { STAGES = ALI3_RADAU, LAST = STAGES - 1 };

static const double node[STAGES] = {0.15505102572168219, 0.64494897427831781, 1.0}; /* (4 -+ sqrt 6)/10 */
/* A and A^2 of the method, to 17 digits. */
static const double A[STAGES][STAGES] = {{0.19681547722366043, -0.06553542585019839, 0.02377097434822015},
                                         {0.39442431473908728, 0.29207341166522846, -0.04154875212599793},
                                         {0.37640306270046728, 0.51248582618842161, 0.11111111111111111}};
static const double A2[STAGES][STAGES] = {{0.02183503419072274, -0.01985725409861227, 0.01004263019656241},
                                          {0.17719058743194561, 0.03816496580927726, -0.00737596352989574},
                                          {0.31804138174397717, 0.18195861825602283, 0.00000000000000000}};

/* Accelerations of stage i, nq. */
static inline double *stage_acceleration(const ali3_instance *in, int i) {
  return in->step.stage + (int64_t)i * in->system->size.nq;
}
/* Rows or multipliers of stage i in an array of all stages, nc. */
static inline double *stage_rows(const ali3_instance *in, double *v, int i) {
  return v + (int64_t)i * in->system->size.nc;
}
/* Powers of sensed elements at stage i, n_work, W. */
static inline double *stage_power(const ali3_instance *in, int i) {
  return in->watch.stages + (int64_t)i * in->system->n_work;
}
/* Entries of stage i in an array of all stages, in the row pattern. */
static inline double *stage_entries(const ali3_instance *in, double *v, int i) {
  return v + i * in->system->size.nnz_rows;
}

/* Sets position, velocity, driving functions and inputs of stage i. */
void ali3_radau_set_stage(ali3_instance *in, double t, double h, int i);

/* Newton's iteration until the tolerances hold and the remaining error, estimated from the last correction and the
 * ratio of the last two errors, is small against the error of the method: a prediction from the last collocation
 * polynomial (`extrapolated`) has an error of h^3, the method of h^5. A tolerance in metres alone would spoil the order
 * at small steps, as it allows accelerations of 2 / h^2 times itself. */
ali3_status ali3_radau_newton(ali3_instance *in, double t, double h, double alpha, bool extrapolated);

/* Removes the part of the multipliers that causes no force (redundant rows), whose round-off would grow by
 * extrapolation. */
void ali3_radau_remove_redundant(ali3_instance *in, double h, double alpha);
#endif
