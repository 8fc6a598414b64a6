/* CRC-32 checksum (ISO 3309, as in zip files). */
#ifndef ALI3_CRC32_H
#define ALI3_CRC32_H
#include <stddef.h>
#include <stdint.h>

/* Checksum of `size` bytes. */
uint32_t ali3_crc32(const void *bytes, size_t size);
#endif
