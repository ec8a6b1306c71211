/* Many short rounds: in each, all contenders take turns. */
#ifndef BENCH_ROUNDS_H
#define BENCH_ROUNDS_H

#include "bench_contenders.h"

/* Fills what contenders have by round, for that many seconds and a few rounds at least. Says what is wrong. */
bool rounds_run(contenders *c, double seconds);

#endif
