/* Elementary functions of the kernel's own: those of the C libraries differ in the last bit from platform to platform.
 * Errors below 2 units in the last place (tanh, atan2, asin: 4); arguments of sine and cosine up to 2^20 turns keep
 * that. */
#ifndef ALI3_ELEMENTARY_H
#define ALI3_ELEMENTARY_H

double ali3_sin(double x);
double ali3_cos(double x);
double ali3_exp(double x);
double ali3_tanh(double x);
double ali3_atan2(double y, double x);
double ali3_asin(double x);
void ali3_sine_cosine(int n, const double *x, double *sine, double *cosine); /* of n angles, without branches */
#endif
