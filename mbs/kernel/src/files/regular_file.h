/* Regular files by a path in UTF-8: what waits, such as a named pipe, and folders are refused. With ALI3_ALONE there is
 * no operating system, and files are those that the host put into memory (file_room.c). */
#ifndef ALI3_REGULAR_FILE_H
#define ALI3_REGULAR_FILE_H
#include <stddef.h>
#include <stdint.h>

enum { ALI3_MOST_PATH = 4096 }; /* bytes of a path with its end */

typedef struct ali3_file ali3_file;

/* NULL where there is none; *why is then a few words, else *size is its size in bytes. Reads are not buffered. */
ali3_file *ali3_file_open(const char *path, int64_t *size, const char **why);
/* size bytes from a place on; 0 where they are not there. */
int ali3_file_read(ali3_file *file, int64_t from, void *to, size_t size);
void ali3_file_close(ali3_file *file);
#endif
