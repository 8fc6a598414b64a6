/* The Systems of an FMU, one file for each value of the parameter fidelity; an instance has one of them loaded. */
#include <stdio.h>
#include <string.h>

#include "slave.h"

/* Whether the indices and counts of the table fit the System. */
static bool table_fits(const ali3_system *system, size_t fidelity) {
  const slave_table *t = &slave_the_table;
  const ali3_sizes z = ali3_system_sizes(system);
  const int32_t n = (int32_t)t->n_variables;
  if (t->n_variables < t->n_known + (size_t)z.ns) return false;
  if (t->first_row[fidelity + 1] - t->first_row[fidelity] != (size_t)z.nc) return false;
  for (size_t i = 0; i < t->n_variables; i++) {
    const slave_variable *v = &t->variable[i];
    const int32_t limit[] = {z.nu, z.np, z.has_pose ? ALI3_POSE : 0, 1, 1, 1, z.has_pose ? 1 : 0,
                             1,    z.ns, ALI3_SOLVER_COUNT,          1, n, 1};
    if ((i < t->n_known) != (v->source < SLAVE_SENSOR)) return false;
    if (v->index < 0 || v->index >= limit[v->source] || v->other >= n) return false;
  }
  return true;
}

/* Makes the System call the code generated for it, which gives the same bits; `text`: whether it does, for the log. */
static void attach_generated(ali3_system *system, size_t number, char *text, size_t size) {
  const ali3_generated *code = slave_the_table.generated[number];
  char why[200];
  if (code == NULL)
    snprintf(text, size, "Its steps use the loops of the kernel, as no code was generated for it");
  else if (ali3_system_attach(system, code, why, sizeof why) == ALI3_OK)
    snprintf(text, size, "Its steps use the code that was generated for it");
  else
    snprintf(text, size, "Its steps use the loops of the kernel: %s", why);
}

void slave_fidelity_free(const slave *s, slave_fidelity *loaded) {
  if (loaded->snapshot != NULL) s->memory.release(loaded->snapshot);
  if (loaded->start != NULL) s->memory.release(loaded->start);
  if (loaded->kernel != NULL) ali3_instance_free(loaded->kernel);
  if (loaded->system != NULL) ali3_system_free(loaded->system);
  memset(loaded, 0, sizeof *loaded);
}

bool slave_fidelity_load(slave *s, size_t number, slave_fidelity *loaded) {
  char file[32], message[256] = "", code[256] = "";
  const char *why;
  size_t size = 0;
  memset(loaded, 0, sizeof *loaded);
  snprintf(file, sizeof file, "system_%u.ali3", (unsigned)number);
  if (number >= slave_the_table.n_systems) {
    slave_log(s, SLAVE_ERROR, "There is no fidelity %u in this FMU.", (unsigned)number);
    return false;
  }
  unsigned char *bytes = slave_read_resource(s->resources, file, &s->memory, &size, &why);
  if (bytes == NULL) {
    slave_log(s, SLAVE_ERROR, "The file %s of the FMU cannot be read in %s: %s.", file, s->resources, why);
    return false;
  }
  ali3_status status = ali3_system_load_with(bytes, size, &s->memory, &loaded->system, message, sizeof message);
  s->memory.release(bytes);
  if (status == ALI3_OK && !table_fits(loaded->system, number)) {
    slave_log(s, SLAVE_ERROR, "The file %s does not belong to this FMU.", file);
    slave_fidelity_free(s, loaded);
    return false;
  }
  if (status == ALI3_OK) attach_generated(loaded->system, number, code, sizeof code);
  if (status == ALI3_OK) status = ali3_instance_new(loaded->system, &loaded->kernel);
  if (status == ALI3_OK) {
    loaded->snapshot = s->memory.allocate(1, ali3_snapshot_size(loaded->system));
    loaded->start = s->memory.allocate(1, ali3_snapshot_size(loaded->system));
    if (loaded->snapshot == NULL || loaded->start == NULL) status = ALI3_NO_MEMORY;
  }
  if (status != ALI3_OK) {
    slave_log(s, SLAVE_ERROR, "The file %s was refused: %s%s%s. %s", file, ali3_status_text(status),
              message[0] != 0 ? ": " : "", message, ali3_status_remedy(status));
    slave_fidelity_free(s, loaded);
    return false;
  }
  ali3_count_work(loaded->kernel, &s->work_left);
  loaded->number = number;
  const ali3_sizes z = ali3_system_sizes(loaded->system);
  slave_log(s, SLAVE_OK, "System loaded: %d coordinates, %d rows, %d inputs, %d outputs. %s.", (int)z.nq, (int)z.nc,
            (int)z.nu, (int)z.ns, code);
  return true;
}

void slave_fidelity_replace(slave *s, const slave_fidelity *loaded) {
  slave_half_steps_free(s);
  slave_fidelity_free(s, &s->fidelity);
  s->fidelity = *loaded;
}

bool slave_fidelity_choose(slave *s) {
  slave_fidelity loaded;
  if (s->fidelity_reference == slave_the_table.n_variables) return true;
  const size_t number = (size_t)s->value[s->fidelity_reference];
  if (number == s->fidelity.number) return true;
  if (!slave_fidelity_load(s, number, &loaded)) return false;
  if (!slave_texts_apply(s, loaded.kernel, s->text)) {
    slave_fidelity_free(s, &loaded);
    return false;
  }
  slave_fidelity_replace(s, &loaded);
  return true;
}
