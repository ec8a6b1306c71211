#include "shading_rate.h"
#include "console.h"

#include <stdio.h>
#include <stdlib.h>

/* TILES of the frame's tiles are shaded REPEATS times each while the cache holds them, as it does in a frame, where a
 * tile is shaded as soon as it is rasterized. All targets take turns; the best round of each counts. */
enum { TILES = 48, REPEATS = 4, ROUNDS_LEAST = 3, TARGETS = 32 };

typedef struct contender {
    facet_target target;
    facet_plan plan;
    double best;                /* seconds */
} contender;

facet_batch tile_batch(const options *o, gbuffer *g, float radiance[3][TILE_SAMPLES])
{
    return (facet_batch){
        .count = TILE_SAMPLES,
        .normal = {g->normal[0], g->normal[1], g->normal[2]},
        .view = {g->view[0], g->view[1], g->view[2]},
        .lights = o->lights, .light_count = o->light_count,
        .ambient = {o->ambient[0], o->ambient[1], o->ambient[2]},
        .coverage = g->covered == TILE_SAMPLES ? NULL : g->coverage,
        .radiance = {radiance[0], radiance[1], radiance[2]},
        .flags = o->two_sided ? FACET_TWO_SIDED : 0,
    };
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

/* Keeps up to TILES of the tiles that have samples, evenly spread; returns how many. */
static size_t keep_tiles(const mesh *m, const raster *r, gbuffer *kept)
{
    size_t columns, count = tile_count(r, &columns), used = 0, taken = 0, seen = 0;
    for (size_t i = 0; i < count; i++)
        used += has_samples(r, i % columns, i / columns);
    for (size_t i = 0; i < count && taken < TILES; i++)
        if (has_samples(r, i % columns, i / columns) && seen++ * TILES >= taken * used)
            raster_tile(r, m, i % columns, i / columns, &kept[taken++]);
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
static double shade_tiles(const options *o, const facet_plan *plan, gbuffer *tiles, size_t count)
{
    float radiance[3][TILE_SAMPLES];
    double start = console_seconds();
    for (size_t i = 0; i < count * REPEATS; i++) {
        facet_batch batch = tile_batch(o, &tiles[i / REPEATS], radiance);
        if (facet_shade(plan, &batch, NULL) != FACET_OK)
            return -1;
    }
    return console_seconds() - start;
}

static bool take_turns(const options *o, contender *c, size_t count, gbuffer *tiles, size_t tile_total)
{
    double end = console_seconds() + (double)o->seconds * (double)count / 2;
    for (int round = 0; round < ROUNDS_LEAST || console_seconds() < end; round++)
        for (size_t i = 0; i < count; i++) {
            double seconds = shade_tiles(o, &c[i].plan, tiles, tile_total);
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

bool shading_rate(const options *o, const facet_material *material, const mesh *m, const raster *r)
{
    static contender c[TARGETS];
    gbuffer *tiles = malloc(TILES * sizeof *tiles);
    if (!tiles)
        return console_error("not enough memory for the timing");
    size_t taken = keep_tiles(m, r, tiles), count = list_contenders(material, c);
    double samples = 0;
    for (size_t i = 0; i < taken; i++)
        samples += (double)(tiles[i].covered * REPEATS);
    bool timed = taken && take_turns(o, c, count, tiles, taken);
    if (timed)
        print_rates(c, count, samples, o->light_count);
    if (!taken)
        printf("\nno sample is covered: nothing to time\n");
    free(tiles);
    return timed || !taken;
}
