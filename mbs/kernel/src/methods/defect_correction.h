/* Newton corrections that include changes of element forces outside the tangent. */
#ifndef ALI3_DEFECT_CORRECTION_H
#define ALI3_DEFECT_CORRECTION_H
#include "../algebra/real.h"
#include "../instance.h"

/* Used with flexible bodies, whose iterations are expensive; elements on tables would need table look-ups. */
static inline bool ali3_defect_corrected(const ali3_system *S) { return S->n_flexible > 0 && S->n_lookup == 0; }

/* Adds defect corrections to the Newton correction in in->step.x of these lanes; h: step, s. */
ALI3_PER_WIDTH void ali3_defect_correction(ali3_instance *in, double h, int32_t iteration, lane_mask lanes);
#endif
