/* Motion of the bodies of a tree from its relative coordinates: frames, velocities, accelerations. */
#include "tree.h"
#include "../algebra/elementary.h"

void ali3_tree_place(const ali3_tree *T, ali3_tree_work *w) {
  ali3_sine_cosine(T->lanes, w->q, w->sine, w->cosine);
  if (T->slides) {
    ALI3_FOR_LANES
    for (int32_t b = 0; b < T->lanes; b++) {
      w->sine[b] *= T->turn[b];
      w->cosine[b] = T->slide[b] + T->turn[b] * w->cosine[b];
    }
  }
  for (int32_t b = 1; b <= T->n; b++)
    for (int i = 0; i < 3; i++) {
      const double x = T->base[i][0][b], y = T->base[i][1][b];
      w->relative[b][i][0] = w->cosine[b] * x + w->sine[b] * y;
      w->relative[b][i][1] = w->cosine[b] * y - w->sine[b] * x;
    }
  for (int32_t b = 1; b <= T->n; b++) {
    const int32_t p = T->parent[b];
    const double *restrict l0 = w->relative[b][0], *restrict l1 = w->relative[b][1], *restrict l2 = w->relative[b][2];
    for (int i = 0; i < 3; i++) {
      const double x = w->frame[p][i][0], y = w->frame[p][i][1], z = w->frame[p][i][2];
      double *restrict row = w->frame[b][i];
      for (int k = 0; k < 4; k++) row[k] = x * l0[k] + y * l1[k] + z * l2[k];
    }
    for (int i = 0; i < 3; i++) w->origin[i][b] = w->origin[i][p] + w->frame[b][i][3];
    if (T->slides)
      for (int i = 0; i < 3; i++) w->origin[i][b] += T->slide[b] * w->q[b] * w->frame[b][i][2];
  }
}

void ali3_tree_joints(const ali3_tree *T, ali3_tree_work *w) {
  ALI3_FOR_LANES
  for (int32_t b = 0; b < T->lanes; b++) {
    const double x = w->frame[b][0][2], y = w->frame[b][1][2], z = w->frame[b][2][2];
    const double r0 = w->origin[0][b], r1 = w->origin[1][b], r2 = w->origin[2][b];
    w->turn[0][b] = x;
    w->turn[1][b] = y;
    w->turn[2][b] = z;
    w->shift[0][b] = r1 * z - r2 * y;
    w->shift[1][b] = r2 * x - r0 * z;
    w->shift[2][b] = r0 * y - r1 * x;
  }
  if (T->slides) {
    ALI3_FOR_LANES
    for (int32_t b = 0; b < T->lanes; b++)
      for (int i = 0; i < 3; i++) {
        w->shift[i][b] = T->turn[b] * w->shift[i][b] + T->slide[b] * w->turn[i][b];
        w->turn[i][b] *= T->turn[b];
      }
  }
}

void ali3_tree_move(const ali3_tree *T, ali3_tree_work *w) {
  for (int32_t b = 1; b <= T->n; b++) {
    const int32_t p = T->parent[b];
    const double rate = w->qd[b];
    for (int i = 0; i < 3; i++) {
      w->spin[i][b] = w->spin[i][p] + w->turn[i][b] * rate;
      w->drift[i][b] = w->drift[i][p] + w->shift[i][b] * rate;
    }
  }
  ALI3_FOR_LANES
  for (int32_t b = 0; b < T->lanes; b++) {
    const double rate = w->qd[b];
    const double o0 = w->spin[0][b], o1 = w->spin[1][b], o2 = w->spin[2][b];
    const double v0 = w->drift[0][b], v1 = w->drift[1][b], v2 = w->drift[2][b];
    const double t0 = rate * w->turn[0][b], t1 = rate * w->turn[1][b], t2 = rate * w->turn[2][b];
    const double s0 = rate * w->shift[0][b], s1 = rate * w->shift[1][b], s2 = rate * w->shift[2][b];
    w->spin_rate[0][b] = o1 * t2 - o2 * t1;
    w->spin_rate[1][b] = o2 * t0 - o0 * t2;
    w->spin_rate[2][b] = o0 * t1 - o1 * t0;
    w->drift_rate[0][b] = (o1 * s2 - o2 * s1) + (v1 * t2 - v2 * t1);
    w->drift_rate[1][b] = (o2 * s0 - o0 * s2) + (v2 * t0 - v0 * t2);
    w->drift_rate[2][b] = (o0 * s1 - o1 * s0) + (v0 * t1 - v1 * t0);
  }
  for (int i = 0; i < 3; i++) w->drift_rate[i][0] = -w->gravity[i]; /* gravity as an acceleration of the ground */
  for (int32_t b = 1; b <= T->n; b++) {
    const int32_t p = T->parent[b];
    for (int i = 0; i < 3; i++) {
      w->spin_rate[i][b] += w->spin_rate[i][p];
      w->drift_rate[i][b] += w->drift_rate[i][p];
    }
  }
}

void ali3_tree_accelerate(const ali3_tree *T, ali3_tree_work *w, const double *qdd) {
  ali3_lanes spin[3] = {{0.0}}, drift[3] = {{0.0}};
  for (int i = 0; i < 3; i++) drift[i][0] = w->gravity[i];
  for (int32_t b = 1; b <= T->n; b++)
    for (int i = 0; i < 3; i++) {
      spin[i][b] = spin[i][T->parent[b]] + w->turn[i][b] * qdd[b - 1];
      drift[i][b] = drift[i][T->parent[b]] + w->shift[i][b] * qdd[b - 1];
    }
  for (int i = 0; i < 3; i++)
    for (int32_t b = 0; b <= T->n; b++) {
      w->spin_rate[i][b] += spin[i][b];
      w->drift_rate[i][b] += drift[i][b];
    }
}
