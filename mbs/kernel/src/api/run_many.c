/* Runs of several instances of one System that advance together. Between steps each instance has the state of ali3_run;
 * a lane whose step fails in the group repeats it alone. */
#include <string.h>

#include "../algebra/processor.h"
#include "../instance.h"
#include "../lanes/lanes.h"
#include "../method.h"
#include "../methods/abrupt_force.h"
#include "../methods/contact_event.h"
#include "../methods/energy_balance.h"
#include "../methods/energy_watch.h"
#include "../methods/generalised_alpha.h"
#include "../methods/history.h"
#include "../methods/input_jump.h"
#include "../methods/newton.h"
#include "../methods/predict.h"
#include "../methods/steps.h"
#include "../methods/stiffness.h"
#include "../methods/whole_step.h"
#include "../rows/driving_functions.h"
#include "../rows/turning.h"
#include "../sensors/sensors.h"
#include "../state/axes.h"
#include "../state/inputs.h"
#include "../state/vectors.h"
#include "../state/work.h"

struct ali3_many {
  ali3_lane_group group;
  const ali3_system *base; /* as loaded */
  bool separate; /* the wheel axes of the lanes differ */
  void (*release)(void *block);
};

int32_t ali3_widest_lanes(void) { return ali3_processor_lanes(); }

/* Functions for a number of lanes that the processor has; NULL: none. */
static const ali3_lane_code *lane_code(int32_t width) {
#if defined(__x86_64__)
  if (width > 2) return width == 4 ? &ali3_code_lanes_4 : &ali3_code_lanes_8;
#endif
  return width == 2 ? &ali3_code_lanes_2 : NULL;
}

size_t ali3_many_size(const ali3_system *s, int32_t width) {
  return s == NULL || width < 2 ? 0 : sizeof(ali3_many) + ali3_group_bytes(ali3_widest_system(s), width);
}

ali3_status ali3_many_new(const ali3_system *s, int32_t width, ali3_many **out) {
  if (s == NULL || out == NULL || (width != 2 && width != 4 && width != 8)) return ALI3_BAD_ARGUMENT;
  *out = NULL;
  if (width > ali3_processor_lanes()) return ALI3_BAD_ARGUMENT;
  char *block = s->memory.allocate(1, ali3_many_size(s, width));
  if (block == NULL) return ALI3_NO_MEMORY;
  ali3_many *many = (ali3_many *)block;
  many->release = s->memory.release;
  many->base = s;
  many->group.system = ali3_widest_system(s);
  many->group.width = width;
  many->group.code = lane_code(width);
  ali3_group_place(&many->group, block + sizeof *many);
  *out = many;
  return ALI3_OK;
}

void ali3_many_free(ali3_many *many) {
  if (many != NULL) many->release(many);
}

/* Whether groups support the System and the settings: ALi3-P with the default update. */
static bool is_supported(const ali3_system *s, const ali3_settings *settings) {
  return s->size.n_switch == 0 && settings->method == ALI3_METHOD_ALI3P && settings->project &&
         settings->update == ALI3_UPDATE_LINEARISED && settings->step_iterations == 0;
}

/* Whether the last step was made by ALi3-P as well. */
static bool continues_method(const ali3_instance *in, double h) {
  if (in->system->n_flexible > 0) return !ali3_damped_start(in, h);
  return in->now.history[ALI3_HISTORY_OWNER] == (double)ALI3_METHOD_ALI3P;
}

/* Begins a step of lane l from in->now. False: the instance must make it alone. */
static bool begin_lane(ali3_lane_group *g, int32_t l, const ali3_whole_step *step) {
  ali3_instance *in = g->lane[l];
  const ali3_sizes *z = &g->system->size;
  ali3_vectors *from = &in->now, *to = &in->next;
  const double h = step->asked.h;
  if (ali3_is_divided(in, step->asked.t, h)) return false;
  in->parting.changed = -1.0;
  ali3_events_begin(in, step->asked.depth);
  if (ali3_divides_ahead(in, &step->asked) || fastest_turn(in) * h > MAX_TURN || !continues_method(in, h)) return false;
  if (ali3_inputs_begin(in, step->asked.t, h) != ALI3_OK) return false;
  ali3_vectors_copy_unwritten(in, to, from);
  if (ali3_input_jump(in, h) != ALI3_OK) return false;
  ali3_driving_step(in, from, to, step->asked.t, h);
  memcpy(to->used, in->inputs.set, (size_t)z->nu * sizeof(double));
  memcpy(to->y_last, from->y, (size_t)z->ny * sizeof(double));
  to->h_last[0] = h;
  return true;
}

/* Ends a step that converged in lane l, after ali3_group_to: in->next becomes the state. */
static ali3_status end_lane(ali3_lane_group *g, int32_t l, const ali3_whole_step *step) {
  ali3_instance *in = g->lane[l];
  if (in->system->n_flexible > 0) {
    in->next.history[ALI3_HISTORY_OWNER] = ALI3_METHOD_ALI3P;
    ali3_predict_rates(in, step->asked.h);
  } else {
    ali3_history_shift(in, step->asked.h);
  }
  ali3_lane_elements_accept(g, l);
  if (ali3_contact_event(in, &step->asked, &in->now, &in->next) || ali3_divides(in, &step->asked, false))
    return ALI3_UNRESOLVED;
  const double *weight = in->system->n_flexible + in->system->n_lookup > 0 ? NULL : &g->weight[l];
  const double *square = g->squares + l;
  const ali3_status resolved =
      ali3_energy_judge(in, &step->asked, g->work[l], g->size[l], g->end[l], g->open[l], weight);
  if (resolved != ALI3_OK) return resolved;
  ali3_work_along(in, 0.5);
  ali3_driving_work(in, &in->next, g->driving_work[l]);
  const ali3_status status = ali3_accept(in);
  if (status != ALI3_OK) return status;
  in->clock.now = step->asked.t;
  ali3_balance_motion(in, square[0], square[g->width], square[2 * g->width]);
  return ALI3_OK;
}

/* Restores the start of the step and makes it with the instance alone. */
static ali3_status step_alone(ali3_instance *in, const ali3_whole_step *step) {
  if (in->stored.backed_up) ali3_vectors_copy(in, &in->now, &in->stored.start);
  memcpy(in->inputs.set, in->inputs.from, (size_t)in->system->size.nu * sizeof(double));
  in->stored.backed_up = false;
  in->bound.capped = false;
  in->report = step->before;
  return ali3_advance(in, &step->asked);
}

/* Makes the step of the active lanes; status[l] is its result. */
static void step_together(ali3_many *many, int32_t n, const bool *active, bool separate, const ali3_whole_step *step,
                          ali3_status *status, ali3_lane *lane) {
  ali3_lane_group *g = &many->group;
  int32_t entered = 0;
  for (int32_t l = 0; l < g->width; l++) g->lanes[l] = 0;
  for (int32_t l = 0; l < n && !separate; l++)
    if (active[l] && begin_lane(g, l, &step[l])) {
      g->lanes[l] = -1;
      entered++;
    }
  for (int32_t l = 0; l < g->width; l++) g->good[l] = 0;
  if (entered > 1) {
    ali3_group_from(g);
    g->code->step(g);
    ali3_group_to(g);
  }
  for (int32_t l = 0; l < n; l++) {
    if (!active[l]) continue;
    status[l] = ALI3_NOT_CONVERGED;
    if (g->good[l]) status[l] = end_lane(g, l, &step[l]);
    if (status[l] == ALI3_OK) continue;
    lane[l].alone++;
    status[l] = step_alone(g->lane[l], &step[l]);
  }
}

/* Checks that the n lanes can run together and sets up their group. */
static ali3_status set_up_group(ali3_many *many, int32_t n, ali3_lane *lane, double h) {
  ali3_lane_group *g = &many->group;
  for (int32_t l = 0; l < n; l++) {
    if (lane[l].instance == NULL || lane[l].instance->base != many->base) return ALI3_BAD_ARGUMENT;
    for (int32_t k = 0; k < l; k++)
      if (lane[k].instance == lane[l].instance) return ALI3_BAD_ARGUMENT;
    if (memcmp(&lane[l].instance->settings, &lane[0].instance->settings, sizeof g->settings) != 0)
      return ALI3_BAD_ARGUMENT;
  }
  for (int32_t l = 0; l < n; l++) g->lane[l] = lane[l].instance;
  g->used = n;
  g->system = lane[0].instance->system;
  many->separate = false;
  for (int32_t l = 1; l < n; l++)
    if (!ali3_axes_same(lane[0].instance, lane[l].instance)) many->separate = true;
  ali3_group_parameters(g);
  g->settings = lane[0].instance->settings;
  g->h = h;
  g->alpha = ali3_penalty(lane[0].instance, h);
  return ALI3_OK;
}

ali3_status ali3_many_run(ali3_many *many, int32_t n, ali3_lane *lane, double h, int64_t n_steps, int64_t every) {
  if (many == NULL || lane == NULL || n < 1 || n > many->group.width || n_steps < 0 || every < 1)
    return ALI3_BAD_ARGUMENT;
  if (!(h > 0.0) || !(h <= 1e6)) return ALI3_BAD_ARGUMENT;
  const ali3_status group_status = set_up_group(many, n, lane, h);
  if (group_status != ALI3_OK) return group_status;
  const ali3_system *S = many->group.system;
  const bool separate = many->separate || !is_supported(S, &many->group.settings);
  bool active[ALI3_MAX_LANES];
  ali3_whole_step step[ALI3_MAX_LANES];
  ali3_status status[ALI3_MAX_LANES];
  for (int32_t l = 0; l < n; l++) {
    lane[l].status = (int32_t)ali3_check_method(lane[l].instance);
    lane[l].done = lane[l].alone = 0;
    lane[l].instance->bound.call_residual = 0.0;
  }
  for (int64_t k = 0; k < n_steps; k++) {
    for (int32_t l = 0; l < n; l++) {
      active[l] = lane[l].status == ALI3_OK;
      const double *end = lane[l].inputs != NULL ? lane[l].inputs + k * S->size.nu : NULL;
      status[l] =
          active[l] ? ali3_step_begin(lane[l].instance, h, end, ALI3_READ_ALL, &step[l]) : (ali3_status)lane[l].status;
      active[l] = active[l] && status[l] == ALI3_OK;
      lane[l].status = (int32_t)status[l];
    }
    step_together(many, n, active, separate, step, status, lane);
    for (int32_t l = 0; l < n; l++) {
      if (!active[l]) continue;
      ali3_instance *in = lane[l].instance;
      lane[l].status = (int32_t)ali3_explain_refusal(in, ali3_step_end(in, &step[l], status[l]), h);
      if (lane[l].status != ALI3_OK) continue;
      lane[l].done = k + 1;
      if ((k + 1) % every == 0) ali3_record_row(in, (k + 1) / every - 1, lane[l].out, lane[l].positions);
    }
  }
  return ALI3_OK;
}
