/* What codecs have in common: limits of sizes, and a confined thread for decoding. */
#include "image/codec.h"

#include "base/budget.h"
#include "base/cancel.h"
#include "base/os_confine.h"
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

status codec_begin(long long width, long long height, size_t file_bytes, unsigned maximum, image **img, float **linear,
                   diagnostic *why)
{
    TRY(codec_check_size(width, height, file_bytes, why));
    TRY(image_create((int)width, (int)height, img, why));
    if (!(*linear = codec_decode_table(maximum)))
        return out_of_memory(why);
    return STATUS_OK;
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
