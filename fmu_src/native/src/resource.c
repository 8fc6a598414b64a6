/* The folder of the resources: its path from a URI, and reading of a file in it. */
#include <stdio.h>
#include <string.h>

#include "slave.h"

enum { MAX_BYTES = 1 << 30 };

/* Functions of the kernel for regular files by a path in UTF-8. */
typedef struct ali3_file ali3_file;
ali3_file *ali3_file_open(const char *path, int64_t *size, const char **why);
int ali3_file_read(ali3_file *file, int64_t from, void *to, size_t size);
void ali3_file_close(ali3_file *file);

/* Value of a hexadecimal digit, or -1. */
static int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

/* The scheme of a URI may be written in any case (RFC 3986, 3.1). */
static bool is_file_uri(const char *uri) {
  static const char scheme[] = "file:";
  size_t n = 0;
  while (scheme[n] != 0 && (uri[n] == scheme[n] || uri[n] == scheme[n] - ('a' - 'A'))) n++;
  return scheme[n] == 0;
}

bool slave_path_of_uri(const char *uri, char *path, size_t size) {
  size_t n = 0;
  bool encoded = false;
  if (is_file_uri(uri)) {
    encoded = true;
    uri += 5;
    if (strncmp(uri, "//", 2) == 0) {
      uri += 2;
      while (*uri != 0 && *uri != '/') uri++;
    }
#if defined(_WIN32)
    if (uri[0] == '/' && uri[1] != 0 && uri[2] == ':') uri++;
#endif
  }
  for (; *uri != 0; uri++, n++) {
    if (n + 1 >= size) return false;
    if (encoded && uri[0] == '%' && hex_digit(uri[1]) >= 0 && hex_digit(uri[2]) >= 0) {
      path[n] = (char)(16 * hex_digit(uri[1]) + hex_digit(uri[2]));
      uri += 2;
    } else {
      path[n] = *uri;
    }
  }
  while (n > 1 && (path[n - 1] == '/' || path[n - 1] == '\\')) n--;
  path[n] = 0;
  return true;
}

unsigned char *slave_read_resource(const char *folder, const char *name, const ali3_memory *memory, size_t *size,
                                   const char **why) {
  char path[SLAVE_PATH + 64];
  int64_t length = 0;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  ali3_file *file = ali3_file_open(path, &length, why);
  if (file == NULL) return NULL;
  unsigned char *bytes = NULL;
  const bool fits = length > 0 && length < MAX_BYTES;
  if (fits) bytes = memory->allocate(1, (size_t)length);
  *why = fits && bytes == NULL ? "there is not enough memory" : "it is too short, too long or breaks off";
  if (bytes != NULL && !ali3_file_read(file, 0, bytes, (size_t)length)) {
    memory->release(bytes);
    bytes = NULL;
  }
  *size = (size_t)length;
  ali3_file_close(file);
  return bytes;
}
