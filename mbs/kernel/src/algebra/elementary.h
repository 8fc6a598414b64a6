/* Elementary functions with the same bits on all platforms, unlike those of C libraries. Errors below 2 units in the
 * last place (tanh, atan2, asin: 4), for arguments of sine and cosine up to 2^20. */
#ifndef ALI3_ELEMENTARY_H
#define ALI3_ELEMENTARY_H

double ali3_sin(double x); /* x in rad, as in all of them */
double ali3_cos(double x);
double ali3_exp(double x);
double ali3_tanh(double x);
double ali3_atan2(double y, double x);
double ali3_asin(double x);
/* Sines and cosines of n angles without branches. */
void ali3_sine_cosine(int n, const double *x, double *sine, double *cosine);
#endif
