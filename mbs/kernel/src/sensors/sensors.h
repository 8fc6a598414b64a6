/* Values of the sensors. */
#ifndef ALI3_SENSORS_H
#define ALI3_SENSORS_H
#include "../instance.h"

void ali3_sensors_evaluate(const ali3_instance *in, double *out);
void ali3_record_row(const ali3_instance *in, int64_t row, double *out, double *positions);
void ali3_quaternion(const ali3_instance *in, const int32_t *v, double n[4]);

#define ALI3_SLOWEST_DIRECTION 0.1 /* m/s: the direction of a slower velocity reads zero */
#endif
