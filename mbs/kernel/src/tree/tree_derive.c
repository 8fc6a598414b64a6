/* The tree of a System as lanes, and its work space. */
#include <string.h>

#include "../system.h"
#include "tree.h"

void ali3_tree_derive(const ali3_system *s, ali3_tree *T) {
  T->n = (int32_t)s->n_tree_parent;
  T->lanes = (T->n + 2) / 2 * 2;
  T->n_cut = (int32_t)(s->n_tree_cut_body / 2);
  T->n_angle = (int32_t)s->n_tree_angle_col;
  for (int32_t c = 0; c < 2 * T->n_cut; c++) T->n_row += s->tree_cut_rows[c];
  for (int32_t b = 1; b <= T->n; b++) {
    const double *base = s->tree_base + 12 * (b - 1), *inertia = s->tree_inertia + 9 * (b - 1);
    T->parent[b] = s->tree_parent[b - 1];
    T->run[b] = b > 1 && T->parent[b] == b - 1 ? T->run[b - 1] : b;
    T->slide[b] = (double)s->tree_slides[b - 1];
    T->turn[b] = 1.0 - T->slide[b];
    T->mass[b] = s->tree_mass[b - 1];
    T->round[b] = inertia[0];
    T->first[b] = inertia[1];
    T->second[b] = inertia[5];
    T->slides = T->slides || s->tree_slides[b - 1] != 0;
    T->asymmetric = T->asymmetric || inertia[5] != 0.0;
    for (int i = 0; i < 3; i++) {
      T->place[i][b] = base[i];
      for (int k = 0; k < 3; k++) T->base[i][k][b] = base[3 + 3 * k + i];
      T->centre[i][b] = s->tree_centre[3 * (b - 1) + i];
      T->first_axis[i][b] = inertia[2 + i];
      T->second_axis[i][b] = inertia[6 + i];
    }
  }
  for (int32_t b = T->n; b > 0; b--) {
    T->composite[b] += T->mass[b];
    T->composite[T->parent[b]] += T->composite[b];
  }
  for (int i = 0; i < 3; i++) T->gravity[i] = s->tree_gravity[i];
}

void ali3_tree_start(const ali3_system *s, ali3_tree_work *w) {
  for (int i = 0; i < 3; i++) {
    w->frame[0][i][i] = 1.0;
    for (int32_t b = 1; b <= s->tree->n; b++) {
      w->relative[b][i][2] = s->tree->base[i][2][b];
      w->relative[b][i][3] = s->tree->place[i][b];
    }
    w->gravity[i] = s->size.ne > 0 ? 0.0 : s->tree->gravity[i];
  }
}
