/* The instance of a System: its data, its state, and the work memory of a step. Its members are declared in
 * instance/. */
#ifndef ALI3_INSTANCE_H
#define ALI3_INSTANCE_H
#include "instance/data.h"
#include "instance/elements.h"
#include "instance/methods.h"
#include "instance/states.h"
#include "instance/step.h"
#include "system.h"

typedef struct ali3_tree_work ali3_tree_work; /* tree/tree.h */

struct ali3_instance {
  const ali3_system *system; /* `base`, or a copy with other wheel axes */
  const ali3_system *base; /* as loaded */
  void (*release)(void *block);

  ali3_settings settings; /* data */
  ali3_parameters parameters;
  ali3_parametric_axes axes;
  ali3_masses mass;
  ali3_roads roads;
  ali3_inputs inputs;
  ali3_start start;

  ali3_clock clock; /* state */
  ali3_vectors now, next;
  ali3_stored_states stored;
  ali3_report report;

  ali3_rule rule; /* the step */
  ali3_iterate step;
  ali3_mixing mixing;
  ali3_tangent_work tangent;
  ali3_parting parting;
  ali3_work_bound bound;

  ali3_element_work element; /* forces */
  ali3_flexible_work flexible;
  ali3_lookup_memory lookup;
  ali3_watch watch;

  ali3_driving_arrays driving; /* methods */
  ali3_discrete discrete;
  ali3_radau radau;
  ali3_tree_work *tree;
  ali3_branches branch;
};
#endif
