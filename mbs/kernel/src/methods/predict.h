/* Start values of a step. */
#ifndef ALI3_PREDICT_H
#define ALI3_PREDICT_H
#include "../instance.h"
#include "../request.h"

enum { ALI3_PARABOLA = 3 };
/* Share of the change of the multipliers that is taken: no step corrects what they have along dependent rows or has
 * right about rows that lose their lever, and whole extrapolations of that would grow. */
static const double ALI3_SHARE = 0.5;

bool ali3_predict(ali3_instance *in, const ali3_request *request, bool from_past);
void ali3_predict_accept(ali3_instance *in, double h);
void ali3_predict_rates(ali3_instance *in, double h);
#endif
