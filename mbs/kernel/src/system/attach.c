/* Generated code comes to a System, or is refused. */
#include <string.h>

#include "../files/crc32.h"
#include "../generated.h"
#include "../system.h"
#include "message.h"

static uint32_t add(uint32_t seen, const void *bytes, int64_t size) {
  const uint32_t both[3] = {seen, (uint32_t)size, size > 0 ? ali3_crc32(bytes, (size_t)size) : 0u};
  return ali3_crc32(both, sizeof both);
}

/* Numbers that are +0 are left out of sums. */
static uint32_t add_zeros(uint32_t seen, const double *x, int64_t n) {
  const double zero = 0.0;
  for (int64_t i = 0; i < n; i++) {
    const unsigned char is_zero = memcmp(x + i, &zero, sizeof zero) == 0;
    seen = seen << 1 ^ (is_zero ? 0x9e3779b9u : 0u) ^ seen >> 31;
  }
  return seen;
}

static uint32_t structure_of(const ali3_system *s) {
  const int32_t nq = s->size.nq, nc = s->size.nc, more[] = {nq, nc, s->size.nf, s->size.ne, s->n_tabled, s->n_flexible};
  uint32_t seen = add(ALI3_GENERATED_VERSION, more, sizeof more);
#define ALI3_SEEN(name) seen = add(seen, s->name, s->n_##name * (int64_t)sizeof *s->name);
  ALI3_SEEN(row_ptr)
  ALI3_SEEN(row_col)
  ALI3_SEEN(row_front)
  ALI3_SEEN(row_loc)
  ALI3_SEEN(quad_ptr)
  ALI3_SEEN(quad_a)
  ALI3_SEEN(quad_b)
  ALI3_SEEN(angle_row)
  ALI3_SEEN(angle_ptr)
  ALI3_SEEN(angle_theta)
  ALI3_SEEN(angle_a)
  ALI3_SEEN(angle_b)
  ALI3_SEEN(gterm_row)
  ALI3_SEEN(gterm_guide)
  ALI3_SEEN(gterm_power)
  ALI3_SEEN(gterm_a)
  ALI3_SEEN(gterm_b)
  ALI3_SEEN(mass_ptr)
  ALI3_SEEN(mass_col)
  ALI3_SEEN(mass_pos)
  ALI3_SEEN(front_col)
  ALI3_SEEN(front_ptr)
  ALI3_SEEN(front_idx)
  ALI3_SEEN(front_off)
  ALI3_SEEN(front_map)
  ALI3_SEEN(front_parent)
  ALI3_SEEN(sig_ptr)
  ALI3_SEEN(sig_col)
  ALI3_SEEN(el_sig_ptr)
  ALI3_SEEN(el_sig)
  ALI3_SEEN(el_front)
  ALI3_SEEN(el_loc_ptr)
  ALI3_SEEN(el_loc)
#undef ALI3_SEEN
  seen = add_zeros(seen, s->row_lin, s->n_row_lin);
  /* Which numbers of the System stand for three. */
  seen = add(seen, s->row_triples, nc);
  seen = add(seen, s->active_triple, s->n_active);
  seen = add(seen, s->el_triple, s->n_el_sig);
  for (int32_t i = 0; i < nq; i++) seen = add(seen, (const int32_t[]){i, s->mass_alike[i] == 0}, 2 * sizeof(int32_t));
  return seen;
}

uint32_t ali3_system_structure(const ali3_system *s) {
  const uint32_t turned = s->turned != NULL ? structure_of(s->turned) : 0;
  return add(structure_of(s), &turned, sizeof turned);
}

ali3_status ali3_system_attach(ali3_system *s, const ali3_generated *generated, char *message, size_t message_size) {
  const ali3_message m = {message, message_size};
  if (message != NULL && message_size > 0) message[0] = 0;
  if (s == NULL || generated == NULL) return ALI3_BAD_ARGUMENT;
  if (generated->version != ALI3_GENERATED_VERSION)
    return ali3_bad(m, "the code was generated for version %u of this kernel's table, which is now %d",
                    (unsigned)generated->version, (int)ALI3_GENERATED_VERSION);
  if (generated->structure != ali3_system_structure(s))
    return ali3_bad(m, "the code was generated for another System, of structure %08x; this one has %08x",
                    (unsigned)generated->structure, (unsigned)ali3_system_structure(s));
  if (generated->avx2 && !s->has_avx2)
    return ali3_bad(m, "the code was generated for processors with AVX2, which this one lacks");
  s->generated = *generated;
  if (s->turned != NULL && generated->turned != NULL) s->turned->generated = *generated->turned;
  return ALI3_OK;
}
