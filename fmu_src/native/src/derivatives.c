/* Derivatives: of the inputs by time (set), of the outputs by time, of the outputs by the inputs. */
#include <math.h>
#include <string.h>

#include "slave.h"

static const double DIFFERENCE = 1e-6; /* of an initial value, to each side, relative to its range or size */

slave_status slave_set_slopes(slave *s, const uint32_t *reference, size_t n, const int32_t *order,
                              const double *value) {
  const slave_table *t = &slave_the_table;
  slave_status worst = SLAVE_OK;
  for (size_t i = 0; i < n; i++) {
    if (reference[i] >= t->n_variables || t->variable[reference[i]].source != SLAVE_INPUT)
      return slave_log(s, SLAVE_ERROR, "Value reference %u is not an input; only inputs have derivatives to set.",
                       (unsigned)reference[i]);
    if (t->variable[reference[i]].whole)
      return slave_log(s, SLAVE_ERROR, "A derivative of '%s' was set; it is a whole number and has none.",
                       t->variable[reference[i]].name);
    if (order[i] < 1 || order[i] > SLAVE_MAX_ORDERS)
      return slave_log(s, SLAVE_ERROR, "A derivative of order %d of '%s' was set; orders 1 to %d can be.",
                       (int)order[i], t->variable[reference[i]].name, SLAVE_MAX_ORDERS);
    if (!(fabs(value[i]) < HUGE_VAL) && !t->variable[reference[i]].port)
      return slave_log(s, SLAVE_ERROR, "The derivative of '%s' was set to %g; a finite number is needed.",
                       t->variable[reference[i]].name, value[i]);
  }
  for (size_t i = 0; i < n; i++) {
    double *slope = &s->slope[reference[i] * SLAVE_TERMS + (uint32_t)order[i]];
    const bool finite = fabs(value[i]) < HUGE_VAL;
    if (!finite && !(s->input_flags[reference[i]] & SLAVE_HELD_FLAT)) {
      s->input_flags[reference[i]] |= SLAVE_HELD_FLAT;
      worst =
          slave_log(s, SLAVE_WARNING, "A derivative of the port '%s' was set to %g; 0 is taken. This is reported once.",
                    t->variable[reference[i]].name, value[i]);
    }
    const double slope_value = finite ? value[i] : 0.0;
    if (*slope != slope_value) slave_forget_refusal(s);
    *slope = slope_value;
  }
  return worst;
}

slave_status slave_output_rates(slave *s, const uint32_t *reference, size_t n, const int32_t *order, double *value) {
  const slave_table *t = &slave_the_table;
  for (size_t i = 0; i < n; i++) {
    if (!slave_is_output(reference[i]))
      return slave_log(s, SLAVE_ERROR, "Value reference %u is not an output.", (unsigned)reference[i]);
    if (order[i] != 1)
      return slave_log(s, SLAVE_ERROR, "A derivative of order %d was asked for; outputs have the first only.",
                       (int)order[i]);
  }
  if (!s->calls.initialised && !slave_initialise(s)) return SLAVE_ERROR;
  const ali3_status status = ali3_sensor_rates(s->fidelity.kernel, s->sensors, s->known);
  if (status != ALI3_OK) return slave_log(s, SLAVE_ERROR, "No output rates: %s.", ali3_status_text(status));
  for (size_t i = 0; i < n; i++)
    if (t->variable[reference[i]].source != SLAVE_SENSOR || !s->known[t->variable[reference[i]].index] ||
        slave_is_omitted(s, &t->variable[reference[i]]))
      return slave_log(s, SLAVE_ERROR,
                       "The rate of '%s' is not known: it depends on forces or accelerations. Positions, angles and "
                       "velocities have rates.",
                       t->variable[reference[i]].name);
  for (size_t i = 0; i < n; i++)
    value[i] = t->variable[reference[i]].scale * s->sensors[t->variable[reference[i]].index];
  return SLAVE_OK;
}

/* Adds the central difference of the outputs over one initial value; the initial state is computed on both sides. */
static bool add_initial_difference(slave *s, uint32_t reference, double seed, bool left_out, double *out) {
  const slave_table *t = &slave_the_table;
  const slave_variable *v = &t->variable[reference];
  const double range = v->max - v->min, value = s->value[reference];
  const double size = range > 0.0 && range < 1e6 ? range : fmax(1.0, fabs(value));
  const double up = fmin(value + DIFFERENCE * size, v->max), down = fmax(value - DIFFERENCE * size, v->min);
  if (seed == 0.0 || !(up > down)) return true;
  bool ok = true;
  for (int side = 0; side < 2 && ok; side++) {
    s->value[reference] = side == 0 ? up : down;
    ok = slave_initialise(s) && slave_compute_outputs(s) && (!left_out || slave_omitted_outputs(s, NULL, 0));
    const double weight = (side == 0 ? seed : -seed) / (up - down);
    for (size_t i = t->n_known; i < t->n_variables && ok; i++)
      if (t->variable[i].source == SLAVE_SENSOR) out[i] += weight * s->value[i];
  }
  s->value[reference] = value;
  return ok;
}

/* Derivatives of the outputs of the initial state by n known variables along the seed, by differences. */
static slave_status initial_derivative(slave *s, const uint32_t *known, size_t n, const double *seed, bool left_out,
                                       double *out) {
  bool ok = true;
  double n_starts = 0.0;
  for (size_t i = 0; i < n; i++) n_starts += seed[i] != 0.0 ? 2.0 : 0.0;
  if (n_starts > 0.0 && slave_settling_steps(s) > slave_settling_left(s, n_starts))
    return slave_log(s, SLAVE_ERROR,
                     "The derivatives take %.0f starts that settle over %.0f inner steps each, and a call that has "
                     "begun cannot be cancelled; it may make %.0f in each. Ask by fewer variables at once, or set "
                     "'step_size' to more or the time that a start settles for to less.",
                     n_starts, slave_settling_steps(s), fmax(slave_settling_left(s, n_starts), 0.0));
  for (size_t i = 0; i < n && ok; i++) ok = add_initial_difference(s, known[i], seed[i], left_out, out);
  slave_invalidate(s); /* the next reading of outputs computes the initial state again */
  return ok ? SLAVE_OK : SLAVE_ERROR;
}

/* Derivatives of the outputs after the last communication step by its inputs. */
static slave_status step_derivative(slave *s, const uint32_t *known, size_t n, const double *seed, bool left_out,
                                    double *out) {
  const slave_table *t = &slave_the_table;
  memset(s->direction, 0, (size_t)ali3_system_sizes(s->fidelity.system).nu * sizeof(double));
  for (size_t i = 0; i < n; i++) {
    const slave_variable *v = &t->variable[known[i]];
    if (v->source != SLAVE_INPUT)
      return slave_log(s, SLAVE_ERROR,
                       "'%s' is not an input; after initialisation outputs have derivatives by inputs only.", v->name);
    s->direction[v->index] += seed[i] / v->scale;
  }
  return slave_step_derivative(s, s->direction, left_out, out);
}

slave_status slave_directional_derivative(slave *s, const uint32_t *unknown, size_t n_unknown, const uint32_t *known,
                                          size_t n_known, const double *seed, double *out) {
  const slave_table *t = &slave_the_table;
  bool left_out = false;
  for (size_t i = 0; i < n_unknown; i++) {
    if (!slave_is_output(unknown[i]))
      return slave_log(s, SLAVE_ERROR, "Value reference %u is not an output; derivatives are those of outputs.",
                       (unsigned)unknown[i]);
    left_out = left_out || slave_is_omitted(s, &t->variable[unknown[i]]);
  }
  for (size_t i = 0; i < n_known; i++) {
    const bool excluded = known[i] >= t->n_known || t->variable[known[i]].source > SLAVE_POSE;
    if (excluded)
      return slave_log(s, SLAVE_ERROR, "There are no derivatives by value reference %u.", (unsigned)known[i]);
    if (t->variable[known[i]].whole)
      return slave_log(s, SLAVE_ERROR, "There are no derivatives by '%s'; it is a whole number.",
                       t->variable[known[i]].name);
    if (!(fabs(seed[i]) < HUGE_VAL))
      return slave_log(s, SLAVE_ERROR, "The seed of '%s' is %g; a finite number is needed.", t->variable[known[i]].name,
                       seed[i]);
  }
  double *all = s->memory.allocate(t->n_variables, sizeof *all);
  if (all == NULL) return slave_log(s, SLAVE_ERROR, "There is not enough memory for the derivatives.");
  memset(all, 0, t->n_variables * sizeof *all);
  const bool initial = (s->calls.phase & (SLAVE_INSTANTIATED | SLAVE_INITIALISING)) != 0;
  const slave_status status = initial ? initial_derivative(s, known, n_known, seed, left_out, all)
                                      : step_derivative(s, known, n_known, seed, left_out, all);
  slave_fill_ahead_rates(s, all);
  for (size_t i = 0; i < n_unknown && status == SLAVE_OK; i++) out[i] = all[unknown[i]];
  s->memory.release(all);
  return status;
}
