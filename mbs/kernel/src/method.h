/* The contract of a time integrator. Each defines its ali3_method_<name> in its own file
 * of methods/ and has one line in ALI3_METHODS of ali3.h. */
#ifndef ALI3_METHOD_H
#define ALI3_METHOD_H
#include "instance.h"
#include "request.h"

/* Round-off that limits the steps of a controlled run from below: of methods of order two for index three, or others. */
typedef enum { ALI3_ROUND_OFF_INDEX_3 = 0, ALI3_ROUND_OFF_INDEX_1 } ali3_round_off;

typedef struct {
  /* Makes a step from in->now, after ali3_inputs_begin. in->next is a copy of in->now, so that it has values that a
   * method does not change, such as switches. A completed step ends with ali3_accept, after which in->next is its
   * start; a refused one returns its status and leaves in->now unchanged, or has called ali3_back_up before it changed
   * it. A step does not allocate, counts iterations, factorizations and solves in in->report and accepts no NaN. */
  ali3_status (*step)(ali3_instance *in, const ali3_request *request);
  /* The following may be NULL. */
  /* Changes in->now before a step, after ali3_back_up. */
  void (*before)(ali3_instance *in, const ali3_request *request);
  /* Calls ali3_balance_change after a completed step; NULL: the step does. */
  void (*motion)(ali3_instance *in, double h);
  bool (*has_balance)(const ali3_instance *in); /* whether its steps end with ali3_energy_watch; NULL: never */
  /* Whether a large energy error alone makes a run invalid; not by quadratures of work, which have errors in stiff
   * systems. */
  bool balance_decides;
  /* Whether its steps measure the work of driving functions; NULL: never. */
  bool (*has_driving_work)(const ali3_instance *in);
  /* ALI3_OK, or a status if it does not accept the System; NULL: it accepts all. */
  ali3_status (*check_system)(const ali3_instance *in);
  const char *excludes; /* what it does not accept in a System, for messages; NULL: it accepts all */
  /* Completes in->now after steps of which nothing was read. */
  void (*after_unobserved)(ali3_instance *in);
  /* The same after steps of which sensors were read. */
  void (*after_sampled)(ali3_instance *in);
  int32_t owner; /* ALI3_METHOD_* in the history of the state after its steps: its own, or a shared one */
  bool relative; /* its steps are in relative coordinates: in->next is not a copy and is filled when it is read */
  /* Its steps write all of q, qd, qdd and lam of in->next and, of rigid Systems, past_a and past_lam, which are not
   * copied before. */
  bool fills;
  bool locates_events; /* its steps ask ali3_contact_event before they are accepted; otherwise advance.c asks then */
  double stable_rate; /* of an explicit method: largest stable step times rate, for negative real rates; otherwise 0 */
  ali3_round_off round_off; /* of its equations */
} ali3_method;

#define ALI3_METHOD_DECLARED(NAME, name, order) extern const ali3_method ali3_method_##name;
ALI3_METHODS(ALI3_METHOD_DECLARED)
#undef ALI3_METHOD_DECLARED

/* The method of the settings. */
const ali3_method *ali3_method_of(const ali3_instance *in);
/* ALI3_OK, or a status if the method does not accept the System. */
ali3_status ali3_check_method(const ali3_instance *in);
/* Whether its steps end with ali3_energy_watch. */
bool ali3_has_balance(const ali3_instance *in);
/* Order of convergence of its steps. */
int32_t ali3_method_order(const ali3_instance *in);
#endif
