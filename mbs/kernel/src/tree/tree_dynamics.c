/* Inertia, inertia forces and mass matrix of a tree: composite bodies about the origin of the earth. */
#include "tree.h"

/* Inertia of each body about its centre of mass in earth axes, and the position of that. */
static void centroidal_inertia(const ali3_tree *T, ali3_tree_work *w) {
  ALI3_FOR_LANES
  for (int32_t b = 0; b < T->lanes; b++) {
    double c[3], e[3], rc[3];
    for (int i = 0; i < 3; i++) {
      const double x = w->frame[b][i][0], y = w->frame[b][i][1], z = w->frame[b][i][2];
      rc[i] = x * T->centre[0][b] + y * T->centre[1][b] + z * T->centre[2][b];
      c[i] = w->origin[i][b] + rc[i];
      e[i] = x * T->first_axis[0][b] + y * T->first_axis[1][b] + z * T->first_axis[2][b];
    }
    const double k0 = T->first[b] * e[0], k1 = T->first[b] * e[1], k2 = T->first[b] * e[2];
    w->inertia[0][b] = T->round[b] + k0 * e[0];
    w->inertia[1][b] = T->round[b] + k1 * e[1];
    w->inertia[2][b] = T->round[b] + k2 * e[2];
    w->inertia[3][b] = k1 * e[2];
    w->inertia[4][b] = k2 * e[0];
    w->inertia[5][b] = k0 * e[1];
    for (int i = 0; i < 3; i++) w->moment[i][b] = c[i];
  }
  if (T->asymmetric) {
    ALI3_FOR_LANES
    for (int32_t b = 0; b < T->lanes; b++) {
      double e[3];
      for (int i = 0; i < 3; i++)
        e[i] = w->frame[b][i][0] * T->second_axis[0][b] + w->frame[b][i][1] * T->second_axis[1][b] +
               w->frame[b][i][2] * T->second_axis[2][b];
      const double k0 = T->second[b] * e[0], k1 = T->second[b] * e[1], k2 = T->second[b] * e[2];
      w->inertia[0][b] += k0 * e[0];
      w->inertia[1][b] += k1 * e[1];
      w->inertia[2][b] += k2 * e[2];
      w->inertia[3][b] += k1 * e[2];
      w->inertia[4][b] += k2 * e[0];
      w->inertia[5][b] += k0 * e[1];
    }
  }
}

void ali3_tree_forces(const ali3_tree *T, ali3_tree_work *w) {
  centroidal_inertia(T, w);
  ALI3_FOR_LANES
  for (int32_t b = 0; b < T->lanes; b++) {
    const double c0 = w->moment[0][b], c1 = w->moment[1][b], c2 = w->moment[2][b], m = T->mass[b];
    const double o0 = w->spin[0][b], o1 = w->spin[1][b], o2 = w->spin[2][b];
    const double a0 = w->spin_rate[0][b], a1 = w->spin_rate[1][b], a2 = w->spin_rate[2][b];
    /* velocity of the centre of mass, then mass times its acceleration */
    const double v0 = w->drift[0][b] + (o1 * c2 - o2 * c1), v1 = w->drift[1][b] + (o2 * c0 - o0 * c2),
                 v2 = w->drift[2][b] + (o0 * c1 - o1 * c0);
    const double f0 = m * (w->drift_rate[0][b] + (a1 * c2 - a2 * c1) + (o1 * v2 - o2 * v1)),
                 f1 = m * (w->drift_rate[1][b] + (a2 * c0 - a0 * c2) + (o2 * v0 - o0 * v2)),
                 f2 = m * (w->drift_rate[2][b] + (a0 * c1 - a1 * c0) + (o0 * v1 - o1 * v0));
    const double xx = w->inertia[0][b], yy = w->inertia[1][b], zz = w->inertia[2][b], yz = w->inertia[3][b],
                 zx = w->inertia[4][b], xy = w->inertia[5][b];
    const double h0 = xx * o0 + xy * o1 + zx * o2, h1 = xy * o0 + yy * o1 + yz * o2, h2 = zx * o0 + yz * o1 + zz * o2;
    w->force[0][b] = f0;
    w->force[1][b] = f1;
    w->force[2][b] = f2;
    w->torque[0][b] = (xx * a0 + xy * a1 + zx * a2) + (o1 * h2 - o2 * h1) + (c1 * f2 - c2 * f1);
    w->torque[1][b] = (xy * a0 + yy * a1 + yz * a2) + (o2 * h0 - o0 * h2) + (c2 * f0 - c0 * f2);
    w->torque[2][b] = (zx * a0 + yz * a1 + zz * a2) + (o0 * h1 - o1 * h0) + (c0 * f1 - c1 * f0);
    const double m0 = m * c0, m1 = m * c1, m2 = m * c2;
    w->moment[0][b] = m0;
    w->moment[1][b] = m1;
    w->moment[2][b] = m2;
    w->inertia[0][b] = xx + (m1 * c1 + m2 * c2);
    w->inertia[1][b] = yy + (m2 * c2 + m0 * c0);
    w->inertia[2][b] = zz + (m0 * c0 + m1 * c1);
    w->inertia[3][b] = yz - m1 * c2;
    w->inertia[4][b] = zx - m2 * c0;
    w->inertia[5][b] = xy - m0 * c1;
  }
}

/* Accumulates the bodies to the composite bodies of the joints. */
static void accumulate_composites(const ali3_tree *T, ali3_tree_work *w) {
  for (int32_t b = T->n; b > 0; b--) {
    const int32_t p = T->parent[b];
    if (p == 0) continue;
    for (int i = 0; i < 6; i++) w->inertia[i][p] += w->inertia[i][b];
    for (int i = 0; i < 3; i++) {
      w->moment[i][p] += w->moment[i][b];
      w->torque[i][p] += w->torque[i][b];
      w->force[i][p] += w->force[i][b];
    }
  }
}

/* Momentum of the composite bodies per unit rate of their joints, and the right side without other forces. */
static void composite_momenta(const ali3_tree *T, ali3_tree_work *w) {
  ALI3_FOR_LANES
  for (int32_t b = 0; b < T->lanes; b++) {
    const double t0 = w->turn[0][b], t1 = w->turn[1][b], t2 = w->turn[2][b];
    const double s0 = w->shift[0][b], s1 = w->shift[1][b], s2 = w->shift[2][b];
    const double m0 = w->moment[0][b], m1 = w->moment[1][b], m2 = w->moment[2][b], m = w->composite[b];
    const double xx = w->inertia[0][b], yy = w->inertia[1][b], zz = w->inertia[2][b], yz = w->inertia[3][b],
                 zx = w->inertia[4][b], xy = w->inertia[5][b];
    w->angular[0][b] = (xx * t0 + xy * t1 + zx * t2) + (m1 * s2 - m2 * s1);
    w->angular[1][b] = (xy * t0 + yy * t1 + yz * t2) + (m2 * s0 - m0 * s2);
    w->angular[2][b] = (zx * t0 + yz * t1 + zz * t2) + (m0 * s1 - m1 * s0);
    w->linear[0][b] = m * s0 + (t1 * m2 - t2 * m1);
    w->linear[1][b] = m * s1 + (t2 * m0 - t0 * m2);
    w->linear[2][b] = m * s2 + (t0 * m1 - t1 * m0);
    w->load[b] = -((t0 * w->torque[0][b] + t1 * w->torque[1][b] + t2 * w->torque[2][b]) +
                   (s0 * w->force[0][b] + s1 * w->force[1][b] + s2 * w->force[2][b]));
  }
}

/* M: row j for the bodies on its path to the ground, by runs of consecutive bodies. */
void ali3_tree_mass(const ali3_tree *T, ali3_tree_work *w) {
  accumulate_composites(T, w);
  composite_momenta(T, w);
  for (int32_t j = 1; j <= T->n; j++) {
    const double a0 = w->angular[0][j], a1 = w->angular[1][j], a2 = w->angular[2][j];
    const double l0 = w->linear[0][j], l1 = w->linear[1][j], l2 = w->linear[2][j];
    double *restrict row = w->mass[j];
    for (int32_t last = j; last > 0; last = T->parent[T->run[last]]) {
      ALI3_FOR_LANES
      for (int32_t i = T->run[last]; i <= last; i++)
        row[i] = (a0 * w->turn[0][i] + a1 * w->turn[1][i] + a2 * w->turn[2][i]) +
                 (l0 * w->shift[0][i] + l1 * w->shift[1][i] + l2 * w->shift[2][i]);
    }
  }
}

/* row -= f p + g q from `first` to `last`, in whole pairs: entries beyond the path are zero, those above the diagonal
 * are not read. */
static void subtract(double *restrict row, const double *restrict p, double f, const double *restrict q, double g,
                     int32_t first, int32_t last) {
  ALI3_SHORT
  for (int32_t j = first & ~1; j <= last; j += 2) {
    const double even = f * p[j] + g * q[j], odd = f * p[j + 1] + g * q[j + 1];
    row[j] -= even;
    row[j + 1] -= odd;
  }
}

/* M = L' D L from the leaves to the root, which preserves the zeros between branches (Featherstone 2005), two joints of
 * a run at a time; b becomes L'^-1 b. The diagonal stores 1/D. */
bool ali3_tree_factorise(const ali3_tree *T, ali3_tree_work *w, double *b) {
  bool positive = true;
  for (int32_t k = T->n; k > 0;) {
    const int32_t previous = T->run[k] < k ? k - 1 : k; /* its parent, or itself at the start of a run */
    double *p = w->mass[k], *q = w->mass[previous];
    const double f = 1.0 / p[k], value = b[k];
    double g = 0.0, next = 0.0;
    positive = positive && p[k] > 0.0;
    p[k] = f;
    if (previous < k) {
      const double factor = p[previous] * f;
      for (int32_t last = previous; last > 0; last = T->parent[T->run[last]])
        subtract(q, p, factor, p, 0.0, T->run[last], last);
      p[previous] = factor;
      b[previous] -= factor * value;
      positive = positive && q[previous] > 0.0;
      q[previous] = g = 1.0 / q[previous];
      next = b[previous];
    }
    for (int32_t i = T->parent[previous]; i > 0; i = T->parent[i]) {
      const double of_p = p[i] * f, of_q = q[i] * g;
      for (int32_t last = i; last > 0; last = T->parent[T->run[last]])
        subtract(w->mass[i], p, of_p, q, of_q, T->run[last], last);
      b[i] -= of_p * value + of_q * next;
      p[i] = of_p;
      if (previous < k) q[i] = of_q;
    }
    k = previous - 1;
  }
  return positive;
}

void ali3_tree_solve(const ali3_tree *T, const ali3_tree_work *w, double *b) {
  for (int32_t k = 1; k <= T->n; k++) {
    const double *row = w->mass[k];
    double even = 0.0, odd = 0.0;
    for (int32_t last = k == T->run[k] ? T->parent[k] : k - 1; last > 0; last = T->parent[T->run[last]]) {
      int32_t i = T->run[last];
      for (; i < last; i += 2) {
        even += row[i] * b[i];
        odd += row[i + 1] * b[i + 1];
      }
      if (i == last) even += row[i] * b[i];
    }
    b[k] = b[k] * row[k] - (even + odd);
  }
}
