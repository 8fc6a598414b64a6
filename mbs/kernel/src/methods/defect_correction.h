/* Defect corrections: Newton corrections with the forces of elements after the correction. */
#ifndef ALI3_DEFECT_CORRECTION_H
#define ALI3_DEFECT_CORRECTION_H
#include "../algebra/real.h"
#include "../instance.h"

/* Only if bodies are flexible, where iterations are expensive; elements on tables would need the tables again. */
static inline bool ali3_defect_corrected(const ali3_system *S) { return S->n_flexible > 0 && S->n_tabled == 0; }

/* Corrects the correction in in->step.x, in these lanes. */
ALI3_PER_WIDTH void ali3_defect_correction(ali3_instance *in, double h, int32_t iteration, truth lanes);
#endif
