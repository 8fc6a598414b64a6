/* The initial state, computed from the values set so far. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "slave.h"

enum { POSE_HEIGHT = 2 }; /* index in a pose: the last length */

const char *slave_worst_row_text(slave *s, char *text, size_t size) {
  ali3_report report;
  text[0] = 0;
  const slave_table *t = &slave_the_table;
  const size_t first = t->first_row[s->fidelity.number], n = t->first_row[s->fidelity.number + 1] - first;
  if (ali3_report_get(s->fidelity.kernel, &report) == ALI3_OK && report.violation > ALI3_OPEN &&
      report.violation < HUGE_VAL && report.worst_row >= 0 && (size_t)report.worst_row < n)
    snprintf(text, size, " Worst constraint: '%.128s', open by %.3g m.", t->row[first + (size_t)report.worst_row],
             report.violation);
  return text;
}

void slave_beyond_table_text(slave *s, char *text, size_t size) {
  const slave_table *t = &slave_the_table;
  const size_t first = t->first_coordinate[s->fidelity.number], n = t->first_coordinate[s->fidelity.number + 1] - first;
  int32_t column;
  double x[3];
  text[0] = 0;
  if (ali3_beyond_table(s->fidelity.kernel, &column, x) == ALI3_BEYOND_TABLE && (size_t)column < n)
    snprintf(text, size, " '%.128s' is %.4g; its table goes from %.4g to %.4g.", t->coordinate[first + (size_t)column],
             x[0], x[1], x[2]);
}

/* Writes " 'initial.x' is 1e+300 m." or nothing. */
static const char *farthest_pose(const slave *s, char *text, size_t size) {
  const slave_table *t = &slave_the_table;
  text[0] = 0;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->source == SLAVE_POSE && fabs(s->value[i]) > (v->index > POSE_HEIGHT ? ALI3_FASTEST : ALI3_FARTHEST))
      snprintf(text, size, " '%.64s' is %g%s.", v->name, s->value[i], v->unit);
  }
  return text;
}

/* Writes the element that refuses the start, the reason, and the height at which it would not. */
static const char *refused_start(const slave *s, char *text, size_t size) {
  const slave_table *t = &slave_the_table;
  const char *reason = "";
  int32_t element = -1;
  const double height = ali3_start_excess(s->fidelity.kernel, &element, &reason);
  const char *name = element < 0 ? "" : t->element[t->first_element[s->fidelity.number] + (size_t)element];
  snprintf(text, size, " '%.64s' %s. %.3g m higher it would be clear of it.", name, reason, height);
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_POSE && t->variable[i].index == POSE_HEIGHT)
      snprintf(text, size, " '%.64s' %s. '%.64s' is %g m; from %.3g m on it is clear.", name, reason,
               t->variable[i].name, s->value[i], s->value[i] + height);
  return text;
}

/* Writes the parameter with the largest change relative to its range; `unit`: only those in it, NULL: all. */
static const char *most_changed_parameter(const slave *s, const char *unit, char *text, size_t size) {
  const slave_table *t = &slave_the_table;
  double largest = 0.0;
  text[0] = 0;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    const double deviation = fabs(s->value[i] - v->start) / (v->max - v->min);
    if (v->source != SLAVE_PARAMETER || !(deviation > largest) || (unit != NULL && strcmp(v->unit, unit) != 0))
      continue;
    largest = deviation;
    snprintf(text, size, " '%.64s' is %g%s, farthest from its start value %g.", v->name, s->value[i], v->unit,
             v->start);
  }
  return text;
}

/* Writes details of a failed start. */
static const char *start_details(slave *s, ali3_status status, char *text, size_t size) {
  if (status == ALI3_TOO_FAR) return farthest_pose(s, text, size);
  if (status == ALI3_NO_EQUILIBRIUM) return most_changed_parameter(s, NULL, text, size);
  if (status == ALI3_BAD_INERTIA) return most_changed_parameter(s, " kg.m2", text, size);
  if (status == ALI3_ROAD_LOST) snprintf(text, size, " Of the road %s.", ali3_road_lost(s->fidelity.kernel));
  if (status == ALI3_ROAD_LOST) return text;
  if (status == ALI3_START_REFUSED) return refused_start(s, text, size);
  text[0] = 0;
  return ali3_status_cause(status) == ALI3_CAUSE_CALL ? text : slave_worst_row_text(s, text, size);
}

/* Sets the limit of iterations of a step and leaves the other settings. */
static ali3_status apply_limit(slave *s) {
  ali3_settings settings;
  const ali3_status status = ali3_get_settings(s->fidelity.kernel, &settings);
  settings.step_iterations = (int32_t)s->value[s->iterations_reference];
  return status == ALI3_OK ? ali3_set_settings(s->fidelity.kernel, &settings) : status;
}

/* Passes all values to the kernel and initialises it. */
static ali3_status apply_values(slave *s) {
  const slave_table *t = &slave_the_table;
  double pose[ALI3_POSE] = {0.0};
  bool posed = false;
  ali3_status status = ali3_reset(s->fidelity.kernel);
  if (status == ALI3_OK) status = apply_limit(s);
  for (size_t i = 0; i < t->n_known && status == ALI3_OK; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->source == SLAVE_INPUT) status = ali3_set_input(s->fidelity.kernel, v->index, s->value[i] / v->scale);
    if (v->source == SLAVE_PARAMETER) status = ali3_set_parameter(s->fidelity.kernel, v->index, s->value[i]);
    if (v->source != SLAVE_POSE) continue;
    pose[v->index] = s->value[i];
    posed = posed || s->value[i] != 0.0;
  }
  if (status == ALI3_OK && posed) status = ali3_set_pose(s->fidelity.kernel, pose);
  return status == ALI3_OK ? ali3_initialise(s->fidelity.kernel, s->calls.start_time) : status;
}

/* Whether the settling of a start fits into the remaining work of the call; if not, an error is logged. */
static bool check_work(slave *s) {
  const double steps = slave_settling_steps(s), available = slave_settling_left(s, 1.0);
  if (steps <= available) return true;
  slave_log(s, SLAVE_ERROR,
            "The start would settle over %.0f inner steps of %g s, and a call that has begun cannot be cancelled; it "
            "may make %.0f of them. Set '%.64s' to less, or 'step_size' to more.",
            steps, s->value[s->step_reference], fmax(available, 0.0), steps > 0.0 ? slave_settling(s)->name : "");
  return false;
}

bool slave_initialise(slave *s) {
  char text[SLAVE_TEXT / 2];
  slave_invalidate(s);
  if (!check_work(s)) return false;
  slave_count_start(s);
  if (!slave_fidelity_choose(s)) return false;
  slave_hold_normals(s);
  ali3_status status = apply_values(s);
  const slave_variable *settling = status == ALI3_OK ? slave_settling(s) : NULL;
  if (settling != NULL)
    status =
        ali3_settle(s->fidelity.kernel, s->value[settling - slave_the_table.variable], s->value[s->step_reference]);
  s->calls.initialised = status == ALI3_OK;
  s->calls.capped_residual = 0.0;
  s->completed.n = 0;
  slave_half_steps_begin(s);
  s->outputs = SLAVE_STALE;
  if (status != ALI3_OK && settling != NULL) {
    if (status == ALI3_BAD_ARGUMENT)
      slave_log(s, SLAVE_ERROR, "No body of this scene has a direction that can be held; set '%.64s' to 0.",
                settling->name);
    else
      slave_log(s, SLAVE_ERROR,
                "The start did not settle while its motion was held, as '%.64s' asks for: %s.%s Set it to %s.",
                settling->name, slave_reason_text(s, status),
                status == ALI3_ROAD_LOST ? start_details(s, status, text, sizeof text) : "",
                s->work_left <= 0 ? "less, or 'step_size' to more" : "0, or 'step_size' to less");
    return false;
  }
  if (status != ALI3_OK) {
    slave_log(s, SLAVE_ERROR, "The initial state could not be found: %s.%s%s%s", ali3_status_text(status),
              start_details(s, status, text, sizeof text), slave_is_of_step(status) ? "" : " ",
              slave_is_of_step(status) ? "" : ali3_status_remedy(status));
    return false;
  }
  memset(s->pending, 0, slave_the_table.n_known);
  return true;
}
