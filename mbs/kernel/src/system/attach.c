/* Attaches generated code to a System of the same structure. */
#include <string.h>

#include "../files/crc32.h"
#include "../generated.h"
#include "../system.h"
#include "message.h"

/* Hash of an earlier hash and an array. */
static uint32_t hash_bytes(uint32_t hash, const void *bytes, int64_t size) {
  const uint32_t both[3] = {hash, (uint32_t)size, size > 0 ? ali3_crc32(bytes, (size_t)size) : 0u};
  return ali3_crc32(both, sizeof both);
}

/* Hash of the positions of factors +0, as generated code omits their terms. */
static uint32_t hash_zeros(uint32_t hash, const double *x, int64_t n) {
  const double zero = 0.0;
  for (int64_t i = 0; i < n; i++) {
    const unsigned char is_zero = memcmp(x + i, &zero, sizeof zero) == 0;
    hash = hash << 1 ^ (is_zero ? 0x9e3779b9u : 0u) ^ hash >> 31;
  }
  return hash;
}

/* Hash of the arrays whose pattern is fixed in generated code. */
static uint32_t structure_of(const ali3_system *s) {
  const int32_t nq = s->size.nq, nc = s->size.nc,
                counts[] = {nq, nc, s->size.nf, s->size.ne, s->n_lookup, s->n_flexible};
  uint32_t hash = hash_bytes(ALI3_GENERATED_VERSION, counts, sizeof counts);
#define HASH(name) hash = hash_bytes(hash, s->name, s->n_##name * (int64_t)sizeof *s->name);
  HASH(row_ptr)
  HASH(row_col)
  HASH(row_front)
  HASH(row_loc)
  HASH(quad_ptr)
  HASH(quad_a)
  HASH(quad_b)
  HASH(angle_row)
  HASH(angle_ptr)
  HASH(angle_theta)
  HASH(angle_a)
  HASH(angle_b)
  HASH(gterm_row)
  HASH(gterm_guide)
  HASH(gterm_power)
  HASH(gterm_a)
  HASH(gterm_b)
  HASH(mass_ptr)
  HASH(mass_col)
  HASH(mass_pos)
  HASH(front_col)
  HASH(front_ptr)
  HASH(front_idx)
  HASH(front_off)
  HASH(front_map)
  HASH(front_parent)
  HASH(sig_ptr)
  HASH(sig_col)
  HASH(el_sig_ptr)
  HASH(el_sig)
  HASH(el_front)
  HASH(el_loc_ptr)
  HASH(el_loc)
#undef HASH
  hash = hash_zeros(hash, s->row_lin, s->n_row_lin);
  /* Numbers that apply to three rows or signals. */
  hash = hash_bytes(hash, s->row_triples, nc);
  hash = hash_bytes(hash, s->active_triple, s->n_active);
  hash = hash_bytes(hash, s->el_triple, s->n_el_sig);
  for (int32_t i = 0; i < nq; i++)
    hash = hash_bytes(hash, (const int32_t[]){i, s->mass_alike[i] == 0}, 2 * sizeof(int32_t));
  return hash;
}

uint32_t ali3_system_structure(const ali3_system *s) {
  const uint32_t turned = s->turned != NULL ? structure_of(s->turned) : 0;
  return hash_bytes(structure_of(s), &turned, sizeof turned);
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
