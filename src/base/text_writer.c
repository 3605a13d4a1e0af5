/* Text in memory, written through a stream. */
#include "base/text_writer.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/types.h>

/* Including room for a final 0. */
static bool make_room(text_writer *w, size_t more)
{
    if (more < w->capacity - w->size)
        return true;
    if (more > SIZE_MAX / 4 - w->size)
        return false;
    const size_t capacity = 2 * (w->size + more) + 128;
    char *larger = realloc(w->text, capacity);
    if (!larger)
        return false;
    w->text = larger;
    w->capacity = capacity;
    return true;
}

static ssize_t append(void *of, const char *bytes, size_t count)
{
    text_writer *w = of;
    if (w->failed || !make_room(w, count)) {
        w->failed = true;
        return 0; /* reports an error to the stream */
    }
    memcpy(w->text + w->size, bytes, count);
    w->size += count;
    return (ssize_t)count;
}

status text_writer_open(text_writer *writer, diagnostic *why)
{
    *writer = (text_writer){.stream = NULL};
    if (make_room(writer, 0) && (writer->stream = fopencookie(writer, "w", (cookie_io_functions_t){.write = append})))
        return STATUS_OK;
    text_writer_abandon(writer);
    return out_of_memory(why);
}

/* Flushes the stream; did everything fit? */
static bool end_stream(text_writer *w)
{
    const bool bad = !w->stream || ferror(w->stream);
    const bool ended = w->stream && fclose(w->stream) == 0;
    w->stream = NULL;
    return ended && !bad && !w->failed;
}

status text_writer_close(text_writer *writer, char **text, size_t *size, diagnostic *why)
{
    *text = NULL;
    if (!end_stream(writer)) {
        text_writer_abandon(writer);
        return out_of_memory(why);
    }
    writer->text[writer->size] = 0;
    *text = writer->text;
    if (size)
        *size = writer->size;
    *writer = (text_writer){.stream = NULL};
    return STATUS_OK;
}

void text_writer_abandon(text_writer *writer)
{
    end_stream(writer);
    free(writer->text);
    *writer = (text_writer){.stream = NULL};
}

status text_writer_end(text_writer *writer, status code, char **text, size_t *size, diagnostic *why)
{
    *text = NULL;
    if (code == STATUS_OK)
        return text_writer_close(writer, text, size, why);
    text_writer_abandon(writer);
    return code;
}
