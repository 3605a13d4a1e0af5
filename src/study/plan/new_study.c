/* Composes a new study file: parses its axes, writes its text, and reads it back as a study. */
#include "study/plan/new_study.h"
#include "base/array.h"
#include "base/file.h"
#include "base/number.h"
#include "base/text.h"
#include "scene/file/write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 100 };

/* --- axes --- */

static status wrong_axis(diagnostic *why, const char *remedy, const char *what)
{
    return diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
}

/* Adds length bytes of text, without blanks around them. */
static status add_value(new_axis *axis, const char *text, size_t length, diagnostic *why)
{
    while (length > 0 && *text == ' ') {
        text++;
        length--;
    }
    while (length > 0 && text[length - 1] == ' ')
        length--;
    if (length == 0)
        return wrong_axis(why, "write PATH=1,2,3", "a value is empty");
    if (!room_for_one(&axis->values, axis->count, sizeof *axis->values) ||
        !(axis->values[axis->count] = strndup(text, length)))
        return out_of_memory(why);
    axis->count++;
    return STATUS_OK;
}

/* Parses FROM..TO:STEPS. Two dots that do not follow a number are part of a value, such as a path. */
static status parse_range(const char *text, new_axis *axis, bool *is_range, diagnostic *why)
{
    const char *dots = strstr(text, ".."), *colon = dots ? strchr(dots, ':') : NULL;
    char from[NUMBER_TEXT_MAX];
    double value;
    snprintf(from, sizeof from, "%.*s", dots && dots - text < NUMBER_TEXT_MAX ? (int)(dots - text) : 0, text);
    *is_range = number_parse_real(from, &value);
    if (!*is_range)
        return STATUS_OK;
    if (!colon)
        return wrong_axis(why, "write FROM..TO:STEPS, such as 1..2:5", "the range has no number of steps");
    axis->range = true;
    TRY(add_value(axis, text, (size_t)(dots - text), why));
    TRY(add_value(axis, dots + 2, (size_t)(colon - dots - 2), why));
    TRY(add_value(axis, colon + 1, strlen(colon + 1), why));
    int64_t steps;
    if (!number_parse_real(axis->values[1], &value) || !number_parse_int(axis->values[2], &steps))
        return wrong_axis(why, "write FROM..TO:STEPS, such as 1..2:5", "this is not a range of numbers");
    return STATUS_OK;
}

static status parse_list(const char *text, new_axis *axis, diagnostic *why)
{
    for (;;) {
        size_t length = 0;
        for (int depth = 0; text[length] && (depth > 0 || text[length] != ','); length++)
            depth += (text[length] == '[') - (text[length] == ']');
        TRY(add_value(axis, text, length, why));
        if (!text[length])
            return STATUS_OK;
        text += length + 1;
    }
}

status new_axis_parse(const char *text, new_axis *out, diagnostic *why)
{
    const char *equals = strchr(text, '=');
    bool is_range = false;
    *out = (new_axis){.path = NULL};
    if (!equals || equals == text)
        return wrong_axis(why, "write PATH=1,2,3 or PATH=FROM..TO:STEPS", "this is not an axis");
    for (const char *c = text; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f)
            return wrong_axis(why, "remove them", "the axis has control characters");
    if (!(out->path = strndup(text, (size_t)(equals - text))))
        return out_of_memory(why);
    TRY(parse_range(equals + 1, out, &is_range, why));
    return is_range ? STATUS_OK : parse_list(equals + 1, out, why);
}

void new_axis_release(new_axis *axis)
{
    for (size_t i = 0; i < axis->count; i++)
        free(axis->values[i]);
    free(axis->values);
    free(axis->path);
    *axis = (new_axis){.path = NULL};
}

/* The number of points of the axis. */
static size_t new_axis_points(const new_axis *axis)
{
    int64_t steps;
    return !axis->range ? axis->count : number_parse_int(axis->values[2], &steps) && steps > 0 ? (size_t)steps : 0;
}

/* --- the text --- */

/* Writes a value, quoted if YAML would interpret its characters. */
static void put_value(FILE *out, const char *text)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_.+-/";
    if (text[0] == '[') {
        write_list(out, text);
    } else if (text[0] && strspn(text, plain) == strlen(text)) {
        fputs(text, out);
    } else {
        fputc('"', out);
        for (; *text; text++)
            fprintf(out, *text == '"' || *text == '\\' ? "\\%c" : "%c", *text);
        fputc('"', out);
    }
}

/* Writes comment lines of at most COLUMNS characters. */
static void put_comment(FILE *out, const char *indent, const char *text)
{
    const size_t room = COLUMNS - strlen(indent) - 2;
    while (*text) {
        size_t length = strlen(text);
        if (length > room) {
            length = room;
            while (length > 0 && text[length] != ' ')
                length--;
            length = length ? length : room;
        }
        fprintf(out, "%s# %.*s\n", indent, (int)length, text);
        text += length;
        text += strspn(text, " ");
    }
}

static void put_meaning(const new_study *s, FILE *out, const char *path)
{
    param_place at;
    char range[300], text[900];
    if (param_place_find(s->base, path, &at, NULL) != STATUS_OK)
        return;
    param_range_text(at.row, range, sizeof range);
    snprintf(text, sizeof text, "%s (%s%s%s)", at.row->meaning, range, at.row->unit[0] ? ", " : "", at.row->unit);
    put_comment(out, "  ", text);
}

static void put_axis(const new_axis *axis, FILE *out)
{
    fputs("  - {", out);
    put_value(out, axis->path);
    if (axis->range) {
        fprintf(out, ": {from: %s, to: %s, steps: %s}}\n", axis->values[0], axis->values[1], axis->values[2]);
        return;
    }
    size_t column = 8 + strlen(axis->path);
    fputs(": [", out);
    for (size_t i = 0; i < axis->count; i++) {
        const size_t length = strlen(axis->values[i]) + 2;
        if (i > 0)
            fputs(column + length > COLUMNS ? ",\n      " : ", ", out);
        column = column + length > COLUMNS ? 6 + length : column + length;
        put_value(out, axis->values[i]);
    }
    fputs("]}\n", out);
}

static void put_grid(const new_study *s, FILE *out)
{
    size_t cells = 1;
    for (size_t i = 0; i < s->axis_count; i++)
        cells *= new_axis_points(&s->axes[i]);
    if (s->set_count) {
        fputs("\nset: # in all cells\n", out);
        for (size_t i = 0; i < s->set_count; i++) {
            const char *equals = strchr(s->sets[i], '=');
            fprintf(out, "  %.*s: ", (int)(equals - s->sets[i]), s->sets[i]);
            put_value(out, equals + 1);
            fputc('\n', out);
        }
    }
    fprintf(out, "\ngrid: # %zu cell%s; the last axis runs fastest\n", cells, cells == 1 ? "" : "s");
    for (size_t i = 0; i < s->axis_count; i++) {
        put_meaning(s, out, s->axes[i].path);
        put_axis(&s->axes[i], out);
    }
}

void new_study_write(const new_study *s, FILE *out)
{
    fprintf(out,
            "# Run: cuvette study run %s.study (before: --dry-run; after: cuvette study summary %s.study).\n"
            "# The format is described in cuvette-study(5), parameters by cuvette params SCENE.\n"
            "study: %s # the rows are written to results/%s\n"
            "title: ",
            s->name, s->name, s->name, s->name);
    for (size_t i = 0; i < s->axis_count; i++)
        fprintf(out, "%s%s", i ? ", " : "Time and rays by ", s->axes[i].path);
    fputs("\nscene: ", out);
    put_value(out, s->scene_path);
    fputs(" # relative to this file\n", out);
    put_grid(s, out);
    fprintf(out,
            "\nrepetitions: %lld # of each cell; from 6 on, medians have a 95%% interval\n"
            "warmups: %lld # frames of a cell before its first repetition, not part of the summary\n"
            "order: {shuffle: on, seed: 1} # each round of repetitions in a new order, against drift of the machine\n"
            "# Files of each cell; also pfm, workers, pixel_rays, pixel_time, pixel_cut, timeline, metrics, curves, "
            "motion:\n"
            "# keep: {image: on}\n"
            "# To compare the image of each cell with its image under other parameters:\n"
            "# reference: {render.depth: 40}\n",
            (long long)s->repetitions, (long long)s->warmups);
}

/* --- composition --- */

enum { NAME_LENGTH = 64 };

/* Applies the settings, then each value of each axis, so that an error is located at its option. */
static status try_settings(const new_study_order *r, scene *s, const new_axis *axes, diagnostic *why)
{
    char where[512];
    for (size_t i = 0; i < r->set_count; i++) {
        const status code = scene_set_assignment(s, r->sets[i], why);
        snprintf(where, sizeof where, "--set %.400s", r->sets[i]);
        if (code != STATUS_OK) {
            diagnostic_locate(why, where, 0, 0);
            return code;
        }
    }
    scene *trial = scene_clone(s);
    status code = trial ? STATUS_OK : out_of_memory(why);
    for (size_t a = 0; a < r->axis_count && code == STATUS_OK; a++)
        for (size_t i = 0; i < axes[a].count - (axes[a].range ? 1 : 0) && code == STATUS_OK; i++) {
            code = scene_set(trial, axes[a].path, axes[a].values[i], why);
            snprintf(where, sizeof where, "--axis %.400s", r->axes[a]);
            if (code != STATUS_OK)
                diagnostic_locate(why, where, 0, 0);
        }
    scene_destroy(trial);
    return code;
}

/* Chooses the study's name: the given one; else the name of the target file without its ending; else the names of the
 * scene and the first parameter, such as "rod-depth". */
static void choose_name(const new_study_order *r, const new_axis *first, char name[NAME_LENGTH + 1])
{
    const char *file = file_name_of(r->target ? r->target : r->scene);
    const char *ending = strrchr(file, '.'), *parameter = strrchr(first->path, '.');
    const int length = ending ? (int)(ending - file) : (int)strlen(file);
    if (r->name)
        snprintf(name, NAME_LENGTH + 1, "%s", r->name);
    else if (r->target)
        snprintf(name, NAME_LENGTH + 1, "%.*s", length, file);
    else
        snprintf(name, NAME_LENGTH + 1, "%.*s-%s", length, file, parameter ? parameter + 1 : first->path);
    for (char *c = name; !r->name && *c; c++)
        if (!strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_", *c))
            *c = '-';
}

/* Moves the location of an error from the line of the composed text to the option that produced the line. */
static void relocate(const new_study_order *r, const char *text, diagnostic *why)
{
    char where[512] = "study new";
    size_t axes = 0;
    for (long line = 1; line <= why->line && *text; line++) {
        axes += strncmp(text, "  - {", 5) == 0;
        if (line == why->line && strncmp(text, "study: ", 7) == 0)
            snprintf(where, sizeof where, "--name %.400s", r->name ? r->name : "");
        text += strcspn(text, "\n");
        text += *text == '\n';
    }
    if (axes > 0 && axes <= r->axis_count)
        snprintf(where, sizeof where, "--axis %.400s", r->axes[axes - 1]);
    diagnostic_locate(why, where, 0, 0);
}

static status write_and_read(const new_study_order *r, const new_study *content, const char *file, char **text,
                             study **read, diagnostic *why)
{
    text_writer writer;
    size_t size = 0;
    TRY(text_writer_open(&writer, why));
    new_study_write(content, writer.stream);
    TRY(text_writer_close(&writer, text, &size, why));
    const status code = study_read_text_guarded(file, *text, size, r->guard, read, why);
    if (code == STATUS_BAD_INPUT && why->line > 0)
        relocate(r, *text, why);
    return code;
}

static status compose(const new_study_order *r, scene *s, new_axis *axes, char **text, study **read, diagnostic *why)
{
    char where[512], name[NAME_LENGTH + 1], file[NAME_LENGTH + 16], *path = NULL;
    for (size_t i = 0; i < r->axis_count; i++) {
        const status code = new_axis_parse(r->axes[i], &axes[i], why);
        snprintf(where, sizeof where, "--axis %.400s", r->axes[i]);
        if (code != STATUS_OK) {
            diagnostic_locate(why, where, 0, 0);
            return code;
        }
    }
    TRY(try_settings(r, s, axes, why));
    choose_name(r, &axes[0], name);
    snprintf(file, sizeof file, "%s.study", name);
    const char *target = r->target ? r->target : file;
    TRY(write_moved_path(file_name_of(r->scene), r->scene, target, &path, why));
    const new_study content = {.name = name,
                               .scene_path = path,
                               .base = s,
                               .sets = r->sets,
                               .set_count = r->set_count,
                               .axes = axes,
                               .axis_count = r->axis_count,
                               .repetitions = r->repetitions,
                               .warmups = r->warmups};
    const status code = write_and_read(r, &content, target, text, read, why);
    free(path);
    return code;
}

status new_study_compose(const new_study_order *order, scene *s, char **text, study **read, diagnostic *why)
{
    *text = NULL;
    *read = NULL;
    new_axis *axes = calloc(order->axis_count + 1, sizeof *axes);
    status code = axes ? STATUS_OK : out_of_memory(why);
    THEN(code, compose(order, s, axes, text, read, why));
    for (size_t i = 0; axes && i < order->axis_count; i++)
        new_axis_release(&axes[i]);
    free(axes);
    if (code != STATUS_OK) {
        study_destroy(*read);
        free(*text);
        *read = NULL;
        *text = NULL;
    }
    return code;
}
