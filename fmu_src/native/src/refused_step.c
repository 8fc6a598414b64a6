/* Refused steps. The first time the host may continue from the state before the step, with a shorter step or other
 * values; if it repeats the step unchanged, the slave requests the end of the simulation; after that it is an error. */
#include <stdio.h>

#include "slave.h"

bool slave_is_of_step(ali3_status status) {
  const ali3_cause cause = ali3_status_cause(status);
  return cause == ALI3_CAUSE_STEP || cause == ALI3_CAUSE_EQUATIONS;
}

void slave_forget_refusal(slave *s) { s->refusal.count = 0; }

bool slave_requests_end(const slave *s) { return s->refusal.count > 1; }

/* Remedy other than a smaller step_size; NULL: there is none. After a bad normal within the step, the last one is held
 * at its start. */
static const char *remedy(const slave *s, ali3_status status, bool jumped) {
  if (status == ALI3_TOO_MUCH_WORK && s->work_left <= 0) return "Take shorter communication steps.";
  if (jumped && status != ALI3_ROAD_LOST && status != ALI3_BAD_NORMAL)
    return "Set one that goes on from the last one, whatever the step_size.";
  return slave_is_of_step(status) ? NULL : ali3_status_remedy(status);
}

slave_status slave_refuse_step(slave *s, ali3_status status, double time, double step, const char *worst,
                               const slave_variable *jumped) {
  slave_refusal *r = &s->refusal;
  const double h = s->value[s->step_reference];
  const char *const other_remedy = remedy(s, status, jumped != NULL);
  char jump[SLAVE_TEXT / 4] = "";
  r->count = r->count > 0 && r->time == time && r->step == step ? r->count + 1 : 1;
  r->time = time;
  r->step = step;
  s->calls.phase = SLAVE_STEP_FAILED;
  if (jumped != NULL)
    snprintf(jump, sizeof jump, " It began with a jump of the answer '%s' to %.6g m.", jumped->name,
             s->value[jumped - slave_the_table.variable]);
  if (other_remedy != NULL)
    return slave_log(s, r->count > 2 ? SLAVE_ERROR : SLAVE_DISCARD,
                     "The step from %.6g s over %.6g s was refused%s, the state at %.6g s is kept: %s.%s%s %s", time,
                     step, r->count > 1 ? " again" : "", time, slave_reason_text(s, status), worst, jump, other_remedy);
  if (r->count == 1)
    return slave_log(
        s, SLAVE_DISCARD,
        "The step from %.6g s over %.6g s was refused, the state at %.6g s is kept: %s.%s %s The step_size "
        "is %g s and can be set before initialisation.",
        time, step, time, slave_reason_text(s, status), worst, ali3_status_remedy(status), h);
  if (r->count == 2)
    return slave_log(
        s, SLAVE_DISCARD,
        "The step from %.6g s over %.6g s was asked for again with nothing changed and refused again; the "
        "simulation should end here. Run it again with a step_size below %g s, or continue from another state.",
        time, step, h);
  return slave_log(s, SLAVE_ERROR,
                   "The step from %.6g s over %.6g s was refused %d times with nothing changed in between; run again "
                   "with a step_size below %g s.",
                   time, step, (int)r->count, h);
}
