/* The stability suite's traps of odd values: not finite, outside their domains, anything at all. */
#ifndef BAD_VALUES_H
#define BAD_VALUES_H

#include "subject.h"

extern const trap bad_values[];
extern const int bad_value_count;

#endif
