/* Files in memory for hosts without an operating system, put there before any is opened; only with ALI3_ALONE. One
 * thread. */
#ifndef ALI3_FILE_ROOM_H
#define ALI3_FILE_ROOM_H
#include <stddef.h>
#include <stdint.h>

/* A file of that path (UTF-8, compared byte by byte) in place of the one that is there. The block, which is from malloc,
 * is the room's from now on. 0: no memory, no path or one that is too long; the block is then still the caller's. */
int32_t ali3_file_add(const char *path, void *bytes, size_t size);
/* 0: there is none of that path. */
int32_t ali3_file_remove(const char *path);
#endif
