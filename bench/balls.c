#include "balls.h"
#include "model_words.h"

#include <math.h>
#include <stdio.h>

/* Of LAYOUT_GRAZING. */
static const facet_metal grazing_metals[] = {FACET_METAL_GOLD, FACET_METAL_COPPER, FACET_METAL_CHROMIUM};
static const facet_fresnel grazing_models[] = {
    FACET_FRESNEL_CONDUCTOR, FACET_FRESNEL_SCHLICK_F82, FACET_FRESNEL_SCHLICK, FACET_FRESNEL_CONSTANT,
};

enum {
    METALS = sizeof grazing_metals / sizeof *grazing_metals,
    MODELS = sizeof grazing_models / sizeof *grazing_models
};

static size_t metal_count(void)
{
    int count = 0;
    while (count < BALL_LIMIT && facet_word(FACET_KIND_METAL, count))
        count++;
    return (size_t)count;
}

size_t ball_count(layout which)
{
    return which == LAYOUT_METALS ? metal_count() : which == LAYOUT_GRAZING ? METALS * MODELS : 0;
}

/* ---- Places ---------------------------------------------------------------------------------------------------- */

/* A ball's place: its row, and the column among the row's. */
typedef struct place {
    size_t row, column, columns;
} place;

/* Of LAYOUT_METALS, rows of 4, 3, 4, 3 ... balls, each in the gaps of those above. */
static place place_of(layout which, size_t ball)
{
    place p = {0, ball, 4};
    if (which == LAYOUT_GRAZING)
        return (place){ball / MODELS, ball % MODELS, MODELS};
    for (; p.column >= p.columns; p.columns = 7 - p.columns) {
        p.column -= p.columns;
        p.row++;
    }
    return p;
}

/* Centres a distance of 1 apart; returns how far the farthest is from the middle. */
static double place_all(layout which, double (*centres)[3])
{
    size_t count = ball_count(which);
    double step = which == LAYOUT_METALS ? sqrt(0.75) : 1, farthest = 0;
    double middle = (double)place_of(which, count - 1).row / 2;
    for (size_t i = 0; i < count; i++) {
        place p = place_of(which, i);
        centres[i][0] = (double)p.column - (double)(p.columns - 1) / 2;
        centres[i][1] = step * (middle - (double)p.row);
        centres[i][2] = 0;
        farthest = fmax(farthest, hypot(centres[i][0], centres[i][1]));
    }
    return farthest;
}

bool ball_mesh(mesh *m, layout which)
{
    const double radius = 0.46;
    double centres[BALL_LIMIT][3], scale = 1 / (place_all(which, centres) + radius);
    for (size_t i = 0; i < 3 * ball_count(which); i++)
        centres[i / 3][i % 3] *= scale;
    return mesh_spheres(m, centres, ball_count(which), radius * scale);
}

/* ---- Materials ------------------------------------------------------------------------------------------------- */

static facet_metal metal_of(layout which, size_t ball)
{
    return which == LAYOUT_METALS ? (facet_metal)ball : grazing_metals[ball / MODELS];
}

facet_material ball_material(const options *o, size_t ball)
{
    facet_material m = o->shading.material;
    model_set_metal(&m, metal_of(o->layout, ball));
    if (o->layout == LAYOUT_GRAZING)
        m.fresnel.model = grazing_models[ball % MODELS];
    return m;
}

/* ---- The report ------------------------------------------------------------------------------------------------ */

static void report_metal(facet_metal metal)
{
    float eta[3], k[3];
    if (facet_index_of_metal(metal, eta, k) != FACET_OK)
        return;
    printf("  %-10s %6.3f %6.3f %6.3f  %6.3f %6.3f %6.3f ", facet_word(FACET_KIND_METAL, (int)metal), (double)eta[0],
           (double)eta[1], (double)eta[2], (double)k[0], (double)k[1], (double)k[2]);
    for (int c = 0; c < 3; c++)
        printf(" %.3f", (double)facet_f0_from_eta(eta[c], k[c], 1));
    printf("\n");
}

void ball_report(layout which)
{
    size_t step = which == LAYOUT_METALS ? 1 : MODELS;
    if (which == LAYOUT_GRAZING) {
        printf("left to right:");
        for (int i = 0; i < MODELS; i++)
            printf(" %s", facet_word(FACET_KIND_FRESNEL, (int)grazing_models[i]));
        printf("\n");
    }
    printf("%-12s eta red, green, blue  k                     F0\n",
           which == LAYOUT_METALS ? "row by row" : "downwards");
    for (size_t i = 0; i < ball_count(which); i += step)
        report_metal(metal_of(which, i));
}
