/* Plans a study as an array job of Slurm: what its parts need, and its script. */
#include "study/run/slurm.h"
#include "base/installed.h"
#include "base/text.h"
#include "scene/model/scene.h"
#include "study/rows/row_files.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_missing(const study_estimate *part)
{
    return part->cells_lacking || part->cells_to_keep;
}

char *slurm_array(const study_estimate *parts, size_t count)
{
    text_writer writer;
    char *text = NULL;
    if (text_writer_open(&writer, NULL) != STATUS_OK)
        return NULL;
    const char *before = "";
    for (size_t i = 0, last; i < count; i = last + 1) {
        for (last = i; last + 1 < count && is_missing(&parts[last + 1]); last++) {
        }
        if (!is_missing(&parts[i])) {
            last = i;
            continue;
        }
        fprintf(writer.stream, last > i ? "%s%zu-%zu" : "%s%zu", before, i, last);
        before = ",";
    }
    return text_writer_close(&writer, &text, NULL, NULL) == STATUS_OK ? text : NULL;
}

double slurm_longest_s(const study_estimate *parts, size_t count)
{
    double longest_s = 0;
    for (size_t i = 0; i < count; i++)
        if (is_missing(&parts[i]) && (parts[i].cut || isnan(parts[i].most_s)))
            return NAN;
        else if (is_missing(&parts[i]))
            longest_s = fmax(longest_s, parts[i].most_s);
    return longest_s;
}

void slurm_time_limit(double longest_s, double factor, char text[SLURM_TIME])
{
    const double most_min = 1e8; /* a limit that Slurm still accepts */
    const long minutes = (long)fmin(fmax(ceil(longest_s * factor / 60), SLURM_LEAST_MIN), most_min);
    const long hours = minutes / 60 % 24, days = minutes / (24 * 60);
    if (days)
        snprintf(text, SLURM_TIME, "%ld-%02ld:%02ld:00", days, hours, minutes % 60);
    else
        snprintf(text, SLURM_TIME, "%02ld:%02ld:00", hours, minutes % 60);
}

status slurm_needs_of(const study *s, slurm_needs *out, diagnostic *why)
{
    const double gib = 1 << 30, program_bytes = gib / 2, pixel_bytes = 64;
    *out = (slurm_needs){1, 0};
    for (size_t cell = 0; cell < study_cell_count(s); cell++) {
        scene *setting;
        TRY(study_cell_scene(s, cell, &setting, why));
        const double pixels = (double)setting->render.width * (double)setting->render.height;
        const long memory_gib = (long)ceil((program_bytes + pixel_bytes * pixels) / gib);
        if (setting->render.threads > out->threads)
            out->threads = (long)setting->render.threads;
        if (memory_gib > out->memory_gib)
            out->memory_gib = memory_gib;
        scene_destroy(setting);
    }
    return STATUS_OK;
}

static bool was_measured_on(const row_environment_count *e, const char *machine)
{
    return e->run && strcmp(e->run->environment.fact[0], machine) == 0 &&
           strcmp(e->run->environment.fact[ENVIRONMENT_FACTS - 1], build_id()) == 0;
}

status slurm_environment(const study *s, const char *results, const char *node_type, char key[ENVIRONMENT_KEY],
                         char *unlike, size_t size, size_t *others, diagnostic *why)
{
    char machine[ENVIRONMENT_FACT_MAX];
    row_files *files;
    row_environment_count *all = NULL, *most = NULL;
    size_t count = 0;
    environment_of_node_type(node_type, machine, sizeof machine);
    snprintf(key, ENVIRONMENT_KEY, "none");
    unlike[0] = 0;
    *others = 0;
    TRY(row_files_read(s, results, ROWS, &files, why));
    const status code = row_environments_find(files, &all, &count, why);
    for (size_t i = 0; i < count; i++)
        if (!was_measured_on(&all[i], machine))
            *others += all[i].rows;
        else if (!most || all[i].rows > most->rows)
            most = &all[i];
    for (size_t i = 0; most && i < count && !unlike[0]; i++)
        if (&all[i] != most && was_measured_on(&all[i], machine))
            environment_difference(&all[i].run->environment, &most->run->environment, unlike, size);
    if (most)
        memcpy(key, most->key, ENVIRONMENT_KEY);
    free(all);
    row_files_destroy(files);
    return code;
}

/* --- the script --- */

/* The template, embedded by the assembler. */
__asm__(".pushsection .rodata\n.globl slurm_template\n.hidden slurm_template\nslurm_template: "
        ".incbin \"experiments/cluster/study.slurm\"\n.byte 0\n.popsection");

static void put_quoted(FILE *out, const char *value)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,+-";
    if (value[0] && !value[strspn(value, plain)]) {
        fputs(value, out);
        return;
    }
    fputc('\'', out);
    for (; *value; value++)
        fputs(*value == '\'' ? "'\\''" : (const char[]){*value, 0}, out);
    fputc('\'', out);
}

/* The length of the word between an @ sign and the next; 0: no word begins there. */
static size_t word_length(const char *at)
{
    const size_t length = strspn(at + 1, "abcdefghijklmnopqrstuvwxyz_");
    return at[1 + length] == '@' ? length : 0;
}

static const slurm_word *find_word(const slurm_word *words, size_t count, const char *name, size_t length)
{
    for (size_t i = 0; i < count; i++)
        if (strlen(words[i].name) == length && memcmp(words[i].name, name, length) == 0)
            return &words[i];
    return NULL;
}

static status unknown_word(const slurm_word *words, size_t count, const char *name, size_t length, diagnostic *why)
{
    char known[300] = "use one of ";
    for (size_t i = 0, used = strlen(known); i < count && used < sizeof known; i++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", words[i].name);
    return diagnose(why, STATUS_BAD_INPUT, known, "unknown word @%.*s@", (int)length, name);
}

/* Writes a line, without its newline; *left_out: it has a word without a value, and is not written. */
static status put_line(FILE *out, const char *line, size_t size, const slurm_word *words, size_t count, bool *left_out,
                       diagnostic *why)
{
    for (const char *at = line; !*left_out && (at = memchr(at, '@', size - (size_t)(at - line)));) {
        const size_t length = word_length(at);
        const slurm_word *word = find_word(words, count, at + 1, length);
        if (length && !word) {
            diagnostic_locate(why, NULL, 0, at - line + 1);
            return unknown_word(words, count, at + 1, length, why);
        }
        *left_out = word && !word->value;
        at += length ? length + 2 : 1;
    }
    for (size_t i = 0; !*left_out && i < size;) {
        const size_t length = line[i] == '@' ? word_length(line + i) : 0;
        if (length)
            put_quoted(out, find_word(words, count, line + i + 1, length)->value);
        else
            fputc(line[i], out);
        i += length ? length + 2 : 1;
    }
    return STATUS_OK;
}

status slurm_fill(const char *file, const char *text, const slurm_word *words, size_t count, char **out,
                  diagnostic *why)
{
    text_writer writer;
    long line = 1;
    *out = NULL;
    TRY(text_writer_open(&writer, why));
    status code = STATUS_OK;
    for (; *text && code == STATUS_OK; line++) {
        const size_t size = strcspn(text, "\n");
        bool left_out = false;
        diagnostic error = {.what = ""};
        code = put_line(writer.stream, text, size, words, count, &left_out, &error);
        if (code != STATUS_OK && why) {
            *why = error;
            diagnostic_locate(why, file, line, error.column);
        }
        text += size;
        if (*text == '\n') {
            if (!left_out)
                fputc('\n', writer.stream);
            text++;
        }
    }
    return text_writer_end(&writer, code, out, NULL, why);
}
