/* A state as bytes: header with magic, version, the FMU's identity, size and checksum; the slave's own numbers, the start
 * of the last communication step, of which there are derivatives, then the kernel's bytes. Flat, without pointers, so that it continues bit for bit anywhere. */
#include <math.h>
#include <string.h>

#include "slave.h"

typedef struct { /* 104 bytes without holes */
  char magic[8];
  uint32_t version, crc;
  uint64_t size;
  unsigned char identity[16];
  uint8_t phase, initialised, step_warned, energy_warned, mode_warned, capped_warned, sloped, zero;
  uint32_t fidelity, n_known; /* fidelity of the kernel's bytes; the value may be set for the next initialisation */
  double start_time, stop_time, capped_residual;
  int64_t made_n, asked_n; /* the last communication step; of how many inner steps of it inputs were given */
  double made_h;
} header;

struct slave_state {
  size_t size;
  unsigned char bytes[];
};

static const char MAGIC[8] = {'A', 'L', 'I', '3', 'F', 'M', 'U', '2'};
/* The checksum covers what follows it; it is written and read with the bytes, a state in memory needs none. */
enum { STATE_VERSION = 9, CRC_AT = 12, CHECKED_FROM = 16 };

uint32_t ali3_crc32(const void *bytes, size_t size); /* of the kernel */

static size_t texts_size(void) { return slave_the_table.n_texts * sizeof(slave_text_value); }

static size_t own_size(void) {
  const size_t n = slave_the_table.n_known;
  return sizeof(header) + n * (1 + 2 * SLAVE_TERMS) * sizeof(double) + n * (sizeof(slave_rhythm) + 2) + texts_size();
}

static size_t start_size(const slave_fidelity *fidelity) { return ali3_snapshot_size(fidelity->system); }

/* Inputs that were given within the last communication step. */
static size_t asked_size(const slave_fidelity *fidelity, int64_t n) {
  return n > 0 ? (size_t)(n + 1) * (size_t)ali3_system_sizes(fidelity->system).nu * sizeof(double) : 0;
}

static size_t whole_size(const slave *s, int64_t asked_n) {
  return own_size() + start_size(&s->fidelity) + ali3_state_size(s->fidelity.system) +
         asked_size(&s->fidelity, asked_n);
}

static void put(unsigned char **to, const void *from, size_t size) {
  memcpy(*to, from, size);
  *to += size;
}

static void save(const slave *s, unsigned char *bytes) {
  const size_t n = slave_the_table.n_known, size = whole_size(s, s->asked.n);
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
                 .sloped = (uint8_t)(s->made.n > 0 && s->made.sloped),
                 .made_n = s->made.n,
                 .asked_n = s->asked.n,
                 .made_h = s->made.n > 0 ? s->made.h : 0.0};
  unsigned char *p = bytes;
  memcpy(head.magic, MAGIC, sizeof MAGIC);
  memcpy(head.identity, slave_the_table.identity, sizeof head.identity);
  put(&p, &head, sizeof head);
  put(&p, s->value, n * sizeof(double));
  put(&p, s->slope, n * SLAVE_TERMS * sizeof(double));
  put(&p, s->made_slope, n * SLAVE_TERMS * sizeof(double));
  put(&p, s->rhythm, n * sizeof *s->rhythm);
  put(&p, s->pending, n);
  put(&p, s->said, n);
  put(&p, s->text, texts_size());
  memset(p, 0, start_size(&s->fidelity));
  if (s->made.n > 0) memcpy(p, s->fidelity.start, start_size(&s->fidelity));
  p += start_size(&s->fidelity);
  ali3_state_save(s->fidelity.kernel, p, ali3_state_size(s->fidelity.system));
  p += ali3_state_size(s->fidelity.system);
  if (s->asked.n > 0) memcpy(p, s->asked.row, asked_size(&s->fidelity, s->asked.n));
}

/* One sentence on what is wrong with the bytes, or NULL. */
static const char *problem(const slave *s, const unsigned char *bytes, size_t size) {
  header head;
  if (size < sizeof head) return "they are too short";
  memcpy(&head, bytes, sizeof head);
  if (memcmp(head.magic, MAGIC, sizeof MAGIC) != 0) return "they begin with other bytes";
  if (head.version != STATE_VERSION) return "they are of another version; save one again with this FMU";
  if (memcmp(head.identity, slave_the_table.identity, sizeof head.identity) != 0)
    return "only states of the same build can be set";
  if (head.size != size || size < own_size() || head.n_known != slave_the_table.n_known)
    return "they have another size";
  if (head.fidelity >= slave_the_table.n_systems) return "their header is inconsistent";
  if (head.asked_n != 0 && head.asked_n != head.made_n) return "their header is inconsistent";
  if (head.asked_n < 0 || (uint64_t)head.asked_n > size) return "their header is inconsistent";
  if (head.fidelity == s->fidelity.number && size != whole_size(s, head.asked_n)) return "they have another size";
  if (head.phase == 0 || (head.phase & (head.phase - 1)) != 0 || head.phase > SLAVE_TERMINATED ||
      head.initialised > 1 || head.step_warned > SLAVE_LONGER_STEPS || head.energy_warned > 1 || head.mode_warned > 1 ||
      head.capped_warned > SLAVE_CAPPED_BADLY || head.sloped > 1 || head.zero != 0 || head.made_n < 0 ||
      !(head.made_h >= 0.0) || !(head.made_h < HUGE_VAL) || !(fabs(head.start_time) < HUGE_VAL) ||
      !(head.stop_time >= head.start_time) || !(head.capped_residual >= 0.0) || !(head.capped_residual < HUGE_VAL))
    return "their header is inconsistent";
  if (!head.initialised && head.phase > SLAVE_INITIALISING) return "their header is inconsistent";
  return NULL;
}

/* The numbers of the table must be ones that could have been set. */
static const char *bad_value(const unsigned char *p) {
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
  const unsigned char *flag = p + numbers * sizeof v + t->n_known * sizeof(slave_rhythm);
  for (size_t i = 0; i < t->n_known; i++)
    if (flag[i] > 1) return "a flag in them is none";
  for (size_t i = 0; i < t->n_known; i++)
    if (flag[i] && t->variable[i].source != SLAVE_INPUT && t->variable[i].source != SLAVE_PARAMETER)
      return "a flag in them is none";
  const unsigned char *text = flag + 2 * t->n_known;
  for (size_t k = 0; k < t->n_texts; k++, text += SLAVE_MOST_TEXT) {
    const unsigned char *end = memchr(text, 0, SLAVE_MOST_TEXT);
    if (end == NULL) return "a text in them has no end";
    for (; end < text + SLAVE_MOST_TEXT; end++)
      if (*end != 0) return "a text in them has no end";
  }
  return NULL;
}

static void get(void *to, const unsigned char **from, size_t size) {
  memcpy(to, *from, size);
  *from += size;
}

/* The state of the kernel, of another System or on other roads too; false, said and nothing changed, if that fails. */
static bool restore_kernel(slave *s, const header *head, const unsigned char *texts, const unsigned char *bytes,
                           size_t size) {
  const size_t fidelity = head->fidelity;
  slave_fidelity other = s->fidelity;
  const bool same = fidelity == s->fidelity.number && (texts_size() == 0 || memcmp(texts, s->text, texts_size()) == 0);
  if (!same && !slave_fidelity_load(s, fidelity, &other)) return false;
  if (!same && !slave_texts_to(s, other.kernel, (const slave_text_value *)texts)) {
    slave_fidelity_free(s, &other);
    return false;
  }
  const size_t start = start_size(&other), asked = asked_size(&other, head->asked_n);
  ali3_status status = size > start + asked ? ALI3_OK : ALI3_BAD_STATE;
  if (status == ALI3_OK && head->made_n > 0) status = ali3_snapshot_check(other.kernel, bytes);
  if (status == ALI3_OK) status = ali3_state_restore(other.kernel, bytes + start, size - start - asked);
  if (status == ALI3_OK) memcpy(other.start, bytes, start);
  if (status != ALI3_OK) {
    if (!same) slave_fidelity_free(s, &other);
    slave_say(s, SLAVE_ERROR, "These bytes are not a state of this FMU: %s. %s", ali3_status_text(status),
              ali3_status_remedy(status));
    return false;
  }
  if (!same) slave_fidelity_take(s, &other);
  s->asked.n = head->asked_n;
  if (asked > 0) memcpy(s->asked.row, bytes + size - asked, asked);
  return true;
}

static slave_status restore(slave *s, const unsigned char *bytes, size_t size) {
  const size_t n = slave_the_table.n_known;
  const unsigned char *p = bytes + sizeof(header);
  const char *why = problem(s, bytes, size);
  header head;
  if (why == NULL) why = bad_value(p);
  if (why != NULL) return slave_say(s, SLAVE_ERROR, "These bytes are not a state of this FMU: %s.", why);
  memcpy(&head, bytes, sizeof head);
  if (head.asked_n > 0 && !slave_asked_room(s, head.asked_n))
    return slave_say(s, SLAVE_ERROR, "There is not enough memory for a state.");
  const unsigned char *texts = bytes + own_size() - texts_size();
  if (!restore_kernel(s, &head, texts, bytes + own_size(), size - own_size())) return SLAVE_ERROR;
  s->calls.phase = (slave_phase)head.phase;
  s->calls.initialised = (int32_t)head.initialised;
  s->calls.step_warned = (int32_t)head.step_warned;
  s->calls.energy_warned = (int32_t)head.energy_warned;
  s->calls.mode_warned = (int32_t)head.mode_warned;
  s->calls.capped_warned = (int32_t)head.capped_warned;
  s->calls.capped_residual = head.capped_residual;
  slave_forget_refusal(s);
  s->made.n = head.made_n;
  s->made.h = head.made_h;
  s->made.sloped = head.sloped;
  slave_half_steps_begin(s);
  s->calls.start_time = head.start_time;
  s->calls.stop_time = head.stop_time;
  get(s->value, &p, n * sizeof(double));
  get(s->slope, &p, n * SLAVE_TERMS * sizeof(double));
  get(s->made_slope, &p, n * SLAVE_TERMS * sizeof(double));
  get(s->rhythm, &p, n * sizeof *s->rhythm);
  get(s->pending, &p, n);
  get(s->said, &p, n);
  get(s->text, &p, texts_size());
  s->outputs = SLAVE_STALE;
  return SLAVE_OK;
}

static slave_status room(slave *s, size_t size, slave_state **state) {
  if (*state != NULL && (*state)->size == size) return SLAVE_OK; /* a state that is there is written over */
  slave_state *fresh = s->memory.allocate(1, sizeof **state + size);
  if (fresh == NULL) return slave_say(s, SLAVE_ERROR, "There is not enough memory for a state.");
  if (*state != NULL) s->memory.release(*state);
  fresh->size = size;
  *state = fresh;
  return SLAVE_OK;
}

slave_status slave_state_get(slave *s, slave_state **state) {
  if (room(s, whole_size(s, s->asked.n), state) != SLAVE_OK) return SLAVE_ERROR;
  save(s, (*state)->bytes);
  return SLAVE_OK;
}

slave_status slave_state_set(slave *s, const slave_state *state) { return restore(s, state->bytes, state->size); }

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
    return slave_say(s, SLAVE_ERROR, "The state needs %zu bytes, there is room for %zu.", state->size, size);
  memcpy(bytes, state->bytes, state->size);
  const uint32_t crc = ali3_crc32(bytes + CHECKED_FROM, state->size - CHECKED_FROM);
  memcpy(bytes + CRC_AT, &crc, sizeof crc);
  return SLAVE_OK;
}

slave_status slave_state_read(slave *s, const unsigned char *bytes, size_t size, slave_state **state) {
  const char *why = problem(s, bytes, size);
  uint32_t crc = 0;
  if (size >= CHECKED_FROM) memcpy(&crc, bytes + CRC_AT, sizeof crc);
  if (why == NULL && crc != ali3_crc32(bytes + CHECKED_FROM, size - CHECKED_FROM)) why = "they were altered";
  if (why != NULL) return slave_say(s, SLAVE_ERROR, "These bytes are not a state of this FMU: %s.", why);
  if (room(s, size, state) != SLAVE_OK) return SLAVE_ERROR;
  memcpy((*state)->bytes, bytes, size);
  return SLAVE_OK;
}
