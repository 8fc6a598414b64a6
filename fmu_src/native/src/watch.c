/* What a run says about itself after a step, once: that its numbers are not what was asked. */
#include "slave.h"

slave_status slave_watch(slave *s) {
  ali3_report r;
  if (s->calls.energy_warned || ali3_report_get(s->rung.kernel, &r) != ALI3_OK) return SLAVE_OK;
  const ali3_doubt doubt = ali3_run_doubt(&r);
  if (doubt == ALI3_DOUBT_NONE) return SLAVE_OK;
  const double h = s->value[s->step_reference], time = ali3_time(s->rung.kernel);
  s->calls.energy_warned = 1;
  if (doubt == ALI3_DOUBT_BALANCE)
    return slave_say(s, SLAVE_WARNING,
                     "At %.6g s the steps have made or lost %.3g J where no force did, %.2g %% of the energy in the "
                     "motion: the results are not to be relied on. Run anew with a step_size below %g s. This is said "
                     "once.",
                     time, r.energy_error, 100.0 * ali3_energy_balance(&r), h);
  return slave_say(s, SLAVE_WARNING,
                   "Up to %.6g s the solver had to halve its step %lld times in %lld steps: the motion is too fast for "
                   "step_size. Compare with a run of half the step_size, %g s. This is said once.",
                   time, (long long)r.halvings, (long long)r.steps, 0.5 * h);
}
