/* A scene that a pose may place starts on the roads that files give it: raised or lowered as a whole until every part
 * that touches the road in the drawing is at most as deep as there. The others then hang above it and settle. */
#include "start_on_road.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../elements/element.h"
#include "../elements/road.h"
#include "../state/parameters.h"
#include "../state/road_files.h"
#include "initialise.h"

static const double LEVEL = 1e-10; /* m: a height that needs no lift, and the error of one */
static const double TOUCHING = 1e-6; /* m: depth of what is lowered */
static const double UNEVEN = 1e-3; /* m: a start that sinks by less is level */
static const double WAY = 0.01; /* m, along which a slope is measured */
enum { MOST_MOVES = 100 };

/* Depth of element e at q, raised; its signals are those of `roads`. */
static double depth(const ali3_instance *in, const ali3_road *roads, const double *q, int32_t e, double raised,
                    double *part) {
  double u[ALI3_MAX_SIGNALS] = {0.0};
  const ali3_element_args a = ali3_start_arguments(in, roads, q, e, u);
  return in->system->el_kind[e]->depth(&a, raised, part);
}

/* Depths of the drawing on the roads of the file, in in->element.potential. True where any element touches. */
static bool drawn_depths(ali3_instance *in) {
  const ali3_system *S = in->system;
  bool touching = false;
  if (S->n_road_real > 0) memcpy(in->parameters.road_real, S->road_real, (size_t)S->n_road_real * sizeof(double));
  for (int32_t e = 0; e < S->size.ne; e++) {
    double part;
    if (S->el_kind[e]->depth == NULL) continue;
    in->element.potential[e] = depth(in, in->roads.own, in->start.q, e, 0.0, &part);
    touching = touching || in->element.potential[e] > 0.0;
  }
  ali3_parameters_apply(in);
  return touching;
}

static double depth_now(const ali3_instance *in, int32_t e) {
  double part;
  return in->system->el_kind[e]->depth != NULL ? depth(in, in->roads.used, in->now.q, e, 0.0, &part) : -INFINITY;
}

/* The rise from `from` on at which element e at q is as deep as `wanted`. */
static double rise_of(const ali3_instance *in, const double *q, int32_t e, double from, double wanted) {
  double rise = from, part = 1.0;
  for (int k = 0; k < MOST_MOVES; k++) {
    const double excess = depth(in, in->roads.used, q, e, rise, &part) - wanted;
    if (!(fabs(excess) > LEVEL)) break;
    rise += excess * part;
  }
  return rise;
}

void ali3_start_on_road(ali3_instance *in) {
  const ali3_system *S = in->system;
  double lift = -INFINITY, part;
  in->start.lift = in->start.uneven = 0.0;
  if (!in->start.to_lift || !S->size.has_pose || !ali3_roads_from_outside(in)) return;
  const bool touching = drawn_depths(in);
  for (int32_t e = 0; e < S->size.ne; e++)
    if (S->el_kind[e]->depth != NULL && (!touching || in->element.potential[e] > 0.0))
      lift = fmax(lift, rise_of(in, in->now.q, e, 0.0, in->element.potential[e]));
  if (!(lift > -INFINITY)) return; /* nothing meets a road */
  for (int32_t e = 0; e < S->size.ne && touching; e++) {
    if (S->el_kind[e]->depth == NULL) continue;
    if (in->element.potential[e] <= 0.0 && depth(in, in->roads.used, in->now.q, e, lift, &part) > 0.0)
      lift = fmax(lift, rise_of(in, in->now.q, e, lift, 0.0));
  }
  for (int32_t e = 0; e < S->size.ne && touching; e++)
    if (S->el_kind[e]->depth != NULL && in->element.potential[e] > 0.0)
      in->start.uneven =
          fmax(in->start.uneven, in->element.potential[e] - depth(in, in->roads.used, in->now.q, e, lift, &part));
  if (fabs(lift) <= LEVEL) return;
  in->start.lift = lift;
  for (int32_t i = 0; i < S->size.nq; i++) in->now.q[i] += lift * S->pose_z[i];
}

bool ali3_lower_to_road(ali3_instance *in) {
  const ali3_system *S = in->system;
  double rise = -INFINITY;
  for (int32_t e = 0; e < S->size.ne; e++) {
    if (S->el_kind[e]->depth == NULL) continue;
    if (depth_now(in, e) > 0.0) return false;
    rise = fmax(rise, rise_of(in, in->now.q, e, 0.0, TOUCHING));
  }
  if (!(rise > -INFINITY)) return false; /* nothing meets a road */
  for (int32_t i = 0; i < S->size.nq; i++) in->now.q[i] += rise * S->pose_z[i];
  return true;
}

double ali3_climb(const ali3_instance *in, const double *rate, double *q, double *spread) {
  const ali3_system *S = in->system;
  double fastest = 0.0, sum = 0.0, least = INFINITY, most = -INFINITY;
  int32_t touching = 0;
  *spread = 0.0;
  for (int32_t i = 0; i < S->size.nq; i++) fastest = fmax(fastest, fabs(rate[i]));
  if (!(fastest > 0.0)) return 0.0;
  for (int32_t i = 0; i < S->size.nq; i++) q[i] = in->now.q[i] + WAY / fastest * rate[i];
  for (int32_t e = 0; e < S->size.ne; e++) {
    const double deep = depth_now(in, e);
    if (!(deep > 0.0)) continue;
    const double rise = fastest / WAY * rise_of(in, q, e, 0.0, deep);
    sum += rise, least = fmin(least, rise), most = fmax(most, rise);
    touching++;
  }
  if (touching == 0) return 0.0;
  *spread = most - least;
  return sum / touching;
}

ali3_status ali3_start_text(const ali3_instance *in, char *text, size_t size) {
  if (in == NULL || text == NULL || size == 0) return ALI3_BAD_ARGUMENT;
  text[0] = 0;
  if (in->start.uneven > UNEVEN)
    snprintf(text, size,
             "The road is not level where this starts: the start is raised by %.3g m so that nothing is in the road, "
             "and the part that hangs highest above its place of rest sinks by %.3g m.",
             in->start.lift, in->start.uneven);
  return ALI3_OK;
}

void ali3_contacts(const ali3_instance *in, unsigned char *touching) {
  for (int32_t e = 0; in != NULL && touching != NULL && e < in->system->size.ne; e++)
    touching[e] = depth_now(in, e) > 0.0;
}
