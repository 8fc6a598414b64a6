/* Values of the sensors in the present state. */
#ifndef ALI3_SENSORS_H
#define ALI3_SENSORS_H
#include "../instance.h"

/* Values of all sensors (ns) at in->now, in the order and the units of the System. */
void ali3_sensors_evaluate(const ali3_instance *in, double *out);
/* out (n): values of the sensors with these numbers. */
void ali3_sensors_some(const ali3_instance *in, int32_t n, const int32_t *number, double *out);
/* Writes sensors (ns) and coordinates (nq) to row `row` of two matrices with one row per record; either may be NULL. */
void ali3_record_row(const ali3_instance *in, int64_t row, double *out, double *positions);
/* Unit quaternion, scalar first and >= 0, of the body axes in the earth; v: numbers of the 9 signals of the axes. */
void ali3_quaternion(const ali3_instance *in, const int32_t *v, double n[4]);
/* Point p = r + a x + b y + c z in the earth, m (order 0), or its first or second rate; v: numbers of the signals of r
 * (3), a, b, c (9), x, y, z. */
void ali3_carried(const ali3_instance *in, const int32_t *v, int32_t order, double out[3]);

#define ALI3_SLOWEST_DIRECTION 0.1 /* m/s: speed below which the direction of a velocity is reported as zero */
#endif
