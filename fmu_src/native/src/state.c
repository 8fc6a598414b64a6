/* A state as bytes: a header with magic, version, identity of the FMU, size and checksum; numbers of the slave; the
 * start of the last communication step, for its derivatives; the second motion; the kernel's bytes; intermediate
 * inputs. It has no pointers, so that a run continues from it bit for bit in any process. */
#include <math.h>
#include <string.h>

#include "slave.h"

typedef struct { /* 104 bytes without padding */
  char magic[8];
  uint32_t version, crc;
  uint64_t size;
  unsigned char identity[16];
  uint8_t phase, initialised, step_warned, energy_warned, mode_warned, capped_warned, sloped, zero;
  uint32_t fidelity,
      n_known; /* fidelity of the kernel's bytes; its parameter may have another value for the next initialisation */
  double start_time, stop_time, capped_residual; /* s, s, m */
  int64_t completed_n,
      intermediate_n; /* inner steps of the last communication step, and those of them with intermediate inputs */
  double completed_h; /* s: length of its inner steps */
} header;

struct slave_state {
  size_t size;
  unsigned char bytes[];
};

static const char MAGIC[8] = {'A', 'L', 'I', '3', 'F', 'M', 'U', '2'};
/* The checksum covers the bytes after it; only serialized states have one. */
enum { STATE_VERSION = 11, CRC_OFFSET = 12, CRC_START = 16 };

uint32_t ali3_crc32(const void *bytes, size_t size); /* of the kernel */

/* Sizes in bytes: of all text variables, */
static size_t texts_size(void) { return slave_the_table.n_texts * sizeof(slave_text_value); }

/* of the header and the numbers of the slave, */
static size_t slave_size(void) {
  const size_t n = slave_the_table.n_known;
  return sizeof(header) + n * (1 + 2 * SLAVE_TERMS) * sizeof(double) + n * (sizeof(slave_port_times) + 2) +
         texts_size();
}

/* of the start of the last communication step, and with the second motion, */
static size_t start_size(const slave_fidelity *fidelity) { return ali3_snapshot_size(fidelity->system); }
static size_t motions_size(const slave_fidelity *fidelity) {
  return start_size(fidelity) + slave_half_steps_size(fidelity);
}

/* Size of the intermediate inputs of n inner steps, bytes. */
static size_t intermediate_size(const slave_fidelity *fidelity, int64_t n) {
  return n > 0 ? (size_t)(n + 1) * (size_t)ali3_system_sizes(fidelity->system).nu * sizeof(double) : 0;
}

/* and of a whole state with intermediate_n inner steps with intermediate inputs. */
static size_t state_size(const slave *s, int64_t intermediate_n) {
  return slave_size() + motions_size(&s->fidelity) + ali3_state_size(s->fidelity.system) +
         intermediate_size(&s->fidelity, intermediate_n);
}

/* Copies bytes to *to and advances it. */
static void append_bytes(unsigned char **to, const void *from, size_t size) {
  memcpy(*to, from, size);
  *to += size;
}

/* Writes the state as bytes, without a checksum. */
static void write_state(const slave *s, unsigned char *bytes) {
  const size_t n = slave_the_table.n_known, size = state_size(s, s->intermediate.n);
  const slave_call_state *c = &s->calls;
  header head = {.version = STATE_VERSION,
                 .size = size,
                 .phase = (uint8_t)c->phase,
                 .initialised = (uint8_t)c->initialised,
                 .step_warned = (uint8_t)c->step_warned,
                 .energy_warned = (uint8_t)c->energy_warned,
                 .mode_warned = (uint8_t)c->mode_warned,
                 .capped_warned = (uint8_t)c->capped_warned,
                 .fidelity = (uint32_t)s->fidelity.number,
                 .n_known = (uint32_t)n,
                 .start_time = c->start_time,
                 .stop_time = c->stop_time,
                 .capped_residual = c->capped_residual,
                 .sloped = (uint8_t)(s->completed.n > 0 && s->completed.sloped),
                 .completed_n = s->completed.n,
                 .intermediate_n = s->intermediate.n,
                 .completed_h = s->completed.n > 0 ? s->completed.h : 0.0};
  unsigned char *p = bytes;
  memcpy(head.magic, MAGIC, sizeof MAGIC);
  memcpy(head.identity, slave_the_table.identity, sizeof head.identity);
  append_bytes(&p, &head, sizeof head);
  append_bytes(&p, s->value, n * sizeof(double));
  append_bytes(&p, s->slope, n * SLAVE_TERMS * sizeof(double));
  append_bytes(&p, s->completed_slope, n * SLAVE_TERMS * sizeof(double));
  append_bytes(&p, s->port_times, n * sizeof *s->port_times);
  append_bytes(&p, s->pending, n);
  append_bytes(&p, s->input_flags, n);
  append_bytes(&p, s->text, texts_size());
  memset(p, 0, motions_size(&s->fidelity));
  if (s->completed.n > 0) memcpy(p, s->fidelity.start, start_size(&s->fidelity));
  slave_half_steps_write(s, p + start_size(&s->fidelity));
  p += motions_size(&s->fidelity);
  ali3_state_save(s->fidelity.kernel, p, ali3_state_size(s->fidelity.system));
  p += ali3_state_size(s->fidelity.system);
  if (s->intermediate.n > 0) memcpy(p, s->intermediate.row, intermediate_size(&s->fidelity, s->intermediate.n));
}

/* What is wrong with the header or the size, or NULL. */
static const char *check_header(const slave *s, const unsigned char *bytes, size_t size) {
  header head;
  if (size < sizeof head) return "they are too short";
  memcpy(&head, bytes, sizeof head);
  if (memcmp(head.magic, MAGIC, sizeof MAGIC) != 0) return "they begin with other bytes";
  if (head.version != STATE_VERSION) return "they are of another version; save one again with this FMU";
  if (memcmp(head.identity, slave_the_table.identity, sizeof head.identity) != 0)
    return "only states of the same build can be set";
  if (head.size != size || size < slave_size() || head.n_known != slave_the_table.n_known)
    return "they have another size";
  if (head.fidelity >= slave_the_table.n_systems) return "their header is inconsistent";
  if (head.intermediate_n != 0 && head.intermediate_n != head.completed_n) return "their header is inconsistent";
  if (head.intermediate_n < 0 || (uint64_t)head.intermediate_n > size) return "their header is inconsistent";
  if (head.fidelity == s->fidelity.number && size != state_size(s, head.intermediate_n))
    return "they have another size";
  if (head.phase == 0 || (head.phase & (head.phase - 1)) != 0 || head.phase > SLAVE_TERMINATED ||
      head.initialised > 1 || head.step_warned > SLAVE_LONGER_STEPS || head.energy_warned > 1 || head.mode_warned > 1 ||
      head.capped_warned > SLAVE_CAPPED_BADLY || head.sloped > 1 || head.zero != 0 || head.completed_n < 0 ||
      !(head.completed_h >= 0.0) || !(head.completed_h < HUGE_VAL) || !(fabs(head.start_time) < HUGE_VAL) ||
      !(head.stop_time >= head.start_time) || !(head.capped_residual >= 0.0) || !(head.capped_residual < HUGE_VAL))
    return "their header is inconsistent";
  if (!head.initialised && head.phase > SLAVE_INITIALISING) return "their header is inconsistent";
  return NULL;
}

/* What is wrong with the values after the header, or NULL: they must be ones that can be set. */
static const char *check_values(const unsigned char *p) {
  const slave_table *t = &slave_the_table;
  double v;
  const size_t numbers = t->n_known * (1 + 2 * SLAVE_TERMS);
  for (size_t i = 0; i < numbers; i++) {
    memcpy(&v, p + i * sizeof v, sizeof v);
    if (!(fabs(v) < HUGE_VAL)) return "a number in them is not finite";
    if (i < t->n_known && !(v >= t->variable[i].min && v <= t->variable[i].max))
      return "a number in them is out of its range";
    if (i < t->n_known && t->variable[i].whole && v != floor(v)) return "a number in them is out of its range";
  }
  const unsigned char *flag = p + numbers * sizeof v + t->n_known * sizeof(slave_port_times);
  for (size_t i = 0; i < t->n_known; i++)
    if (flag[i] > 1) return "a flag in them is none";
  for (size_t i = 0; i < t->n_known; i++)
    if (flag[i] && t->variable[i].source != SLAVE_INPUT && t->variable[i].source != SLAVE_PARAMETER)
      return "a flag in them is none";
  const unsigned char *text = flag + 2 * t->n_known;
  for (size_t k = 0; k < t->n_texts; k++, text += SLAVE_MAX_TEXT) {
    const unsigned char *end = memchr(text, 0, SLAVE_MAX_TEXT);
    if (end == NULL) return "a text in them has no end";
    for (; end < text + SLAVE_MAX_TEXT; end++)
      if (*end != 0) return "a text in them has no end";
  }
  return NULL;
}

/* Copies bytes from *from and advances it. */
static void take_bytes(void *to, const unsigned char **from, size_t size) {
  memcpy(to, *from, size);
  *from += size;
}

/* Restores the kernel, if need be with another System or other roads. False: an error was logged and nothing
 * changed. */
static bool restore_kernel(slave *s, const header *head, const unsigned char *texts, const unsigned char *bytes,
                           size_t size) {
  const size_t fidelity = head->fidelity;
  slave_fidelity other = s->fidelity;
  const bool same = fidelity == s->fidelity.number && (texts_size() == 0 || memcmp(texts, s->text, texts_size()) == 0);
  if (!same && !slave_fidelity_load(s, fidelity, &other)) return false;
  if (!same && !slave_texts_apply(s, other.kernel, (const slave_text_value *)texts)) {
    slave_fidelity_free(s, &other);
    return false;
  }
  const size_t start = start_size(&other), motions = motions_size(&other),
               intermediate = intermediate_size(&other, head->intermediate_n);
  ali3_status status = size > motions + intermediate ? ALI3_OK : ALI3_BAD_STATE;
  if (status == ALI3_OK && head->completed_n > 0) status = ali3_snapshot_check(other.kernel, bytes);
  if (status == ALI3_OK) status = slave_half_steps_check(&other, bytes + start);
  if (status == ALI3_OK) status = ali3_state_restore(other.kernel, bytes + motions, size - motions - intermediate);
  if (status == ALI3_OK) memcpy(other.start, bytes, start);
  if (status != ALI3_OK) {
    if (!same) slave_fidelity_free(s, &other);
    slave_log(s, SLAVE_ERROR, "These bytes are not a state of this FMU: %s. %s", ali3_status_text(status),
              ali3_status_remedy(status));
    return false;
  }
  if (!same) slave_fidelity_replace(s, &other);
  s->intermediate.n = head->intermediate_n;
  if (intermediate > 0) memcpy(s->intermediate.row, bytes + size - intermediate, intermediate);
  return true;
}

/* Sets the state from bytes; on an error, which is logged, nothing changes. */
static slave_status read_state(slave *s, const unsigned char *bytes, size_t size) {
  const size_t n = slave_the_table.n_known;
  const unsigned char *p = bytes + sizeof(header);
  const char *why = check_header(s, bytes, size);
  header head;
  if (why == NULL) why = check_values(p);
  if (why != NULL) return slave_log(s, SLAVE_ERROR, "These bytes are not a state of this FMU: %s.", why);
  memcpy(&head, bytes, sizeof head);
  if (head.intermediate_n > 0 && !slave_intermediate_reserve(s, head.intermediate_n))
    return slave_log(s, SLAVE_ERROR, "There is not enough memory for a state.");
  const unsigned char *texts = bytes + slave_size() - texts_size();
  if (!restore_kernel(s, &head, texts, bytes + slave_size(), size - slave_size())) return SLAVE_ERROR;
  s->calls.phase = (slave_phase)head.phase;
  s->calls.initialised = (int32_t)head.initialised;
  s->calls.step_warned = (int32_t)head.step_warned;
  s->calls.energy_warned = (int32_t)head.energy_warned;
  s->calls.mode_warned = (int32_t)head.mode_warned;
  s->calls.capped_warned = (int32_t)head.capped_warned;
  s->calls.capped_residual = head.capped_residual;
  slave_forget_refusal(s);
  s->completed.n = head.completed_n;
  s->completed.h = head.completed_h;
  s->completed.sloped = head.sloped;
  slave_half_steps_read(s, bytes + slave_size() + start_size(&s->fidelity));
  s->calls.start_time = head.start_time;
  s->calls.stop_time = head.stop_time;
  take_bytes(s->value, &p, n * sizeof(double));
  take_bytes(s->slope, &p, n * SLAVE_TERMS * sizeof(double));
  take_bytes(s->completed_slope, &p, n * SLAVE_TERMS * sizeof(double));
  take_bytes(s->port_times, &p, n * sizeof *s->port_times);
  take_bytes(s->pending, &p, n);
  take_bytes(s->input_flags, &p, n);
  take_bytes(s->text, &p, texts_size());
  s->outputs = SLAVE_STALE;
  return SLAVE_OK;
}

/* Makes *state a state of this size; an error is logged if there is no memory. */
static slave_status allocate(slave *s, size_t size, slave_state **state) {
  if (*state != NULL && (*state)->size == size) return SLAVE_OK; /* an allocated state is overwritten */
  slave_state *allocated = s->memory.allocate(1, sizeof **state + size);
  if (allocated == NULL) return slave_log(s, SLAVE_ERROR, "There is not enough memory for a state.");
  if (*state != NULL) s->memory.release(*state);
  allocated->size = size;
  *state = allocated;
  return SLAVE_OK;
}

slave_status slave_state_get(slave *s, slave_state **state) {
  if (allocate(s, state_size(s, s->intermediate.n), state) != SLAVE_OK) return SLAVE_ERROR;
  slave_half_steps_settle(s);
  write_state(s, (*state)->bytes);
  return SLAVE_OK;
}

slave_status slave_state_set(slave *s, const slave_state *state) { return read_state(s, state->bytes, state->size); }

slave_status slave_state_free(slave *s, slave_state **state) {
  if (*state != NULL) s->memory.release(*state);
  *state = NULL;
  return SLAVE_OK;
}

slave_status slave_state_size(slave *s, const slave_state *state, size_t *size) {
  (void)s;
  *size = state->size;
  return SLAVE_OK;
}

slave_status slave_state_write(slave *s, const slave_state *state, unsigned char *bytes, size_t size) {
  if (size < state->size)
    return slave_log(s, SLAVE_ERROR, "The state needs %zu bytes, there is room for %zu.", state->size, size);
  memcpy(bytes, state->bytes, state->size);
  const uint32_t crc = ali3_crc32(bytes + CRC_START, state->size - CRC_START);
  memcpy(bytes + CRC_OFFSET, &crc, sizeof crc);
  return SLAVE_OK;
}

slave_status slave_state_read(slave *s, const unsigned char *bytes, size_t size, slave_state **state) {
  const char *why = check_header(s, bytes, size);
  uint32_t crc = 0;
  if (size >= CRC_START) memcpy(&crc, bytes + CRC_OFFSET, sizeof crc);
  if (why == NULL && crc != ali3_crc32(bytes + CRC_START, size - CRC_START)) why = "they were altered";
  if (why != NULL) return slave_log(s, SLAVE_ERROR, "These bytes are not a state of this FMU: %s.", why);
  if (allocate(s, size, state) != SLAVE_OK) return SLAVE_ERROR;
  memcpy((*state)->bytes, bytes, size);
  return SLAVE_OK;
}
