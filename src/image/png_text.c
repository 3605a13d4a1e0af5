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

/* Whether a chunk of text (tEXt, zTXt, iTXt) has that keyword: libpng drops one that it cannot expand without a
 * word. */
static bool has_keyword(const unsigned char *bytes, size_t size, const char *keyword)
{
    const size_t name_size = strlen(keyword) + 1;
    for (size_t at = 8; size > at && size - at >= 12;) {
        const size_t length = png_get_uint_32(bytes + at);
        if (length > size - at - 12)
            return false;
        const bool is_text = memcmp(bytes + at + 5, "TXt", 3) == 0 || memcmp(bytes + at + 5, "EXt", 3) == 0;
        if (is_text && length >= name_size && memcmp(bytes + at + 8, keyword, name_size) == 0)
            return true;
        at += 12 + length;
    }
    return false;
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
        else if (!found && has_keyword(bytes, size, keyword))
            code = diagnose(why, STATUS_BAD_INPUT, "copy the file again from where it is whole",
                            "the text '%s' in this PNG file is damaged, or longer than %zu bytes", keyword, limit);
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
