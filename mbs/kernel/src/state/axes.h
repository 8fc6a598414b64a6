/* Axes of wheels with directions set by parameters. */
#ifndef ALI3_AXES_H
#define ALI3_AXES_H
#include "../instance.h"
#include "../system/pool.h"

/* Places the arrays for the axes of an instance. */
void ali3_axes_place(const ali3_system *s, ali3_instance *in, ali3_pool *pool);
/* Updates the System of the instance after parameters have changed axes. */
void ali3_axes_apply(ali3_instance *in);
/* Whether the axis of wheel k is as drawn. */
bool ali3_axis_as_drawn(const ali3_instance *in, int64_t k);
/* Change of the second moments of wheel k about its centre, kg m^2, in the axes of the drawing. */
void ali3_axis_moments(const ali3_instance *in, int64_t k, double change[3][3]);
/* Whether both instances have equal axes, so that one System applies to both. */
bool ali3_axes_same(const ali3_instance *one, const ali3_instance *other);
#endif
