#include "base/system_error.h"
#include "base/json_build.h"
#include "study/upgrade.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/text.h"
#include "scene/model/open.h"
#include "study/check.h"
#include "study/identity.h"
#include "study/keep.h"
#include "study/manifest.h"
#include "study/row_environments.h"
#include "study/rows.h"
#include <dirent.h>
#include <inttypes.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { COPY_BYTES_MAX = 1 << 30 };

/* The run that stands for the rows of one environment. */
typedef struct old_run {
    const row_environment_count *of;
    char id[RUN_ID];
    run_seal seal[3];
    size_t seal_count;
} old_run;

typedef struct upgrade {
    const study *s;
    char *from, *to;
    row_environment_count *environments;
    old_run *runs;
    size_t count;
} upgrade;

/* What is known of such rows: instruction set and configuration. */
static run_environment facts_of(const row_files *files, const char *key)
{
    run_environment e = {.key = ""};
    for (int i = 0; i < ENVIRONMENT_FACTS; i++)
        snprintf(e.fact[i], ENVIRONMENT_FACT_MAX, "unknown");
    for (size_t i = 0; i < files->row_count; i++)
        if (strcmp(files->rows[i].environment, key) == 0) {
            snprintf(e.fact[ENVIRONMENT_FACTS - 2], ENVIRONMENT_FACT_MAX, "%.60s", row_field(&files->rows[i], "isa"));
            snprintf(e.fact[ENVIRONMENT_FACTS - 1], ENVIRONMENT_FACT_MAX, "unknown (%.60s)",
                     row_field(&files->rows[i], "config"));
            break;
        }
    environment_close(&e);
    return e;
}

static status name_runs(upgrade *u, const row_files *files, diagnostic *why)
{
    TRY(row_environments_find(files, &u->environments, &u->count, why));
    u->runs = calloc(u->count + 1, sizeof *u->runs);
    if (!u->runs)
        return out_of_memory(why);
    for (size_t i = 0; i < u->count; i++) {
        const char *key = u->environments[i].key;
        uint64_t hash = hash_bytes(HASH_START, u->s->name, strlen(u->s->name) + 1);
        u->runs[i].of = &u->environments[i];
        hash = hash_finish(hash_bytes(hash, key, strlen(key) + 1));
        snprintf(u->runs[i].id, RUN_ID, "%016" PRIx64, hash);
    }
    return STATUS_OK;
}

/* The run of a row: a worker row or a comparison has the environment of no column, so its first run is taken. */
static old_run *run_of(const upgrade *u, const row_ref *ref)
{
    for (size_t i = 0; i < u->count; i++)
        if (strcmp(u->runs[i].of->key, ref->environment) == 0)
            return &u->runs[i];
    return &u->runs[0];
}

/* --- rows --- */

/* The row's values under the present header. */
static void put_row(csv_line *line, const upgrade *u, const row_ref *ref, row_kind kind, char *const *names,
                    size_t count, const char *run)
{
    const uint64_t identity = u->s->identity[ref->cell];
    for (size_t i = 0; i < count; i++)
        if (strcmp(names[i], "identity") == 0)
            csv_hash(line, kind == COMPARE_ROWS ? identity_compared(u->s, identity) : identity);
        else if (strcmp(names[i], "schema") == 0)
            csv_count(line, ROW_SCHEMA);
        else if (strcmp(names[i], "run") == 0)
            csv_text(line, run);
        else if (strcmp(names[i], "process") == 0)
            csv_count(line, 0);
        else
            csv_text(line, row_field(ref, names[i]));
    csv_end(line);
}

/* Writes the rows of one run. */
static status write_run(upgrade *u, const row_files *files, row_kind kind, old_run *run, char *const *names,
                        const check_columns *columns, FILE *out, diagnostic *why)
{
    run_seal *seal = &run->seal[run->seal_count++];
    *seal = (run_seal){.table = row_file_stem(kind)};
    memcpy(seal->check, run->id, sizeof seal->check);
    for (size_t i = 0; i < files->row_count; i++) {
        csv_line line = {0};
        if (run_of(u, &files->rows[i]) != run)
            continue;
        put_row(&line, u, &files->rows[i], kind, names, columns->count, run->id);
        const status code = check_lines(columns, seal->check, &line, why);
        if (code == STATUS_OK)
            fputs(line.text, out);
        csv_line_free(&line);
        TRY(code);
        seal->rows++;
    }
    return STATUS_OK;
}

static status write_rows(upgrade *u, const row_files *files, row_kind kind, FILE *out, diagnostic *why)
{
    check_columns columns = {0};
    char *header = row_file_header(u->s, kind), *names_text = header ? strdup(header) : NULL;
    char **names = names_text ? malloc((strlen(header) + 1) * sizeof *names) : NULL;
    status code = names ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        fputs(header, out);
        names_text[strcspn(names_text, "\n")] = 0;
        const size_t count = csv_split(names_text, names);
        code = check_columns_create(names, count, &columns, why);
    }
    for (size_t i = 0; code == STATUS_OK && i < u->count; i++)
        code = write_run(u, files, kind, &u->runs[i], names, &columns, out, why);
    check_columns_free(&columns);
    free(names);
    free(names_text);
    free(header);
    return code;
}

static status upgrade_table(upgrade *u, const row_files *files, row_kind kind, diagnostic *why)
{
    char *path = row_file_path(u->to, kind, 0, 1);
    file_writer writer;
    status code = path ? file_writer_open(&writer, path, why) : out_of_memory(why);
    THEN(code, file_writer_end(&writer, write_rows(u, files, kind, writer.stream, why), why));
    free(path);
    return code;
}

/* --- runs --- */

static json_t *run_json(const old_run *run, const run_environment *e, const json_t *manifest)
{
    json_t *environment = json_pack("{s:s}", "key", e->key), *rows = json_object();
    for (int i = 0; i < ENVIRONMENT_FACTS; i++)
        json_add_as(&environment, environment_names[i], json_string(e->fact[i]));
    for (size_t i = 0; i < run->seal_count; i++)
        json_add_as(&rows, run->seal[i].table,
                    json_pack("{s:I, s:s}", "count", (json_int_t)run->seal[i].rows, "check", run->seal[i].check));
    return json_pack("{s:s, s:o, s:O?, s:o}", "id", run->id, "environment", environment, "recorded",
                     json_object_get(manifest, "runs"), "rows", rows);
}

static status write_runs(const upgrade *u, const row_files *files, diagnostic *why)
{
    char *path = text_format("%s/runs.json", u->to), *old = text_format("%s/manifest.json", u->from);
    json_t *manifest = NULL, *entries = json_array(), *facts = NULL;
    status code = path && old && entries ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && access(old, F_OK) == 0)
        code = facts_read(old, scene_root(u->s->base), &manifest, why);
    for (size_t i = 0; code == STATUS_OK && i < u->count; i++) {
        const run_environment e = facts_of(files, u->runs[i].of->key);
        json_add(&entries, run_json(&u->runs[i], &e, manifest));
    }
    if (code == STATUS_OK)
        facts = json_pack("{s:i, s:o, s:O?, s:O}", "schema", 2, "study", run_study_facts(u->s), "machine",
                          json_object_get(manifest, "machine"), "runs", entries);
    if (code == STATUS_OK)
        code = facts ? facts_write(facts, JSON_REAL_PRECISION(6), path, why) : out_of_memory(why);
    json_decref(facts);
    json_decref(entries);
    json_decref(manifest);
    free(old);
    free(path);
    return code;
}

/* --- kept files --- */

static status copy_file(const char *from, const char *to, const char *root, diagnostic *why)
{
    char *bytes;
    size_t size;
    file_writer writer;
    TRY(file_read_below(from, root, COPY_BYTES_MAX, &bytes, &size, why));
    status code = file_writer_open(&writer, to, why);
    if (code == STATUS_OK) {
        fwrite(bytes, 1, size, writer.stream);
        code = file_writer_commit(&writer, why);
    }
    free(bytes);
    return code;
}

static status copy_folder(const upgrade *u, const char *name, diagnostic *why)
{
    char *from = text_format("%s/%s", u->from, name), *to = text_format("%s/%s", u->to, name);
    struct dirent **entries = NULL;
    const int count = from ? scandir(from, &entries, NULL, alphasort) : -1;
    status code = from && to ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK && count < 0 && errno != ENOENT)
        code = system_error(why, STATUS_FAILURE, from, "cannot be read", errno, "give a folder that can be read");
    if (code == STATUS_OK && count > 0)
        code = file_make_directory(to, why);
    for (int i = 0; i < count; i++) {
        char *source = text_format("%s/%s", from, entries[i]->d_name),
             *target = text_format("%s/%s", to, entries[i]->d_name);
        if (code == STATUS_OK && (!source || !target))
            code = out_of_memory(why);
        if (code == STATUS_OK && entries[i]->d_type == DT_REG)
            code = copy_file(source, target, scene_root(u->s->base), why);
        free(source);
        free(target);
        free(entries[i]);
    }
    free(entries);
    free(from);
    free(to);
    return code;
}

/* The old numbering is known from the manifest of the old folder, which is copied for that. */
static status copy_kept(const upgrade *u, diagnostic *why)
{
    bool changed;
    char *from = text_format("%s/manifest.json", u->from), *to = text_format("%s/manifest.json", u->to);
    status code = from && to ? STATUS_OK : out_of_memory(why);
    THEN(code, copy_folder(u, "references", why));
    THEN(code, copy_folder(u, "images", why));
    const bool has = code == STATUS_OK && access(from, F_OK) == 0;
    if (has)
        code = copy_file(from, to, scene_root(u->s->base), why);
    THEN(code, keep_renumber(u->s, u->to, false, &changed, why));
    if (has)
        unlink(to);
    free(from);
    free(to);
    return code;
}

/* --- all --- */

static status check_need(const upgrade *u, const row_files *files, const char *results, diagnostic *why)
{
    size_t old = 0;
    char *rows = row_file_path(u->to, ROWS, 0, 1);
    if (!rows)
        return out_of_memory(why);
    for (size_t i = 0; i < files->row_count; i++)
        old += files->rows[i].run < 0;
    status code = row_files_judge(files, why);
    if (code == STATUS_OK && old == 0)
        code = diagnose_at(why, u->s->path, STATUS_BAD_INPUT, "give the folder of older rows with --results",
                           "%s/%s has no rows of an older version", results, u->s->name);
    else if (code == STATUS_OK && old < files->row_count)
        code = diagnose_at(why, u->s->path, STATUS_BAD_INPUT, "older rows stay readable: nothing needs to be done",
                           "%s/%s has rows of this version already", results, u->s->name);
    else if (code == STATUS_OK && access(rows, F_OK) == 0)
        code = diagnose_at(why, rows, STATUS_BAD_INPUT, "choose another folder with --to", "there are rows already");
    free(rows);
    return code;
}

static status upgrade_kind(upgrade *u, const char *results, row_kind kind, diagnostic *why)
{
    row_files *files;
    TRY(row_files_read(u->s, results, kind, &files, why));
    const status code = files->row_count ? upgrade_table(u, files, kind, why) : STATUS_OK;
    row_files_destroy(files);
    return code;
}

static status upgrade_all(upgrade *u, const char *results, const row_files *files, diagnostic *why)
{
    TRY(file_make_directory(u->to, why));
    TRY(name_runs(u, files, why));
    for (row_kind kind = ROWS; kind <= COMPARE_ROWS; kind++)
        TRY(upgrade_kind(u, results, kind, why));
    TRY(write_runs(u, files, why));
    return copy_kept(u, why);
}

status study_upgrade(const study *s, const char *results, const char *to, size_t *rows, diagnostic *why)
{
    row_files *files;
    *rows = 0;
    TRY(row_files_read(s, results, ROWS, &files, why));
    upgrade u = {.s = s, .from = study_folder(s, results), .to = study_folder(s, to)};
    status code = u.from && u.to ? check_need(&u, files, results, why) : out_of_memory(why);
    THEN(code, upgrade_all(&u, results, files, why));
    *rows = code == STATUS_OK ? files->row_count : 0;
    free(u.environments);
    free(u.runs);
    free(u.from);
    free(u.to);
    row_files_destroy(files);
    return code;
}
