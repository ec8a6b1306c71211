#include "exr.h"

#include <openexr.h>

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { ALLOCATION_MAX = 1 << 30 };

static bool __attribute__((format(printf, 2, 3))) fail(char why[EXR_WHY], const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(why, EXR_WHY, format, arguments);
    va_end(arguments);
    return false;
}

/* ---- OpenEXRCore's errors, memory, input and output -------------------------------------------------------------- */

/* What the callbacks see of one file. */
typedef struct transfer {
    char *why;
    int input;                     /* the file being read */
    unsigned char *bytes;          /* the file being written */
    size_t size, room;
    bool no_room;
} transfer;

/* A call's first complaint is the precise one; what follows it is consequences. */
static void keep_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *data = NULL;
    (void)code;
    if (!context || exr_get_user_data(context, &data) || !data)
        return;
    transfer *s = data;
    if (!*s->why)
        fail(s->why, "%s", message);
}

static int64_t get_size(exr_const_context_t context, void *data)
{
    struct stat status;
    (void)context;
    return fstat(((transfer *)data)->input, &status) ? -1 : status.st_size;
}

static int64_t get(exr_const_context_t context, void *data, void *to, uint64_t size, uint64_t offset,
                   exr_stream_error_func_ptr_t error)
{
    uint64_t done = 0;
    (void)context, (void)error;
    while (done < size) {
        ssize_t got = pread(((transfer *)data)->input, (char *)to + done, size - done, (off_t)(offset + done));
        if (got < 0)
            return -1;
        if (!got)
            break;
        done += (uint64_t)got;
    }
    return (int64_t)done;
}

/* What a damaged header asks for must not take the machine's memory. */
static void *allocate(size_t size)
{
    return size <= ALLOCATION_MAX ? malloc(size) : NULL;
}

static bool grow(transfer *s, size_t size)
{
    if (size <= s->room)
        return true;
    size_t room = size + size / 2;
    unsigned char *bytes = realloc(s->bytes, room);
    if (!bytes)
        return false;
    s->bytes = bytes;
    s->room = room;
    return true;
}

/* Into memory, and never reporting failure: OpenEXRCore 3.1 waits for its own lock when a write fails. */
static int64_t put(exr_const_context_t context, void *data, const void *from, uint64_t size, uint64_t offset,
                   exr_stream_error_func_ptr_t error)
{
    transfer *s = data;
    (void)context, (void)error;
    if (s->no_room || !grow(s, offset + size)) {
        s->no_room = true;
        return (int64_t)size;
    }
    if (offset > s->size)
        memset(s->bytes + s->size, 0, offset - s->size);
    memcpy(s->bytes + offset, from, size);
    s->size = offset + size > s->size ? offset + size : s->size;
    return (int64_t)size;
}

static exr_context_initializer_t initializer(transfer *s)
{
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn = keep_message;
    setup.alloc_fn = allocate;
    setup.free_fn = free;
    setup.user_data = s;
    setup.size_fn = get_size;
    setup.read_fn = get;
    setup.write_fn = put;
    /* Without these, a value that is wrong is replaced by a guess. */
    setup.flags = EXR_CONTEXT_FLAG_STRICT_HEADER | EXR_CONTEXT_FLAG_DISABLE_CHUNK_RECONSTRUCTION;
    return setup;
}

static bool passed(exr_result_t result, char why[EXR_WHY])
{
    if (result == EXR_ERR_SUCCESS) {
        *why = 0;
        return true;
    }
    return *why ? false : fail(why, "%s", exr_get_default_error_message(result));
}

/* ---- Finding layers ---------------------------------------------------------------------------------------------- */

typedef struct reader {
    char *why;
    exr_context_t file;
    exr_frame *frame;
    exr_layer *layers;
    int count, part, parts;
    const exr_attr_chlist_t *channels;     /* of the part */
    int index[EXR_LAYERS_MAX][3];          /* of each layer's channels */
} reader;

/* Where the ending NAME.C, or C where the name is empty, begins in a channel's name; -1 where it has another. */
static int ending(const char *channel, const exr_layer *layer, int component)
{
    char text[256];
    int length = snprintf(text, sizeof text, "%s%s%c", layer->name, *layer->name ? "." : "",
                          layer->components[component]);
    int start = (int)strlen(channel) - length;
    return length < (int)sizeof text && start >= 0 && !strcmp(channel + start, text) ? start : -1;
}

/* The channel of a component after a prefix of `length` characters, or -1. */
static int find_channel(const exr_attr_chlist_t *channels, const exr_layer *layer, int component, const char *prefix,
                        int length)
{
    for (int i = 0; i < channels->num_channels; i++) {
        const char *name = channels->entries[i].name.str;
        if (ending(name, layer, component) == length && !strncmp(name, prefix, (size_t)length))
            return i;
    }
    return -1;
}

static bool find_layer(reader *r, int layer, const char *prefix, int length)
{
    for (int c = 0; c < 3; c++)
        if ((r->index[layer][c] = find_channel(r->channels, &r->layers[layer], c, prefix, length)) < 0)
            return false;
    return true;
}

static bool select_by_prefix(reader *r)
{
    for (int i = 0; i < r->channels->num_channels; i++) {
        const char *name = r->channels->entries[i].name.str;
        int length = ending(name, &r->layers[0], 0), found = 0;
        while (length >= 0 && found < r->count && find_layer(r, found, name, length))
            found++;
        if (found == r->count)
            return true;
    }
    return false;
}

/* Whether one prefix alone has the layer. */
static bool select_alone(reader *r, int layer)
{
    int prefixes = 0, last[3];
    for (int i = 0; i < r->channels->num_channels; i++) {
        const char *name = r->channels->entries[i].name.str;
        int length = ending(name, &r->layers[layer], 0);
        if (length >= 0 && find_layer(r, layer, name, length)) {
            memcpy(last, r->index[layer], sizeof last);
            prefixes++;
        }
    }
    if (prefixes == 1)
        memcpy(r->index[layer], last, sizeof last);
    return prefixes == 1;
}

static bool select_in_part(reader *r)
{
    if (select_by_prefix(r))
        return true;
    for (int layer = 0; layer < r->count; layer++)
        if (!select_alone(r, layer))
            return false;
    return true;
}

/* The channels of a part with pixels; NULL for a deep one. */
static const exr_attr_chlist_t *flat_channels(const reader *r, int part)
{
    exr_storage_t storage;
    const exr_attr_chlist_t *channels;
    if (exr_get_storage(r->file, part, &storage) || exr_get_channels(r->file, part, &channels))
        return NULL;
    return storage == EXR_STORAGE_SCANLINE || storage == EXR_STORAGE_TILED ? channels : NULL;
}

static bool has_component(const reader *r, const exr_layer *layer, int component)
{
    for (int part = 0; part < r->parts; part++) {
        const exr_attr_chlist_t *channels = flat_channels(r, part);
        for (int i = 0; channels && i < channels->num_channels; i++)
            if (ending(channels->entries[i].name.str, layer, component) >= 0)
                return true;
    }
    return false;
}

static bool refuse_channels(const reader *r)
{
    char names[200] = "";
    for (int i = 0; i < r->count; i++) {
        for (int c = 0; c < 3; c++)
            if (!has_component(r, &r->layers[i], c))
                return fail(r->why, "no channel ends in %.100s.%c", r->layers[i].name, r->layers[i].components[c]);
        size_t used = strlen(names);
        snprintf(names + used, sizeof names - used, "%s%.60s", i ? ", " : "", r->layers[i].name);
    }
    return fail(r->why, "no part has all of %s, under one prefix or each of them once", names);
}

static bool select_channels(reader *r)
{
    if (!passed(exr_get_count(r->file, &r->parts), r->why))
        return false;
    for (r->part = 0; r->part < r->parts; r->part++)
        if ((r->channels = flat_channels(r, r->part)) && select_in_part(r))
            return true;
    return refuse_channels(r);
}

/* ---- Reading ----------------------------------------------------------------------------------------------------- */

/* OpenEXRCore 3.1 returns garbage for what B44 leaves uncompressed: channels that are not half. */
static bool check_compression(const reader *r)
{
    exr_compression_t compression;
    if (!passed(exr_get_compression(r->file, r->part, &compression), r->why))
        return false;
    if (compression != EXR_COMPRESSION_B44 && compression != EXR_COMPRESSION_B44A)
        return true;
    for (int i = 0; i < r->channels->num_channels; i++)
        if (r->channels->entries[i].pixel_type != EXR_PIXEL_HALF)
            return fail(r->why, "B44 compression is supported for half channels alone, and %.200s is another",
                        r->channels->entries[i].name.str);
    return true;
}

static bool check_sampling(const reader *r)
{
    for (int i = 0; i < 3 * r->count; i++) {
        const exr_attr_chlist_entry_t *channel = &r->channels->entries[r->index[i / 3][i % 3]];
        if (channel->x_sampling != 1 || channel->y_sampling != 1)
            return fail(r->why, "channel %.200s is subsampled", channel->name.str);
    }
    return true;
}

static bool read_frame(const reader *r)
{
    exr_frame *frame = r->frame;
    exr_attr_box2i_t data, display;
    if (!passed(exr_get_data_window(r->file, r->part, &data), r->why) ||
        !passed(exr_get_display_window(r->file, r->part, &display), r->why) ||
        !passed(exr_get_pixel_aspect_ratio(r->file, r->part, &frame->pixel_aspect), r->why))
        return false;
    int64_t width = (int64_t)data.max.x - data.min.x + 1, height = (int64_t)data.max.y - data.min.y + 1;
    if (width < 1 || height < 1)
        return fail(r->why, "the data window is empty");
    if (width > EXR_PIXELS_MAX / height)
        return fail(r->why, "a data window of %lld x %lld is more than %d pixels", (long long)width,
                    (long long)height, EXR_PIXELS_MAX);
    memcpy(frame->data, &data, sizeof frame->data);
    memcpy(frame->display, &display, sizeof frame->display);
    frame->width = (size_t)width;
    frame->height = (size_t)height;
    return true;
}

static bool make_planes(const reader *r)
{
    for (int i = 0; i < 3 * r->count; i++)
        if (!(r->layers[i / 3].plane[i % 3] = calloc(r->frame->width * r->frame->height, sizeof(float))))
            return fail(r->why, "not enough memory for %zu x %zu pixels", r->frame->width, r->frame->height);
    return true;
}

static void aim(exr_coding_channel_info_t *channel, const exr_frame *frame, float *first)
{
    channel->user_bytes_per_element = sizeof(float);
    channel->user_data_type = EXR_PIXEL_FLOAT;
    channel->user_pixel_stride = sizeof(float);
    channel->user_line_stride = (int32_t)(frame->width * sizeof(float));
    channel->decode_to_ptr = (uint8_t *)first;
}

static bool read_chunk(const reader *r, const exr_chunk_info_t *chunk, size_t x, size_t y)
{
    const exr_frame *frame = r->frame;
    if (chunk->width < 1 || chunk->height < 1 || x + (size_t)chunk->width > frame->width ||
        y + (size_t)chunk->height > frame->height)
        return fail(r->why, "a chunk of pixels reaches outside the data window");
    exr_decode_pipeline_t decode = EXR_DECODE_PIPELINE_INITIALIZER;
    if (!passed(exr_decoding_initialize(r->file, r->part, chunk, &decode), r->why))
        return false;
    for (int i = 0; i < 3 * r->count; i++)
        aim(&decode.channels[r->index[i / 3][i % 3]], frame, r->layers[i / 3].plane[i % 3] + y * frame->width + x);
    bool read = passed(exr_decoding_choose_default_routines(r->file, r->part, &decode), r->why) &&
                passed(exr_decoding_run(r->file, r->part, &decode), r->why);
    exr_decoding_destroy(r->file, &decode);
    return read;
}

static bool read_chunks(const reader *r)
{
    const exr_frame *frame = r->frame;
    exr_storage_t storage;
    int32_t width = (int32_t)frame->width, height;
    if (!passed(exr_get_storage(r->file, r->part, &storage), r->why))
        return false;
    bool tiled = storage == EXR_STORAGE_TILED;
    if (!passed(tiled ? exr_get_tile_sizes(r->file, r->part, 0, 0, &width, &height)
                      : exr_get_scanlines_per_chunk(r->file, r->part, &height), r->why))
        return false;
    for (size_t y = 0; y < frame->height; y += (size_t)height)
        for (size_t x = 0; x < frame->width; x += (size_t)width) {
            exr_chunk_info_t chunk;
            int column = (int)(x / (size_t)width), row = (int)(y / (size_t)height), line = frame->data[1] + (int)y;
            if (!passed(tiled ? exr_read_tile_chunk_info(r->file, r->part, column, row, 0, 0, &chunk)
                              : exr_read_scanline_chunk_info(r->file, r->part, line, &chunk), r->why) ||
                !read_chunk(r, &chunk, x, y))
                return false;
        }
    return true;
}

static int open_input(const char *path, char why[EXR_WHY])
{
    struct stat status;
    int input = open(path, O_RDONLY | O_CLOEXEC);
    if (input >= 0 && !fstat(input, &status) && S_ISREG(status.st_mode))
        return input;
    fail(why, "%s", input < 0 ? strerror(errno) : "not a regular file");
    if (input >= 0)
        close(input);
    return -1;
}

bool exr_load(const char *path, exr_frame *frame, exr_layer *layers, int count, char why[EXR_WHY])
{
    transfer s = {.why = why, .input = open_input(path, why)};
    reader r = {.why = why, .frame = frame, .layers = layers, .count = count};
    exr_context_initializer_t setup = initializer(&s);
    for (int i = 0; i < count; i++)
        memset(layers[i].plane, 0, sizeof layers[i].plane);
    if (s.input < 0)
        return false;
    *why = 0;
    bool loaded = passed(exr_start_read(&r.file, path, &setup), why) && select_channels(&r) && check_sampling(&r) &&
                  check_compression(&r) && read_frame(&r) && make_planes(&r) && read_chunks(&r);
    exr_finish(&r.file);
    close(s.input);
    if (!loaded)
        exr_free(layers, count);
    return loaded;
}

void exr_free(exr_layer *layers, int count)
{
    for (int i = 0; i < 3 * count; i++) {
        free(layers[i / 3].plane[i % 3]);
        layers[i / 3].plane[i % 3] = NULL;
    }
}

/* ---- Writing ----------------------------------------------------------------------------------------------------- */

static const char *const written[3] = {"R", "G", "B"};

static bool write_header(exr_context_t file, const exr_frame *frame, char why[EXR_WHY])
{
    exr_attr_box2i_t data, display;
    exr_attr_v2f_t centre = {.arr = {0, 0}};
    int part;
    memcpy(&data, frame->data, sizeof data);
    memcpy(&display, frame->display, sizeof display);
    if (!passed(exr_add_part(file, "radiance", EXR_STORAGE_SCANLINE, &part), why) ||
        !passed(exr_initialize_required_attr(file, part, &display, &data, frame->pixel_aspect, &centre, 1,
                                             EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP), why))
        return false;
    for (int c = 0; c < 3; c++)
        if (!passed(exr_add_channel(file, part, written[c], EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), why))
            return false;
    return passed(exr_write_header(file), why);
}

static bool write_chunk(exr_context_t file, const exr_frame *frame, size_t y, float *const rgb[3], char why[EXR_WHY])
{
    exr_chunk_info_t chunk;
    exr_encode_pipeline_t encode = EXR_ENCODE_PIPELINE_INITIALIZER;
    if (!passed(exr_write_scanline_chunk_info(file, 0, frame->data[1] + (int32_t)y, &chunk), why) ||
        !passed(exr_encoding_initialize(file, 0, &chunk, &encode), why))
        return false;
    for (int i = 0; i < encode.channel_count; i++)
        for (int c = 0; c < 3; c++)
            if (!strcmp(encode.channels[i].channel_name, written[c]))
                aim(&encode.channels[i], frame, rgb[c] + y * frame->width);
    bool wrote = passed(exr_encoding_choose_default_routines(file, 0, &encode), why) &&
                 passed(exr_encoding_run(file, 0, &encode), why);
    exr_encoding_destroy(file, &encode);
    return wrote;
}

static bool write_image(exr_context_t file, const exr_frame *frame, float *const rgb[3], char why[EXR_WHY])
{
    int32_t lines;
    if (!write_header(file, frame, why) || !passed(exr_get_scanlines_per_chunk(file, 0, &lines), why))
        return false;
    for (size_t y = 0; y < frame->height; y += (size_t)lines)
        if (!write_chunk(file, frame, y, rgb, why))
            return false;
    return true;
}

/* The whole file, in memory. */
static bool encode(transfer *s, const exr_frame *frame, float *const rgb[3])
{
    exr_context_initializer_t setup = initializer(s);
    exr_context_t file = NULL;
    bool encoded = passed(exr_start_write(&file, "radiance", EXR_WRITE_FILE_DIRECTLY, &setup), s->why) &&
                   write_image(file, frame, rgb, s->why);
    exr_result_t finished = exr_finish(&file);
    if (!encoded || !passed(finished, s->why))
        return false;
    return !s->no_room || fail(s->why, "not enough memory");
}

static bool write_bytes(const char *path, const transfer *s)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return fail(s->why, "%s", strerror(errno));
    bool wrote = fwrite(s->bytes, 1, s->size, file) == s->size && !fflush(file);
    int error = errno;
    if (fclose(file) && wrote) {
        wrote = false;
        error = errno;
    }
    return wrote || fail(s->why, "%s", strerror(error));
}

static bool replace_file(const char *path, const transfer *s)
{
    size_t size = strlen(path) + 32;
    char *temporary = malloc(size);
    if (!temporary)
        return fail(s->why, "not enough memory");
    snprintf(temporary, size, "%s.%ld.part", path, (long)getpid());
    bool wrote = write_bytes(temporary, s);
    if (wrote && rename(temporary, path))
        wrote = fail(s->why, "%s", strerror(errno));
    if (!wrote)
        unlink(temporary);
    free(temporary);
    return wrote;
}

static bool write_to(const char *path, const transfer *s)
{
    struct stat status;
    if (stat(path, &status))
        return replace_file(path, s);
    if (!S_ISREG(status.st_mode))
        return write_bytes(path, s);
    char *target = realpath(path, NULL);       /* a link stays one */
    bool wrote = target ? replace_file(target, s) : fail(s->why, "%s", strerror(errno));
    free(target);
    return wrote;
}

bool exr_save(const char *path, const exr_frame *frame, float *const rgb[3], char why[EXR_WHY])
{
    transfer s = {.why = why};
    *why = 0;
    bool saved = encode(&s, frame, rgb) && write_to(path, &s);
    free(s.bytes);
    return saved;
}
