/* What codecs have in common: limits of sizes, orientation, and a confined thread for decoding. */
#include "image/codec.h"

#include "base/budget.h"
#include "base/cancel.h"
#include "base/os_process.h"
#include <pthread.h>
#include <signal.h>
#include <stddef.h>

/* ---- limits ---- */

status codec_check_size(long long width, long long height, size_t file_bytes, diagnostic *why)
{
    bool sides = width >= 1 && height >= 1 && width <= IMAGE_SIDE_MAX && height <= IMAGE_SIDE_MAX;
    if (!sides || width * height > CODEC_PIXELS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use sides of 1 to 65536 and at most 2^28 pixels in total",
                        "the image has %lld x %lld pixels", width, height);
    if (width * height > CODEC_PIXELS_FREE && width * height / CODEC_PIXELS_PER_BYTE > (long long)file_bytes)
        return diagnose(why, STATUS_BAD_INPUT, "save a smaller image: its size does not match its contents",
                        "the image has %lld x %lld pixels in only %zu bytes", width, height, file_bytes);
    return STATUS_OK;
}

status codec_begin(long long width, long long height, size_t file_bytes, unsigned maximum, const codec_color *color,
                   image **img, codec_tables *tables, diagnostic *why)
{
    TRY(codec_check_size(width, height, file_bytes, why));
    TRY(image_create((int)width, (int)height, img, why));
    return codec_tables_make(color, (const unsigned[]){maximum, maximum, maximum}, tables, why);
}

/* ---- orientation ---- */

static uint32_t tiff_number(const unsigned char *at, int bytes, bool big)
{
    return big ? codec_big_endian(at, bytes) : codec_little_endian(at, bytes);
}

/* A TIFF file (TIFF 6.0, section 2) whose first directory may have the tag 274, Orientation, of type SHORT. */
int codec_exif_orientation(const unsigned char *bytes, size_t size)
{
    if (size < 10 || (memcmp(bytes, "II*\0", 4) != 0 && memcmp(bytes, "MM\0*", 4) != 0))
        return 1;
    const bool big = bytes[0] == 'M';
    const size_t directory = tiff_number(bytes + 4, 4, big);
    if (directory > size - 2)
        return 1;
    const size_t entries = tiff_number(bytes + directory, 2, big);
    for (size_t i = 0, at = directory + 2; i < entries && at + 12 <= size; i++, at += 12) {
        if (tiff_number(bytes + at, 2, big) != 274 || tiff_number(bytes + at + 2, 2, big) != 3)
            continue;
        const uint32_t value = tiff_number(bytes + at + 8, 2, big);
        return value >= 1 && value <= 8 ? (int)value : 1;
    }
    return 1;
}

/* The image's row y and column x, where the stored rows and columns begin at these sides:
 * 1 top left, 2 top right, 3 bottom right, 4 bottom left, 5 left top, 6 right top, 7 right bottom, 8 left bottom. */
status codec_orient(image **img, int orientation, diagnostic *why)
{
    if (orientation <= 1)
        return STATUS_OK;
    const bool turned = orientation >= 5, columns_back = strchr("2378", '0' + orientation),
               rows_back = strchr("3467", '0' + orientation);
    const image *from = *img;
    image *to;
    TRY(image_create(turned ? from->height : from->width, turned ? from->width : from->height, &to, why));
    status code = from->alpha ? image_add_alpha(to, why) : STATUS_OK;
    for (int y = 0; y < to->height && code == STATUS_OK; y++) {
        code = cancel_check(why);
        for (int x = 0; x < to->width; x++) {
            const int along = turned ? y : x, across = turned ? x : y;
            const size_t column = (size_t)(columns_back ? from->width - 1 - along : along),
                         row = (size_t)(rows_back ? from->height - 1 - across : across),
                         at = row * (size_t)from->width + column, i = (size_t)y * (size_t)to->width + (size_t)x;
            memcpy(to->pixel + 3 * i, from->pixel + 3 * at, 3 * sizeof *to->pixel);
            if (to->alpha)
                to->alpha[i] = from->alpha[at];
        }
    }
    memcpy(to->note, from->note, sizeof to->note);
    image_destroy(code == STATUS_OK ? *img : to);
    *img = code == STATUS_OK ? to : *img;
    return code;
}

/* ---- a confined thread ---- */

enum { STACK_BYTES = 1 << 20 };

typedef struct call {
    void (*work)(void *context);
    void *context;
    cancel_token *token; /* of the caller */
    memory_room room;
} call;

static void *run_confined(void *of)
{
    const call *c = of;
    cancel_follow(c->token);
    memory_budget_assume(c->room);
    if (!os_confine_calls(CONFINE_COMPUTING))
        os_confine_files(NULL, 0);
    c->work(c->context);
    return NULL;
}

void codec_run_confined(void (*work)(void *context), void *context)
{
    call c = {work, context, cancel_current(), memory_budget_snapshot()};
    pthread_t thread;
    pthread_attr_t attributes;
    sigset_t all, before;
    int error = pthread_attr_init(&attributes);
    if (!error) {
        pthread_attr_setstacksize(&attributes, STACK_BYTES);
        sigfillset(&all);
        pthread_sigmask(SIG_SETMASK, &all, &before);
        error = pthread_create(&thread, &attributes, run_confined, &c);
        pthread_sigmask(SIG_SETMASK, &before, NULL);
        pthread_attr_destroy(&attributes);
    }
    if (error)
        work(context);
    else
        cancel_join(thread);
}
