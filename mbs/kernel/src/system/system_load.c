/* Reads the container of a System file: header, directory, copies; system_check.c checks the content. */
#include <stdlib.h>
#include <string.h>

#include "../files/crc32.h"
#include "../system.h"
#include "loading.h"
#include "message.h"

enum { HEADER_SIZE = 32, ENTRY_SIZE = 64, NAME_SIZE = 40 };

enum { MAY = 0, MUST }; /* presence */

typedef struct {
  const char *name;
  uint32_t dtype;
  bool must;
  size_t pointer, count; /* offsets in ali3_system */
} ali3_slot;

static const ali3_slot slots[ALI3_ARRAY_COUNT] = {
#define ALI3_SLOT(items, array, presence, ...)                                                                         \
  {.name = #array,                                                                                                     \
   .dtype = ALI3_##items,                                                                                              \
   .must = presence,                                                                                                   \
   .pointer = offsetof(ali3_system, array),                                                                            \
   .count = offsetof(ali3_system, n_##array)},
    ALI3_SYSTEM_ARRAYS(ALI3_SLOT)
#undef ALI3_SLOT
};

/* Little-endian numbers at any address. */
static uint32_t read_u32(const unsigned char *p) {
  uint32_t v;
  memcpy(&v, p, sizeof v);
  return v;
}

static uint64_t read_u64(const unsigned char *p) {
  uint64_t v;
  memcpy(&v, p, sizeof v);
  return v;
}

/* Header of the file, with its size and checksum. */
static ali3_status check_header(const unsigned char *bytes, size_t size, ali3_message m) {
  const uint16_t one = 1;
  if (*(const unsigned char *)&one != 1) return ali3_bad(m, "this machine is not little endian");
  if (size < HEADER_SIZE) return ali3_bad(m, "the file ends within its header");
  if (memcmp(bytes, "ALI3SYS\n", 8) != 0) return ali3_bad(m, "this is not a System file");
  const uint32_t version = read_u32(bytes + 8);
  if (version != ALI3_SYSTEM_VERSION)
    return ali3_bad(m, "System version %u, this kernel reads version %d", (unsigned)version, ALI3_SYSTEM_VERSION);
  if (read_u64(bytes + 16) != size)
    return ali3_bad(m, "the header says %llu bytes, there are %llu", (unsigned long long)read_u64(bytes + 16),
                    (unsigned long long)size);
  if (read_u32(bytes + 28) != 0) return ali3_bad(m, "the last four bytes of the header are not zero: it was altered");
  if (size > INT32_MAX) return ali3_bad(m, "the file is larger than 2 GB");
  if (read_u32(bytes + 24) != ali3_crc32(bytes + HEADER_SIZE, size - HEADER_SIZE))
    return ali3_bad(m, "the checksum does not fit: the file was altered or damaged");
  return ALI3_OK;
}

/* One entry of the directory: sets the array and its length. */
static ali3_status read_entry(ali3_system *s, const unsigned char *entry, size_t size, bool *seen, ali3_message m) {
  static const size_t item_size[] = {0, 4, 8, 1};
  char name[NAME_SIZE + 1] = {0};
  memcpy(name, entry, NAME_SIZE);
  const uint32_t dtype = read_u32(entry + NAME_SIZE);
  const uint64_t offset = read_u64(entry + 48), count = read_u64(entry + 56);
  int k = 0;
  while (k < ALI3_ARRAY_COUNT && strcmp(slots[k].name, name) != 0) k++;
  if (k == ALI3_ARRAY_COUNT) {
    for (char *p = name; *p; p++)
      if (*p < ' ' || *p > '~') *p = '?';
    return ali3_bad(m, "unknown array '%s'", name);
  }
  if (seen[k]) return ali3_bad(m, "array '%s' appears twice", name);
  if (dtype != slots[k].dtype) return ali3_bad(m, "array '%s' has item type %u", name, (unsigned)dtype);
  if (offset % 8 != 0 || offset > size || count > (size - offset) / item_size[dtype])
    return ali3_bad(m, "array '%s' lies outside the file", name);
  const void *pointer = s->bytes + offset;
  const int64_t n = (int64_t)count;
  memcpy((char *)s + slots[k].pointer, &pointer, sizeof pointer);
  memcpy((char *)s + slots[k].count, &n, sizeof n);
  seen[k] = true;
  return ALI3_OK;
}

/* All entries; required arrays are there. */
static ali3_status read_directory(ali3_system *s, size_t size, ali3_message m) {
  bool seen[ALI3_ARRAY_COUNT] = {false};
  const uint32_t n = read_u32(s->bytes + 12);
  if (n > ALI3_ARRAY_COUNT || (size_t)n * ENTRY_SIZE > size - HEADER_SIZE)
    return ali3_bad(m, "the directory names %u arrays, at most %d are known", (unsigned)n, (int)ALI3_ARRAY_COUNT);
  for (uint32_t i = 0; i < n; i++) {
    ali3_status status = read_entry(s, s->bytes + HEADER_SIZE + (size_t)i * ENTRY_SIZE, size, seen, m);
    if (status != ALI3_OK) return status;
  }
  for (int k = 0; k < ALI3_ARRAY_COUNT; k++)
    if (!seen[k] && slots[k].must) return ali3_bad(m, "array '%s' is missing", slots[k].name);
  return ALI3_OK;
}

ali3_status ali3_system_load(const void *bytes, size_t size, ali3_system **out, char *message, size_t message_size) {
  const ali3_memory memory = {calloc, free};
  return ali3_system_load_with(bytes, size, &memory, out, message, message_size);
}

ali3_status ali3_system_load_with(const void *bytes, size_t size, const ali3_memory *memory, ali3_system **out,
                                  char *message, size_t message_size) {
  const ali3_message m = {message, message_size};
  if (message != NULL && message_size > 0) message[0] = 0;
  if (bytes == NULL || out == NULL || memory == NULL || memory->allocate == NULL || memory->release == NULL)
    return ALI3_BAD_ARGUMENT;
  *out = NULL;
  ali3_status status = check_header(bytes, size, m);
  if (status != ALI3_OK) return status;
  ali3_system *s = memory->allocate(1, sizeof *s);
  if (s == NULL) return ALI3_NO_MEMORY;
  s->memory = *memory;
  s->bytes = memory->allocate(1, size);
  if (s->bytes == NULL) {
    ali3_system_free(s);
    return ALI3_NO_MEMORY;
  }
  memcpy(s->bytes, bytes, size);
  s->crc = read_u32(s->bytes + 24);
  status = read_directory(s, size, m);
  if (status == ALI3_OK) status = ali3_system_check(s, m);
  if (status == ALI3_OK) status = ali3_system_turn(s, m);
  if (status == ALI3_OK) status = ali3_system_derive(s, m);
  if (status != ALI3_OK) {
    ali3_system_free(s);
    return status;
  }
  *out = s;
  return ALI3_OK;
}

void ali3_system_free(ali3_system *s) {
  if (s == NULL) return;
  /* copied, as s is released; null pointers are not passed, which a host's release may refuse */
  const ali3_memory memory = s->memory;
  if (s->turned != NULL) {
    if (s->turned->derived != NULL) memory.release(s->turned->derived);
    memory.release(s->turned);
  }
  if (s->lean != NULL) memory.release(s->lean);
  if (s->derived != NULL) memory.release(s->derived);
  if (s->bytes != NULL) memory.release(s->bytes);
  memory.release(s);
}

int32_t ali3_road_count(const ali3_system *s) { return s->nr; }

ali3_sizes ali3_system_sizes(const ali3_system *s) {
  const ali3_sizes none = {0};
  return s != NULL ? s->size : none;
}
