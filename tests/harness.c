/* The test harness and the test program's main: facet-check [--slow] [--update] [--data DIR] [SUITE ...] */
#include "harness.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

bool test_slow_machine, test_update;
const char *test_data = "tests";

static const char *suite_name;
static char test_name[256], failure[512], skipped[256];
static int failures, tests;

static void finish_test(void)
{
    if (!test_name[0]) return;
    tests++;
    if (failure[0]) {
        printf("FAIL %s: %s: %s\n", suite_name, test_name, failure);
        failures++;
    } else if (skipped[0]) {
        printf("skip %s: %s: %s\n", suite_name, test_name, skipped);
    } else {
        printf("ok %s: %s\n", suite_name, test_name);
    }
    fflush(stdout);
    test_name[0] = failure[0] = skipped[0] = 0;
}

#define FORMAT_INTO(buffer, format)                                                                                   \
    do {                                                                                                              \
        va_list arguments;                                                                                            \
        va_start(arguments, format);                                                                                  \
        vsnprintf(buffer, sizeof buffer, format, arguments);                                                          \
        va_end(arguments);                                                                                            \
    } while (0)

void test(const char *name, ...)
{
    finish_test();
    FORMAT_INTO(test_name, name);
}

bool expect(bool ok, const char *why, ...)
{
    if (!ok && !failure[0]) FORMAT_INTO(failure, why);
    return ok;
}

void skip(const char *why, ...)
{
    FORMAT_INTO(skipped, why);
}

static const struct { const char *name; void (*run)(void); } suites[] = {
    { "ops", suite_ops },                  { "elementary", suite_elementary },
    { "fits", suite_fits },                    { "api", suite_api },                  { "encode", suite_encode },
    { "conversions", suite_conversions },  { "metals", suite_metals },        { "truths", suite_truths },
    { "accuracy", suite_accuracy },        { "stability", suite_stability },  { "physics", suite_physics },
    { "agreement", suite_agreement },      { "packed", suite_packed },        { "golden", suite_golden },
    { "environment", suite_environment },
};

static bool run_suite(const char *name)
{
    bool found = false;
    for (size_t i = 0; i < sizeof suites / sizeof suites[0]; i++) {
        if (name && strcmp(name, suites[i].name)) continue;
        found = true;
        suite_name = suites[i].name;
        const int before = tests;
        suites[i].run();
        finish_test();
        if (tests > before) continue;
        test("has tests");
        expect(false, "it ran none");
        finish_test();
    }
    return found;
}

int main(int count, char **words)
{
    int named = 0;
    for (int i = 1; i < count; i++) {
        if (!strcmp(words[i], "--slow")) test_slow_machine = true;
        else if (!strcmp(words[i], "--update")) test_update = true;
        else if (!strcmp(words[i], "--data") && i + 1 < count) test_data = words[++i];
        else if (words[i][0] != '-' && ++named && run_suite(words[i])) continue;
        else {
            fprintf(stderr, "facet-check: unknown option or suite '%s'\n", words[i]);
            return 2;
        }
    }
    if (!named) run_suite(NULL);
    return failures > 0;
}
