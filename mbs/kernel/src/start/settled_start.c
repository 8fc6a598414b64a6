/* A start in motion, held until the states that the user does not set have settled: roll and pitch, springs, tyres,
 * steering, the speed of wheels under brakes. After each step the scene is moved back as a whole to the start:
 * horizontal position and velocity of its heaviest point, heading and yaw rate of its heaviest direction. On a slope it
 * moves back along the slope, so that the contacts keep their depth. Only a rigid-body motion is removed, so that every
 * part has the accelerations of its forces. */
#include "settled_start.h"

#include <math.h>
#include <string.h>

#include "../elements/signal.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "start_on_road.h"

static const double SLIDING = 50.0; /* 1/s: damping of the velocity of a scene at rest */
static const double HELD_FROM = 0.7; /* fraction of the settling time after which a scene at rest is held */

/* M_ii with the prepared bodies, kg or kg m^2. */
static double diagonal_mass(ali3_instance *in, int32_t i) {
  memset(in->step.x, 0, (size_t)in->system->size.nq * sizeof(double));
  in->step.x[i] = 1.0;
  ali3_mass_times(in, in->step.x, in->step.r);
  return in->step.r[i];
}

/* Coordinates along x of the point and the direction with the largest mass and inertia; -1: none. */
static void find_heaviest(ali3_instance *in, ali3_held_motion *motion) {
  const ali3_system *S = in->system;
  double mass = 0.0, inertia = 0.0;
  motion->point = motion->axis = -1;
  ali3_bodies_prepare(in, in->now.q);
  for (int32_t i = 0; i < S->size.nq; i++) {
    if (S->pose_partner[i] >= 0) continue; /* not along x */
    const double m = diagonal_mass(in, i), horizontal = S->pose_cos[i] * S->pose_cos[i] * m;
    if (S->pose_x[i] != 0.0 && m > mass) {
      mass = m;
      motion->point = i;
    }
    if (S->pose_x[i] == 0.0 && horizontal > inertia) {
      inertia = horizontal;
      motion->axis = i;
    }
  }
}

/* Measures place, heading and their rates of the held motion. */
static void measure(const ali3_instance *in, ali3_held_motion *m) {
  const ali3_system *S = in->system;
  /* the component along y is minus the derivative by a rotation to the left */
  const double *q = in->now.q, *qd = in->now.qd;
  m->place[0] = q[m->point];
  m->place[1] = -ali3_turned(S, m->point, q, false);
  m->velocity[0] = qd[m->point];
  m->velocity[1] = -ali3_turned(S, m->point, qd, true);
  const double x = q[m->axis], y = -ali3_turned(S, m->axis, q, false), size = sqrt(x * x + y * y);
  m->direction[0] = x / size;
  m->direction[1] = y / size;
  m->rate = (x * -ali3_turned(S, m->axis, qd, true) - y * qd[m->axis]) / (size * size);
}

bool ali3_measure_held_motion(ali3_instance *in, ali3_held_motion *held) {
  find_heaviest(in, held);
  if (held->point < 0 || held->axis < 0) return false;
  measure(in, held);
  return true;
}

/* Rotates x by an angle with cosine c and sine s, in place. */
static void rotate(ali3_instance *in, double c, double s, bool rate, double *x) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->size.nq; i++) in->step.w[i] = ali3_turned(S, i, x, rate);
  for (int32_t i = 0; i < S->size.nq; i++)
    if (S->pose_partner[i] != 0) x[i] = c * x[i] + s * in->step.w[i];
}

/* out = q translated by (x, y); grouped so that positions far from the origin lose no digits. */
static void translate(const ali3_system *S, const double *q, double x, double y, double *out) {
  for (int32_t i = 0; i < S->size.nq; i++) out[i] = q[i] + (x * S->pose_x[i] + y * S->pose_y[i]);
}

double ali3_heading_change(const ali3_instance *in, const ali3_held_motion *held) {
  ali3_held_motion now = *held;
  measure(in, &now);
  return held->direction[0] * now.direction[1] - held->direction[1] * now.direction[0];
}

/* Factor on the velocity of a scene at rest: until HELD_FROM it slides with a damping, so that the deflections of its
 * tyres can hold it; then it is held. If its velocity were set to 0 after every step, that would take 2 m / (k h)
 * instead of 2 / SLIDING, with mass m and stiffness k of the tyres of cars. */
double ali3_velocity_factor(const ali3_held_motion *held, double h, double progress) {
  const bool at_rest = held->velocity[0] == 0.0 && held->velocity[1] == 0.0 && held->rate == 0.0;
  return at_rest && progress < HELD_FROM ? 1.0 / (1.0 + SLIDING * h) : 0.0;
}

void ali3_restore_motion(ali3_instance *in, const ali3_held_motion *held, double kept_velocity) {
  const ali3_system *S = in->system;
  double *q = in->now.q, *qd = in->now.qd;
  ali3_held_motion now = *held;
  double spread;
  const double slope[2] = {ali3_climb(in, S->pose_x, in->step.x, &spread),
                           ali3_climb(in, S->pose_y, in->step.x, &spread)};
  measure(in, &now);
  const double rise = slope[0] * (held->place[0] - now.place[0]) + slope[1] * (held->place[1] - now.place[1]);
  translate(S, q, -now.place[0], -now.place[1], q);
  const double c = now.direction[0] * held->direction[0] + now.direction[1] * held->direction[1];
  const double s = now.direction[0] * held->direction[1] - now.direction[1] * held->direction[0];
  rotate(in, c, s, false, q);
  rotate(in, c, s, true, qd);
  measure(in, &now);
  for (int32_t i = 0; i < S->size.nq; i++) in->step.w[i] = ali3_turned(S, i, q, false);
  const double rate = (1.0 - kept_velocity) * (held->rate - now.rate);
  const double vx = (1.0 - kept_velocity) * (held->velocity[0] - now.velocity[0]);
  const double vy = (1.0 - kept_velocity) * (held->velocity[1] - now.velocity[1]);
  const double vz = slope[0] * vx + slope[1] * vy;
  for (int32_t i = 0; i < S->size.nq; i++)
    qd[i] += rate * in->step.w[i] + vx * S->pose_x[i] + vy * S->pose_y[i] + vz * S->pose_z[i];
  translate(S, q, held->place[0], held->place[1], q);
  for (int32_t i = 0; i < S->size.nq; i++) q[i] += rise * S->pose_z[i];
}

/* Writes the held motion, without climb, to in->step.w; returns the climb rate of the road under it, m/s. */
static double held_climb(ali3_instance *in, const ali3_held_motion *held, double *spread) {
  const ali3_system *S = in->system;
  translate(S, in->now.q, -held->place[0], -held->place[1], in->step.x);
  for (int32_t i = 0; i < S->size.nq; i++) {
    const double horizontal = held->velocity[0] * S->pose_x[i] + held->velocity[1] * S->pose_y[i];
    in->step.w[i] = held->rate * ali3_turned(S, i, in->step.x, false) + horizontal;
  }
  return ali3_climb(in, in->step.w, in->step.x, spread);
}

void ali3_follow_slope(ali3_instance *in, const ali3_held_motion *held) {
  double spread;
  const double climb = held_climb(in, held, &spread);
  for (int32_t i = 0; i < in->system->size.nq; i++) in->now.qd[i] += climb * in->system->pose_z[i];
}

double ali3_unsettled_speed(ali3_instance *in, const ali3_held_motion *held) {
  const ali3_system *S = in->system;
  double spread;
  const double climb = held_climb(in, held, &spread);
  double largest = spread;
  for (int32_t i = 0; i < S->size.nq; i++) {
    if (S->pose_partner[i] == 0 && S->pose_z[i] == 0.0) continue; /* spins of wheels */
    largest = fmax(largest, fabs(in->now.qd[i] - in->step.w[i] - climb * S->pose_z[i]));
  }
  return largest;
}
