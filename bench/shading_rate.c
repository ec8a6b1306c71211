#include "shading_rate.h"
#include "console.h"
#include "workers.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Up to TILES of the frame's tiles are shaded REPEATS times each while the cache holds them, as it does in a frame,
 * where a tile is shaded as soon as it is rasterized. All targets take turns; the best round of each counts. */
enum { TILES = 48, REPEATS = 4, ROUNDS_LEAST = 3, TARGETS = 32 };

/* What is shaded: tiles of the frame, and how many samples they cover. */
typedef struct load {
    const options *options;
    uint32_t streams;
    gbuffer *tiles;
    size_t count;
    double samples;
} load;

typedef struct contender {
    facet_target target;
    facet_plan plan;
    double best;                /* seconds */
} contender;

facet_batch tile_batch(const options *o, uint32_t streams, gbuffer *g, float radiance[3][TILE_SAMPLES])
{
    const shading *s = &o->shading;
    facet_batch batch = {
        .count = TILE_SAMPLES, .lights = s->lights, .light_count = s->light_count,
        .coverage = g->covered == TILE_SAMPLES ? NULL : g->coverage,
        .flags = o->two_sided ? FACET_TWO_SIDED : 0,
    };
    memcpy(batch.ambient, s->ambient, sizeof batch.ambient);
    memcpy(batch.sh, s->sh, sizeof batch.sh);
    for (int c = 0; c < 3; c++) {
        batch.normal[c] = g->normal[c];
        batch.view[c] = g->view[c];
        batch.position[c] = streams & FACET_STREAM_POSITION ? g->position[c] : NULL;
        batch.tangent[c] = streams & FACET_STREAM_TANGENT ? g->tangent[c] : NULL;
        batch.radiance[c] = radiance[c];
    }
    return batch;
}

static bool has_samples(const raster *r, size_t column, size_t row)
{
    for (size_t y = row * TILE_HEIGHT; y < (row + 1) * TILE_HEIGHT && y < r->height; y++)
        for (size_t x = column * TILE_WIDTH; x < (column + 1) * TILE_WIDTH && x < r->width; x++)
            if (r->depth[y * r->width + x] > 0)
                return true;
    return false;
}

/* With many lights fewer tiles make a round as long. */
static size_t tile_limit(size_t lights)
{
    return lights > 8 ? (size_t)TILES * 8 / lights : TILES;
}

/* Keeps up to `most` of the tiles that have samples, evenly spread. */
static void keep_tiles(load *l, const mesh *m, const raster *r, size_t most)
{
    size_t columns, count = raster_tiles(r, &columns), used = 0, seen = 0;
    for (size_t i = 0; i < count; i++)
        used += has_samples(r, i % columns, i / columns);
    for (size_t i = 0; i < count && l->count < most; i++)
        if (has_samples(r, i % columns, i / columns) && seen++ * most >= l->count * used) {
            gbuffer *g = &l->tiles[l->count++];
            raster_tile(r, m, i % columns, i / columns, l->streams, g);
            l->samples += (double)g->covered;
        }
}

/* ---- On one thread --------------------------------------------------------------------------------------------- */

static size_t list_contenders(const facet_material *material, contender *c)
{
    size_t count = 0;
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++)
        for (int tier = 0; facet_word(FACET_KIND_TIER, tier) && count < TARGETS; tier++) {
            c[count] = (contender){.target = {.arch = (facet_arch)arch, .tier = (facet_tier)tier}, .best = 1e30};
            count += facet_plan_init(&c[count].plan, material, c[count].target, NULL) == FACET_OK;
        }
    return count;
}

static bool refused(void)
{
    return console_error("facet refused the tiles of the frame");
}

/* Seconds for one round, or a negative number where facet refuses the batch. */
static double shade_tiles(const load *l, const facet_plan *plan)
{
    float radiance[3][TILE_SAMPLES];
    double start = console_seconds();
    for (size_t i = 0; i < l->count * REPEATS; i++) {
        facet_batch batch = tile_batch(l->options, l->streams, &l->tiles[i / REPEATS], radiance);
        if (facet_shade(plan, &batch, NULL) != FACET_OK)
            return -1;
    }
    return console_seconds() - start;
}

static bool take_turns(const load *l, contender *c, size_t count)
{
    double end = console_seconds() + (double)l->options->seconds * (double)count / 2;
    for (int round = 0; round < ROUNDS_LEAST || console_seconds() < end; round++)
        for (size_t i = 0; i < count; i++) {
            double seconds = shade_tiles(l, &c[i].plan);
            if (seconds < 0)
                return refused();
            c[i].best = seconds < c[i].best ? seconds : c[i].best;
        }
    return true;
}

static void print_rates(const load *l, const contender *c, size_t count)
{
    size_t lights = l->options->shading.light_count;
    printf("\nmillions of samples shaded a second, with %zu light%s\n  %-8s", lights, lights == 1 ? "" : "s", "");
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        printf(" %8s", facet_word(FACET_KIND_TIER, tier));
    for (size_t i = 0; i < count; i++) {
        if (!i || c[i].target.arch != c[i - 1].target.arch)
            printf("\n  %-8s", facet_word(FACET_KIND_ARCH, (int)c[i].target.arch));
        printf(" %8.2f", 1e-6 * l->samples * (double)REPEATS / c[i].best);
    }
    printf("\n");
}

static bool time_targets(const load *l, const facet_material *material)
{
    static contender c[TARGETS];
    size_t count = list_contenders(material, c);
    bool timed = take_turns(l, c, count);
    if (timed)
        print_rates(l, c, count);
    return timed;
}

/* ---- On threads ------------------------------------------------------------------------------------------------ */

/* Rounds on one thread and on all of them take turns, as the machine may have other work; an odd number. */
enum { THREAD_ROUNDS = 9 };

typedef struct thread_round {
    const load *load;
    facet_plan plan;
    size_t repeats;             /* of each tile */
} thread_round;

/* One tile from its G-buffer to its pixels, a sample each. */
static bool finish_tile(void *context, int worker, size_t i)
{
    const thread_round *r = context;
    const options *o = r->load->options;
    float radiance[3][TILE_SAMPLES] = {{0}};
    uint8_t pixels[4 * TILE_SAMPLES];
    facet_batch batch = tile_batch(o, r->load->streams, &r->load->tiles[i / r->repeats], radiance);
    facet_image image = {
        .width = TILE_WIDTH, .height = TILE_HEIGHT, .radiance = {radiance[0], radiance[1], radiance[2]},
        .exposure = o->exposure, .pixels = pixels,
    };
    (void)worker;
    return facet_shade(&r->plan, &batch, NULL) == FACET_OK && facet_encode(&image, NULL) == FACET_OK;
}

/* Lowers *threads to how many there were, 0 where facet refuses a tile. Returns seconds. */
static double finish_tiles(thread_round *r, int *threads)
{
    double start = console_seconds();
    *threads = workers_run(*threads, r->load->count * r->repeats, finish_tile, r);
    return console_seconds() - start;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double values[THREAD_ROUNDS])
{
    qsort(values, THREAD_ROUNDS, sizeof *values, by_size);
    return values[THREAD_ROUNDS / 2];
}

static bool time_threads(const load *l, const facet_material *material)
{
    const options *o = l->options;
    thread_round r = {.load = l, .repeats = 1};
    int one = 1, all = o->threads;
    double seconds[THREAD_ROUNDS], ratio[THREAD_ROUNDS];
    if (facet_plan_init(&r.plan, material, o->shading.target, NULL) != FACET_OK)
        return refused();
    double repeats = (double)o->seconds / 4 / finish_tiles(&r, &one);
    r.repeats = repeats > 1 ? (size_t)repeats : 1;
    for (int i = 0; i < THREAD_ROUNDS; i++) {
        double alone = finish_tiles(&r, &one);
        seconds[i] = finish_tiles(&r, &all);
        ratio[i] = alone / seconds[i];
        if (!one || !all)
            return refused();
    }
    facet_target target = facet_plan_target(&r.plan);
    printf("\nshaded and encoded by %s %s on %d threads: %.2f, %.2f times one thread's (medians of %d rounds)\n",
           facet_word(FACET_KIND_ARCH, (int)target.arch), facet_word(FACET_KIND_TIER, (int)target.tier), all,
           1e-6 * l->samples * (double)r.repeats / median(seconds), median(ratio), THREAD_ROUNDS);
    return true;
}

bool shading_rate(const options *o, const facet_material *material, uint32_t streams, const mesh *m, const raster *r)
{
    load l = {.options = o, .streams = streams, .tiles = malloc(TILES * sizeof *l.tiles)};
    if (!l.tiles)
        return console_error("not enough memory for the timing");
    keep_tiles(&l, m, r, tile_limit(o->shading.light_count));
    bool timed = !l.count || (time_targets(&l, material) && (o->threads == 1 || time_threads(&l, material)));
    if (!l.count)
        printf("\nno sample is covered: nothing to time\n");
    free(l.tiles);
    return timed;
}
