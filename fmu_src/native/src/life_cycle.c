/* Life cycle of an instance: creation, set-up, initialisation, termination, reset and release. */
#include <math.h>
#include <string.h>

#include "slave.h"

/* Allocates one block for all arrays of the instance; false if there is no memory. */
static bool allocate_arrays(slave *s) {
  const slave_table *t = &slave_the_table;
  const ali3_sizes z = ali3_system_sizes(s->fidelity.system);
  const size_t numbers = 2 * t->n_variables + 2 * t->n_known * SLAVE_TERMS + (size_t)z.nu;
  const size_t port_times_size = t->n_known * sizeof *s->port_times;
  const size_t text_size = t->n_texts * sizeof *s->text;
  const size_t flag_size = 2 * t->n_known + t->n_variables + (size_t)z.ns;
  const size_t list_size = t->n_variables * (sizeof *s->sensor + sizeof *s->output);
  double *pool =
      s->memory.allocate(1, numbers * sizeof(double) + port_times_size + text_size + list_size + flag_size + 1);
  if (pool == NULL) {
    slave_log(s, SLAVE_ERROR, "There is not enough memory for an instance.");
    return false;
  }
  s->value = pool;
  s->slope = s->value + t->n_variables;
  s->completed_slope = s->slope + t->n_known * SLAVE_TERMS;
  s->sensors = s->completed_slope + t->n_known * SLAVE_TERMS;
  s->direction = s->sensors + t->n_variables;
  s->port_times = (slave_port_times *)(s->direction + z.nu);
  s->text = (slave_text_value *)(s->port_times + t->n_known);
  s->sensor = (int32_t *)(s->text + t->n_texts);
  s->output = (uint32_t *)(s->sensor + t->n_variables);
  s->pending = (unsigned char *)(s->output + t->n_variables);
  s->input_flags = s->pending + t->n_known;
  s->fresh = s->input_flags + t->n_known;
  s->known = s->fresh + t->n_variables;
  return true;
}

/* A copy of a text; NULL if there is no memory. */
static char *copy_text(const ali3_memory *memory, const char *text) {
  char *copy = memory->allocate(1, strlen(text) + 1);
  if (copy != NULL) strcpy(copy, text);
  return copy;
}

/* Loads the System of the fidelity that is the start value, and allocates the arrays; false: an error was logged. */
static bool load(slave *s, const char *resources) {
  const slave_table *t = &slave_the_table;
  size_t fidelity = 0;
  s->fidelity_reference = t->n_variables;
  for (size_t i = 0; i < t->n_known; i++)
    if (t->variable[i].source == SLAVE_FIDELITY) {
      s->fidelity_reference = i;
      fidelity = (size_t)t->variable[i].start;
    }
  s->resources = copy_text(&s->memory, resources);
  if (s->resources == NULL) {
    slave_log(s, SLAVE_ERROR, "There is not enough memory for an instance.");
    return false;
  }
  return slave_fidelity_load(s, fidelity, &s->fidelity) && allocate_arrays(s);
}

/* Sets all variables to their start values and forgets every earlier step and warning. */
static void set_start_values(slave *s) {
  const slave_table *t = &slave_the_table;
  const slave_call_state calls = {.phase = SLAVE_INSTANTIATED, .stop_time = HUGE_VAL};
  s->calls = calls;
  s->last_step = SLAVE_OK;
  s->completed.n = 0;
  s->intermediate.n = 0;
  slave_half_steps_free(s);
  slave_forget_refusal(s);
  s->outputs = SLAVE_STALE;
  s->uncomputed_warned = s->overturned_warned = s->rim_warned = s->error_warned = s->unchecked_logged = false;
  memset(s->pending, 0, t->n_known);
  memset(s->input_flags, 0, t->n_known);
  memset(s->port_times, 0, t->n_known * sizeof *s->port_times);
  memset(s->slope, 0, 2 * t->n_known * SLAVE_TERMS * sizeof(double)); /* and completed_slope */
  for (size_t i = 0; i < t->n_variables; i++) {
    s->value[i] = t->variable[i].start;
    if (t->variable[i].source == SLAVE_STEP_SIZE) s->step_reference = i;
    if (t->variable[i].source == SLAVE_STEP_ITERATIONS) s->iterations_reference = i;
    if (t->variable[i].source == SLAVE_LEAD) s->lead_reference = i;
  }
}

slave *slave_new(const ali3_memory *memory, void *host, slave_logger *logger, bool logging, const char *name,
                 const char *token, const char *resources) {
  slave *s = memory->allocate(1, sizeof *s);
  if (s == NULL) return NULL;
  memset(s, 0, sizeof *s);
  s->memory = *memory;
  s->host = host;
  s->logger = logger;
  s->logging = logging;
  s->all_categories = true;
  s->name = copy_text(memory, name != NULL ? name : "");
  bool loaded = false;
  if (s->name == NULL)
    slave_log(s, SLAVE_ERROR, "There is not enough memory for an instance.");
  else if (name == NULL || name[0] == 0)
    slave_log(s, SLAVE_ERROR, "An instance needs a name.");
  else if (token == NULL || strcmp(token, slave_the_table.token) != 0)
    slave_log(s, SLAVE_ERROR, "The GUID %.64s does not belong to this FMU; its GUID is %s.",
              token != NULL ? token : "(none)", slave_the_table.token);
  else if (resources == NULL)
    slave_log(s, SLAVE_ERROR, "The location of the resources is missing; this FMU reads its System there.");
  else
    loaded = load(s, resources);
  if (!loaded) {
    slave_free(s);
    return NULL;
  }
  set_start_values(s);
  if (slave_texts_reset(s)) return s;
  slave_free(s);
  return NULL;
}

/* Logs what is known only at the end of a run. */
static void end_run(slave *s) {
  slave_half_steps_end(s);
  slave_watch(s);
}

void slave_free(slave *s) {
  if (s == NULL) return;
  void (*const release)(void *) = s->memory.release;
  end_run(s);
  if (s->value != NULL) release(s->value);
  slave_half_steps_free(s);
  slave_intermediate_free(s);
  slave_fidelity_free(s, &s->fidelity);
  slave_fidelity_free(s, &s->follower);
  if (s->resources != NULL) release(s->resources);
  if (s->name != NULL) release(s->name);
  release(s);
}

bool slave_check_tolerance(slave *s, bool defined, double tolerance) {
  if (!defined || (tolerance >= 0.0 && tolerance < HUGE_VAL)) return true;
  slave_log(s, SLAVE_ERROR, "The tolerance is %g; a finite number of at least 0 is needed.", tolerance);
  return false;
}

slave_status slave_setup(slave *s, double start_time, bool stop_defined, double stop_time) {
  if (!(fabs(start_time) < HUGE_VAL))
    return slave_log(s, SLAVE_ERROR, "The start time is %g s; a finite number is needed.", start_time);
  if (stop_defined && !(stop_time >= start_time))
    return slave_log(s, SLAVE_ERROR, "The stop time %g s lies before the start time %g s.", stop_time, start_time);
  s->calls.start_time = start_time;
  for (size_t i = 0; i < slave_the_table.n_known; i++)
    s->port_times[i].last_set = s->port_times[i].changed = s->port_times[i].seen = start_time;
  s->calls.stop_time = stop_defined ? stop_time : HUGE_VAL;
  slave_invalidate(s);
  return SLAVE_OK;
}

slave_status slave_enter(slave *s) {
  s->calls.phase = SLAVE_INITIALISING;
  return SLAVE_OK;
}

slave_status slave_exit(slave *s) {
  if (!s->calls.initialised && !slave_initialise(s)) return SLAVE_ERROR;
  s->calls.phase = SLAVE_STEPPING;
  slave_texts_warn(s);
  slave_watch_start(s);
  return slave_log(s, SLAVE_OK, "Initialised at %g s.", s->calls.start_time);
}

slave_status slave_terminate(slave *s) {
  end_run(s);
  s->calls.phase = SLAVE_TERMINATED;
  return SLAVE_OK;
}

slave_status slave_reset(slave *s) {
  end_run(s);
  ali3_reset(s->fidelity.kernel);
  set_start_values(s);
  return slave_texts_reset(s) ? SLAVE_OK : SLAVE_ERROR;
}
