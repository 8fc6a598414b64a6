/* Serialised state: header with magic, version, checksum of the System, size and own checksum; then settings, report,
 * clock and vectors, which continue a run bit for bit. */
#include <math.h>
#include <string.h>

#include "../files/crc32.h"
#include "../instance.h"
#include "../rows/assembly_mode.h"
#include "parameters.h"
#include "road_files.h"
#include "snapshot.h"
#include "vectors.h"

typedef struct { /* 40 bytes without padding */
  char magic[8];
  uint32_t version, model_crc; /* model_crc: of the System and its road files */
  uint64_t size;
  uint32_t crc, initialised;
  int64_t count;
} ali3_state_header;

static const char MAGIC[8] = {'A', 'L', 'I', '3', 'S', 'T', 'A', '\n'};
enum { CHECKED_FROM = 28 }; /* offset from which bytes are included in the checksum */
static const double MAX_MAGNITUDE = 1e60; /* of times, positions, rates, multipliers and element states */
static const int64_t MAX_COUNT = (int64_t)1 << 53; /* largest count of steps that doubles represent exactly */

size_t ali3_state_size(const ali3_system *s) {
  if (s == NULL) return 0;
  const size_t numbers = 2 + ali3_vector_count(s) + (size_t)s->size.nu + (size_t)s->size.np;
  return sizeof(ali3_state_header) + sizeof(ali3_settings) + sizeof(ali3_report) + numbers * sizeof(double);
}

/* Writes bytes and moves the position behind them. */
static void append(unsigned char **to, const void *from, size_t size) {
  if (size > 0) memcpy(*to, from, size);
  *to += size;
}

ali3_status ali3_state_save(const ali3_instance *in, void *bytes, size_t size) {
  if (in == NULL || bytes == NULL || size != ali3_state_size(in->system)) return ALI3_BAD_ARGUMENT;
  const ali3_sizes *z = &in->system->size;
  ali3_state_header header = {.version = ALI3_STATE_VERSION,
                              .model_crc = ali3_model_crc(in),
                              .size = size,
                              .initialised = (uint32_t)in->start.initialised,
                              .count = in->clock.count};
  memcpy(header.magic, MAGIC, sizeof MAGIC);
  unsigned char *p = bytes;
  append(&p, &header, sizeof header);
  append(&p, &in->settings, sizeof in->settings);
  append(&p, &in->report, sizeof in->report);
  append(&p, &in->clock.base, sizeof(double));
  append(&p, &in->clock.h, sizeof(double));
  append(&p, in->now.q, in->stored.n * sizeof(double));
  append(&p, in->inputs.set, (size_t)z->nu * sizeof(double));
  append(&p, in->parameters.value, (size_t)z->np * sizeof(double));
  header.crc = ali3_crc32((unsigned char *)bytes + CHECKED_FROM, size - CHECKED_FROM);
  memcpy(bytes, &header, sizeof header);
  return ALI3_OK;
}

/* Whether numbers are finite and small enough that energies and norms of them are finite. */
static bool numbers_valid(const unsigned char *p, size_t n) {
  for (size_t i = 0; i < n; i++) {
    double v;
    memcpy(&v, p + i * sizeof v, sizeof v);
    if (!(v >= -MAX_MAGNITUDE && v <= MAX_MAGNITUDE)) return false;
  }
  return true;
}

/* Whether n numbers are finite and in their ranges. */
static bool in_ranges(const unsigned char *p, int32_t n, const double *low, const double *high) {
  for (int32_t i = 0; i < n; i++) {
    double v;
    memcpy(&v, p + (size_t)i * sizeof v, sizeof v);
    if (!(v - v == 0.0 && v >= low[i] && v <= high[i])) return false;
  }
  return true;
}

/* A count that a report may have; a size, finite and not negative. */
static bool count_valid(int64_t n) { return n >= 0 && n < MAX_COUNT; }

static bool magnitude_valid(double x) { return x >= 0.0 && x - x == 0.0; }

/* A change of an assembly mode names a triad of the System. */
static bool branch_valid(const ali3_system *s, const ali3_report *r) {
  if (!count_valid(r->branch_changes) || !(r->branch_time - r->branch_time == 0.0)) return false;
  return r->branch_changes == 0 ||
         (r->branch_loop >= 0 && r->branch_loop < ali3_loop_count(s) && r->branch_triad >= 0 &&
          ALI3_TRIAD_ITEMS * ((int64_t)r->branch_triad + 1) <=
              s->mode_triad_ptr[r->branch_loop + 1] - s->mode_triad_ptr[r->branch_loop]);
}

/* Measures of abrupt forces. */
static bool forces_valid(const ali3_report *r) {
  return magnitude_valid(r->largest_force) && magnitude_valid(r->largest_load) && count_valid(r->abrupt_steps) &&
         count_valid(r->divisions) && magnitude_valid(r->change_rate);
}

/* Sums of the linear trend of the energy; see ali3_energy_trend. */
static bool trend_valid(const ali3_report *r) {
  return count_valid(r->free_states) && magnitude_valid(r->free_steps) && r->free_start - r->free_start == 0.0 &&
         r->free_energy - r->free_energy == 0.0 && magnitude_valid(r->free_steps_squares) &&
         magnitude_valid(r->free_energy_squares) && r->free_product - r->free_product == 0.0;
}

/* A report that an instance of the System can have. */
static bool report_valid(const ali3_system *s, const ali3_report *r) {
  return branch_valid(s, r) && forces_valid(r) && trend_valid(r) && magnitude_valid(r->work) &&
         magnitude_valid(r->kinetic_peak) && magnitude_valid(r->speed_peak) && magnitude_valid(r->velocity_path) &&
         magnitude_valid(r->predictor_path) && magnitude_valid(r->velocity_squares) &&
         magnitude_valid(r->predictor_squares) && r->energy - r->energy == 0.0 &&
         r->open_power - r->open_power == 0.0 && magnitude_valid(r->energy_floor) && magnitude_valid(r->rim_pressed) &&
         r->rim_time - r->rim_time == 0.0 && r->rim_x - r->rim_x == 0.0 && r->rim_y - r->rim_y == 0.0 &&
         count_valid(r->rim_element) && (r->rim_pressed == 0.0 || r->rim_element < s->size.ne) &&
         count_valid(r->steps) && count_valid(r->iterations) && count_valid(r->factorizations) &&
         count_valid(r->solves) && count_valid(r->halvings) && count_valid(r->failures) && count_valid(r->capped) &&
         magnitude_valid(r->capped_residual) && r->energy_error - r->energy_error == 0.0;
}

/* Checks vectors, inputs and parameters, stored in this order. */
static bool vectors_valid(const ali3_instance *in, const unsigned char *vectors) {
  const ali3_system *S = in->system;
  const unsigned char *inputs = vectors + in->stored.n * sizeof(double),
                      *parameters = inputs + (size_t)S->size.nu * sizeof(double);
  return numbers_valid(vectors, in->stored.n) && in_ranges(inputs, S->size.nu, S->input_min, S->input_max) &&
         in_ranges(parameters, S->size.np, S->par_min, S->par_max);
}

ali3_status ali3_snapshot_check(ali3_instance *in, const void *snapshot) {
  ali3_snapshot_head head;
  if (in == NULL || snapshot == NULL) return ALI3_BAD_ARGUMENT;
  const unsigned char *vectors = (const unsigned char *)snapshot + sizeof head;
  const size_t size = (size_t)in->system->size.np * sizeof(double);
  memcpy(&head, snapshot, sizeof head);
  if (!report_valid(in->system, &head.report) || !count_valid(head.count) || !(fabs(head.t_base) <= MAX_MAGNITUDE) ||
      !(head.h_last >= 0.0 && head.h_last <= MAX_MAGNITUDE) || !vectors_valid(in, vectors))
    return ALI3_BAD_STATE;
  const unsigned char *parameters = vectors + (in->stored.n + (size_t)in->system->size.nu) * sizeof(double);
  if (memcmp(parameters, in->parameters.value, size) == 0) return ALI3_OK;
  if (!ali3_parameters_set_all(in, parameters)) return ALI3_BAD_STATE;
  memcpy(in->parameters.value, in->parameters.work, size);
  return ali3_parameters_apply(in);
}

/* Reads bytes and moves the position behind them. */
static void extract(void *to, const unsigned char **from, size_t size) {
  if (size > 0) memcpy(to, *from, size);
  *from += size;
}

ali3_status ali3_state_restore(ali3_instance *in, const void *bytes, size_t size) {
  if (in == NULL || bytes == NULL) return ALI3_BAD_ARGUMENT;
  const ali3_system *S = in->system;
  const ali3_sizes *z = &S->size;
  const size_t fixed = sizeof(ali3_state_header) + sizeof(ali3_settings) + sizeof(ali3_report);
  ali3_state_header header;
  ali3_settings settings;
  ali3_report report;
  if (size != ali3_state_size(in->system)) return ALI3_BAD_STATE;
  const unsigned char *p = bytes;
  extract(&header, &p, sizeof header);
  if (memcmp(header.magic, MAGIC, sizeof MAGIC) != 0 || header.version != ALI3_STATE_VERSION || header.size != size ||
      header.model_crc != ali3_model_crc(in) || header.initialised > 1 || !count_valid(header.count) ||
      header.crc != ali3_crc32((const unsigned char *)bytes + CHECKED_FROM, size - CHECKED_FROM))
    return ALI3_BAD_STATE;
  extract(&settings, &p, sizeof settings);
  extract(&report, &p, sizeof report);
  const unsigned char *times = (const unsigned char *)bytes + fixed, *vectors = times + 2 * sizeof(double);
  if (!ali3_settings_valid(&settings) || !report_valid(S, &report) || !numbers_valid(times, 2) ||
      !vectors_valid(in, vectors) ||
      !ali3_parameters_set_all(in, vectors + (in->stored.n + (size_t)z->nu) * sizeof(double)))
    return ALI3_BAD_STATE;
  in->settings = settings;
  in->report = report;
  in->start.initialised = (int32_t)header.initialised;
  in->clock.count = header.count;
  in->branch.known = false;
  in->start.placed = ALI3_PLACED_BY_Q; /* a new start begins at these coordinates */
  in->start.to_lift = false;
  extract(&in->clock.base, &p, sizeof(double));
  extract(&in->clock.h, &p, sizeof(double));
  extract(in->now.q, &p, in->stored.n * sizeof(double));
  extract(in->inputs.set, &p, (size_t)z->nu * sizeof(double));
  return ALI3_OK;
}
