/* Directional derivative of the outputs at the end of the last communication step by constant changes of its inputs:
 * the step is repeated from its start with the inputs a little higher and a little lower, each inner step converged to
 * round-off. Afterwards the state is restored. */
#include <math.h>
#include <string.h>

#include "slave.h"

static const double HALF_DIFFERENCE = 3e-4; /* to each side, relative to the range of an input */
/* Limits: iterations of an inner step or a part of it, as Newton's method gains a digit or more in each; parts of an
 * inner step. */
enum { MAX_ITERATIONS = 12, MAX_PARTS = 32 };

typedef struct { /* work arrays in one block, and settings */
  void *end;                        /* snapshot of the kernel */
  double *held, *direction_unit, *set, *row,
      *intermediate; /* nu: inputs of the step; direction relative to input ranges; work */
  double *parameter;                /* np: parameters of the step */
  unsigned char *contacts_before, *contacts_after;    /* ne: contacts with the road */
  slave_kinks kinks;
  double direction_size, plus,
      minus; /* norm of the direction; ends of the difference, one of them 0 at the end of a range */
  bool divided; /* the step had divided inner steps, at abrupt forces */
  int64_t divisions; /* divisions of the replay before; -1: there is none */
  ali3_settings settings;
} replay;

/* Allocates the work arrays of a replay in one block; false if there is no memory. */
static bool allocate(slave *s, replay *r) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  const size_t nu = (size_t)z.nu, ne = (size_t)z.ne, snapshot = ali3_snapshot_size(s->fidelity.system);
  r->end = s->memory.allocate(1, snapshot + (5 * nu + (size_t)z.np) * sizeof(double) + 3 * ne * sizeof(uint32_t) +
                                     3 * ne + 1);
  if (r->end == NULL) return false;
  r->held = (double *)((unsigned char *)r->end + snapshot);
  r->direction_unit = r->held + nu;
  r->set = r->direction_unit + nu;
  r->row = r->set + nu;
  r->intermediate = r->row + nu;
  r->parameter = r->intermediate + nu;
  uint32_t *const piece = (uint32_t *)(r->parameter + z.np);
  r->contacts_before = (unsigned char *)(piece + 3 * ne);
  r->contacts_after = r->contacts_before + ne;
  r->kinks = (slave_kinks){piece, piece + ne, piece + 2 * ne, r->contacts_after + ne, z.ne};
  memset(r->kinks.passed, 0, ne);
  r->divisions = -1;
  return true;
}

/* Stores the end of the step, its settings, parameters and inputs. */
static void store_end(slave *s, replay *r) {
  ali3_snapshot_take(s->fidelity.kernel, r->end);
  ali3_get_settings(s->fidelity.kernel, &r->settings);
  slave_read_step(s, r->parameter, r->held);
}

/* Normalises the direction by the ranges of the inputs and limits the difference to these. */
static void set_direction(replay *r, const double *direction) {
  const slave_table *t = &slave_the_table;
  r->direction_size = 0.0;
  r->plus = HALF_DIFFERENCE;
  r->minus = -HALF_DIFFERENCE;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    const double range = (v->max - v->min) / fabs(v->scale);
    if (v->source == SLAVE_INPUT)
      r->direction_size = fmax(r->direction_size, fabs(direction[v->index]) / (range < 1e300 ? range : 1.0));
  }
  for (size_t i = 0; i < t->n_known && r->direction_size > 0.0; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->source != SLAVE_INPUT) continue;
    const double direction_unit = direction[v->index] / r->direction_size, held = r->held[v->index];
    r->direction_unit[v->index] = direction_unit;
    const double up = v->scale * (held + HALF_DIFFERENCE * direction_unit),
                 down = v->scale * (held - HALF_DIFFERENCE * direction_unit);
    if (up > v->max || up < v->min) r->plus = 0.0;
    if (down > v->max || down < v->min) r->minus = 0.0;
  }
  if (r->plus == r->minus) r->plus = HALF_DIFFERENCE; /* inputs are at both ends of their ranges */
}

/* The inputs of this replay at `elapsed` s after the communication point. */
static const double *inputs_at(const slave *s, const replay *r, double elapsed) {
  memcpy(r->row, r->set, (size_t)ali3_system_sizes(s->fidelity.system).nu * sizeof(double));
  const size_t nu = (size_t)ali3_system_sizes(s->fidelity.system).nu;
  if (s->intermediate.n > 0) { /* `set` has the last of the intermediate inputs */
    slave_intermediate_at(s, elapsed, s->completed.h, r->intermediate);
    const double *const reached = s->intermediate.row + (size_t)s->intermediate.n * nu;
    for (size_t i = 0; i < nu; i++) r->row[i] += r->intermediate[i] - reached[i];
  } else if (s->completed.sloped) {
    slave_add_slopes(s->completed_slope, elapsed, r->row);
  }
  return r->row;
}

/* Restores the start of the step and adds `factor` times the direction to its inputs. */
static ali3_status begin(slave *s, const replay *r, double factor) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_settings exact = r->settings;
  exact.max_iterations = MAX_ITERATIONS;
  exact.step_iterations = MAX_ITERATIONS * MAX_PARTS;
  if (!r->divided) exact.max_halvings = 0; /* the replays have none either, however abrupt their inputs are */
  exact.tolerance_r = 1e-300;
  ali3_snapshot_restore(kernel, s->fidelity.start);
  for (int32_t i = 0; i < z.nu; i++) r->set[i] = r->held[i] + factor * r->direction_unit[i];
  const ali3_status status = ali3_set_settings(kernel, &exact);
  return status == ALI3_OK ? slave_restore_step(s, r->parameter, inputs_at(s, r, 0.0)) : status;
}

/* Repeats the inner steps; *contact: a contact with a road was made or lost. */
static ali3_status run(slave *s, replay *r, bool beside, bool *contact) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_status status = ALI3_OK;
  ali3_contacts(kernel, r->contacts_before);
  slave_kinks_begin(&r->kinks, kernel, beside);
  for (int64_t k = 0; k < s->completed.n && status == ALI3_OK; k++) {
    status =
        ali3_run(kernel, s->completed.h, 1, inputs_at(s, r, (double)(k + 1) * s->completed.h), 1, NULL, NULL, NULL);
    ali3_contacts(kernel, r->contacts_after);
    *contact = *contact || memcmp(r->contacts_before, r->contacts_after, (size_t)z.ne) != 0;
    slave_kinks_after(&r->kinks, kernel);
  }
  return status;
}

/* Adds `weight` times the outputs at the end of one of the two replays. */
static slave_status add_outputs(slave *s, replay *r, double factor, double weight, bool left_out, double *out) {
  const slave_table *t = &slave_the_table;
  /* a one-sided difference has no kink at the end of an input's range */
  const bool beside = weight < 0.0 && r->plus != 0.0 && r->minus != 0.0;
  bool contact = false;
  ali3_status status = begin(s, r, factor);
  if (status == ALI3_OK) status = run(s, r, beside, &contact);
  if (status != ALI3_OK)
    return slave_log(s, SLAVE_ERROR, "The directional derivative could not be found: %s.",
                     slave_reason_text(s, status));
  if (contact)
    return slave_log(s, SLAVE_ERROR,
                     "There is no directional derivative of this communication step: a contact with the road was made "
                     "or lost in it.");
  if (slave_kinks_report(s, &r->kinks) != SLAVE_OK) return SLAVE_ERROR;
  ali3_report report;
  ali3_report_get(s->fidelity.kernel, &report);
  const bool divided_differently = r->divisions >= 0 && report.divisions != r->divisions;
  r->divisions = report.divisions;
  if (divided_differently)
    return slave_log(
        s, SLAVE_ERROR,
        "There is no directional derivative of this communication step: a force changes abruptly in it, and "
        "its inner steps are divided there otherwise with inputs a little higher than lower.");
  s->outputs = SLAVE_STALE;
  if (!slave_compute_outputs(s) || (left_out && !slave_omitted_outputs(s, NULL, 0))) return SLAVE_ERROR;
  for (size_t i = t->n_known; i < t->n_variables; i++)
    if (t->variable[i].source == SLAVE_SENSOR) out[i] += weight * s->value[i];
  return SLAVE_OK;
}

/* Refuses a step with halved inner steps, which is a different function of nearby inputs. */
static slave_status check_halvings(slave *s, replay *r) {
  ali3_report start, end;
  ali3_report_get(s->fidelity.kernel, &end);
  ali3_snapshot_restore(s->fidelity.kernel, s->fidelity.start);
  ali3_report_get(s->fidelity.kernel, &start);
  r->divided = start.divisions != end.divisions;
  if (start.halvings == end.halvings) return SLAVE_OK;
  return slave_log(s, SLAVE_ERROR,
                   "There is no directional derivative of this communication step: an inner step of it was halved; "
                   "a smaller step_size may leave it whole.");
}

slave_status slave_step_derivative(slave *s, const double *direction, bool left_out, double *out) {
  replay r;
  if (s->completed.n == 0)
    return slave_log(s, SLAVE_ERROR,
                     "There is no communication step to differentiate; after initialisation it takes one step.");
  if (2.0 * (double)s->completed.n > slave_steps_left(s))
    return slave_log(s, SLAVE_ERROR,
                     "The derivatives make the %.0f inner steps of the communication step twice, and a call that has "
                     "begun cannot be cancelled; it has %.0f. Take shorter communication steps.",
                     (double)s->completed.n, slave_steps_left(s));
  if (!allocate(s, &r)) return slave_log(s, SLAVE_ERROR, "There is not enough memory for the derivatives.");
  store_end(s, &r);
  set_direction(&r, direction);
  slave_status status = r.direction_size > 0.0 ? check_halvings(s, &r) : SLAVE_OK;
  const double weight = r.direction_size / (r.plus - r.minus);
  if (r.direction_size > 0.0 && status == SLAVE_OK) status = add_outputs(s, &r, r.plus, weight, left_out, out);
  if (r.direction_size > 0.0 && status == SLAVE_OK) status = add_outputs(s, &r, r.minus, -weight, left_out, out);
  ali3_set_settings(s->fidelity.kernel, &r.settings);
  ali3_snapshot_restore(s->fidelity.kernel, r.end);
  s->outputs = SLAVE_STALE;
  s->memory.release(r.end);
  return status;
}
