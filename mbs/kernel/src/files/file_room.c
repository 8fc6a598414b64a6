/* Files in memory, registered by the host, for platforms without an operating system. An open file keeps its content
 * when it is replaced or removed. */
#include "file_room.h"

#if defined(ALI3_ALONE)
#include <stdlib.h>
#include <string.h>

#include "regular_file.h"

struct ali3_file {
  ali3_file *next; /* in the list of registered files */
  char *path;
  unsigned char *bytes; /* `size` of them */
  int64_t size;
  int64_t users; /* number of open handles, plus one while registered */
};

static ali3_file *first; /* registered file; NULL: none */

/* Takes one user from a file, and frees it after the last. */
static void release(ali3_file *file) {
  if (--file->users > 0) return;
  free(file->path);
  free(file->bytes);
  free(file);
}

/* The link that points to the file of a path, or the last link, which is NULL. */
static ali3_file **link_to(const char *path) {
  ali3_file **link = &first;
  while (*link != NULL && strcmp((*link)->path, path) != 0) link = &(*link)->next;
  return link;
}

int32_t ali3_file_add(const char *path, void *bytes, size_t size) {
  if (path == NULL || path[0] == 0 || strlen(path) >= ALI3_MAX_PATH || (bytes == NULL && size > 0)) return 0;
  ali3_file *file = malloc(sizeof *file);
  char *copy = malloc(strlen(path) + 1);
  if (file == NULL || copy == NULL) {
    free(file);
    free(copy);
    return 0;
  }
  strcpy(copy, path);
  ali3_file_remove(path);
  *file = (ali3_file){.next = first, .path = copy, .bytes = bytes, .size = (int64_t)size, .users = 1};
  first = file;
  return 1;
}

int32_t ali3_file_remove(const char *path) {
  ali3_file **link = link_to(path), *file = *link;
  if (file == NULL) return 0;
  *link = file->next;
  release(file);
  return 1;
}

ali3_file *ali3_file_open(const char *path, int64_t *size, const char **why) {
  ali3_file *file = *link_to(path);
  if (file == NULL) {
    *why = "there is no such file";
    return NULL;
  }
  file->users++;
  *size = file->size;
  return file;
}

int ali3_file_read(ali3_file *file, int64_t from, void *to, size_t size) {
  if (from < 0 || from > file->size || (uint64_t)(file->size - from) < size) return 0;
  if (size > 0) memcpy(to, file->bytes + from, size);
  return 1;
}

void ali3_file_close(ali3_file *file) { release(file); }
#endif
