/* What held inputs do to the end of the last communication step: it is made again from its start, with the inputs a
 * little higher and a little lower, each inner step down to round-off. The state after it then comes back. */
#include <math.h>
#include <string.h>

#include "slave.h"

static const double PART = 3e-4; /* of an input's range: the difference to each side */
/* Of an inner step or a part of it: Newton's loop converges by a factor of ten or more. And parts that it may have. */
enum { ITERATIONS = 12, PARTS = 32 };

typedef struct { /* in one block, but for the settings */
  void *end;                        /* snapshot of the kernel */
  double *held, *unit, *set, *row, *asked; /* nu: inputs of the step, direction in parts of their ranges, work */
  double *parameter;                /* np: of the step */
  unsigned char *before, *after;    /* ne: contacts */
  slave_kinks kinks;
  double size, plus, minus; /* of the direction; ends of the difference, one of them 0 at the end of a range */
  bool divided; /* the step was, at abrupt forces */
  int64_t divisions; /* counted in the replay before; below 0: there is none */
  ali3_settings settings;
} replay;

static bool allocate(slave *s, replay *r) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  const size_t nu = (size_t)z.nu, ne = (size_t)z.ne, snapshot = ali3_snapshot_size(s->fidelity.system);
  r->end = s->memory.allocate(1, snapshot + (5 * nu + (size_t)z.np) * sizeof(double) + 3 * ne * sizeof(uint32_t) +
                                     3 * ne + 1);
  if (r->end == NULL) return false;
  r->held = (double *)((unsigned char *)r->end + snapshot);
  r->unit = r->held + nu;
  r->set = r->unit + nu;
  r->row = r->set + nu;
  r->asked = r->row + nu;
  r->parameter = r->asked + nu;
  uint32_t *const piece = (uint32_t *)(r->parameter + z.np);
  r->before = (unsigned char *)(piece + 3 * ne);
  r->after = r->before + ne;
  r->kinks = (slave_kinks){piece, piece + ne, piece + 2 * ne, r->after + ne, z.ne};
  memset(r->kinks.passed, 0, ne);
  r->divisions = -1;
  return true;
}

/* The step as it was made: what it ended with, and what its start does not have. */
static void look(slave *s, replay *r) {
  ali3_snapshot_take(s->fidelity.kernel, r->end);
  ali3_get_settings(s->fidelity.kernel, &r->settings);
  slave_look_at_step(s, r->parameter, r->held);
}

/* The direction in parts of the inputs' ranges, and how far to go each way. */
static void aim(replay *r, const double *direction) {
  const slave_table *t = &slave_the_table;
  r->size = 0.0;
  r->plus = PART;
  r->minus = -PART;
  for (size_t i = 0; i < t->n_known; i++) {
    const slave_variable *v = &t->variable[i];
    const double range = (v->max - v->min) / fabs(v->scale);
    if (v->source == SLAVE_INPUT) r->size = fmax(r->size, fabs(direction[v->index]) / (range < 1e300 ? range : 1.0));
  }
  for (size_t i = 0; i < t->n_known && r->size > 0.0; i++) {
    const slave_variable *v = &t->variable[i];
    if (v->source != SLAVE_INPUT) continue;
    const double unit = direction[v->index] / r->size, held = r->held[v->index];
    r->unit[v->index] = unit;
    const double up = v->scale * (held + PART * unit), down = v->scale * (held - PART * unit);
    if (up > v->max || up < v->min) r->plus = 0.0;
    if (down > v->max || down < v->min) r->minus = 0.0;
  }
  if (r->plus == r->minus) r->plus = PART; /* at two ends at once */
}

/* The inputs of this run at `elapsed` after the communication point. */
static const double *row_at(const slave *s, const replay *r, double elapsed) {
  memcpy(r->row, r->set, (size_t)ali3_system_sizes(s->fidelity.system).nu * sizeof(double));
  const size_t nu = (size_t)ali3_system_sizes(s->fidelity.system).nu;
  if (s->asked.n > 0) { /* what is held is what was reached */
    slave_asked_at(s, elapsed, s->made.h, r->asked);
    const double *const reached = s->asked.row + (size_t)s->asked.n * nu;
    for (size_t i = 0; i < nu; i++) r->row[i] += r->asked[i] - reached[i];
  } else if (s->made.sloped) {
    slave_add_slopes(s->made_slope, elapsed, r->row);
  }
  return r->row;
}

/* Starts the step again with `part` of the direction added to its inputs. */
static ali3_status begin(slave *s, const replay *r, double part) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_settings exact = r->settings;
  exact.max_iterations = ITERATIONS;
  exact.step_iterations = ITERATIONS * PARTS;
  if (!r->divided) exact.max_halvings = 0; /* nor are the replays, however abrupt their inputs are */
  exact.tolerance_r = 1e-300;
  ali3_snapshot_restore(kernel, s->fidelity.start);
  for (int32_t i = 0; i < z.nu; i++) r->set[i] = r->held[i] + part * r->unit[i];
  const ali3_status status = ali3_set_settings(kernel, &exact);
  return status == ALI3_OK ? slave_set_step(s, r->parameter, row_at(s, r, 0.0)) : status;
}

/* To its end; *contact: one with a road was made or lost on the way. */
static ali3_status run(slave *s, replay *r, bool beside, bool *contact) {
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  ali3_instance *kernel = s->fidelity.kernel;
  ali3_status status = ALI3_OK;
  ali3_contacts(kernel, r->before);
  slave_kinks_begin(&r->kinks, kernel, beside);
  for (int64_t k = 0; k < s->made.n && status == ALI3_OK; k++) {
    status = ali3_run(kernel, s->made.h, 1, row_at(s, r, (double)(k + 1) * s->made.h), 1, NULL, NULL, NULL);
    ali3_contacts(kernel, r->after);
    *contact = *contact || memcmp(r->before, r->after, (size_t)z.ne) != 0;
    slave_kinks_after(&r->kinks, kernel);
  }
  return status;
}

/* Adds weight times the outputs at the end of one of the two. */
static slave_status add(slave *s, replay *r, double part, double weight, bool left_out, double *out) {
  const slave_table *t = &slave_the_table;
  /* a kink at the end of an input's range is none to the one side that there is */
  const bool beside = weight < 0.0 && r->plus != 0.0 && r->minus != 0.0;
  bool contact = false;
  ali3_status status = begin(s, r, part);
  if (status == ALI3_OK) status = run(s, r, beside, &contact);
  if (status != ALI3_OK)
    return slave_say(s, SLAVE_ERROR, "The directional derivative could not be found: %s.", slave_reason(s, status));
  if (contact)
    return slave_say(s, SLAVE_ERROR,
                     "There is no directional derivative of this communication step: a contact with the road was made "
                     "or lost in it.");
  if (slave_kinks_say(s, &r->kinks) != SLAVE_OK) return SLAVE_ERROR;
  ali3_report made;
  ali3_report_get(s->fidelity.kernel, &made);
  const bool otherwise = r->divisions >= 0 && made.divisions != r->divisions;
  r->divisions = made.divisions;
  if (otherwise)
    return slave_say(
        s, SLAVE_ERROR,
        "There is no directional derivative of this communication step: a force changes abruptly in it, and "
        "its inner steps are divided there otherwise with inputs a little higher than lower.");
  s->outputs = SLAVE_STALE;
  if (!slave_outputs(s) || (left_out && !slave_follow(s, NULL, 0))) return SLAVE_ERROR;
  for (size_t i = t->n_known; i < t->n_variables; i++)
    if (t->variable[i].source == SLAVE_SENSOR) out[i] += weight * s->value[i];
  return SLAVE_OK;
}

/* A step that had to be halved is another function of its inputs nearby. */
static slave_status check_halvings(slave *s, replay *r) {
  ali3_report start, end;
  ali3_report_get(s->fidelity.kernel, &end);
  ali3_snapshot_restore(s->fidelity.kernel, s->fidelity.start);
  ali3_report_get(s->fidelity.kernel, &start);
  r->divided = start.divisions != end.divisions;
  if (start.halvings == end.halvings) return SLAVE_OK;
  return slave_say(s, SLAVE_ERROR,
                   "There is no directional derivative of this communication step: an inner step of it was halved; "
                   "a smaller step_size may leave it whole.");
}

/* out (n_variables): the change of the outputs that are sensors per unit of the direction (nu); left_out: also of those
 * that the System at work leaves out. The instance stays as it is. */
slave_status slave_step_derivative(slave *s, const double *direction, bool left_out, double *out) {
  replay r;
  if (s->made.n == 0)
    return slave_say(s, SLAVE_ERROR,
                     "There is no communication step to differentiate; after initialisation it takes one step.");
  if (2.0 * (double)s->made.n > slave_steps_left(s))
    return slave_say(s, SLAVE_ERROR,
                     "The derivatives make the %.0f inner steps of the communication step twice, and a call that has "
                     "begun cannot be cancelled; it has %.0f. Take shorter communication steps.",
                     (double)s->made.n, slave_steps_left(s));
  if (!allocate(s, &r)) return slave_say(s, SLAVE_ERROR, "There is not enough memory for the derivatives.");
  look(s, &r);
  aim(&r, direction);
  slave_status status = r.size > 0.0 ? check_halvings(s, &r) : SLAVE_OK;
  const double weight = r.size / (r.plus - r.minus);
  if (r.size > 0.0 && status == SLAVE_OK) status = add(s, &r, r.plus, weight, left_out, out);
  if (r.size > 0.0 && status == SLAVE_OK) status = add(s, &r, r.minus, -weight, left_out, out);
  ali3_set_settings(s->fidelity.kernel, &r.settings);
  ali3_snapshot_restore(s->fidelity.kernel, r.end);
  s->outputs = SLAVE_STALE;
  s->memory.release(r.end);
  return status;
}
