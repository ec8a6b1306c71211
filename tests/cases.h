/* The kernels by name: what accuracy, agreement, golden hashes, the bench and the README's tables walk. It expands
 * src/models.def, so that a new row is tested because it is there. */
#ifndef CASES_H
#define CASES_H

#include "facet.h"

typedef struct {
    char name[64];           /* "oren-nayar", "ggx/smith", "fujii+ggx/smith-correlated/schlick", "lambert@point" */
    facet_material material; /* models and `coupled`, and of fresnel what no stream brings: f82, eta_outside,
                              * polarisation; other parameters are zero, streams none */
    facet_light light;       /* its kind, and of point and spot lights position, range and cone; else zero */
    uint32_t streams;        /* FACET_STREAM_* that the models read, FACET_STREAM_TANGENT too */
    uint32_t promised;       /* of these, what a material promises: ALBEDO and those after it */
    float sigma_max;         /* domain of sigma: [0, sigma_max]; 0: none */
    bool view;               /* depends on v */
    bool lobe;               /* its distribution is one */
    bool reciprocal, conserves;
} kernel_case;

/* Every diffuse row alone; every masking under its distribution, and every lobe, with Fresnel one; every Fresnel row
 * under the first specular one, exact ones a second time in water and polarised light ("/outside"); every diffuse row,
 * coupled, under the first specular one with Schlick; every row of special.def; Lambert and the first specular one
 * under a point and a spot light ("@point", "@spot"). Of these, what the build holds. */
int case_count(void);
const kernel_case *case_at(int index);

/* By its name, or NULL. */
const kernel_case *find_case(const char *name);

#endif
