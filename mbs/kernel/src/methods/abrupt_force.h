/* Division of steps with abrupt changes of forces. */
#ifndef ALI3_METHODS_ABRUPT_FORCE_H
#define ALI3_METHODS_ABRUPT_FORCE_H
#include "../instance.h"
#include "../request.h"

/* Counts the step from in->next to in->now in the report if a force changed abruptly in it. */
void ali3_abrupt_force(ali3_instance *in);
/* Whether to make the next step in halves, as a force changed abruptly in the last one; counted. */
bool ali3_divides_ahead(ali3_instance *in, const ali3_request *request);
/* Whether the limit of iterations leaves `iterations` for each half of a step; then it is counted as a division.
 * Otherwise the step ends at its limit. */
bool ali3_allows_division(ali3_instance *in, const ali3_request *request, int32_t iterations);
/* Whether to repeat the step from in->now to in->next, whose outputs are evaluated, in halves. */
bool ali3_divides(ali3_instance *in, const ali3_request *request);
/* Whether the limit of iterations leaves room to end a part of a step at a row of a force by table; counts it if so. */
bool ali3_divides_at_row(ali3_instance *in, const ali3_request *request);
/* The same at a quarter of a piece of a driving function, which is no abrupt force. */
bool ali3_divides_at_quarter(ali3_instance *in, const ali3_request *request);
/* Fraction of the way between two lengths of an element, m, to the first row of its force by table that the ends do not
 * resolve; 1: none, or no table. */
double ali3_table_resolved(const ali3_instance *in, int32_t element, double from, double to);
/* Step from in->now, s, at most h, to the first row that a force by table at both ends of the step does not resolve. */
double ali3_tables_resolved_step(const ali3_instance *in, double h);
#endif
