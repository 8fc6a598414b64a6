/* The numbers of a spring-damper and the laws of its end stops. */
#ifndef ALI3_SPRING_DAMPER_H
#define ALI3_SPRING_DAMPER_H
#include "contact_law.h"
#include "element.h"

enum { /* reals; progression and travel of bump, then of rebound; loss of bump, then of rebound */
       ALI3_SPRING_STIFFNESS,
       ALI3_SPRING_DAMPING,
       ALI3_SPRING_FREE_LENGTH,
       ALI3_SPRING_BUMP_LENGTH,
       ALI3_SPRING_BUMP_STIFFNESS,
       ALI3_SPRING_REBOUND_LENGTH,
       ALI3_SPRING_REBOUND_STIFFNESS,
       ALI3_SPRING_PROGRESSION,
       ALI3_SPRING_METAL_STIFFNESS = ALI3_SPRING_PROGRESSION + 4,
       ALI3_SPRING_METAL_ONSET,
       ALI3_SPRING_STOP_LOSS,
       ALI3_SPRING_REALS = ALI3_SPRING_STOP_LOSS + 2
};

/* Laws of the bump stop and the rebound stop over the length beyond them. */
void ali3_end_stops(const double *real, int32_t nreal, ali3_contact_law law[2]);
#endif
