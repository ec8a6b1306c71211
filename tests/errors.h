/* What a call's status and facet_error say. */
#ifndef ERRORS_H
#define ERRORS_H

#include "harness.h"

#include "facet.h"

#include <string.h>

static inline bool is_error(const facet_error *e, facet_status code, const char *field, int index)
{
    return e->code == code && e->field && !strcmp(e->field, field) && e->index == index;
}

static inline void expect_refused(const char *change, facet_status status, const facet_error *e, facet_status code,
                                  const char *field, int index)
{
    expect(status == code && is_error(e, code, field, index), "%s: status %d, %s[%d]", change, (int)status,
           e->field ? e->field : "NULL", e->index);
}

/* Of an error that was none of this before. */
static inline void expect_accepted(const char *change, facet_status status, const facet_error *e)
{
    expect(status == FACET_OK && e->code == FACET_OK && !e->field && e->index == -1, "%s: status %d, %s[%d]", change,
           (int)status, e->field ? e->field : "NULL", e->index);
}

#endif
