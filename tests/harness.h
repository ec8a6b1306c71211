/* The test harness. A suite is a function that runs named tests; each test prints one line,
 * `ok SUITE: NAME`, `FAIL SUITE: NAME: WHY` or `skip SUITE: NAME: WHY`, and tests/run.sh counts the lines. */
#ifndef HARNESS_H
#define HARNESS_H

#include <stdbool.h>
#include <stdint.h>

/* Starts a test; printf-like name. Ends the one before. */
void test(const char *name, ...) __attribute__((format(printf, 1, 2)));

/* Fails the current test where `ok` is false; the first failure's message is printed. Returns ok. */
bool expect(bool ok, const char *why, ...) __attribute__((format(printf, 2, 3)));

/* Marks the current test as skipped. */
void skip(const char *why, ...) __attribute__((format(printf, 1, 2)));

/* Options of the test program. */
extern bool test_slow_machine;       /* --slow: an emulator or a sanitizer runs this: fewer samples, no time limits */
extern bool test_update;             /* --update: write the committed tables anew instead of comparing with them */
extern const char *test_data;        /* --data DIR: where the committed tables are; default "tests" */

/* SplitMix64: the same numbers everywhere. */
typedef struct { uint64_t state; } test_random;
uint64_t random_u64(test_random *);
double random_unit(test_random *);               /* [0, 1) */

/* The suites, in the order they run (main in harness.c has the table). */
void suite_ops(void);
void suite_elementary(void);
void suite_fits(void);
void suite_api(void);
void suite_encode(void);
void suite_conversions(void);
void suite_metals(void);
void suite_truths(void);
void suite_accuracy(void);
void suite_stability(void);
void suite_physics(void);
void suite_agreement(void);
void suite_packed(void);
void suite_golden(void);
void suite_environment(void);

#endif
