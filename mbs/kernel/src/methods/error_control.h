/* Functions that the files of the error control share. */
#ifndef ALI3_ERROR_CONTROL_H
#define ALI3_ERROR_CONTROL_H
#include "../instance.h"
#include "../request.h"

/* Settings of a controlled run; scale (nq): length of a unit of each coordinate, m; NULL: 1 m each. */
typedef struct {
  ali3_control *control;
  const double *scale;
} ali3_measure;

/* step_doubling.c */
ali3_status ali3_step_doubling(ali3_instance *in, const ali3_measure *measure, double t, double h, double *error);
ali3_status ali3_trial_step(ali3_instance *in, double t, double h, ali3_reading reading);
double ali3_distance(const ali3_instance *in, const ali3_measure *measure, const double *q, const double *qd,
                     double rate);
double ali3_rate(const ali3_instance *in, const ali3_measure *measure, bool all);

/* branch_watch.c */
double ali3_branch_fraction(ali3_instance *in, const ali3_measure *measure, double t, double h);

/* dense_output.c */
void ali3_interpolate(const ali3_instance *in, double h, double x, ali3_vectors *to);
ali3_status ali3_dense_output(ali3_instance *in, const ali3_measure *measure, double t, double h, double when,
                              double *out, double *positions);
#endif
