/* The contract of a time integrator. Each defines its ali3_method_<name> in its own file
 * of methods/ and has one line in ALI3_METHODS of ali3.h. */
#ifndef ALI3_METHOD_H
#define ALI3_METHOD_H
#include "instance.h"
#include "request.h"

/* Round-off that bounds the steps of a controlled run from below: that of equations of index three, solved by rules of
 * order two or by collocation, or of index one. */
typedef enum { ALI3_ROUND_OFF_INDEX_3 = 0, ALI3_ROUND_OFF_COLLOCATION, ALI3_ROUND_OFF_INDEX_1 } ali3_round_off;

typedef struct {
  /* A step from in->now, after ali3_inputs_begin. Before it, in->next is a copy of in->now, so it
   * has what a method does not change, such as switches. A good step ends with ali3_accept; one that is
   * refused, with a status, leaves in->now as it was, or has called ali3_back_up before it changed it. It does not
   * allocate, counts iterations, factorizations and solves in in->report and never passes a NaN on. */
  ali3_status (*step)(ali3_instance *in, const ali3_request *request);
  /* The following may be NULL. */
  void (*before)(ali3_instance *in, const ali3_request *request); /* what it changes in in->now, after ali3_back_up */
  void (*motion)(ali3_instance *in, double h);   /* ali3_balance_change after a good step; NULL: the step does it */
  bool (*has_balance)(const ali3_instance *in);  /* whether its steps end with ali3_energy_watch; NULL: never */
  /* Whether an open balance says by itself that a run is wrong; a quadrature of work errs where it is stiff. */
  bool balance_decides;
  bool (*has_guides_work)(const ali3_instance *in); /* whether its steps measure the work of guides; NULL: never */
  ali3_status (*takes)(const ali3_instance *in); /* ALI3_OK, or why it cannot take the System; NULL: it takes all */
  const char *excludes; /* what it takes no System with, in words for users; NULL: it takes all */
  /* What readers of in->now need after steps of which nothing is read, and after those of which sensors are. */
  void (*after_unobserved)(ali3_instance *in);
  void (*after_sampled)(ali3_instance *in);
  int32_t owner; /* ALI3_METHOD_* that its steps leave in the history of the state: its own, or one it shares */
  bool relative; /* steps relative coordinates: no copy to in->next, which is filled when it is read */
  bool fills; /* steps write all of q, qd, qdd and lam of in->next and, of rigid Systems, past_a and past_lam; these are
                 then no copy */
  double stable_rate; /* of an explicit rule: largest step times rate that it follows, of negative rates; else 0 */
  ali3_round_off round_off;
} ali3_method;

#define ALI3_METHOD_DECLARED(NAME, name, order) extern const ali3_method ali3_method_##name;
ALI3_METHODS(ALI3_METHOD_DECLARED)
#undef ALI3_METHOD_DECLARED

/* The method of the settings, whether it takes the System, whether its steps end with ali3_energy_watch; order of its
 * steps where they change. */
const ali3_method *ali3_method_of(const ali3_instance *in);
ali3_status ali3_check_method(const ali3_instance *in);
bool ali3_has_balance(const ali3_instance *in);
int32_t ali3_method_order(const ali3_instance *in);
#endif
