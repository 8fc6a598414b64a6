/* Values of the sensors in the present state. */
#ifndef ALI3_SENSORS_H
#define ALI3_SENSORS_H
#include "../instance.h"

/* Values of all sensors at in->now, in the order of the System. */
void ali3_sensors_evaluate(const ali3_instance *in, double *out);
void ali3_sensors_some(const ali3_instance *in, int32_t n, const int32_t *number, double *out);
/* Writes sensors and coordinates to row `row` of two matrices with one row per record; either may be NULL. */
void ali3_record_row(const ali3_instance *in, int64_t row, double *out, double *positions);
/* Unit quaternion, scalar first and >= 0, of the body axes; v: numbers of their signals. */
void ali3_quaternion(const ali3_instance *in, const int32_t *v, double n[4]);
/* p = r + a x + b y + c z (order 0), or its first or second rate; v: numbers of the signals. */
void ali3_carried(const ali3_instance *in, const int32_t *v, int32_t order, double out[3]);

#define ALI3_SLOWEST_DIRECTION 0.1 /* m/s: speed below which the direction of a velocity is reported as zero */
#endif
