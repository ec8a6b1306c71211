/* A batch in one arrangement of everything that must not matter: where its streams stand, where its parameters come
 * from, what is covered, what aliases what. A row of streams.def is in all of it because it is there. */
#ifndef ARRANGEMENT_H
#define ARRANGEMENT_H

#include "factors.h"
#include "guarded.h"

enum { MOST_COUNT = 131 };

typedef struct {
    const recipe *recipe;
    facet_target target;
    size_t count;
    int light_count;
    facet_light lights[MOST_LIGHTS];             /* what no stream brings */
    uint32_t flags;
    uint32_t reads;                              /* FACET_STREAM_*: the batch's, that are read wherever they are */
    bool counted;                                /* the batch counts invalid samples */
    stream_source sources[INPUTS];
    float values[COMPONENTS][MOST_COUNT];        /* what each sample has; radiance: what stood there before */
    bool ordinary[MOST_COUNT];                   /* no edge value among them */
    facet_material numbers;                      /* of the material, that no stream brings; emission */
    float ambient[3], sh[4][3];
    float *place[COMPONENTS];                    /* between pages that fault; NULL where the values are elsewhere */
    uint8_t *coverage;
    char words[500];                             /* the levels, for messages */
} arrangement;

bool is_read(const arrangement *, int stream);
bool is_covered(const arrangement *, size_t i);

facet_material material_of(const arrangement *, const stream_source *sources);

/* A batch and its lights over streams that start at `at`. Count, coverage and invalid are left to the caller. */
facet_batch point_batch(const arrangement *, float *const *at, facet_light *lights, const stream_source *sources);

/* There is one arrangement at a time, between open_ and close_arrangements; `number` seeds its values. */
void open_arrangements(void);
const arrangement *arrange(const design *, int number);
void clear_arrangement(void);
void close_arrangements(void);

/* NULL, or what was written that should not have been: an input, or a place beside the radiance. */
const char *find_damage(const arrangement *);

#endif
