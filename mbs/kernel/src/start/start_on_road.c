/* Start on roads from files: the scene is raised or lowered as a whole until every part that touches the road in the
 * drawing is at most as deep as there. The other parts then settle from above. */
#include "start_on_road.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "../elements/element.h"
#include "../elements/road.h"
#include "../state/parameters.h"
#include "../state/road_files.h"
#include "initialise.h"

static const double LEVEL = 1e-10; /* m: a smaller lift is omitted; also the accuracy of a lift */
static const double TOUCHING = 1e-6; /* m: depth to which a scene is lowered */
static const double UNEVEN = 1e-3; /* m: a start that sinks by less counts as level */
static const double WAY = 0.01; /* m: displacement over which a slope is measured */
enum { MAX_MOVES = 100 };

/* Depth of element e in `roads` at q, raised by `raised`, m; *cosine: rise per depth. */
static double depth(const ali3_instance *in, const ali3_road *roads, const double *q, int32_t e, double raised,
                    double *cosine) {
  double u[ALI3_MAX_SIGNALS] = {0.0};
  const ali3_element_args a = ali3_start_arguments(in, roads, q, e, u);
  return in->system->el_kind[e]->depth(&a, raised, cosine);
}

/* Writes the depths of the drawing on the roads of the file to in->element.potential; true if an element touches. */
static bool measure_drawn_depths(ali3_instance *in) {
  const ali3_system *S = in->system;
  bool touching = false;
  if (S->n_road_parameter > 0)
    memcpy(in->parameters.road_parameter, S->road_parameter, (size_t)S->n_road_parameter * sizeof(double));
  for (int32_t e = 0; e < S->size.ne; e++) {
    double cosine;
    if (S->el_kind[e]->depth == NULL) continue;
    in->element.potential[e] = depth(in, in->roads.own, in->start.q, e, 0.0, &cosine);
    touching = touching || in->element.potential[e] > 0.0;
  }
  ali3_parameters_apply(in);
  return touching;
}

/* Depth of element e in the road at the present position, m; -infinity if it has no contact. */
static double current_depth(const ali3_instance *in, int32_t e) {
  double cosine;
  return in->system->el_kind[e]->depth != NULL ? depth(in, in->roads.used, in->now.q, e, 0.0, &cosine) : -INFINITY;
}

/* Rise, searched upwards from `from`, at which element e at q is as deep as `target_depth`, m. */
static double find_rise(const ali3_instance *in, const double *q, int32_t e, double from, double target_depth) {
  double rise = from, cosine = 1.0;
  for (int k = 0; k < MAX_MOVES; k++) {
    const double excess = depth(in, in->roads.used, q, e, rise, &cosine) - target_depth;
    if (!(fabs(excess) > LEVEL)) break;
    rise += excess * cosine;
  }
  return rise;
}

void ali3_start_on_road(ali3_instance *in) {
  const ali3_system *S = in->system;
  double lift = -INFINITY, cosine;
  in->start.lift = in->start.uneven = 0.0;
  if (!in->start.to_lift || !S->size.has_pose || !ali3_roads_from_outside(in)) return;
  const bool touching = measure_drawn_depths(in);
  for (int32_t e = 0; e < S->size.ne; e++)
    if (S->el_kind[e]->depth != NULL && (!touching || in->element.potential[e] > 0.0))
      lift = fmax(lift, find_rise(in, in->now.q, e, 0.0, in->element.potential[e]));
  if (!(lift > -INFINITY)) return; /* no element can touch a road */
  for (int32_t e = 0; e < S->size.ne && touching; e++) {
    if (S->el_kind[e]->depth == NULL) continue;
    if (in->element.potential[e] <= 0.0 && depth(in, in->roads.used, in->now.q, e, lift, &cosine) > 0.0)
      lift = fmax(lift, find_rise(in, in->now.q, e, lift, 0.0));
  }
  for (int32_t e = 0; e < S->size.ne && touching; e++)
    if (S->el_kind[e]->depth != NULL && in->element.potential[e] > 0.0)
      in->start.uneven =
          fmax(in->start.uneven, in->element.potential[e] - depth(in, in->roads.used, in->now.q, e, lift, &cosine));
  if (fabs(lift) <= LEVEL) return;
  in->start.lift = lift;
  for (int32_t i = 0; i < S->size.nq; i++) in->now.q[i] += lift * S->pose_z[i];
}

bool ali3_lower_to_road(ali3_instance *in) {
  const ali3_system *S = in->system;
  double rise = -INFINITY;
  for (int32_t e = 0; e < S->size.ne; e++) {
    if (S->el_kind[e]->depth == NULL) continue;
    if (current_depth(in, e) > 0.0) return false;
    rise = fmax(rise, find_rise(in, in->now.q, e, 0.0, TOUCHING));
  }
  if (!(rise > -INFINITY)) return false; /* no element can touch a road */
  for (int32_t i = 0; i < S->size.nq; i++) in->now.q[i] += rise * S->pose_z[i];
  return true;
}

double ali3_climb(const ali3_instance *in, const double *rate, double *q, double *spread) {
  const ali3_system *S = in->system;
  double fastest = 0.0, sum = 0.0, slowest = INFINITY, fastest_rise = -INFINITY;
  int32_t touching = 0;
  *spread = 0.0;
  for (int32_t i = 0; i < S->size.nq; i++) fastest = fmax(fastest, fabs(rate[i]));
  if (!(fastest > 0.0)) return 0.0;
  for (int32_t i = 0; i < S->size.nq; i++) q[i] = in->now.q[i] + WAY / fastest * rate[i];
  for (int32_t e = 0; e < S->size.ne; e++) {
    const double depth_e = current_depth(in, e);
    if (!(depth_e > 0.0)) continue;
    const double rise = fastest / WAY * find_rise(in, q, e, 0.0, depth_e);
    sum += rise, slowest = fmin(slowest, rise), fastest_rise = fmax(fastest_rise, rise);
    touching++;
  }
  if (touching == 0) return 0.0;
  *spread = fastest_rise - slowest;
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
    touching[e] = current_depth(in, e) > 0.0;
}
