/* A start in motion, held until the states that nobody sets have settled: roll and pitch, springs, tyres, steering, the
 * speed of wheels under brakes. The scene makes steps; after each it is put back as a whole to the start: place along
 * the ground and horizontal velocity of its heaviest point, heading and yaw rate of its heaviest direction. On a slope
 * it comes back along the slope: what touches the road stays as deep as it was. Only a motion as one rigid body is
 * taken away, so that every part feels the accelerations that the forces give it. */
#include "settled_start.h"

#include <math.h>
#include <string.h>

#include "../elements/signal.h"
#include "../flexible/bodies.h"
#include "../flexible/mass.h"
#include "start_on_road.h"

static const double SLIDING = 50.0; /* 1/s */
static const double HELD_FROM = 0.7; /* of the settling */

/* M_ii of the bodies prepared. */
static double mass_of(ali3_instance *in, int32_t i) {
  memset(in->step.x, 0, (size_t)in->system->size.nq * sizeof(double));
  in->step.x[i] = 1.0;
  ali3_mass_times(in, in->step.x, in->step.r);
  return in->step.r[i];
}

/* -1: there is none. */
static void find_heaviest(ali3_instance *in, ali3_held_motion *found) {
  const ali3_system *S = in->system;
  double mass = 0.0, inertia = 0.0;
  found->point = found->axis = -1;
  ali3_bodies_prepare(in, in->now.q);
  for (int32_t i = 0; i < S->size.nq; i++) {
    if (S->pose_partner[i] >= 0) continue; /* not along x */
    const double m = mass_of(in, i), along = S->pose_cos[i] * S->pose_cos[i] * m;
    if (S->pose_x[i] != 0.0 && m > mass) {
      mass = m;
      found->point = i;
    }
    if (S->pose_x[i] == 0.0 && along > inertia) {
      inertia = along;
      found->axis = i;
    }
  }
}

static void look(const ali3_instance *in, ali3_held_motion *m) {
  const ali3_system *S = in->system;
  const double *q = in->now.q, *qd = in->now.qd; /* the y of a component along x: minus what a turn gives it */
  m->place[0] = q[m->point];
  m->place[1] = -ali3_turned(S, m->point, q, false);
  m->velocity[0] = qd[m->point];
  m->velocity[1] = -ali3_turned(S, m->point, qd, true);
  const double x = q[m->axis], y = -ali3_turned(S, m->axis, q, false), size = sqrt(x * x + y * y);
  m->direction[0] = x / size;
  m->direction[1] = y / size;
  m->rate = (x * -ali3_turned(S, m->axis, qd, true) - y * qd[m->axis]) / (size * size);
}

bool ali3_hold(ali3_instance *in, ali3_held_motion *held) {
  find_heaviest(in, held);
  if (held->point < 0 || held->axis < 0) return false;
  look(in, held);
  return true;
}

/* x turned by the angle of this cosine and sine, in place. */
static void turn(ali3_instance *in, double c, double s, bool rate, double *x) {
  const ali3_system *S = in->system;
  for (int32_t i = 0; i < S->size.nq; i++) in->step.w[i] = ali3_turned(S, i, x, rate);
  for (int32_t i = 0; i < S->size.nq; i++)
    if (S->pose_partner[i] != 0) x[i] = c * x[i] + s * in->step.w[i];
}

/* out = q + way (x, y): seen from a place far away no digits are lost. */
static void shift(const ali3_system *S, const double *q, double x, double y, double *out) {
  for (int32_t i = 0; i < S->size.nq; i++) out[i] = q[i] + (x * S->pose_x[i] + y * S->pose_y[i]);
}

double ali3_heading_change(const ali3_instance *in, const ali3_held_motion *start) {
  ali3_held_motion now = *start;
  look(in, &now);
  return start->direction[0] * now.direction[1] - start->direction[1] * now.direction[0];
}

/* Share of the velocity that a scene at rest keeps: it slides until the deflections of its tyres hold it, and is held
 * from then on. With no velocity left after a step that would take 2 m / (k h), with this damping 2 / SLIDING, m and k
 * being mass and stiffness of cars. */
double ali3_kept_velocity(const ali3_held_motion *held, double h, double done) {
  const bool stands = held->velocity[0] == 0.0 && held->velocity[1] == 0.0 && held->rate == 0.0;
  return stands && done < HELD_FROM ? 1.0 / (1.0 + SLIDING * h) : 0.0;
}

void ali3_put_back(ali3_instance *in, const ali3_held_motion *start, double kept) {
  const ali3_system *S = in->system;
  double *q = in->now.q, *qd = in->now.qd;
  ali3_held_motion now = *start;
  double spread;
  const double slope[2] = {ali3_climb(in, S->pose_x, in->step.x, &spread),
                           ali3_climb(in, S->pose_y, in->step.x, &spread)};
  look(in, &now);
  const double rise = slope[0] * (start->place[0] - now.place[0]) + slope[1] * (start->place[1] - now.place[1]);
  shift(S, q, -now.place[0], -now.place[1], q);
  const double c = now.direction[0] * start->direction[0] + now.direction[1] * start->direction[1];
  const double s = now.direction[0] * start->direction[1] - now.direction[1] * start->direction[0];
  turn(in, c, s, false, q);
  turn(in, c, s, true, qd);
  look(in, &now);
  for (int32_t i = 0; i < S->size.nq; i++) in->step.w[i] = ali3_turned(S, i, q, false);
  const double rate = (1.0 - kept) * (start->rate - now.rate);
  const double vx = (1.0 - kept) * (start->velocity[0] - now.velocity[0]);
  const double vy = (1.0 - kept) * (start->velocity[1] - now.velocity[1]);
  const double vz = slope[0] * vx + slope[1] * vy;
  for (int32_t i = 0; i < S->size.nq; i++)
    qd[i] += rate * in->step.w[i] + vx * S->pose_x[i] + vy * S->pose_y[i] + vz * S->pose_z[i];
  shift(S, q, start->place[0], start->place[1], q);
  for (int32_t i = 0; i < S->size.nq; i++) q[i] += rise * S->pose_z[i];
}

/* The held motion, level, in in->step.w; how fast the road rises under it. */
static double held_climb(ali3_instance *in, const ali3_held_motion *held, double *spread) {
  const ali3_system *S = in->system;
  shift(S, in->now.q, -held->place[0], -held->place[1], in->step.x);
  for (int32_t i = 0; i < S->size.nq; i++) {
    const double along = held->velocity[0] * S->pose_x[i] + held->velocity[1] * S->pose_y[i];
    in->step.w[i] = held->rate * ali3_turned(S, i, in->step.x, false) + along;
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
  double most = spread;
  for (int32_t i = 0; i < S->size.nq; i++) {
    if (S->pose_partner[i] == 0 && S->pose_z[i] == 0.0) continue; /* wheels turn */
    most = fmax(most, fabs(in->now.qd[i] - in->step.w[i] - climb * S->pose_z[i]));
  }
  return most;
}
