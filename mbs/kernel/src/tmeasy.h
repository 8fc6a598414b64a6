/* TMeasy steady tyre characteristics (Hirschberg, Rill, Weinfurter, Vehicle System Dynamics 45(S1), 2007, 101-119). */
#ifndef ALI3_TMEASY_H
#define ALI3_TMEASY_H

typedef struct { /* one direction at the present load and friction; forces are divided by q = load / nominal load */
  double slope;                   /* initial slope dF/ds, N */
  double max_force, max_slip;     /* N, - */
  double slide_force, slide_slip; /* N, - */
} ali3_tmeasy;

/* pairs: values at the nominal load and at twice of it of slope, max_force, max_slip, slide_force, slide_slip. */
ali3_tmeasy ali3_tmeasy_at(const double pairs[10], double q, double friction_ratio);

/* Secant F(s)/s for s >= 0, finite at s = 0, and its derivative with respect to s. */
double ali3_tmeasy_secant(const ali3_tmeasy *t, double s, double *derivative);

/* Dynamic trail over contact length at lateral slip s >= 0; pairs: value at s = 0, slip of the first zero, slip where
 * it ends. */
double ali3_tmeasy_trail(const double pairs[6], double q, double s);
#endif
