/* Getting and setting variables: checks of ranges, phases and finiteness; a call with one bad value changes nothing. */
#include <math.h>
#include <string.h>

#include "slave.h"

static const unsigned SETTABLE = SLAVE_INSTANTIATED | SLAVE_INITIALISING | SLAVE_STEPPING | SLAVE_STEP_FAILED;

bool slave_is_output(uint32_t reference) {
  const slave_table *t = &slave_the_table;
  return reference >= t->n_known && reference < t->n_variables && t->variable[reference].source != SLAVE_CONSTANT;
}

/* Value of a SLAVE_AHEAD variable, extrapolated by its rate over communication steps like the last one, or before any
 * over inner steps. */
static double extrapolate(const slave *s, const slave_variable *v, const double *value) {
  const double step = s->completed.n > 0 ? (double)s->completed.n * s->completed.h : s->value[s->step_reference];
  return value[v->index] + s->value[s->lead_reference] * step * value[v->other];
}

void slave_fill_ahead_rates(const slave *s, double *derivative) {
  const slave_table *t = &slave_the_table;
  for (size_t i = t->n_known; i < t->n_variables; i++)
    if (t->variable[i].source == SLAVE_AHEAD) derivative[i] = extrapolate(s, &t->variable[i], derivative);
}

/* Value of an output at the present state; `sensor`: the kernel's value if it is a sensor. */
static double output_value(const slave *s, const slave_variable *v, double sensor) {
  return v->source == SLAVE_SENSOR   ? v->scale * sensor
         : v->source == SLAVE_SOLVER ? ali3_solver_value(s->fidelity.kernel, v->index)
         : v->source == SLAVE_AHEAD  ? extrapolate(s, v, s->value) /* sensors precede these variables */
                                     : s->calls.capped_residual;
}

/* Prepares the computation of outputs; false: there is no valid state. */
static bool prepare_outputs(slave *s) {
  if (!s->calls.initialised && !slave_initialise(s)) return false;
  memset(s->fresh, 0, slave_the_table.n_variables);
  s->follower_current = false;
  return true;
}

bool slave_compute_outputs(slave *s) {
  const slave_table *t = &slave_the_table;
  const bool first = s->outputs == SLAVE_STALE;
  if (s->outputs == SLAVE_FRESH) return true;
  if (!prepare_outputs(s) || ali3_sensors(s->fidelity.kernel, s->sensors) != ALI3_OK) return false;
  for (size_t i = t->n_known; i < t->n_variables; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->source == SLAVE_CONSTANT) break; /* constants come last */
    s->value[i] = output_value(s, v, s->sensors[v->index]);
  }
  s->outputs = SLAVE_FRESH;
  if (!first) return true;
  slave_watch_outputs(s);
  slave_watch_answers(s);
  return true;
}

/* Whether inputs of other programs are checked, which needs the outputs of each step. */
static bool watches_answers(void) {
  for (size_t i = 0; i < slave_the_table.n_known; i++)
    if (slave_the_table.variable[i].role == SLAVE_ANSWER || slave_the_table.variable[i].role == SLAVE_HUB) return true;
  return false;
}

/* Computes the outputs among n variables, except those of a follower. */
static bool compute_outputs(slave *s, const uint32_t *reference, size_t n) {
  const slave_table *t = &slave_the_table;
  const bool first = s->outputs == SLAVE_STALE;
  size_t n_sensors = 0;
  if (s->outputs == SLAVE_FRESH || watches_answers()) return slave_compute_outputs(s);
  if (first && !prepare_outputs(s)) return false;
  const bool has_follower = slave_has_follower(s); /* evaluated after the fidelity may have changed */
  if (first && t->roll < t->n_variables) slave_request_sensor(s, &n_sensors, (uint32_t)t->roll);
  for (size_t k = 0; k < n; k++) {
    const slave_variable *v = &t->variable[reference[k]];
    if (!slave_is_output(reference[k])) continue;
    if (v->source == SLAVE_SENSOR && !(has_follower && slave_is_omitted(s, v)))
      slave_request_sensor(s, &n_sensors, reference[k]);
    if (v->source == SLAVE_AHEAD) slave_request_sensor(s, &n_sensors, (uint32_t)v->index);
    if (v->source == SLAVE_AHEAD) slave_request_sensor(s, &n_sensors, (uint32_t)v->other);
  }
  if (!slave_read_sensors(s, s->fidelity.kernel, n_sensors)) return false;
  s->outputs = SLAVE_SOME;
  for (size_t k = 0; k < n; k++) {
    const slave_variable *v = &t->variable[reference[k]];
    if (slave_is_output(reference[k]) && v->source != SLAVE_SENSOR) s->value[reference[k]] = output_value(s, v, 0.0);
  }
  if (first) slave_watch_outputs(s);
  return true;
}

/* Computes the omitted outputs by the follower; without one a warning is logged once a run. */
static bool compute_omitted(slave *s, const uint32_t *reference, size_t n) {
  for (size_t i = 0; i < n; i++) {
    const slave_variable *v = &slave_the_table.variable[reference[i]];
    if (!slave_is_omitted(s, v)) continue;
    if (slave_has_follower(s)) return slave_omitted_outputs(s, reference, n);
    if (!s->uncomputed_warned) slave_log_uncomputed(s, v);
    s->uncomputed_warned = true;
    return true;
  }
  return true;
}

slave_status slave_get(slave *s, const uint32_t *reference, size_t n, double *value) {
  const slave_table *t = &slave_the_table;
  bool any_output = false;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= t->n_variables)
      return slave_log(s, SLAVE_ERROR, "There is no variable with value reference %u.", (unsigned)reference[i]);
    if (!slave_is_output(reference[i])) continue;
    if (s->calls.phase == SLAVE_INSTANTIATED)
      return slave_log(s, SLAVE_ERROR, "'%s' is an output without a start value; it is there in initialisation mode.",
                       t->variable[reference[i]].name);
    any_output = true;
  }
  if (any_output && !(compute_outputs(s, reference, n) && compute_omitted(s, reference, n))) return SLAVE_ERROR;
  for (size_t i = 0; i < n; i++) value[i] = s->value[reference[i]];
  return SLAVE_OK;
}

/* Checks a value. *clamped: what is stored, after a warning the end of the range of an input or the last value of a
 * port. */
static slave_status check_value(slave *s, uint32_t reference, double value, double *clamped) {
  const slave_table *t = &slave_the_table;
  if (reference >= t->n_variables)
    return slave_log(s, SLAVE_ERROR, "There is no variable with value reference %u.", (unsigned)reference);
  const slave_variable *v = &t->variable[reference];
  if (reference >= t->n_known)
    return slave_log(s, SLAVE_ERROR, "'%s' is %s and cannot be set.", v->name,
                     v->source == SLAVE_CONSTANT ? "a constant" : "an output");
  if (!(s->calls.phase & SETTABLE) || (v->fixed && (s->calls.phase & (SLAVE_STEPPING | SLAVE_STEP_FAILED))))
    return slave_log(s, SLAVE_ERROR, "'%s' cannot be set %s%s.", v->name, slave_phase_name(s->calls.phase),
                     v->fixed ? "; it is a fixed parameter" : "");
  const bool finite = fabs(value) < HUGE_VAL;
  if (!finite && !v->port)
    return slave_log(s, SLAVE_ERROR, "'%s' was set to %g; a finite number is needed, the last value %g%s is kept.",
                     v->name, value, s->value[reference], v->unit);
  if (finite && v->whole && value != floor(value))
    return slave_log(s, SLAVE_ERROR, "'%s' was set to %.10g; it must be a whole number, it keeps %g.", v->name, value,
                     s->value[reference]);
  *clamped = finite ? value : s->value[reference];
  if (finite && value >= v->min && value <= v->max) return SLAVE_OK;
  if (v->source != SLAVE_INPUT)
    return slave_log(s, SLAVE_ERROR, "'%s' was set to %.10g%s, outside its range %g to %g; it keeps %g.", v->name,
                     value, v->unit, v->min, v->max, s->value[reference]);
  if (finite) *clamped = value < v->min ? v->min : v->max;
  return SLAVE_WARNING;
}

/* Asks the kernel, without changing it, whether a parameter in its range is consistent with the others. */
static slave_status try_parameter(slave *s, uint32_t reference, double value) {
  const slave_variable *v = &slave_the_table.variable[reference];
  if (v->source != SLAVE_PARAMETER) return SLAVE_OK;
  if (ali3_try_parameter(s->fidelity.kernel, v->index, value) != ALI3_OK)
    return slave_log(s, SLAVE_ERROR, "'%s' was set to %.10g%s, which the model cannot take; it keeps %g.", v->name,
                     value, v->unit, s->value[reference]);
  return SLAVE_OK;
}

/* Stores a checked value; warns outside the usual range and where it has no effect. */
static void store_value(slave *s, uint32_t reference, double value) {
  const slave_variable *v = &slave_the_table.variable[reference];
  if (value == s->value[reference]) return;
  if ((s->calls.phase & (SLAVE_STEPPING | SLAVE_STEP_FAILED)) && slave_has_no_effect(s, v))
    slave_log(s, SLAVE_WARNING, "'%s' was set to %.10g%s, without effect: it is of the built-in road.", v->name, value,
              v->unit);
  if (value < v->least || value > v->most)
    slave_log(s, SLAVE_WARNING,
              "'%s' was set to %.10g%s, outside the range in which such vehicles work, %.4g to %.4g%s.", v->name, value,
              v->unit, v->least, v->most, v->unit);
  s->value[reference] = value;
  slave_forget_refusal(s);
  if (v->source == SLAVE_INPUT || v->source == SLAVE_PARAMETER) s->pending[reference] = 1;
  if (s->calls.phase & (SLAVE_INSTANTIATED | SLAVE_INITIALISING)) slave_invalidate(s);
}

slave_status slave_check_set(slave *s, uint32_t reference, double value) {
  double clamped;
  const slave_status status = check_value(s, reference, value, &clamped);
  if (status > SLAVE_WARNING || clamped == s->value[reference]) return status;
  return try_parameter(s, reference, clamped) == SLAVE_OK ? status : SLAVE_ERROR;
}

/* Warns once of an input that is clamped to its range, and once of a port that keeps its last value. */
static slave_status warn_clamped(slave *s, uint32_t reference, double value, double clamped_value) {
  const slave_variable *v = &slave_the_table.variable[reference];
  const unsigned char warning = fabs(value) < HUGE_VAL ? SLAVE_HELD_AT_END : SLAVE_HELD_LAST;
  if (s->input_flags[reference] & warning) return SLAVE_OK;
  s->input_flags[reference] |= warning;
  if (warning == SLAVE_HELD_LAST)
    return slave_log(s, SLAVE_WARNING,
                     "The port '%s' was set to %g and holds its last value %g%s. This is reported once.", v->name,
                     value, clamped_value, v->unit);
  return slave_log(s, SLAVE_WARNING,
                   "'%s' was set to %.10g%s and is held at %g, the end of its range %g to %g. This is reported once.",
                   v->name, value, v->unit, clamped_value, v->min, v->max);
}

slave_status slave_clamp(slave *s, uint32_t reference, double value, double *clamped) {
  const slave_status status = check_value(s, reference, value, clamped);
  return status == SLAVE_WARNING ? warn_clamped(s, reference, value, *clamped) : status;
}

slave_status slave_set(slave *s, const uint32_t *reference, size_t n, const double *value) {
  slave_status worst = SLAVE_OK;
  double clamped;
  for (size_t i = 0; i < n; i++) {
    const slave_status status = slave_check_set(s, reference[i], value[i]);
    if (status > SLAVE_WARNING) return status;
  }
  for (size_t i = 0; i < n; i++) {
    const bool clamped_value = check_value(s, reference[i], value[i], &clamped) == SLAVE_WARNING;
    if (clamped_value && warn_clamped(s, reference[i], value[i], clamped) == SLAVE_WARNING) worst = SLAVE_WARNING;
    s->input_flags[reference[i]] |= SLAVE_WAS_SET;
    if (fabs(value[i]) < HUGE_VAL) slave_record_port_set(s, reference[i], clamped != s->value[reference[i]]);
    store_value(s, reference[i], clamped);
  }
  return worst;
}
