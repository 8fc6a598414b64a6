/* Start values of a step. */
#ifndef ALI3_PREDICT_H
#define ALI3_PREDICT_H
#include "../instance.h"

bool ali3_predict(ali3_instance *in, double h, bool from_past);
void ali3_predict_accept(ali3_instance *in, double h);
void ali3_predict_rates(ali3_instance *in, double h);
#endif
