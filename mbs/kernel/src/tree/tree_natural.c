/* Conversion between the relative coordinates of a tree and the natural coordinates of its System. */
#include "../algebra/elementary.h"
#include "../algebra/small_vectors.h"
#include "../elements/signal.h"
#include "../instance.h"
#include "tree.h"

typedef struct {
  double origin[3], axis[3][3], velocity[3], spin[3];
} frame;

/* Frame of body b, 0: the ground; the angular velocity is half the sum of the products of axes and their rates. */
static frame evaluate_frame(const ali3_system *S, int32_t b, const double *q, const double *qd) {
  frame f = {{0.0}, {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}, {0.0}, {0.0}};
  if (b == 0) return f;
  const int32_t *signal = S->tree_frame + 12 * (int64_t)(b - 1);
  for (int i = 0; i < 3; i++) {
    f.origin[i] = ali3_signal_at(S, signal[i], q, false);
    f.velocity[i] = ali3_signal_at(S, signal[i], qd, true);
  }
  for (int k = 0; k < 3; k++) {
    double rate[3], product[3];
    for (int i = 0; i < 3; i++) {
      f.axis[k][i] = ali3_signal_at(S, signal[3 + 3 * k + i], q, false);
      rate[i] = ali3_signal_at(S, signal[3 + 3 * k + i], qd, true);
    }
    ali3_cross(f.axis[k], rate, product);
    for (int i = 0; i < 3; i++) f.spin[i] += 0.5 * product[i];
  }
  return f;
}

void ali3_tree_read(ali3_instance *in, const double *q, const double *qd, double *x) {
  const ali3_system *S = in->system;
  const ali3_tree *T = S->tree;
  for (int32_t b = 1; b <= T->n; b++) {
    const frame parent = evaluate_frame(S, T->parent[b], q, qd), body = evaluate_frame(S, b, q, qd);
    double base[3][3], arm[3], relative[3], gap[3];
    for (int i = 0; i < 3; i++) {
      arm[i] = 0.0;
      for (int k = 0; k < 3; k++) {
        arm[i] += parent.axis[k][i] * T->place[k][b];
        base[k][i] = 0.0;
        for (int m = 0; m < 3; m++) base[k][i] += parent.axis[m][i] * T->base[m][k][b];
      }
      gap[i] = body.origin[i] - (parent.origin[i] + arm[i]);
    }
    if (T->slide[b] != 0.0) {
      for (int i = 0; i < 3; i++) arm[i] += gap[i];
      ali3_cross(parent.spin, arm, relative);
      x[b - 1] = ali3_dot(base[2], gap);
      for (int i = 0; i < 3; i++) relative[i] = body.velocity[i] - parent.velocity[i] - relative[i];
      x[T->n + b - 1] = ali3_dot(base[2], relative);
    } else {
      x[b - 1] = ali3_atan2(ali3_dot(base[1], body.axis[0]), ali3_dot(base[0], body.axis[0]));
      for (int i = 0; i < 3; i++) relative[i] = body.spin[i] - parent.spin[i];
      x[T->n + b - 1] = ali3_dot(base[2], relative);
    }
  }
}

void ali3_tree_write(const ali3_instance *in, double *q, double *qd, double *qdd) {
  const ali3_system *S = in->system;
  const ali3_tree_work *w = in->tree;
  ali3_angles_write(S, w, q, qd, qdd);
  for (int64_t n = 0; n < S->n_tree_out_body; n++) {
    const int32_t b = S->tree_out_body[n], *column = S->tree_out_col + 3 * n;
    const double *local = S->tree_out_local + 4 * n, o = local[0];
    double r[3], spin[3], rate[3], v[3], turned[3], vd[3], acceleration[3];
    for (int i = 0; i < 3; i++) {
      r[i] = o * w->origin[i][b] +
             (w->frame[b][i][0] * local[1] + w->frame[b][i][1] * local[2] + w->frame[b][i][2] * local[3]);
      spin[i] = w->spin[i][b];
      rate[i] = w->spin_rate[i][b];
    }
    ali3_cross(spin, r, v);
    for (int i = 0; i < 3; i++) v[i] += o * w->drift[i][b];
    ali3_cross(rate, r, vd);
    ali3_cross(spin, v, turned);
    for (int i = 0; i < 3; i++) {
      acceleration[i] = o * w->drift_rate[i][b] + vd[i] + turned[i];
      if (column[i] < 0) continue;
      q[column[i]] = r[i];
      if (qd != NULL) qd[column[i]] = v[i];
      if (qdd != NULL) qdd[column[i]] = acceleration[i];
    }
  }
}

void ali3_tree_load(const ali3_instance *in, const double *Q) {
  const ali3_system *S = in->system;
  ali3_tree_work *w = in->tree;
  for (int64_t n = 0; n < S->n_tree_out_body; n++) {
    const int32_t b = S->tree_out_body[n], *column = S->tree_out_col + 3 * n;
    const double *local = S->tree_out_local + 4 * n, o = local[0];
    double r[3], force[3], torque[3];
    for (int i = 0; i < 3; i++) {
      r[i] = o * w->origin[i][b] +
             (w->frame[b][i][0] * local[1] + w->frame[b][i][1] * local[2] + w->frame[b][i][2] * local[3]);
      force[i] = column[i] < 0 ? 0.0 : Q[column[i]];
    }
    ali3_cross(r, force, torque);
    for (int i = 0; i < 3; i++) {
      w->force[i][b] -= o * force[i];
      w->torque[i][b] -= torque[i];
    }
  }
}
