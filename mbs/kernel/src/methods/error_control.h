/* Functions that the files of the error control share. */
#ifndef ALI3_ERROR_CONTROL_H
#define ALI3_ERROR_CONTROL_H
#include "../instance.h"
#include "../request.h"

/* Settings of a controlled run. */
typedef struct {
  ali3_control *control; /* tolerance, length and rate; its steps and counts */
  const double *scale; /* nq, m: length that a unit of each coordinate counts as; NULL: 1 m */
} ali3_measure;

/* Makes a step of h from time t, s, once whole and once in halves, from in->now to in->now; its start is stored in
 * in->stored.origin, its middle in in->stored.centre. *error: of positions and velocities, as in ali3_distance.
 * After a failed step in->now is unchanged; returns its status. */
ali3_status ali3_step_doubling(ali3_instance *in, const ali3_measure *measure, double t, double h, double *error);
/* Makes a step of h from time t, s, that is not halved; after a failure the caller restores the state. */
ali3_status ali3_trial_step(ali3_instance *in, double t, double h, ali3_reading reading);
/* Size of a difference q (nq) of coordinates and qd (nq) of their rates, relative to the length of the control: the
 * largest s_i |q_i| and, for coordinates with mass, s_i |qd_i| / rate, with `scale` s_i and a rate in 1/s; NaN if one
 * is. */
double ali3_distance(const ali3_instance *in, const ali3_measure *measure, const double *q, const double *qd,
                     double rate);
/* Reference rate of velocities, 1/s: that of the present motion, at least the one of the control. `all`: includes
 * coordinates without mass, such as driven angles. */
double ali3_rate(const ali3_instance *in, const ali3_measure *measure, bool all);

/* Checks the accepted controlled step of h from time t, s, for a jump between close branches; returns the fraction of
 * it that may be made, 1: all. */
double ali3_branch_fraction(ali3_instance *in, const ali3_measure *measure, double t, double h);

/* Writes q, qd and qdd at x, -1 (start) to 1 (end), of the step of h, s, in in->stored.origin, in->stored.centre and
 * in->now. */
void ali3_interpolate(const ali3_instance *in, double h, double x, ali3_vectors *result);
/* Sensors (ns) and coordinates (nq) at `time`, s, of the same step, which starts at t, s; either may be NULL. Returns
 * the status of the evaluation. */
ali3_status ali3_dense_output(ali3_instance *in, const ali3_measure *measure, double t, double h, double time,
                              double *out, double *positions);
#endif
