/* The energy balance of a run. */
#ifndef ALI3_BOOKS_H
#define ALI3_BOOKS_H
#include "../instance.h"

bool ali3_keeps_books(const ali3_instance *in);
void ali3_books_open(ali3_instance *in);
void ali3_books_energy(ali3_instance *in, double error, double kinetic);
void ali3_books_motion(ali3_report *report, double speed, double change, double miss);
void ali3_books_step(ali3_instance *in, double h);
void ali3_books_back(ali3_report *report, const ali3_report *before);
#endif
