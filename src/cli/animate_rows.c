/* The CSV table of an animation: one row per rendered frame. */
#include "base/csv.h"
#include "base/number.h"
#include "cli/animate.h"
#include "study/rows/rows.h"
#include "study/rows/table.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

struct animate_rows {
    char *path;
    table *file;
    struct existing_row *existing; /* rows of the file, sorted by frame */
    size_t count;
};

typedef struct existing_row {
    int64_t frame;
    char film_hash[32];
} existing_row;

static void put(csv_buffer *line, const animate_row *r, const char *name)
{
    row_put(line, frame_quantity(name), r->account, -1);
}

/* Name and writer of each column, in one list so that header and rows agree. r: the row; m: the motion's report; b: the
 * first slime's quantities. */
#define COLUMNS(X)                                         \
    X("definition", csv_hash(line, r->definition))         \
    X("frame", csv_count(line, r->frame))                  \
    X("time_s", csv_real(line, r->time_s))                 \
    X("film_hash", put(line, r, "film_hash"))              \
    X("wall_s", put(line, r, "wall_s"))                    \
    X("cpu_s", put(line, r, "cpu_s"))                      \
    X("rays_total", put(line, r, "rays_total"))            \
    X("triangles", put(line, r, "triangles"))              \
    X("steps", csv_count(line, (int64_t)m.steps))          \
    X("step_s", csv_real(line, m.step_s))                  \
    X("surface_s", csv_real(line, m.surface_s))            \
    X("refitted", csv_count(line, m.hierarchies.refitted)) \
    X("rebuilt", csv_count(line, m.hierarchies.rebuilt))   \
    X("refit_s", csv_real(line, m.hierarchies.refit_s))    \
    X("build_s", csv_real(line, m.hierarchies.build_s))    \
    X("growth", csv_real(line, m.hierarchies.growth))      \
    X("kinetic", csv_real(line, b.kinetic))                \
    X("elastic", csv_real(line, b.elastic))                \
    X("compression", csv_real(line, b.compression))        \
    X("gravity", csv_real(line, b.gravity))                \
    X("volume", csv_real(line, b.volume))                  \
    X("center_x", csv_real(line, b.center.x))              \
    X("center_y", csv_real(line, b.center.y))              \
    X("center_z", csv_real(line, b.center.z))              \
    X("low", csv_real(line, b.low))                        \
    X("high", csv_real(line, b.high))                      \
    X("speed_max", csv_real(line, b.speed_max))            \
    X("held", csv_count(line, (int64_t)b.held))            \
    X("isa", put(line, r, "isa"))                          \
    X("config", put(line, r, "config"))

static void put_header(csv_buffer *line)
{
#define NAME(name, put) csv_text(line, name);
    COLUMNS(NAME)
#undef NAME
    csv_end(line);
}

static void put_row(csv_buffer *line, const animate_row *r)
{
    const scene_motion_report m = r->motion;
    const softbody_quantities b = softbody_measure(r->body);
#define VALUE(name, put) put;
    COLUMNS(VALUE)
#undef VALUE
    csv_end(line);
}

static status refuse(const char *path, const char *what, diagnostic *why)
{
    return diagnose_at(why, path, STATUS_BAD_INPUT, "use another file with --rows, or move this one away", "%s", what);
}

static bool has_header(const csv *there, const char *header)
{
    const size_t size = strlen(header);
    return there->complete_size >= size && memcmp(there->raw, header, size) == 0;
}

/* Whether the file is a header that was not written completely: its end is missing, or sectors of it read as zeros. */
static bool is_torn_header(const csv *there, const char *header)
{
    bool torn = there->complete_size == 0 && there->size <= strlen(header);
    for (size_t i = 0; torn && i < there->size; i++)
        torn = there->raw[i] == header[i] || there->raw[i] == 0;
    return torn;
}

static int compare_frames(const void *a, const void *b)
{
    const int64_t x = ((const existing_row *)a)->frame, y = ((const existing_row *)b)->frame;
    return (x > y) - (x < y);
}

/* Reads the existing rows; all must belong to this animation. */
static status read_rows(animate_rows *rows, const char *path, const csv *there, const char *header, uint64_t definition,
                        diagnostic *why)
{
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, definition);
    if (is_torn_header(there, header))
        return STATUS_OK;
    if (!has_header(there, header))
        return refuse(path, "has other columns than the table of an animation", why);
    rows->existing = calloc(there->row_count + 1, sizeof *rows->existing);
    if (!rows->existing)
        return out_of_memory(why);
    const int frame = csv_column(there, "frame"), of_animation = csv_column(there, "definition"),
              img = csv_column(there, "film_hash");
    for (size_t i = 0; i < there->row_count; i++) {
        if (strcmp(csv_field(there, i, of_animation), hash) != 0)
            return refuse(path, "has rows of another animation", why);
        if (!number_parse_int(csv_field(there, i, frame), &rows->existing[i].frame))
            return refuse(path, "has a row without a frame number", why);
        snprintf(rows->existing[i].film_hash, sizeof rows->existing[i].film_hash, "%s", csv_field(there, i, img));
    }
    rows->count = there->row_count;
    qsort(rows->existing, rows->count, sizeof *rows->existing, compare_frames);
    return STATUS_OK;
}

/* table_open with a remedy for animations: the remedy of table_open is for studies. */
static status open_table(const char *path, const char *header, table **out, diagnostic *why)
{
    const status result = table_open(path, header, out, why);
    return result == STATUS_BAD_INPUT ? diagnose(why, result, "wait for it to end, or use another file with --rows",
                                                 "another process is writing this table")
                                      : result;
}

status animate_rows_open(const char *path, uint64_t definition, bool restart, animate_rows **out, diagnostic *why)
{
    csv_buffer header = {0};
    put_header(&header);
    animate_rows *rows = calloc(1, sizeof *rows);
    csv *there = NULL;
    if (rows)
        rows->path = strdup(path);
    status result = rows && rows->path && !header.failed ? csv_read(path, &there, why) : out_of_memory(why);
    if (result == STATUS_OK && there)
        result = read_rows(rows, path, there, header.text, definition, why);
    if (result == STATUS_OK && restart && rows->count > 0)
        result = refuse(path, "already has rows, but this animation starts from the beginning", why);
    THEN(result, open_table(path, header.text, &rows->file, why));
    csv_destroy(there);
    csv_buffer_free(&header);
    if (result != STATUS_OK) {
        animate_rows_close(rows);
        rows = NULL;
    }
    *out = rows;
    return result;
}

void animate_rows_close(animate_rows *rows)
{
    if (!rows)
        return;
    if (rows->file)
        table_close(rows->file);
    free(rows->existing);
    free(rows->path);
    free(rows);
}

static const existing_row *find(const animate_rows *rows, int64_t frame)
{
    const existing_row key = {.frame = frame};
    return rows->count > 0 ? bsearch(&key, rows->existing, rows->count, sizeof key, compare_frames) : NULL;
}

bool animate_rows_have(const animate_rows *rows, int64_t frame)
{
    return find(rows, frame) != NULL;
}

status animate_rows_add(animate_rows *rows, const animate_row *row, diagnostic *why)
{
    char hash[32];
    const existing_row *there = find(rows, row->frame);
    snprintf(hash, sizeof hash, "%016" PRIx64, job_account_hash(row->account));
    if (there && strcmp(there->film_hash, hash) != 0)
        return diagnose_at(
            why, rows->path, STATUS_BAD_INPUT, "render the animation again with --restart and another --rows file",
            "frame %" PRId64 " has film hash %s, but its row has %s", row->frame, hash, there->film_hash);
    if (there)
        return STATUS_OK;
    csv_buffer line = {0};
    put_row(&line, row);
    status result = line.failed ? out_of_memory(why) : table_append(rows->file, line.text, line.size, why);
    csv_buffer_free(&line);
    return result;
}
