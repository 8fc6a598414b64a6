/* Forces of all elements and flexible bodies, and their tangents. */
#ifndef ALI3_FORCES_H
#define ALI3_FORCES_H
#include "../instance.h"

/* Request for an evaluation: ali3_forces needs all arrays, ali3_elements_forces neither q, qd nor Q. */
typedef struct {
  const double *q, *qd, *y_old; /* nq, nq, ny: coordinates, rates, element states to start from */
  double h, wC, wK, reach; /* as in ali3_element_args */
  bool tangent; /* also signal tangents, in->element.S */
  bool discrete; /* over a step from in->now, by discrete gradients if an element has them */
  bool iterate; /* one of several iterates: in->watch.now is not updated */
  double *Q; /* nq, N or N m: generalised forces with gravity */
  double *y_new, *out, *potential; /* ny; nout; ne, J */
} ali3_force_call;

/* Request at the position and velocity of v from the element states of in->now: forces to in->step.Q, states, outputs
 * and potentials to v; without a step and without tangents. */
static inline ali3_force_call ali3_forces_at(ali3_instance *in, ali3_vectors *v) {
  return (ali3_force_call){.q = v->q,
                           .qd = v->qd,
                           .y_old = in->now.y,
                           .Q = in->step.Q,
                           .y_new = v->y,
                           .out = v->out,
                           .potential = v->potential};
}

/* Generalised forces of elements, gravity, and flexible and lookup-table bodies. */
void ali3_forces(ali3_instance *in, const ali3_force_call *call);
/* Evaluates the elements at the signals of the last ali3_forces. */
void ali3_elements_forces(ali3_instance *in, const ali3_force_call *call);
/* F += tangents of elements, and of flexible and lookup-table bodies with their changing mass, in front storage, of the
 * last ali3_forces with `tangent`. */
void ali3_forces_tangent(ali3_instance *in, double *F);
/* Evaluates element e at its signals u and rates ud (nsig): forces f (nsig), tangent (nsig x nsig, or NULL). Returns
 * whether both are zero. */
bool ali3_element_forces(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud,
                         double *f, double *tangent);
/* Makes discrete changes of element e after an accepted step, at its signals u and rates ud. */
void ali3_element_accept(ali3_instance *in, const ali3_force_call *call, int32_t e, const double *u, const double *ud);
/* The same for all elements, at the signals of the last ali3_forces. */
void ali3_forces_accept(ali3_instance *in, const ali3_force_call *call);
#endif
