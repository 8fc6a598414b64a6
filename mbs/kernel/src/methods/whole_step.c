/* Start and end of a requested step, common to all methods. */
#include "whole_step.h"

#include <math.h>
#include <string.h>

#include "../lookup/lookup.h"
#include "../method.h"
#include "../start/initialise.h"
#include "../state/inputs.h"
#include "../state/road_files.h"
#include "../state/vectors.h"
#include "branch_watch.h"
#include "energy_balance.h"
#include "energy_watch.h"
#include "newton.h"

ali3_status ali3_step_begin(ali3_instance *in, double h, const double *end, ali3_reading reading,
                            ali3_whole_step *step) {
  if (!in->start.initialised) return ALI3_NOT_INITIALISED;
  ali3_roads_clear_read_errors(in);
  if (ali3_wheels_watch(in) != ALI3_OK && ali3_roads_status(in) == ALI3_OK) {
    in->report.last_status = ALI3_WHEEL_IN_ROAD;
    in->report.failures++;
    return ALI3_WHEEL_IN_ROAD;
  }
  if (ali3_beyond_table(in, NULL, NULL) != ALI3_OK) {
    in->report.last_status = ALI3_BEYOND_TABLE;
    in->report.failures++;
    return ALI3_BEYOND_TABLE;
  }
  const ali3_status input_status = ali3_inputs_set_end(in, h, end);
  if (input_status != ALI3_OK) return input_status;
  step->t_base = h == in->clock.h ? in->clock.base : ali3_time(in); /* counted steps of equal h add no round-off */
  step->count = h == in->clock.h ? in->clock.count + 1 : 1;
  step->asked = (ali3_request){
      .t = step->t_base + (double)step->count * h, .h = h, .depth = in->settings.max_halvings, .reading = reading};
  step->before = in->report;
  in->bound.capped = false;
  in->bound.capped_residual = 0.0;
  in->bound.iterations_before = step->before.iterations;
  in->stored.backed_up =
      false; /* only halves and a new owner of the history change in->now before a step is accepted */
  in->clock.now = ali3_time(in);
  ali3_branch_before(in);
  return ALI3_OK;
}

ali3_status ali3_step_end(ali3_instance *in, const ali3_whole_step *step, ali3_status status) {
  if (status == ALI3_OK) status = ali3_branch_after(in, &step->asked);
  in->report.last_status = (int32_t)status;
  if (status != ALI3_OK) {
    if (in->stored.backed_up) ali3_vectors_copy(in, &in->now, &in->stored.start);
    memcpy(in->inputs.set, in->inputs.from, (size_t)in->system->size.nu * sizeof(double));
    ali3_balance_restore(&in->report, &step->before);
    in->report.failures++;
    return status;
  }
  if (in->report.halvings != step->before.halvings || in->report.divisions != step->before.divisions)
    ali3_iterations_since(in, step->before.iterations); /* of all halves */
  in->report.steps++;
  const bool balanced = ali3_has_balance(in);
  if (balanced || step->asked.reading != ALI3_READ_NOTHING) ali3_energy_trend(in, balanced);
  if (in->bound.capped) {
    in->report.capped++;
    in->report.capped_residual = fmax(in->report.capped_residual, in->bound.capped_residual);
    in->bound.call_residual = fmax(in->bound.call_residual, in->bound.capped_residual);
  }
  in->clock.base = step->t_base;
  in->clock.h = step->asked.h;
  in->clock.count = step->count;
  return ALI3_OK;
}
