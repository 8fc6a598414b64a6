/* Request for a step. */
#ifndef ALI3_REQUEST_H
#define ALI3_REQUEST_H
#include <stdbool.h>
#include <stdint.h>

/* Parts of the state that are read at the end of the step. */
typedef enum { ALI3_READ_ALL = 0, ALI3_READ_SENSORS, ALI3_READ_NOTHING } ali3_reading;

/* A requested step, or a part of one. */
typedef struct {
  double t, h;            /* time at its end, length, s */
  int32_t depth;          /* number of times that it may be halved */
  ali3_reading reading;   /* what is read at its end */
  bool controlled;        /* a step of the error control: its length varies, and it may be discarded */
  int64_t iterations_end; /* value of report.iterations at which it ends, with a limit of iterations of the step */
} ali3_request;
#endif
