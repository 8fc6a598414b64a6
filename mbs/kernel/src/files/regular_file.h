/* Regular files by a path in UTF-8; folders and files that may block, such as named pipes, are refused. With ALI3_ALONE
 * files are in memory (file_room.c). */
#ifndef ALI3_REGULAR_FILE_H
#define ALI3_REGULAR_FILE_H
#include <stddef.h>
#include <stdint.h>

enum { ALI3_MAX_PATH = 4096 }; /* bytes of a path including its terminator */

typedef struct ali3_file ali3_file;

/* Opens a file; *size: in bytes. NULL on failure, with a short reason in *why. Reads are not buffered. */
ali3_file *ali3_file_open(const char *path, int64_t *size, const char **why);
/* Reads `size` bytes from offset `from`; 0 on failure. */
int ali3_file_read(ali3_file *file, int64_t from, void *to, size_t size);
void ali3_file_close(ali3_file *file);
#endif
