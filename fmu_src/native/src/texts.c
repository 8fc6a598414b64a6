/* Text variables: the files of roads, which are fixed parameters. The kernel loads a road when its text is set, so that
 * errors are reported then. */
#include <stdio.h>
#include <string.h>

#include "slave.h"

/* Writes the path of a road file; a name without a folder is one in the resources. False: the path is too long, and an
 * error was logged. */
static bool write_path(slave *s, const char *name, const char *value, char *path) {
  if (strchr(value, '/') == NULL && strchr(value, '\\') == NULL) {
    const int n = snprintf(path, SLAVE_PATH, "%s/roads/%s", s->resources, value);
    if (n >= 0 && n < SLAVE_PATH) return true;
  } else if (slave_path_of_uri(value, path, SLAVE_PATH)) {
    return true;
  }
  slave_log(s, SLAVE_ERROR, "'%s': the path '%.128s...' is too long.", name, value);
  return false;
}

/* Loads the road of a text into a kernel. False: an error was logged and the kernel keeps its road. */
static bool set_road(slave *s, ali3_instance *kernel, const slave_text *t, const char *value) {
  char path[SLAVE_PATH] = "", why[256];
  if (value[0] != 0 && !write_path(s, t->name, value, path)) return false;
  const ali3_status status = ali3_set_road(kernel, t->road, path, why, sizeof why);
  if (status == ALI3_OK) return true;
  slave_log(s, SLAVE_ERROR, "'%s' cannot be '%.256s' (%.256s): %s.", t->name, value, path,
            why[0] != 0 ? why : ali3_status_text(status));
  return false;
}

bool slave_texts_apply(slave *s, ali3_instance *kernel, const slave_text_value *value) {
  for (size_t k = 0; k < slave_the_table.n_texts; k++)
    if (!set_road(s, kernel, &slave_the_table.text[k], value[k])) return false;
  return true;
}

bool slave_texts_reset(slave *s) {
  slave_text_value start;
  for (size_t k = 0; k < slave_the_table.n_texts; k++) {
    const slave_text *t = &slave_the_table.text[k];
    memset(start, 0, sizeof start);
    snprintf(start, sizeof start, "%s", t->start);
    if (memcmp(s->text[k], start, sizeof start) != 0 && !set_road(s, s->fidelity.kernel, t, start)) return false;
    memcpy(s->text[k], start, sizeof start);
  }
  return true;
}

/* Whether all references are text variables; if not, an error is logged. */
static bool are_texts(slave *s, uint32_t first, const uint32_t *reference, size_t n) {
  for (size_t i = 0; i < n; i++)
    if (reference[i] < first || reference[i] - first >= slave_the_table.n_texts) {
      slave_log(s, SLAVE_ERROR, "There is no text variable with value reference %u.", (unsigned)reference[i]);
      return false;
    }
  return true;
}

slave_status slave_get_text(slave *s, uint32_t first, const uint32_t *reference, size_t n, const char **value) {
  if (!are_texts(s, first, reference, n)) return SLAVE_ERROR;
  for (size_t i = 0; i < n; i++) value[i] = s->text[reference[i] - first];
  return SLAVE_OK;
}

slave_status slave_set_text(slave *s, uint32_t first, const uint32_t *reference, size_t n, const char *const *value) {
  if (!are_texts(s, first, reference, n)) return SLAVE_ERROR;
  for (size_t i = 0; i < n; i++) {
    const char *name = slave_the_table.text[reference[i] - first].name;
    if (!(s->calls.phase & (SLAVE_INSTANTIATED | SLAVE_INITIALISING)))
      return slave_log(s, SLAVE_ERROR, "'%s' cannot be set %s; it is a fixed parameter.", name,
                       slave_phase_name(s->calls.phase));
    if (value[i] == NULL) return slave_log(s, SLAVE_ERROR, "'%s' was set to no text at all.", name);
    if (strlen(value[i]) >= SLAVE_MAX_TEXT)
      return slave_log(s, SLAVE_ERROR, "'%s' was set to a text of %zu bytes; at most %d are taken.", name,
                       strlen(value[i]), SLAVE_MAX_TEXT - 1);
  }
  for (size_t i = 0; i < n; i++)
    if (!set_road(s, s->fidelity.kernel, &slave_the_table.text[reference[i] - first], value[i])) {
      while (i-- > 0) { /* restores the roads that were changed */
        const size_t k = reference[i] - first;
        set_road(s, s->fidelity.kernel, &slave_the_table.text[k], s->text[k]);
      }
      return SLAVE_ERROR;
    }
  for (size_t i = 0; i < n; i++) {
    char *to = s->text[reference[i] - first];
    const size_t length = strlen(value[i]);
    memmove(to, value[i], length);
    memset(to + length, 0, SLAVE_MAX_TEXT - length);
  }
  slave_invalidate(s);
  return SLAVE_OK;
}

static const double REST_SPEED = 0.01; /* m/s */

void slave_texts_warn(slave *s) {
  char text[SLAVE_TEXT / 2];
  if (ali3_start_text(s->fidelity.kernel, text, sizeof text) == ALI3_OK && text[0] != 0)
    slave_log(s, SLAVE_WARNING,
              "%s With 'initial.settling' of 3 it begins at rest in the road, or in its motion along it.", text);
  if (ali3_unsettled(s->fidelity.kernel) > REST_SPEED)
    slave_log(s, SLAVE_WARNING,
              "The start has not settled: parts still move at %.1g m/s; 'initial.settling' should be longer.",
              ali3_unsettled(s->fidelity.kernel));
  for (size_t i = 0; i < slave_the_table.n_known; i++) {
    const slave_variable *v = &slave_the_table.variable[i];
    if (s->value[i] != v->start && slave_has_no_effect(s, v))
      slave_log(s, SLAVE_WARNING, "'%s' is %.10g%s, without effect: it is of the built-in road.", v->name, s->value[i],
                v->unit);
  }
}

bool slave_has_no_effect(const slave *s, const slave_variable *v) {
  for (size_t k = 0; k < slave_the_table.n_texts; k++)
    if (slave_the_table.text[k].road == v->road && s->text[k][0] != 0) return true;
  return false;
}
