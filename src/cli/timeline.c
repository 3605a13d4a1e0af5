#include "cli/timeline.h"
#include "base/file.h"
#include "base/number.h"

static void write_row_name(FILE *stream, int worker)
{
    fprintf(stream, ",\n{\"name\":\"thread_name\",\"ph\":\"M\",\"pid\":1,\"tid\":%d,\"args\":{\"name\":\"worker %d\"}}",
            worker, worker);
    fprintf(stream,
            ",\n{\"name\":\"thread_sort_index\",\"ph\":\"M\",\"pid\":1,\"tid\":%d,\"args\":{\"sort_index\":%d}}",
            worker, worker);
}

static void write_event(FILE *stream, const tile_event *e)
{
    char begin[NUMBER_TEXT_MAX], length[NUMBER_TEXT_MAX];
    number_format(e->begin_s * 1e6, begin);
    number_format((e->end_s - e->begin_s) * 1e6, length);
    fprintf(stream,
            ",\n{\"name\":\"tile %d,%d\",\"cat\":\"tile\",\"ph\":\"X\",\"ts\":%s,\"dur\":%s,\"pid\":1,\"tid\":%d,",
            e->x0, e->y0, begin, length, e->worker);
    fprintf(stream, "\"args\":{\"x0\":%d,\"y0\":%d,\"x1\":%d,\"y1\":%d}}", e->x0, e->y0, e->x1, e->y1);
}

status timeline_write(const render_result *result, const char *path, diagnostic *why)
{
    file_writer file;
    status opened = file_writer_open(&file, path, why);
    if (opened != STATUS_OK)
        return opened;
    fputs("{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n", file.stream);
    fputs("{\"name\":\"process_name\",\"ph\":\"M\",\"pid\":1,\"tid\":0,\"args\":{\"name\":\"cuvette render\"}}",
          file.stream);
    for (int i = 0; i < result->worker_count; i++)
        write_row_name(file.stream, i);
    for (size_t i = 0; i < result->event_count; i++)
        write_event(file.stream, &result->events[i]);
    fputs("\n]}\n", file.stream);
    return file_writer_commit(&file, why);
}
