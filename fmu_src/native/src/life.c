/* From the first to the last call of an instance. */
#include <math.h>
#include <string.h>

#include "slave.h"

static const char SYSTEM_FILE[] = "system.ali3";

/* One block behind the instance for all its arrays; 0 if there is no memory. */
static bool take_arrays(slave *s) {
  const slave_table *t = &slave_the_table;
  const ali3_sizes z = ali3_system_sizes(s->system);
  const size_t numbers = t->n_variables + t->n_known * SLAVE_MOST_ORDERS + (size_t)z.ns + 2 * (size_t)z.nu;
  const size_t saved = ali3_state_size(s->system);
  double *pool = s->memory.allocate(1, numbers * sizeof(double) + saved + 2 * t->n_known + (size_t)z.ns + 1);
  if (pool == NULL) return false;
  s->value = pool;
  s->slope = s->value + t->n_variables;
  s->sensors = s->slope + t->n_known * SLAVE_MOST_ORDERS;
  s->direction = s->sensors + z.ns;
  s->input = s->direction + z.nu;
  s->saved = (unsigned char *)(s->input + z.nu);
  s->pending = s->saved + saved;
  s->clamped = s->pending + t->n_known;
  s->known = s->clamped + t->n_known;
  return true;
}

/* Whether the table and the System speak of the same things. */
static bool table_fits(const slave *s) {
  const slave_table *t = &slave_the_table;
  const ali3_sizes z = ali3_system_sizes(s->system);
  if (t->n_variables != t->n_known + (size_t)z.ns || t->n_rows != (size_t)z.nc) return false;
  for (size_t i = 0; i < t->n_variables; i++) {
    const slave_variable *v = &t->variable[i];
    const int32_t limit[] = {z.nu, z.np, z.has_pose ? 5 : 0, 1, z.ns};
    if (v->index < 0 || v->index >= limit[v->source]) return false;
  }
  return true;
}

static bool load(slave *s, const char *resources) {
  char message[256] = "";
  size_t size = 0;
  unsigned char *bytes = slave_read(resources, SYSTEM_FILE, &s->memory, &size);
  if (bytes == NULL) {
    slave_say(s, SLAVE_ERROR, "The file %s of the FMU cannot be read in %s.", SYSTEM_FILE, resources);
    return false;
  }
  ali3_status status = ali3_system_load_with(bytes, size, &s->memory, &s->system, message, sizeof message);
  s->memory.release(bytes);
  if (status == ALI3_OK && !table_fits(s)) {
    slave_say(s, SLAVE_ERROR, "The file %s does not belong to this FMU.", SYSTEM_FILE);
    return false;
  }
  if (status == ALI3_OK) status = ali3_instance_new(s->system, &s->kernel);
  if (status == ALI3_OK && !take_arrays(s)) status = ALI3_NO_MEMORY;
  if (status != ALI3_OK)
    slave_say(s, SLAVE_ERROR, "The file %s was refused: %s%s%s.", SYSTEM_FILE, ali3_status_text(status),
              message[0] != 0 ? ": " : "", message);
  return status == ALI3_OK;
}

static void start_values(slave *s) {
  const slave_table *t = &slave_the_table;
  const slave_memory_of_calls calls = {SLAVE_INSTANTIATED, 0, 0, 0.0, HUGE_VAL};
  s->calls = calls;
  s->outputs_fresh = false;
  memset(s->pending, 0, t->n_known);
  memset(s->clamped, 0, t->n_known);
  memset(s->slope, 0, t->n_known * SLAVE_MOST_ORDERS * sizeof(double));
  for (size_t i = 0; i < t->n_variables; i++) {
    s->value[i] = t->variable[i].start;
    if (t->variable[i].source == SLAVE_STEP_SIZE) s->step_reference = i;
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
  s->name = memory->allocate(1, (name != NULL ? strlen(name) : 0) + 1);
  if (s->name != NULL) strcpy(s->name, name != NULL ? name : "");
  bool good = false;
  if (s->name == NULL)
    slave_say(s, SLAVE_ERROR, "There is not enough memory for an instance.");
  else if (name == NULL || name[0] == 0)
    slave_say(s, SLAVE_ERROR, "An instance needs a name.");
  else if (token == NULL || strcmp(token, slave_the_table.token) != 0)
    slave_say(s, SLAVE_ERROR, "The GUID %.64s does not belong to this FMU; its GUID is %s.",
              token != NULL ? token : "(none)", slave_the_table.token);
  else if (resources == NULL)
    slave_say(s, SLAVE_ERROR, "The location of the resources is missing; this FMU reads %s there.", SYSTEM_FILE);
  else
    good = load(s, resources);
  if (!good) {
    slave_free(s);
    return NULL;
  }
  start_values(s);
  const ali3_sizes z = ali3_system_sizes(s->system);
  slave_say(s, SLAVE_OK, "System loaded: %d coordinates, %d rows, %d inputs, %d outputs.", (int)z.nq, (int)z.nc,
            (int)z.nu, (int)z.ns);
  return s;
}

void slave_free(slave *s) {
  if (s == NULL) return;
  void (*const release)(void *) = s->memory.release;
  if (s->value != NULL) release(s->value);
  if (s->kernel != NULL) ali3_instance_free(s->kernel);
  if (s->system != NULL) ali3_system_free(s->system);
  if (s->name != NULL) release(s->name);
  release(s);
}

slave_status slave_setup(slave *s, double start_time, bool stop_defined, double stop_time) {
  if (!(fabs(start_time) < HUGE_VAL))
    return slave_say(s, SLAVE_ERROR, "The start time is %g s; a finite number is needed.", start_time);
  if (stop_defined && !(stop_time > start_time))
    return slave_say(s, SLAVE_ERROR, "The stop time %g s does not lie after the start time %g s.", stop_time,
                     start_time);
  s->calls.start_time = start_time;
  s->calls.stop_time = stop_defined ? stop_time : HUGE_VAL;
  slave_stale(s);
  return SLAVE_OK;
}

slave_status slave_enter(slave *s) {
  s->calls.phase = SLAVE_INITIALISING;
  return SLAVE_OK;
}

slave_status slave_exit(slave *s) {
  if (!s->calls.initialised && !slave_initialise(s)) return SLAVE_ERROR;
  s->calls.phase = SLAVE_STEPPING;
  return slave_say(s, SLAVE_OK, "Initialised at %g s.", s->calls.start_time);
}

slave_status slave_terminate(slave *s) {
  s->calls.phase = SLAVE_TERMINATED;
  return SLAVE_OK;
}

slave_status slave_reset(slave *s) {
  ali3_reset(s->kernel);
  start_values(s);
  return SLAVE_OK;
}
