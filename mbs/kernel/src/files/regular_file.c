/* Opens and reads files by the C library of each platform, for paths in UTF-8 and files above 2 GB. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#define _FILE_OFFSET_BITS 64
#endif
#include "regular_file.h"

#if !defined(ALI3_ALONE)
#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>

#if defined(_WIN32)
#include <io.h>
#include <wchar.h>
typedef struct _stat64 file_kind;
#define IS_REGULAR(mode) (((mode) & _S_IFMT) == _S_IFREG)

/* Converts UTF-8 to UTF-16; 0 if it does not fit or is invalid. */
static int wide_path(const char *path, wchar_t *wide) {
  const unsigned char *p = (const unsigned char *)path;
  size_t n = 0;
  while (*p != 0) {
    const int continuation = *p < 0x80                 ? 0
                             : *p >= 0xc2 && *p < 0xe0 ? 1
                             : *p >= 0xe0 && *p < 0xf0 ? 2
                             : *p < 0xf5               ? 3
                                                       : -1;
    if (continuation < 0 || (*p >= 0x80 && *p < 0xc2) || n + 3 > ALI3_MAX_PATH) return 0;
    uint32_t code = continuation == 0 ? *p : *p & (0x3fu >> continuation);
    p++;
    for (int k = 0; k < continuation; k++, p++) {
      if ((*p & 0xc0u) != 0x80u) return 0;
      code = code << 6 | (*p & 0x3fu);
    }
    if (code >= 0x10000u) {
      wide[n++] = (wchar_t)(0xd800u + ((code - 0x10000u) >> 10));
      code = 0xdc00u + ((code - 0x10000u) & 0x3ffu);
    }
    wide[n++] = (wchar_t)code;
  }
  wide[n] = 0;
  return 1;
}

static FILE *open_path(const char *path) {
  wchar_t wide[ALI3_MAX_PATH];
  if (wide_path(path, wide)) return _wfopen(wide, L"rb");
  errno = EINVAL;
  return NULL;
}

/* Both return 0 on success. */
static int read_kind(FILE *file, file_kind *kind) { return _fstat64(_fileno(file), kind); }

static int seek(FILE *file, int64_t from) { return _fseeki64(file, from, SEEK_SET); }
#else
#include <fcntl.h>
#include <unistd.h>
typedef struct stat file_kind;
#define IS_REGULAR(mode) S_ISREG(mode)

/* Does not wait for the writer of a pipe; a terminal does not become the controlling one. */
static FILE *open_path(const char *path) {
  const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY);
  FILE *file = descriptor >= 0 ? fdopen(descriptor, "rb") : NULL;
  if (descriptor >= 0 && file == NULL) close(descriptor);
  return file;
}

static int read_kind(FILE *file, file_kind *kind) { return fstat(fileno(file), kind); }

static int seek(FILE *file, int64_t from) { return fseeko(file, (off_t)from, SEEK_SET); }
#endif

/* Words for a value of errno. */
static const char *reason(int error) {
  switch (error) {
  case ENOENT:
  case ENOTDIR:
    return "there is no such file";
  case EACCES:
    return "it may not be read";
  case EISDIR:
    return "it is not a regular file";
#if defined(ELOOP)
  case ELOOP:
    return "its links go in a circle";
#endif
  case ENAMETOOLONG:
    return "its name is too long";
  case EMFILE:
  case ENFILE:
    return "too many files are open";
  case ENOMEM:
    return "there is not enough memory";
  default:
    return "it cannot be opened";
  }
}

ali3_file *ali3_file_open(const char *path, int64_t *size, const char **why) {
  file_kind kind;
  errno = 0;
  FILE *file = open_path(path);
  if (file == NULL) {
    *why = reason(errno);
    return NULL;
  }
  if (read_kind(file, &kind) == 0 && IS_REGULAR(kind.st_mode)) {
    setvbuf(file, NULL, _IONBF, 0); /* unbuffered, as the first read would allocate the buffer */
    *size = (int64_t)kind.st_size;
    return (ali3_file *)file;
  }
  *why = "it is not a regular file";
  fclose(file);
  return NULL;
}

int ali3_file_read(ali3_file *file, int64_t from, void *to, size_t size) {
  FILE *stream = (FILE *)file;
  return seek(stream, from) == 0 && fread(to, 1, size, stream) == size;
}

void ali3_file_close(ali3_file *file) { fclose((FILE *)file); }
#endif
