/* Values of the sensors. */
#ifndef ALI3_SENSORS_H
#define ALI3_SENSORS_H
#include "../instance.h"

/* Values of all sensors at in->now, in the order of the System. */
void ali3_sensors_evaluate(const ali3_instance *in, double *out);
void ali3_sensors_some(const ali3_instance *in, int32_t n, const int32_t *number, double *out);
/* Sensors and coordinates as a row of matrices with a row a record; either matrix may be NULL. */
void ali3_record_row(const ali3_instance *in, int64_t row, double *out, double *positions);
/* Unit quaternion, scalar first and not negative, of the body axes whose signals v numbers. */
void ali3_quaternion(const ali3_instance *in, const int32_t *v, double n[4]);
/* p = r + a x + b y + c z of the signals v numbers, or its first or second rate. */
void ali3_carried(const ali3_instance *in, const int32_t *v, int32_t order, double out[3]);

#define ALI3_SLOWEST_DIRECTION 0.1 /* m/s: the direction of a slower velocity reads zero */
#endif
