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
/* Whether to repeat the step from in->now to in->next, whose outputs are evaluated, in halves. `early`: in->next is an
 * iterate; then only if forces change so abruptly that the step is not worth further iterations. With a limit of
 * iterations they go on, as the last iterate may be the step. */
bool ali3_divides(ali3_instance *in, const ali3_request *request, bool early);
/* Whether `early` holds for a step that may be halved `depth` times; not counted. */
bool ali3_is_abrupt(const ali3_instance *in, int32_t depth);
/* Whether the limit of iterations leaves room to end a part of a step that resolves a force by table or a driving
 * function; counts it if so, as an abrupt force if it ends `at_row` of a table. */
bool ali3_divides_to_resolve(ali3_instance *in, const ali3_request *request, bool at_row);
/* Fraction of the way between two lengths, m, of a spring by a table to the first row that the ends do not resolve; 1:
 * none. */
double ali3_table_resolved(const ali3_instance *in, int32_t element, double from, double to);
/* Step from in->now, s, at most h, to the first row that a force by table at both ends of the step does not resolve. */
double ali3_tables_resolved_step(const ali3_instance *in, double h);
#endif
