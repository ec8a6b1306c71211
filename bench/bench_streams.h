/* The buffers that are shaded: every stream for a number of samples, twice. Staggered, no two streams start in lines
 * that a cache keeps in the same place; aligned, each starts on a page, and all of them do. */
#ifndef BENCH_STREAMS_H
#define BENCH_STREAMS_H

#include "facet.h"

typedef enum { STAGGERED, ALIGNED, LAYOUTS } layout;
extern const char *const layout_words[LAYOUTS];

/* Samples a call. */
enum { SIZE_TINY, SIZE_L1, SIZE_L2, SIZE_MEMORY, SIZES };
extern const size_t sizes[SIZES];
extern const char *const size_words[SIZES];

/* What streams hold: floats; or normals, colours and numbers as facet_packed has them, so many words a sample, and
 * radiance halves or pixels. */
typedef enum { FLOATS, HALVES, PIXELS } stream_format;
enum { STREAMS_PACKED = 3 };

/* A batch of that many samples with these streams of floats (FACET_STREAM_*), the packed ones and a camera where the
 * format says so, and radiance; the others are NULL, and so are lights. Buffers are made when they are first asked for;
 * what is in them is the same in every layout, and packed what it is as floats, but for the view. False where memory
 * ends. */
bool streams_batch(int size, layout where, uint32_t streams, stream_format format, facet_batch *batch);

/* The same batch, of floats, so many samples on. */
void streams_move(facet_batch *batch, size_t samples);

#endif
