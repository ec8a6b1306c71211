#include "targets.h"

#include "harness.h"

#include <stdio.h>

enum { MOST_TARGETS = 64 };
static facet_target targets[MOST_TARGETS];
static int targets_found;

static void find_targets(void)
{
    const uint32_t arches = facet_arches();
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++)
        for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
            if (arches >> arch & 1 && facet_has(FACET_KIND_TIER, tier) && targets_found < MOST_TARGETS)
                targets[targets_found++] = (facet_target){ (facet_arch)arch, (facet_tier)tier, arches };
}

int target_count(void)
{
    if (!targets_found) find_targets();
    return targets_found;
}

facet_target target_at(int index)
{
    return index >= 0 && index < target_count() ? targets[index] : (facet_target){ 0 };
}

const char *target_words(facet_target target)
{
    static char words[64];
    snprintf(words, sizeof words, "%s %s", facet_word(FACET_KIND_ARCH, (int)target.arch),
             facet_word(FACET_KIND_TIER, (int)target.tier));
    return words;
}

bool whole_build(void)
{
    for (int kind = FACET_KIND_DIFFUSE; kind <= FACET_KIND_FRESNEL; kind++)
        for (int value = 0; facet_word((facet_kind)kind, value); value++)
            if (!facet_has((facet_kind)kind, value)) return false;
    return true;
}

void skip_absent_targets(void)
{
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
        if (!facet_arch_lanes((facet_arch)arch) || facet_has(FACET_KIND_ARCH, arch)) continue;
        test("%s", facet_word(FACET_KIND_ARCH, arch));
        skip("this CPU lacks it");
    }
}
