/* Report of the solver: its clock, its report, and numbers of it that sensors of type 13 and the FMU read. */
#include <float.h>
#include <math.h>

#include "../instance.h"

double ali3_time(const ali3_instance *in) {
  return in != NULL ? in->clock.base + (double)in->clock.count * in->clock.h : 0.0;
}

/* Status of the last step, or that a good one followed a change of an assembly mode. */
static ali3_status find_status(const ali3_report *report) {
  const ali3_status last = (ali3_status)report->last_status;
  return last == ALI3_OK && report->branch_changes > 0 ? ALI3_BRANCH_CHANGED : last;
}

double ali3_energy_balance(const ali3_report *report) {
  const double size = report != NULL ? fmax(report->kinetic_peak + report->work, report->energy_floor) : 0.0;
  return size > 0.0 ? fabs(report->energy_error) / size : 0.0;
}

/* A refused step may leave a residual beyond all numbers. */
static double or_largest(double value) { return value - value == 0.0 ? value : DBL_MAX; }

double ali3_solver_value(const ali3_instance *in, int32_t kind) {
  if (in == NULL) return 0.0;
  const ali3_report *r = &in->report;
  switch (kind) {
  case ALI3_SOLVER_ITERATIONS:
    return r->last_iterations;
  case ALI3_SOLVER_VIOLATION:
    return or_largest(r->violation);
  case ALI3_SOLVER_RESIDUAL:
    return or_largest(r->residual);
  case ALI3_SOLVER_FACTORIZATIONS:
    return (double)r->factorizations;
  case ALI3_SOLVER_HALVINGS:
    return (double)r->halvings;
  case ALI3_SOLVER_STATUS:
    return (double)find_status(r);
  case ALI3_SOLVER_ENERGY_ERROR:
    return or_largest(r->energy_error);
  case ALI3_SOLVER_ENERGY_BALANCE:
    return or_largest(ali3_energy_balance(r));
  case ALI3_SOLVER_CAPPED:
    return (double)r->capped;
  default:
    return 0.0;
  }
}

double ali3_capped_residual(const ali3_instance *in) { return in != NULL ? in->bound.call_residual : 0.0; }
