/* What facet_error says of a call. */
#ifndef ERRORS_H
#define ERRORS_H

#include "facet.h"

#include <string.h>

static inline bool is_error(const facet_error *e, facet_status code, const char *field, int index)
{
    return e->code == code && e->field && !strcmp(e->field, field) && e->index == index;
}

static inline bool is_no_error(const facet_error *e) { return e->code == FACET_OK && !e->field && e->index == -1; }

#endif
