/* The folder of the resources: from a URI to a path, and a file in it. */
#if defined(_WIN32)
#include <windows.h>
#else
#define _POSIX_C_SOURCE 200809L
#include <sys/stat.h>
#endif
#include <stdio.h>
#include <string.h>

#include "slave.h"

enum { MOST_BYTES = 1 << 30 };

static int hex(char c) {
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

/* file:, file:/, file:// or file://host/ and any %xx; a plain path stays. False if it does not fit. */
bool slave_path_of_uri(const char *uri, char *path, size_t size) {
  size_t n = 0;
  bool coded = false;
  if (is_file_uri(uri)) {
    coded = true;
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
    if (coded && uri[0] == '%' && hex(uri[1]) >= 0 && hex(uri[2]) >= 0) {
      path[n] = (char)(16 * hex(uri[1]) + hex(uri[2]));
      uri += 2;
    } else {
      path[n] = *uri;
    }
  }
  while (n > 1 && (path[n - 1] == '/' || path[n - 1] == '\\')) n--;
  path[n] = 0;
  return true;
}

/* Paths are UTF-8. */
static FILE *open_file(const char *path) {
#if defined(_WIN32)
  wchar_t wide[SLAVE_PATH];
  if (MultiByteToWideChar(CP_UTF8, 0, path, -1, wide, SLAVE_PATH) <= 0) return NULL;
  return _wfopen(wide, L"rb");
#else
  struct stat kind; /* a named pipe would wait for its writer */
  if (stat(path, &kind) != 0 || !S_ISREG(kind.st_mode)) return NULL;
  return fopen(path, "rb");
#endif
}

unsigned char *slave_read(const char *folder, const char *name, const ali3_memory *memory, size_t *size) {
  char path[SLAVE_PATH + 64];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = open_file(path);
  if (file == NULL) return NULL;
  unsigned char *bytes = NULL;
  long length = -1;
  if (fseek(file, 0, SEEK_END) == 0) length = ftell(file);
  if (length > 0 && length < MOST_BYTES && fseek(file, 0, SEEK_SET) == 0) {
    *size = (size_t)length;
    bytes = memory->allocate(1, *size);
    if (bytes != NULL && fread(bytes, 1, *size, file) != *size) {
      memory->release(bytes);
      bytes = NULL;
    }
  }
  fclose(file);
  return bytes;
}
