/* State of the motion of an instance, stored copies of it, and its clock. */
#ifndef ALI3_INSTANCE_STATES_H
#define ALI3_INSTANCE_STATES_H
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Past steps that are stored; indices into ali3_vectors.history, and its length. */
enum { ALI3_PAST = 4, ALI3_HISTORY_OWNER = 0, ALI3_HISTORY_COUNT, ALI3_HISTORY_TIME, ALI3_HISTORY = 2 + ALI3_PAST };

/* One state; its vectors are in one block of doubles, so that a copy is one memcpy. */
typedef struct {
  double *q, *qd, *qdd; /* nq: coordinates (earth axes: m of points, 1 of directions, rad of angles) and their rates */
  double *lam; /* nc: multipliers of the stored rows; a row puts -Phi_q' lam on q */
  double *y; /* ny: states of elements */
  double *mean, *mean_before; /* nq: mean rates of the last two steps, of Systems with flexible bodies */
  double *s, *sd, *sdd; /* ng: driving functions, m or rad, and their rates */
  double *out, *potential; /* nout, units as of their type; ne, J: of the last evaluation of the elements */
  double *used; /* nu: inputs as used in the last step */
  double *y_last, *h_last; /* ny; 1, s: element states at the start of the last step, its length; 0 at a start */
  double *on, *anchor; /* n_switch: 0 or 1; nc with switches: values at which rows are held */
  double *history; /* ALI3_HISTORY: ALI3_METHOD_* of the owner, number of past steps, times of their middles relative
                      to now, s */
  double *own; /* nq: velocity (energy-momentum) or algorithmic acceleration (generalised-alpha) */
  double *past_a, *past_lam; /* ALI3_PAST x nq, x nc: mean accelerations and multipliers of past steps, newest first */
  double *work,
      *stored; /* J: n_work and then n_driving_work, work since the start; n_work, stored energy at the start */
  double *watched; /* n_work powers, W, then n_work_force generalised forces at the end of the last step */
  double *step_force, *step_displacement; /* n_work_force: mean forces of the last step, change of their signals */
  double *by_inputs; /* n_input_work, J: stored energy that jumps of inputs have added since the start */
} ali3_vectors;

/* Stored states of an instance other than the present one and the next. */
typedef struct {
  ali3_vectors start; /* before a step that may be halved */
  ali3_vectors whole; /* before a composed step */
  ali3_vectors origin, centre, coarse; /* of a controlled step: its start, its middle, its end by one whole step */
  ali3_vectors near_branch; /* before a step near other branches */
  ali3_vectors direction; /* a direction in the space of states */
  size_t n; /* number of doubles of a state */
  bool backed_up; /* `start` holds the state before the step */
} ali3_stored_states;

/* time = base + count h */
typedef struct {
  double base, h; /* s; h: length of the last step */
  int64_t count; /* number of steps of that length */
  double now; /* s: time of in->now, also within a step */
} ali3_clock;
#endif
