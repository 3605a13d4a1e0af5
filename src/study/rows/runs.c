/* Reads the lists of runs, and changes them under a lock. */
#include "study/rows/runs.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/json_build.h"
#include "base/status.h"
#include "base/text.h"
#include "scene/model/open.h"
#include "study/rows/facts.h"
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

static char *list_path(const char *folder, long shard, long shards)
{
    return shards > 1 ? text_format("%s/runs.shard-%ld-of-%ld.json", folder, shard, shards)
                      : text_format("%s/runs.json", folder);
}

static status damaged(const char *path, diagnostic *why)
{
    return diagnose_at(why, path, STATUS_BAD_INPUT,
                       "restore it from a copy; without it the rows have no known environment",
                       "the list of runs is damaged");
}

static bool is_run(const json_t *run)
{
    return json_is_string(json_object_get(run, "id")) && json_is_object(json_object_get(run, "environment"));
}

static bool is_list(const json_t *list)
{
    const json_t *entries = json_object_get(list, "runs"), *run;
    size_t i;
    if (!json_is_array(entries))
        return false;
    json_array_foreach(entries, i, run) if (!is_run(run)) return false;
    return true;
}

static status read_list(const char *path, const char *root, json_t **out, diagnostic *why)
{
    TRY(facts_read(path, root, out, why));
    if (is_list(*out))
        return STATUS_OK;
    json_decref(*out);
    *out = NULL;
    return damaged(path, why);
}

static void read_entry(const json_t *run, run_entry *out)
{
    const json_t *facts = json_object_get(run, "environment");
    *out = (run_entry){.id = json_string_value(json_object_get(run, "id")), .facts = run};
    for (int i = 0; i < ENVIRONMENT_FACTS; i++) {
        const char *text = json_string_value(json_object_get(facts, environment_names[i]));
        snprintf(out->environment.fact[i], ENVIRONMENT_FACT_MAX, "%s", text ? text : "unknown");
    }
    environment_close(&out->environment);
    const char *key = json_string_value(json_object_get(facts, "key"));
    out->key_is_right = key && strcmp(key, out->environment.key) == 0;
}

static status add_entries(run_list *all, const json_t *list, diagnostic *why)
{
    const json_t *entries = json_object_get(list, "runs"), *run;
    const size_t more = json_array_size(entries);
    run_entry *grown = realloc(all->entry, (all->count + more + 1) * sizeof *grown);
    size_t i;
    if (!grown)
        return out_of_memory(why);
    all->entry = grown;
    json_array_foreach(entries, i, run)
    {
        read_entry(run, &all->entry[all->count]);
        all->count += runs_find(all, all->entry[all->count].id) < 0; /* a merged list repeats the runs of the shards */
    }
    return STATUS_OK;
}

static int is_list_name(const struct dirent *entry)
{
    const size_t length = strlen(entry->d_name);
    return strcmp(entry->d_name, "runs.json") == 0 ||
           (strncmp(entry->d_name, "runs.shard-", 11) == 0 && strcmp(entry->d_name + length - 5, ".json") == 0);
}

status runs_read(const char *folder, const char *root, run_list **out, diagnostic *why)
{
    struct dirent **names = NULL;
    const int found = scandir(folder, &names, is_list_name, alphasort); /* runs.json is the first */
    *out = NULL;
    if (found < 0 && errno != ENOENT)
        return system_error(why, STATUS_FAILURE, folder, "cannot be read", errno, "make the folder readable");
    run_list *all = calloc(1, sizeof *all);
    if (all)
        all->files = calloc(found > 0 ? (size_t)found : 1, sizeof(json_t *));
    status code = all && all->files ? STATUS_OK : out_of_memory(why);
    for (int i = 0; i < found; i++) {
        char *path = code == STATUS_OK ? text_format("%s/%s", folder, names[i]->d_name) : NULL;
        if (code == STATUS_OK)
            code = path ? read_list(path, root, &all->files[all->file_count], why) : out_of_memory(why);
        if (code == STATUS_OK)
            code = add_entries(all, all->files[all->file_count++], why);
        free(path);
        free(names[i]);
    }
    free(names);
    if (code != STATUS_OK) {
        runs_destroy(all);
        all = NULL;
    }
    *out = all;
    return code;
}

void runs_destroy(run_list *all)
{
    if (!all)
        return;
    for (size_t i = 0; i < all->file_count; i++)
        json_decref(all->files[i]);
    free(all->files);
    free(all->entry);
    free(all);
}

long runs_find(const run_list *all, const char *id)
{
    for (size_t i = all ? all->count : 0; i > 0; i--)
        if (strcmp(all->entry[i - 1].id, id) == 0)
            return (long)i - 1;
    return -1;
}

bool runs_seal(const run_entry *run, const char *table, run_seal *out)
{
    const json_t *seal = json_object_get(json_object_get(run->facts, "rows"), table);
    const char *checksum = json_string_value(json_object_get(seal, "checksum"));
    if (!checksum)
        return false;
    *out = (run_seal){.table = table, .rows = (size_t)json_integer_value(json_object_get(seal, "count"))};
    snprintf(out->checksum, sizeof out->checksum, "%s", checksum);
    return true;
}

/* --- writing --- */

/* Changes the list at path under a lock of its folder, because shards and merges may change it at the same time. */
typedef status change_list(json_t *list, void *context, diagnostic *why);
static status change(const char *folder, const char *root, char *path, const json_t *fresh, change_list *apply,
                     void *context, diagnostic *why)
{
    json_t *list = NULL;
    if (!path)
        return out_of_memory(why);
    const int lock = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock >= 0)
        flock(lock, LOCK_EX);
    status code = STATUS_OK;
    if (access(path, F_OK) == 0)
        code = read_list(path, root, &list, why);
    else
        list = fresh ? json_deep_copy(fresh) : json_pack("{s:i, s:[]}", "schema", 2, "runs");
    if (code == STATUS_OK && !list)
        code = out_of_memory(why);
    THEN(code, apply(list, context, why));
    THEN(code, facts_write(list, JSON_REAL_PRECISION(6), path, why));
    if (lock >= 0)
        close(lock);
    json_decref(list);
    free(path);
    return code;
}

void runs_make_id(const run_environment *environment, char id[RUN_ID])
{
    uint64_t random = 0;
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    if (getrandom(&random, sizeof random, GRND_NONBLOCK) != (ssize_t)sizeof random)
        random = 0; /* time and process id distinguish the runs of one machine */
    const int64_t words[] = {(int64_t)random, now.tv_sec, now.tv_nsec, getpid()};
    const uint64_t hash = hash_bytes(hash_words(HASH_START, words, 4), environment->fact, sizeof environment->fact);
    snprintf(id, RUN_ID, "%016" PRIx64, hash_finish(hash));
}

static status add_run(json_t *list, void *context, diagnostic *why)
{
    return json_array_append(json_object_get(list, "runs"), context) == 0 ? STATUS_OK : out_of_memory(why);
}

status runs_begin(const study *s, const char *folder, const topology *machine, const run_environment *environment,
                  long shard, long shards, const char *id, diagnostic *why)
{
    json_t *run = run_facts(s, machine, environment, id, shard, shards);
    json_t *fresh = json_pack("{s:i, s:o, s:o, s:[]}", "schema", 2, "study", run_study_facts(s), "machine",
                              run_machine_facts(machine), "runs");
    status code = run && fresh
                      ? change(folder, scene_root(s->base), list_path(folder, shard, shards), fresh, add_run, run, why)
                      : out_of_memory(why);
    json_decref(run);
    json_decref(fresh);
    return code;
}

typedef struct ending {
    const char *id;
    const run_seal *seals;
    size_t count;
} ending;

static status end_run(json_t *list, void *context, diagnostic *why)
{
    const ending *e = context;
    json_t *run;
    size_t i;
    json_array_foreach(json_object_get(list, "runs"), i, run)
    {
        if (strcmp(json_string_value(json_object_get(run, "id")), e->id) != 0)
            continue;
        json_t *rows = json_object();
        for (size_t k = 0; k < e->count; k++)
            json_add_as(
                &rows, e->seals[k].table,
                json_pack("{s:I, s:s}", "count", (json_int_t)e->seals[k].rows, "checksum", e->seals[k].checksum));
        return json_object_set_new(run, "rows", rows) == 0 && json_object_set_new(run, "ended_utc", run_time()) == 0
                   ? STATUS_OK
                   : out_of_memory(why);
    }
    return STATUS_OK;
}

status runs_end(const char *folder, const char *root, long shard, long shards, const char *id, const run_seal *seals,
                size_t seal_count, diagnostic *why)
{
    return change(folder, root, list_path(folder, shard, shards), NULL, end_run, &(ending){id, seals, seal_count}, why);
}

static status add_missing(json_t *list, void *context, diagnostic *why)
{
    const run_list *all = context;
    json_t *entries = json_object_get(list, "runs"), *run;
    size_t k;
    for (size_t i = 0; i < all->count; i++) {
        bool has = false;
        json_array_foreach(entries, k, run) has |=
            strcmp(json_string_value(json_object_get(run, "id")), all->entry[i].id) == 0;
        if (!has && json_array_append(entries, (json_t *)(uintptr_t)all->entry[i].facts) != 0)
            return out_of_memory(why);
    }
    return STATUS_OK;
}

status runs_merge(const char *folder, const char *root, diagnostic *why)
{
    run_list *all;
    TRY(runs_read(folder, root, &all, why));
    status code = STATUS_OK;
    if (all->count > 0) {
        json_t *fresh = json_copy(all->files[0]);
        if (fresh)
            json_add_as(&fresh, "runs", json_array());
        code = fresh ? change(folder, root, list_path(folder, 0, 1), fresh, add_missing, all, why) : out_of_memory(why);
        json_decref(fresh);
    }
    runs_destroy(all);
    return code;
}

/* --- the quick form --- */

/* The numbers of quick and of other runs in a folder of a study. */
static status count_runs(const study *s, const char *folder, size_t *quick, size_t *others, diagnostic *why)
{
    run_list *all;
    *quick = *others = 0;
    TRY(runs_read(folder, scene_root(s->base), &all, why));
    for (size_t i = 0; i < all->count; i++)
        json_is_true(json_object_get(all->entry[i].facts, "quick")) ? ++*quick : ++*others;
    runs_destroy(all);
    return STATUS_OK;
}

status study_follow_runs(study *s, const char *results, diagnostic *why)
{
    size_t quick, others;
    char *folder = study_folder(s, results);
    status code = folder ? count_runs(s, folder, &quick, &others, why) : out_of_memory(why);
    free(folder);
    return code == STATUS_OK && quick > 0 && !s->quick ? study_make_quick(s, why) : code;
}

status quick_check_runs(const study *s, const char *folder, diagnostic *why)
{
    size_t quick, others;
    TRY(count_runs(s, folder, &quick, &others, why));
    if (s->quick && others > 0)
        return diagnose_at(why, folder, STATUS_BAD_INPUT, "choose another folder with --results",
                           "the folder has rows of full frames, to which quick rows must not be added");
    if (!s->quick && quick > 0)
        return diagnose_at(why, folder, STATUS_BAD_INPUT, "choose another folder with --results, or add --quick",
                           "the folder has rows of a quick run");
    return STATUS_OK;
}
