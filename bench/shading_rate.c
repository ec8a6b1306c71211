#include "shading_rate.h"
#include "console.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Up to TILES of the frame's tiles are shaded REPEATS times each while the cache holds them, as it does in a frame,
 * where a tile is shaded as soon as it is rasterized. All targets take turns; the best round of each counts. */
enum { TILES = 48, REPEATS = 4, ROUNDS_LEAST = 3, TARGETS = 32 };

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

static size_t tile_count(const raster *r, size_t *columns)
{
    *columns = (r->width + TILE_WIDTH - 1) / TILE_WIDTH;
    return *columns * ((r->height + TILE_HEIGHT - 1) / TILE_HEIGHT);
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

/* Keeps up to `most` of the tiles that have samples, evenly spread; returns how many. */
static size_t keep_tiles(const mesh *m, const raster *r, uint32_t streams, size_t most, gbuffer *kept)
{
    size_t columns, count = tile_count(r, &columns), used = 0, taken = 0, seen = 0;
    for (size_t i = 0; i < count; i++)
        used += has_samples(r, i % columns, i / columns);
    for (size_t i = 0; i < count && taken < most; i++)
        if (has_samples(r, i % columns, i / columns) && seen++ * most >= taken * used)
            raster_tile(r, m, i % columns, i / columns, streams, &kept[taken++]);
    return taken;
}

static size_t list_contenders(const facet_material *material, contender *c)
{
    size_t count = 0;
    for (int arch = FACET_ARCH_BEST + 1; facet_word(FACET_KIND_ARCH, arch); arch++)
        for (int tier = 0; facet_word(FACET_KIND_TIER, tier) && count < TARGETS; tier++) {
            c[count] = (contender){.target = {(facet_arch)arch, (facet_tier)tier}, .best = 1e30};
            count += facet_plan_init(&c[count].plan, material, c[count].target, NULL) == FACET_OK;
        }
    return count;
}

/* Seconds for one round, or a negative number where facet refuses the batch. */
static double shade_tiles(const options *o, uint32_t streams, const facet_plan *plan, gbuffer *tiles, size_t count)
{
    float radiance[3][TILE_SAMPLES];
    double start = console_seconds();
    for (size_t i = 0; i < count * REPEATS; i++) {
        facet_batch batch = tile_batch(o, streams, &tiles[i / REPEATS], radiance);
        if (facet_shade(plan, &batch, NULL) != FACET_OK)
            return -1;
    }
    return console_seconds() - start;
}

static bool take_turns(const options *o, uint32_t streams, contender *c, size_t count, gbuffer *tiles,
                       size_t tile_total)
{
    double end = console_seconds() + (double)o->seconds * (double)count / 2;
    for (int round = 0; round < ROUNDS_LEAST || console_seconds() < end; round++)
        for (size_t i = 0; i < count; i++) {
            double seconds = shade_tiles(o, streams, &c[i].plan, tiles, tile_total);
            if (seconds < 0)
                return console_error("facet refused the tiles of the frame");
            c[i].best = seconds < c[i].best ? seconds : c[i].best;
        }
    return true;
}

static void print_rates(const contender *c, size_t count, double samples, size_t lights)
{
    printf("\nmillions of samples shaded a second, with %zu light%s\n  %-8s", lights, lights == 1 ? "" : "s", "");
    for (int tier = 0; facet_word(FACET_KIND_TIER, tier); tier++)
        printf(" %8s", facet_word(FACET_KIND_TIER, tier));
    for (size_t i = 0; i < count; i++) {
        if (!i || c[i].target.arch != c[i - 1].target.arch)
            printf("\n  %-8s", facet_word(FACET_KIND_ARCH, (int)c[i].target.arch));
        printf(" %8.2f", 1e-6 * samples / c[i].best);
    }
    printf("\n");
}

bool shading_rate(const options *o, const facet_material *material, uint32_t streams, const mesh *m, const raster *r)
{
    static contender c[TARGETS];
    gbuffer *tiles = malloc(TILES * sizeof *tiles);
    if (!tiles)
        return console_error("not enough memory for the timing");
    size_t taken = keep_tiles(m, r, streams, tile_limit(o->shading.light_count), tiles);
    size_t count = list_contenders(material, c);
    double samples = 0;
    for (size_t i = 0; i < taken; i++)
        samples += (double)(tiles[i].covered * REPEATS);
    bool timed = taken && take_turns(o, streams, c, count, tiles, taken);
    if (timed)
        print_rates(c, count, samples, o->shading.light_count);
    if (!taken)
        printf("\nno sample is covered: nothing to time\n");
    free(tiles);
    return timed || !taken;
}
