#include "bench_contenders.h"
#include "console.h"

#include <stdlib.h>
#include <string.h>

#define BASELINE(name) extern const baseline baseline_##name;
#include "built.def"

static const baseline *const baselines[] = {
#define BASELINE(name) &baseline_##name,
#include "built.def"
};

static const char skipped[] = "  "
#define SKIPPED(why) ", " why
#include "built.def"
    ;

const char *contenders_skipped(void) { return skipped[2] ? skipped + 4 : ""; }

/* The textbook's shader takes a hundred times as long as others: of what is large it shades a part. */
enum { BASELINES = sizeof baselines / sizeof baselines[0], TEXTBOOK_PARTS = 16 };

static contender *add(contenders *c, const work *w, int size, layout where)
{
    contender *grown = realloc(c->all, (size_t)(c->count + 1) * sizeof *grown);
    if (!grown) return NULL;
    c->all = grown;
    contender *one = &c->all[c->count];
    *one = (contender){ .work = w, .size = size, .layout = where, .parts = 1 };
    if (!streams_batch(size, where, w->streams, w->format, &one->batch)) return NULL;
    one->batch.lights = w->lights;
    one->batch.light_count = w->light_count;
    c->count++;
    return one;
}

/* Whether the library takes such a batch: what it refused would be fast. */
static bool is_taken(const contender *c)
{
    facet_error error;
    facet_batch first = c->batch;
    first.count = 1;
    if (!facet_shade(&c->plan, &first, &error)) return true;
    return console_error("%s: facet refuses %s", c->work->name, error.field);
}

/* Every architecture and tier that has it. */
static bool add_library(contenders *c, const work *w, int size, layout where, int only)
{
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++) {
            const facet_target target = { .arch = (facet_arch)arch, .tier = (facet_tier)tier };
            facet_plan plan;
            if ((only && only != arch) || facet_plan_init(&plan, &w->material, target, NULL)) continue;
            contender *one = add(c, w, size, where);
            if (!one) return console_error("not enough memory for the streams");
            one->target = target;
            one->plan = plan;
            if (!is_taken(one)) return false;
        }
    return true;
}

static bool add_baselines(contenders *c, const work *w, int size, layout where)
{
    for (int i = 0; i < BASELINES && w->shade >= 0; i++) {
        if (!baselines[i]->shade[w->shade]) continue;
        contender *one = add(c, w, size, where);
        if (!one) return console_error("not enough memory for the streams");
        one->baseline = baselines[i];
        if (size == SIZE_MEMORY && baselines[i]->kind == TEXTBOOK) one->parts = TEXTBOOK_PARTS;
        one->batch.count /= one->parts;
    }
    return true;
}

/* It has that in its name, or what is compared with it has. */
static bool passes(const work *w, const char *filter)
{
    if (strstr(w->name, filter)) return true;
    for (int i = 0; work_at(i); i++) {
        const work *other = work_at(i);
        if (other->beside && !strcmp(other->beside, w->name) && strstr(other->name, filter)) return true;
    }
    return false;
}

/* A frame is what tile is in memory. */
static bool is_wanted(const work *w, int size, const bench_options *o)
{
    const bool in_memory = size == SIZE_MEMORY, is_tile = w->shade == SHADE_TILE;
    if ((is_tile || w->frame) && w->frame != in_memory) return false;
    if (o->filter && !passes(w, o->filter)) return false;
    if (!w->title && !o->all && !o->filter) return false;
    return o->sizes & 1u << size || (!o->sizes && in_memory == w->frame);
}

bool contenders_list(contenders *c, const bench_options *o)
{
    const int arch = o->arch == FACET_ARCH_BEST ? (int)facet_arch_best() : o->arch;
    for (int i = 0; work_at(i); i++)
        for (int size = 0; size < SIZES; size++)
            for (int where = 0; where < LAYOUTS && is_wanted(work_at(i), size, o); where++) {
                const int before = c->count;
                if (!add_library(c, work_at(i), size, (layout)where, arch < 0 ? 0 : arch)) return false;
                /* What this build lacks has nothing to be compared with. */
                if (c->count > before && !add_baselines(c, work_at(i), size, (layout)where)) return false;
            }
    if (!c->count && o->filter)
        return console_error("--filter '%.80s': no workload or kernel of that name at that size; of 4M tile is frame, "
                             "packed and packed-pixels", o->filter);
    return c->count || console_error("nothing to time at that size");
}

int contenders_group(const contenders *c, int first)
{
    int count = 1;
    const contender *a = &c->all[first];
    while (first + count < c->count && a[count].work == a->work && a[count].size == a->size
           && a[count].layout == a->layout)
        count++;
    return count;
}

/* ---- Calls ------------------------------------------------------------------------------------------------------- */

double contender_visit(contender *c)
{
    facet_batch batch = c->batch;
    streams_move(&batch, c->part * batch.count);
    c->part = (c->part + 1) % c->parts;
    const double start = console_seconds();
    if (c->baseline) {
        baseline_shader *const shade = c->baseline->shade[c->work->shade];
        for (long i = 0; i < c->calls; i++) shade(&c->work->material, &batch);
    } else {
        for (long i = 0; i < c->calls; i++) facet_shade(&c->plan, &batch, NULL);
    }
    return console_seconds() - start;
}
