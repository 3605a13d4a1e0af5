/* Reading a text of a PNG file through libpng. What must survive a longjmp is in the png_library, which belongs to a
 * function that does not call setjmp. */
#include "base/apart.h"
#include "image/codec.h"
#include "image/png_library.h"

#include <stdlib.h>

/* The limit on a chunk's memory also bounds what a compressed text expands to. */
static bool read_guarded(png_library *job, size_t limit)
{
    if (setjmp(png_jmpbuf(job->png)))
        return false;
    png_library_guard(job, limit + 4096);
    png_read_info(job->png, job->info);
    return true;
}

static char *find(const png_library *job, const char *keyword, size_t limit)
{
    png_textp texts = NULL;
    const int count = png_get_text(job->png, job->info, &texts, NULL);
    for (int i = 0; i < count; i++)
        if (strcmp(texts[i].key, keyword) == 0 && texts[i].text && strlen(texts[i].text) <= limit)
            return texts[i].text;
    return NULL;
}

static status read_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why)
{
    png_library job = {.bytes = bytes, .size = size};
    status code = STATUS_OK;
    *text = NULL;
    if (!png_library_read(&job)) {
        code = out_of_memory(why);
    } else if (!read_guarded(&job, limit)) {
        code = png_library_failed(&job, why);
    } else {
        const char *found = find(&job, keyword, limit);
        if (found && !(*text = strdup(found)))
            code = out_of_memory(why);
    }
    png_destroy_read_struct(&job.png, &job.info, NULL);
    return code;
}

typedef struct wanted {
    const void *bytes;
    size_t size;
    const char *keyword;
    size_t limit;
    char **text;
    diagnostic *why;
    status code;
} wanted;

static void read_apart(void *of)
{
    wanted *w = of;
    w->code = read_text(w->bytes, w->size, w->keyword, w->limit, w->text, w->why);
}

status image_png_text(const void *bytes, size_t size, const char *keyword, size_t limit, char **text, diagnostic *why)
{
    wanted w = {bytes, size, keyword, limit, text, why, STATUS_OK};
    apart_run(read_apart, &w);
    return w.code;
}
