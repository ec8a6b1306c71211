/* The kernels by name: what accuracy, agreement, golden hashes, the bench and the README's tables walk. It expands
 * src/models.def, so that a new row is tested because it is there. */
#ifndef CASES_H
#define CASES_H

#include "facet.h"

typedef struct {
    char name[64];           /* "oren-nayar", "ggx/smith", "fujii+ggx/smith-correlated/schlick" */
    facet_material material; /* models and `coupled` alone; parameters are zero, streams none */
    uint32_t streams;        /* FACET_STREAM_ALBEDO … that the models read */
    float sigma_max;         /* domain of sigma: [0, sigma_max]; 0: none */
    bool view;               /* depends on v */
    bool reciprocal, conserves;
} kernel_case;

/* Every diffuse row alone; every masking under its distribution with Fresnel one; every Fresnel row under the first
 * specular one; every diffuse row, coupled, under the first specular one with Schlick; and every row of special.def. Of
 * these, what the build holds. */
int case_count(void);
const kernel_case *case_at(int index);

#endif
