/* The stability suite's traps of lights with a position and of ambient light. */
#ifndef LIGHTS_H
#define LIGHTS_H

#include "subject.h"

extern const trap light_traps[];
extern const int light_trap_count;

#endif
