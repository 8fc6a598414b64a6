/* Files in memory for hosts without an operating system, only with ALI3_ALONE. Not thread-safe. */
#ifndef ALI3_FILE_ROOM_H
#define ALI3_FILE_ROOM_H
#include <stddef.h>
#include <stdint.h>

/* Registers a file under a path (UTF-8, compared byte by byte), replacing one of that path. Takes ownership of the
 * block, which is from malloc. Returns 0, leaving the block to the caller, without memory, or if the path is empty or
 * too long. */
int32_t ali3_file_add(const char *path, void *bytes, size_t size);
/* Removes a file; 0: there is none of that path. */
int32_t ali3_file_remove(const char *path);
#endif
