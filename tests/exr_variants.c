/* exr_variants make IN.exr DIR    writes one G-buffer in many kinds of EXR file, and lists their names
 * exr_variants check IN.exr OUT.exr    compares OUT.exr, a white Lambert shading of IN.exr, with nz E/pi
 *
 * Normals are cut to half precision and positions to whole numbers: every file holds the same values exactly. */
#include "exr.h"

#include <math.h>
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The light of `check`, along z: its red, green and blue differ, and tell swapped channels. */
static const double irradiance[3] = {1, 2, 4};

typedef struct variant {
    const char *name, *normal, *position, *decoy;   /* decoy: a layer that does not belong to the G-buffer */
    exr_compression_t compression;
    int tile;                                       /* its side; 0: scanlines */
    exr_pixel_type_t normal_type, position_type;
    int x, y;                                       /* the data window's corner */
    bool second_part;
} variant;

#define LAYERS "V.Normal", "V.Position", NULL

static const variant variants[] = {
    {"plain", LAYERS, EXR_COMPRESSION_ZIP, 0, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 0, 0, false},
    {"raw", LAYERS, EXR_COMPRESSION_NONE, 0, EXR_PIXEL_FLOAT, EXR_PIXEL_HALF, 0, 0, false},
    {"rle", LAYERS, EXR_COMPRESSION_RLE, 0, EXR_PIXEL_HALF, EXR_PIXEL_UINT, 0, 0, false},
    {"piz", LAYERS, EXR_COMPRESSION_PIZ, 0, EXR_PIXEL_HALF, EXR_PIXEL_HALF, 0, 0, false},
    {"tiles", LAYERS, EXR_COMPRESSION_PXR24, 48, EXR_PIXEL_FLOAT, EXR_PIXEL_HALF, 0, 0, false},
    {"tile", LAYERS, EXR_COMPRESSION_ZIPS, 1000, EXR_PIXEL_HALF, EXR_PIXEL_FLOAT, 0, 0, false},
    {"parts", LAYERS, EXR_COMPRESSION_ZIP, 20, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 0, 0, true},
    {"bare", "Normal", "Position", NULL, EXR_COMPRESSION_ZIP, 0, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 0, 0, false},
    {"apart", "shading.Normal", "WorldPosition", NULL, EXR_COMPRESSION_ZIP, 0, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 0, 0,
     false},
    {"decoy", "V.Normal", "V.Position", "A.Normal", EXR_COMPRESSION_ZIP, 0, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 0, 0,
     false},
    {"below", LAYERS, EXR_COMPRESSION_ZIP, 0, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, -37, -1001, false},
    {"above", LAYERS, EXR_COMPRESSION_ZIP, 32, EXR_PIXEL_FLOAT, EXR_PIXEL_FLOAT, 5000, 33, false},
};

static void quit(const char *what, const char *why)
{
    fprintf(stderr, "exr_variants: %s: %s\n", what, why);
    exit(EXIT_FAILURE);
}

static void must(exr_result_t result, const char *what)
{
    if (result)
        quit(what, exr_get_default_error_message(result));
}

/* ---- Writing ----------------------------------------------------------------------------------------------------- */

static void add_channels(exr_context_t file, int part, const char *layer, exr_pixel_type_t type)
{
    char name[64];
    for (int c = 0; layer && c < 3; c++) {
        snprintf(name, sizeof name, "%s.%c", layer, "XYZ"[c]);
        must(exr_add_channel(file, part, name, type, EXR_PERCEPTUALLY_LINEAR, 1, 1), name);
    }
}

static int add_part(exr_context_t file, const char *name, const variant *v, const exr_frame *frame)
{
    const int width = (int)frame->width, height = (int)frame->height;
    exr_attr_box2i_t data = {.min = {.x = v->x, .y = v->y}, .max = {.x = v->x + width - 1, .y = v->y + height - 1}};
    exr_attr_box2i_t display = {.max = {.x = width - 1, .y = height - 1}};
    exr_attr_v2f_t centre = {.arr = {0, 0}};
    int part;
    must(exr_add_part(file, name, v->tile ? EXR_STORAGE_TILED : EXR_STORAGE_SCANLINE, &part), name);
    must(exr_initialize_required_attr(file, part, &display, &data, 1, &centre, 1, EXR_LINEORDER_INCREASING_Y,
                                      v->compression), name);
    if (v->tile)
        must(exr_set_tile_descriptor(file, part, (uint32_t)v->tile, (uint32_t)v->tile, EXR_TILE_ONE_LEVEL,
                                     EXR_TILE_ROUND_DOWN), name);
    return part;
}

/* The plane of a channel: a decoy has the positions' values. */
static const float *plane_of(const char *channel, const variant *v, const exr_layer layers[2])
{
    size_t length = strlen(channel);
    bool normal = length == strlen(v->normal) + 2 && !strncmp(channel, v->normal, length - 2);
    return layers[normal ? 0 : 1].plane[channel[length - 1] - 'X'];
}

static void write_chunk(exr_context_t file, int part, const exr_chunk_info_t *chunk, const variant *v,
                        const exr_frame *frame, const exr_layer layers[2], size_t first)
{
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    must(exr_encoding_initialize(file, part, chunk, &encode), v->name);
    for (int i = 0; i < encode.channel_count; i++) {
        exr_coding_channel_info_t *channel = &encode.channels[i];
        channel->user_bytes_per_element = sizeof(float);
        channel->user_data_type = EXR_PIXEL_FLOAT;
        channel->user_pixel_stride = sizeof(float);
        channel->user_line_stride = (int32_t)(frame->width * sizeof(float));
        channel->encode_from_ptr = (const uint8_t *)(plane_of(channel->channel_name, v, layers) + first);
    }
    must(exr_encoding_choose_default_routines(file, part, &encode), v->name);
    must(exr_encoding_run(file, part, &encode), v->name);
    exr_encoding_destroy(file, &encode);
}

static void write_part(exr_context_t file, int part, const variant *v, const exr_frame *frame,
                       const exr_layer layers[2])
{
    int32_t step = v->tile, across = v->tile ? v->tile : (int32_t)frame->width;
    if (!v->tile)
        must(exr_get_scanlines_per_chunk(file, part, &step), v->name);
    for (int y = 0; y < (int)frame->height; y += step)
        for (int x = 0; x < (int)frame->width; x += across) {
            exr_chunk_info_t chunk;
            must(v->tile ? exr_write_tile_chunk_info(file, part, x / step, y / step, 0, 0, &chunk)
                         : exr_write_scanline_chunk_info(file, part, v->y + y, &chunk), v->name);
            write_chunk(file, part, &chunk, v, frame, layers, (size_t)y * frame->width + (size_t)x);
        }
}

static void write_variant(const char *directory, const variant *v, const exr_frame *frame, const exr_layer layers[2])
{
    /* A part that comes first and lacks the normals. */
    const variant preview = {.name = "preview", .normal = "", .position = "V.Position",
                             .compression = EXR_COMPRESSION_ZIP, .x = v->x, .y = v->y};
    exr_context_t file;
    char path[512];
    snprintf(path, sizeof path, "%s/%s.exr", directory, v->name);
    must(exr_start_write(&file, path, EXR_WRITE_FILE_DIRECTLY, NULL), path);
    if (v->second_part)
        add_channels(file, add_part(file, preview.name, &preview, frame), preview.position, EXR_PIXEL_FLOAT);
    int part = add_part(file, "buffer", v, frame);
    add_channels(file, part, v->decoy, EXR_PIXEL_FLOAT);
    add_channels(file, part, v->normal, v->normal_type);
    add_channels(file, part, v->position, v->position_type);
    must(exr_write_header(file), path);
    if (v->second_part)
        write_part(file, 0, &preview, frame, layers);
    write_part(file, part, v, frame, layers);
    must(exr_finish(&file), path);
    puts(v->name);
}

/* ---- The two commands -------------------------------------------------------------------------------------------- */

static void load(const char *path, exr_frame *frame, exr_layer *layers, int count)
{
    char why[EXR_WHY];
    if (!exr_load(path, frame, layers, count, why))
        quit(path, why);
}

static void make(const char *path, const char *directory)
{
    exr_frame frame;
    exr_layer layers[2] = {{"Normal", "XYZ", {0}}, {"Position", "XYZ", {0}}};
    load(path, &frame, layers, 2);
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < frame.width * frame.height; i++) {
            layers[0].plane[c][i] = truncf(layers[0].plane[c][i] * 1024) / 1024;
            layers[1].plane[c][i] = floorf(fabsf(layers[1].plane[c][i]) * 2);
        }
    for (size_t i = 0; i < sizeof variants / sizeof *variants; i++)
        write_variant(directory, &variants[i], &frame, layers);
    exr_free(layers, 2);
}

static void check(const char *in, const char *out)
{
    exr_frame from, to;
    exr_layer buffer[2] = {{"Normal", "XYZ", {0}}, {"Position", "XYZ", {0}}}, radiance = {"", "RGB", {0}};
    size_t lit = 0;
    load(in, &from, buffer, 2);
    load(out, &to, &radiance, 1);
    if (memcmp(from.data, to.data, sizeof from.data) || memcmp(from.display, to.display, sizeof from.display))
        quit(out, "has other windows");
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < from.width * from.height; i++) {
            double got = (double)radiance.plane[c][i], want = (double)buffer[0].plane[2][i] * irradiance[c] / acos(-1);
            if (got != 0 && !(fabs(got - want) <= 1e-6 * want))
                quit(out, "has another radiance than nz E/pi");
            lit += got != 0;
        }
    if (lit < from.width * from.height / 4)
        quit(out, "is black");
    exr_free(buffer, 2);
    exr_free(&radiance, 1);
}

int main(int count, char **arguments)
{
    if (count == 4 && !strcmp(arguments[1], "make"))
        make(arguments[2], arguments[3]);
    else if (count == 4 && !strcmp(arguments[1], "check"))
        check(arguments[2], arguments[3]);
    else
        quit("usage", "exr_variants make IN.exr DIR | check IN.exr OUT.exr");
    return EXIT_SUCCESS;
}
