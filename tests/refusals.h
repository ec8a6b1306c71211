/* The part of the api suite that is about what the library refuses: every status, field and index of facet.h. */
#ifndef REFUSALS_H
#define REFUSALS_H

void test_refusals(void);

#endif
