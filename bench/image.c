#include "image.h"
#include "console.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---- Deflate (RFC 1951): greedy matches found along hash chains, fixed Huffman codes ----------------------------- */

enum { WINDOW = 1 << 15, MATCH_LEAST = 3, MATCH_MOST = 258, CHAIN_MOST = 48 };

typedef struct deflater {
    const uint8_t *in;
    size_t count;
    uint8_t *out;
    size_t written;
    uint32_t bits;
    int bit_count;
    int64_t newest[WINDOW];     /* by hash: the newest position, or -1 */
    int64_t older[WINDOW];      /* by position: the one before it with the same hash */
} deflater;

static void put_bits(deflater *d, unsigned value, int count)
{
    d->bits |= (uint32_t)value << d->bit_count;
    for (d->bit_count += count; d->bit_count >= 8; d->bit_count -= 8, d->bits >>= 8)
        d->out[d->written++] = (uint8_t)d->bits;
}

/* Huffman codes go out from their first bit on. */
static void put_code(deflater *d, unsigned code, int count)
{
    unsigned reversed = 0;
    for (int i = 0; i < count; i++)
        reversed |= (code >> i & 1) << (count - 1 - i);
    put_bits(d, reversed, count);
}

static void put_symbol(deflater *d, unsigned symbol)
{
    if (symbol < 144)
        put_code(d, 0x30 + symbol, 8);
    else if (symbol < 256)
        put_code(d, 0x190 + symbol - 144, 9);
    else if (symbol < 280)
        put_code(d, symbol - 256, 7);
    else
        put_code(d, 0xc0 + symbol - 280, 8);
}

/* Lengths and distances share a pattern: a code holds the leading bit and the `kept` bits after it, the rest follow. */
static int extra_bits(unsigned value, int kept)
{
    int extra = 0;
    while (value >> extra >= 2u << kept)
        extra++;
    return extra;
}

static void put_match(deflater *d, size_t length, size_t distance)
{
    unsigned l = (unsigned)length - MATCH_LEAST, s = (unsigned)distance - 1;
    int extra = length == MATCH_MOST ? 0 : extra_bits(l, 2);
    put_symbol(d, length == MATCH_MOST ? 285 : 257 + ((unsigned)extra << 2) + (l >> extra));
    put_bits(d, length == MATCH_MOST ? 0 : l & ((1u << extra) - 1), extra);
    extra = extra_bits(s, 1);
    put_code(d, ((unsigned)extra << 1) + (s >> extra), 5);
    put_bits(d, s & ((1u << extra) - 1), extra);
}

static size_t hash(const uint8_t *p)
{
    uint32_t three = (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16;
    return (three * 2654435761u) >> 17;
}

static void remember(deflater *d, size_t at)
{
    if (at + MATCH_LEAST > d->count)
        return;
    int64_t *newest = &d->newest[hash(d->in + at)];
    d->older[at % WINDOW] = *newest;
    *newest = (int64_t)at;
}

static size_t match_length(const deflater *d, size_t at, size_t before)
{
    size_t most = d->count - at < MATCH_MOST ? d->count - at : MATCH_MOST, length = 0;
    while (length < most && d->in[at + length] == d->in[before + length])
        length++;
    return length;
}

static size_t find_match(const deflater *d, size_t at, size_t *distance)
{
    size_t longest = 0;
    if (at + MATCH_LEAST > d->count)
        return 0;
    int64_t before = d->newest[hash(d->in + at)];
    for (int i = 0; i < CHAIN_MOST && before >= 0 && at - (size_t)before < WINDOW && longest < MATCH_MOST; i++) {
        size_t length = match_length(d, at, (size_t)before);
        if (length > longest) {
            longest = length;
            *distance = at - (size_t)before;
        }
        before = d->older[(size_t)before % WINDOW];
    }
    return longest;
}

static void deflate(deflater *d)
{
    for (size_t i = 0; i < WINDOW; i++)
        d->newest[i] = -1;
    put_bits(d, 1, 1);      /* the last block */
    put_bits(d, 1, 2);      /* fixed codes */
    for (size_t at = 0, shown = 0; at < d->count;) {
        if (at >= shown) {
            console_progress("compressing", at, d->count);
            shown += 1 << 16;
        }
        size_t distance, length = find_match(d, at, &distance);
        if (length >= MATCH_LEAST)
            put_match(d, length, distance);
        else
            put_symbol(d, d->in[at]);
        for (size_t end = at + (length >= MATCH_LEAST ? length : 1); at < end; at++)
            remember(d, at);
    }
    put_symbol(d, 256);
    put_bits(d, 0, 7);
}

static void put_big_endian(uint8_t out[4], uint32_t value)
{
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(value >> (24 - 8 * i));
}

static uint32_t adler32(const uint8_t *p, size_t count)
{
    uint32_t a = 1, b = 0;
    for (size_t i = 0; i < count; i++) {
        a = (a + p[i]) % 65521;
        b = (b + a) % 65521;
    }
    return b << 16 | a;
}

/* The zlib stream (RFC 1950) of `in`, which the caller frees, or NULL. A literal takes at most 9 bits. */
static uint8_t *zlib_stream(const uint8_t *in, size_t count, size_t *size)
{
    deflater *d = malloc(sizeof *d);
    uint8_t *out = d ? malloc(count + count / 8 + 64) : NULL;
    if (out) {
        *d = (deflater){.in = in, .count = count, .out = out, .written = 2};
        out[0] = 0x78;
        out[1] = 0x01;
        deflate(d);
        put_big_endian(out + d->written, adler32(in, count));
        *size = d->written + 4;
    }
    free(d);
    return out;
}

/* ---- PNG ------------------------------------------------------------------------------------------------------- */

static uint8_t paeth(int left, int up, int corner)
{
    int to_left = abs(up - corner), to_up = abs(left - corner), to_corner = abs(left + up - 2 * corner);
    if (to_left <= to_up && to_left <= to_corner)
        return (uint8_t)left;
    return (uint8_t)(to_up <= to_corner ? up : corner);
}

static uint8_t predict(int filter, uint8_t left, uint8_t up, uint8_t corner)
{
    switch (filter) {
    case 0: return 0;
    case 1: return left;
    case 2: return up;
    case 3: return (uint8_t)((left + up) / 2);
    default: return paeth(left, up, corner);
    }
}

/* Filters one row of `count` bytes; returns the sum of the differences as signed bytes. `up`: NULL in the first row. */
static uint64_t filter_row(int filter, const uint8_t *row, const uint8_t *up, size_t count, size_t channels,
                           uint8_t *out)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < count; i++) {
        uint8_t left = i >= channels ? row[i - channels] : 0, above = up ? up[i] : 0;
        uint8_t corner = up && i >= channels ? up[i - channels] : 0;
        out[i] = (uint8_t)(row[i] - predict(filter, left, above, corner));
        sum += (uint64_t)abs((int8_t)out[i]);
    }
    return sum;
}

/* Writes the filter's number and the row under the filter with the least sum. `room` holds a row. */
static void best_filter(const uint8_t *row, const uint8_t *up, size_t count, size_t channels, uint8_t *room,
                        uint8_t *out)
{
    uint64_t least = UINT64_MAX;
    for (int filter = 0; filter < 5; filter++) {
        uint64_t sum = filter_row(filter, row, up, count, channels, room);
        if (sum < least) {
            least = sum;
            out[0] = (uint8_t)filter;
            memcpy(out + 1, room, count);
        }
    }
}

static void pack_row(const uint8_t *rgba, size_t width, size_t channels, uint8_t *out)
{
    for (size_t x = 0; x < width; x++)
        memcpy(out + x * channels, rgba + 4 * x, channels);
}

/* All rows filtered, each behind its filter's number; the caller frees it; or NULL. */
static uint8_t *filtered(const uint8_t *rgba, size_t width, size_t height, size_t channels)
{
    size_t count = width * channels;
    uint8_t *out = malloc((count + 1) * height), *rows = malloc(3 * count);
    for (size_t y = 0; out && rows && y < height; y++) {
        uint8_t *row = rows + y % 2 * count, *up = rows + (y + 1) % 2 * count;
        pack_row(rgba + 4 * y * width, width, channels, row);
        best_filter(row, y ? up : NULL, count, channels, rows + 2 * count, out + y * (count + 1));
        console_progress("filtering", y, height);
    }
    if (!rows) {
        free(out);
        out = NULL;
    }
    free(rows);
    return out;
}

static uint32_t crc32(uint32_t crc, const uint8_t *p, size_t count)
{
    uint32_t table[256];
    for (uint32_t i = 0; i < 256; i++) {
        table[i] = i;
        for (int k = 0; k < 8; k++)
            table[i] = table[i] & 1 ? 0xedb88320u ^ table[i] >> 1 : table[i] >> 1;
    }
    crc = ~crc;
    for (size_t i = 0; i < count; i++)
        crc = table[(crc ^ p[i]) & 255] ^ crc >> 8;
    return ~crc;
}

static void write_chunk(FILE *file, const char type[4], const uint8_t *data, size_t size)
{
    uint8_t head[8], tail[4];
    put_big_endian(head, (uint32_t)size);
    memcpy(head + 4, type, 4);
    put_big_endian(tail, crc32(crc32(0, head + 4, 4), data, size));
    fwrite(head, 1, sizeof head, file);
    fwrite(data, 1, size, file);
    fwrite(tail, 1, sizeof tail, file);
}

static FILE *open_for_writing(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        console_error("%s: %s", path, strerror(errno));
    return file;
}

static bool close_written(FILE *file, const char *path)
{
    bool written = !ferror(file);
    written = fclose(file) == 0 && written;
    return written || console_error("%s: %s", path, strerror(errno));
}

bool image_write_png(const char *path, const uint8_t *rgba, size_t width, size_t height, bool opaque)
{
    size_t channels = opaque ? 3 : 4, size = 0;
    uint8_t *rows = filtered(rgba, width, height, channels);
    uint8_t *stream = rows ? zlib_stream(rows, (width * channels + 1) * height, &size) : NULL;
    free(rows);
    FILE *file = stream ? open_for_writing(path) : NULL;
    if (file) {
        uint8_t header[13] = {[8] = 8, [9] = opaque ? 2 : 6};
        put_big_endian(header, (uint32_t)width);
        put_big_endian(header + 4, (uint32_t)height);
        fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
        write_chunk(file, "IHDR", header, sizeof header);
        write_chunk(file, "sRGB", (const uint8_t[1]){0}, 1);
        write_chunk(file, "IDAT", stream, size);
        write_chunk(file, "IEND", header, 0);
    }
    bool out_of_memory = !stream;
    free(stream);
    if (out_of_memory)
        return console_error("%s: not enough memory", path);
    return file && close_written(file, path);
}

/* ---- PFM ------------------------------------------------------------------------------------------------------- */

static void put_little_endian(uint8_t out[4], float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int i = 0; i < 4; i++)
        out[i] = (uint8_t)(bits >> 8 * i);
}

bool image_write_pfm(const char *path, const float *rgb, size_t width, size_t height)
{
    FILE *file = open_for_writing(path);
    if (!file)
        return false;
    fprintf(file, "PF\n%zu %zu\n-1.0\n", width, height);
    for (size_t y = height; y-- > 0;)
        for (size_t i = 0; i < 3 * width; i++) {
            uint8_t bytes[4];
            put_little_endian(bytes, rgb[y * 3 * width + i]);
            fwrite(bytes, 1, sizeof bytes, file);
        }
    return close_written(file, path);
}
