/* Coulomb friction on one signal u: the force -tau of slider.h at the rate u'. */
#include "coordinate_friction_fields.h"
#include "element.h"
#include "slider.h"

static void evaluate(ali3_element_args *a) {
  const double *p = a->real;
  const ali3_slider slider = ali3_slider_step(a, p[STICK_STIFFNESS], p[STICK_DAMPING], p[LARGEST], a->ud[0]);
  a->f[0] = -slider.force;
  a->out[COORDINATE_FRICTION_OUT_FORCE] = -slider.force;
  a->out[COORDINATE_FRICTION_OUT_STICKING] = slider.sticks;
  if (a->S) a->S[0] = a->wC * slider.slope;
}

const ali3_element_type ali3_coordinate_friction = {
    ALI3_COORDINATE_FRICTION,
    .evaluate = evaluate,
};
