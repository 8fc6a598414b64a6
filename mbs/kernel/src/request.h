/* Request for a step. */
#ifndef ALI3_REQUEST_H
#define ALI3_REQUEST_H
#include <stdbool.h>
#include <stdint.h>

/* Parts of the state that are read at the end of the step. */
typedef enum { ALI3_READ_ALL = 0, ALI3_READ_SENSORS, ALI3_READ_NOTHING } ali3_reading;

/* A step as a caller asks for it, or a part of one. */
typedef struct {
  double t, h;            /* time at its end, length, s */
  int32_t depth;          /* how often it may be halved */
  ali3_reading reading;
  bool controlled;        /* its length is not that of the last one, and it may be discarded */
  int64_t iterations_end; /* report.iterations where it must end, with a limit of the step's; by advance.c */
} ali3_request;
#endif
