/* The types of guides of a System file; `GuideType` in Python is read from here. */
#ifndef ALI3_GUIDE_TYPES_H
#define ALI3_GUIDE_TYPES_H

enum { /* guide_type */
       ALI3_GUIDE_OF_TIME = 0, /* polynomial pieces of time */
       ALI3_GUIDE_OF_INPUT,    /* an input through a critically damped filter, with a state of its own */
       ALI3_GUIDE_TYPE_COUNT
};
#endif
