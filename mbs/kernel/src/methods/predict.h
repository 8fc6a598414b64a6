/* Prediction of the increment and multipliers of a step. */
#ifndef ALI3_PREDICT_H
#define ALI3_PREDICT_H
#include "../instance.h"
#include "../request.h"

enum { ALI3_PARABOLA = 3 };
/* Fraction of the extrapolated change of multipliers that is used: errors along dependent rows, and of rows whose lever
 * vanishes, are not corrected by the step and would grow by full extrapolation. */
static const double ALI3_MULTIPLIER_FRACTION = 0.5;

/* Writes in->step.D and in->next.lam; returns whether past steps were extrapolated, which `from_past` false forbids. */
bool ali3_predict_step(ali3_instance *in, const ali3_request *request, bool from_past);
/* Stores the mean acceleration and the multipliers of the step h, s, from in->now to in->next, of rigid Systems. */
void ali3_predict_accept(ali3_instance *in, double h);
/* Stores the mean rate of that step, of Systems with flexible bodies. */
void ali3_predict_rates(ali3_instance *in, double h);
#endif
