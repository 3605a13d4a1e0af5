/* Conversion, filtering and compression of the rows of a PNG in bands, by a thread team. */
#include "image/codec.h"

#include "base/cancel.h"
#include "base/worker_pool.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <zlib.h>

/* ---- filters ---- */

/* Row filters of PNG (PNG specification, 9): before compression a byte is replaced by its difference to a neighbour,
 * modulo 256. Only Sub (the pixel to the left) and Up (the row above) are used. On the shipped scenes the others, added
 * to these, made the files larger or saved nothing, and needed more time. */
enum { SUB = 1, UP = 2 };

/* How the filter of a row is chosen. */
typedef enum png_filter_choice {
    PNG_FILTER_ALWAYS_SUB,     /* fastest */
    PNG_FILTER_FEWEST_CHANGES, /* the fewest unequal neighbouring bytes: deflate finds long matches, best for 8 bits */
    PNG_FILTER_LEAST_SUM       /* the least sum of absolute differences (PNG specification, 12.7), best for 16 bits */
} png_filter_choice;

static void filter_sub(const unsigned char *row, size_t bytes, size_t pixel, unsigned char *out)
{
    memcpy(out, row, pixel);
    for (size_t i = pixel; i < bytes; i++)
        out[i] = (unsigned char)(row[i] - row[i - pixel]);
}

static void filter_up(const unsigned char *row, const unsigned char *above, size_t bytes, unsigned char *out)
{
    for (size_t i = 0; i < bytes; i++)
        out[i] = (unsigned char)(row[i] - above[i]);
}

static uint32_t changes(const unsigned char *filtered, size_t bytes)
{
    uint32_t count = 0;
    for (size_t i = 1; i < bytes; i++)
        count += filtered[i] != filtered[i - 1];
    return count;
}

static uint32_t absolute_sum(const unsigned char *filtered, size_t bytes)
{
    uint32_t sum = 0; /* at most 128 x 6 x 65536 */
    for (size_t i = 0; i < bytes; i++)
        sum += filtered[i] < 128 ? filtered[i] : 256u - filtered[i];
    return sum;
}

/* Writes the filter's type and the filtered row, bytes + 1 values, to out. above: the row above, all 0 for the first
 * row. pixel: bytes per pixel. spare: bytes + 1 values that may be overwritten. */
static void png_filter_row(png_filter_choice choice, const unsigned char *row, const unsigned char *above, size_t bytes,
                           size_t pixel, unsigned char *out, unsigned char *spare)
{
    out[0] = SUB;
    filter_sub(row, bytes, pixel, out + 1);
    if (choice == PNG_FILTER_ALWAYS_SUB)
        return;
    uint32_t (*cost)(const unsigned char *, size_t) = choice == PNG_FILTER_LEAST_SUM ? absolute_sum : changes;
    spare[0] = UP;
    filter_up(row, above, bytes, spare + 1);
    if (cost(spare + 1, bytes) < cost(out + 1, bytes))
        memcpy(out, spare, bytes + 1);
}

/* ---- bands ---- */

/* A band has at least BAND_BYTES of pixels. Measured on all shipped scenes: smaller bands cost more than 3 % of the
 * file, larger ones balance the threads badly. WAVE bands are in memory at a time. */
enum { BAND_BYTES = 131072, WAVE = 64, THREADS_MAX = 16 };
enum { HEADER_BYTES = 2, TRAILER_BYTES = 4, FLUSH_BYTES = 16, MEMORY_LEVEL = 8, RAW_WINDOW = -15 };

/* Chosen by measurement, so that no file of a shipped scene is more than 10 % larger than libpng's at level 6. */
typedef struct effort {
    int level, strategy;
    bool tuned; /* level 4 with the numbers of reset_deflater */
    png_filter_choice filter;
} effort;

/* The deflater and the buffers of one thread. */
typedef struct workspace {
    z_stream deflater;
    bool ready;               /* the deflater is initialised */
    float *rgb;               /* one row, linear */
    unsigned char *row[2];    /* two rows, encoded */
    unsigned char *filtered;  /* the band */
    unsigned char *spare_row; /* one filtered row */
} workspace;

typedef struct band {
    unsigned char *bytes;
    size_t size, rows_size; /* after and before compression */
    uLong adler;
    bool failed;
} band;

struct png_bands {
    const image_rows *rows;
    int bits;
    effort effort;
    size_t pixel_bytes, row_bytes, band_rows, band_count, begun; /* begun: bands of this and earlier waves */
    size_t capacity;                                             /* of a compressed band */
    uLong adler;
    codec_bytes bytes;
    codec_words *words;
    thread_team *team;
    workspace *work;
    band wave[WAVE];
    size_t wave_count;
};

static effort choose_effort(int bits, bool fast)
{
    if (fast)
        return (effort){1, Z_DEFAULT_STRATEGY, false, PNG_FILTER_ALWAYS_SUB};
    return bits == 8 ? (effort){4, Z_DEFAULT_STRATEGY, true, PNG_FILTER_FEWEST_CHANGES}
                     : (effort){4, Z_FILTERED, true, PNG_FILTER_LEAST_SUM};
}

/* Level 4 with two differences: only the longest match ends the search (rendered images have long runs), and matches
 * below 8 bytes may be replaced by a longer one that begins at the next byte. 8-bit images become as small as with
 * level 5 in four fifths of the time; longer searches gain little. Resetting a deflater sets the numbers of its level
 * again. */
static bool reset_deflater(z_stream *z, bool tuned)
{
    enum { GOOD_LENGTH = 4, LAZY_BELOW = 8, NICE_LENGTH = 258, CHAIN = 16 };
    return deflateReset(z) == Z_OK && (!tuned || deflateTune(z, GOOD_LENGTH, LAZY_BELOW, NICE_LENGTH, CHAIN) == Z_OK);
}

static bool create_workspace(png_bands *b, workspace *w)
{
    const size_t filtered_row = b->row_bytes + 1;
    w->rgb = malloc((size_t)b->rows->width * 3 * sizeof *w->rgb);
    w->row[0] = malloc(b->row_bytes);
    w->row[1] = malloc(b->row_bytes);
    w->filtered = malloc(filtered_row * b->band_rows);
    w->spare_row = malloc(filtered_row);
    w->ready =
        deflateInit2(&w->deflater, b->effort.level, Z_DEFLATED, RAW_WINDOW, MEMORY_LEVEL, b->effort.strategy) == Z_OK;
    return w->rgb && w->row[0] && w->row[1] && w->filtered && w->spare_row && w->ready;
}

static void destroy_workspace(workspace *w)
{
    free(w->rgb);
    free(w->row[0]);
    free(w->row[1]);
    free(w->filtered);
    free(w->spare_row);
    if (w->ready)
        deflateEnd(&w->deflater);
}

static bool allocate(png_bands *b)
{
    const size_t in_memory = b->band_count < WAVE ? b->band_count : WAVE;
    const int units = thread_team_units(), most = units < THREADS_MAX ? units : THREADS_MAX;
    b->team = thread_team_create(in_memory < (size_t)most ? (int)in_memory : most);
    if (!b->team || !(b->work = calloc((size_t)thread_team_size(b->team), sizeof *b->work)))
        return false;
    if (b->bits == 8)
        codec_bytes_prepare(&b->bytes);
    else if (!(b->words = codec_words_create()))
        return false;
    for (int i = 0; i < thread_team_size(b->team); i++)
        if (!create_workspace(b, &b->work[i]))
            return false;
    b->capacity = deflateBound(&b->work[0].deflater, (uLong)((b->row_bytes + 1) * b->band_rows)) + HEADER_BYTES +
                  TRAILER_BYTES + FLUSH_BYTES;
    for (size_t i = 0; i < in_memory; i++)
        if (!(b->wave[i].bytes = malloc(b->capacity)))
            return false;
    return true;
}

status png_bands_create(const image_rows *rows, int bits, bool fast, png_bands **out, diagnostic *why)
{
    png_bands *b = calloc(1, sizeof *b);
    *out = NULL;
    if (!b)
        return out_of_memory(why);
    b->rows = rows;
    b->bits = bits;
    b->effort = choose_effort(bits, fast);
    b->pixel_bytes = 3 * (size_t)(bits / 8);
    b->row_bytes = (size_t)rows->width * b->pixel_bytes;
    b->band_rows = (BAND_BYTES + b->row_bytes - 1) / b->row_bytes;
    if (b->band_rows > (size_t)rows->height)
        b->band_rows = (size_t)rows->height;
    b->band_count = ((size_t)rows->height + b->band_rows - 1) / b->band_rows;
    b->adler = adler32(0, NULL, 0);
    if (!allocate(b)) {
        png_bands_destroy(b);
        return out_of_memory(why);
    }
    *out = b;
    return STATUS_OK;
}

void png_bands_destroy(png_bands *b)
{
    if (!b)
        return;
    for (int i = 0; b->work && i < thread_team_size(b->team); i++)
        destroy_workspace(&b->work[i]);
    for (size_t i = 0; i < WAVE; i++)
        free(b->wave[i].bytes);
    thread_team_destroy(b->team);
    free(b->work);
    free(b->words);
    free(b);
}

static void encode_row(const png_bands *b, workspace *w, size_t y, unsigned char *row)
{
    b->rows->read(b->rows->of, (int)y, w->rgb);
    if (b->bits == 8)
        codec_bytes_encode(&b->bytes, w->rgb, 3 * (size_t)b->rows->width, row);
    else
        codec_words_encode(b->words, w->rgb, 3 * (size_t)b->rows->width, row);
}

/* Fills w->filtered with the rows first .. end - 1. The filter needs the row above, also of the band's first row. */
static void filter_rows(const png_bands *b, workspace *w, size_t first, size_t end)
{
    unsigned char *row = w->row[0], *above = w->row[1], *to = w->filtered;
    if (first > 0)
        encode_row(b, w, first - 1, above);
    else
        memset(above, 0, b->row_bytes);
    for (size_t y = first; y < end; y++, to += b->row_bytes + 1) {
        encode_row(b, w, y, row);
        png_filter_row(b->effort.filter, row, above, b->row_bytes, b->pixel_bytes, to, w->spare_row);
        unsigned char *swapped = row;
        row = above;
        above = swapped;
    }
}

/* The first band begins with zlib's header (RFC 1950, 2.2): deflate, window of 32 KiB, "fast" as libpng writes it for
 * levels below 6. */
static void compress_band(void *context, size_t index, int member)
{
    static const unsigned char header[HEADER_BYTES] = {0x78, 0x5e};
    png_bands *b = context;
    workspace *w = &b->work[member];
    band *to = &b->wave[index];
    const size_t number = b->begun - b->wave_count + index, first = number * b->band_rows;
    const bool is_last = number + 1 == b->band_count;
    const size_t end = is_last ? (size_t)b->rows->height : first + b->band_rows;
    const size_t start = number == 0 ? HEADER_BYTES : 0;
    to->failed = cancel_asked();
    if (to->failed)
        return;
    filter_rows(b, w, first, end);
    memcpy(to->bytes, header, start);
    to->rows_size = (end - first) * (b->row_bytes + 1);
    to->adler = adler32(adler32(0, NULL, 0), w->filtered, (uInt)to->rows_size);
    z_stream *z = &w->deflater;
    to->failed = !reset_deflater(z, b->effort.tuned);
    z->next_in = w->filtered;
    z->avail_in = (uInt)to->rows_size;
    z->next_out = to->bytes + start;
    z->avail_out = (uInt)(b->capacity - start - TRAILER_BYTES);
    to->failed = to->failed || deflate(z, is_last ? Z_FINISH : Z_SYNC_FLUSH) != (is_last ? Z_STREAM_END : Z_OK) ||
                 z->avail_in > 0 || z->avail_out == 0;
    to->size = b->capacity - TRAILER_BYTES - z->avail_out;
}

static void add_checksum(png_bands *b)
{
    for (size_t i = 0; i < b->wave_count; i++)
        b->adler = adler32_combine(b->adler, b->wave[i].adler, (z_off_t)b->wave[i].rows_size);
    if (b->begun < b->band_count)
        return;
    band *last = &b->wave[b->wave_count - 1];
    for (int i = 0; i < TRAILER_BYTES; i++)
        last->bytes[last->size++] = (unsigned char)(b->adler >> (24 - 8 * i)); /* big-endian, RFC 1950, 2.2 */
}

size_t png_bands_compress(png_bands *b)
{
    const size_t left = b->band_count - b->begun;
    b->wave_count = left < WAVE ? left : WAVE;
    b->begun += b->wave_count;
    if (b->wave_count == 0)
        return 0;
    thread_team_run(b->team, compress_band, b, b->wave_count);
    add_checksum(b);
    return b->wave_count;
}

bool png_bands_get(const png_bands *b, size_t index, const unsigned char **bytes, size_t *size)
{
    *bytes = b->wave[index].bytes;
    *size = b->wave[index].size;
    return !b->wave[index].failed;
}
