/* Fault injection: runs each command of a table again and again, one fault a run, and judges how it ends (judge.h).
 *   faults [OPTION...] --library FILE --work FOLDER --template FOLDER TABLE WORD=PATH...
 * A line of the table: NAME, traits ("-", "resumes", "forked", "slow": fewer sites with --every), the command's words;
 * the first of them is one of the WORDs. Options: --every N, only each N-th site; --depth N, call stacks are the same
 * if N frames are; --only NAMES and --kinds NAMES, separated by commas; --at N, only the Nth call, as an error names
 * it; --from N and --to N, only calls from the Nth on, up to it: parts of a long run; --known NAMES, commands that an
 * earlier run tried, whose call stacks are not tried again; --stays, what fails fails from then on; --shown N, of each
 * kind of error. Prints the Test Anything Protocol, a case for each command and kind of fault, and a table of verdicts
 * as comments "##". */
#include "judge.h"
#include "trace.h"

#include <err.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct kind {
    const char *name;
    fault_class class;
    call_group group;
    int error;
} kind;

static const kind kinds[] = {
    {"memory", FAULT_MEMORY, 0, ENOMEM},
    {"thread", FAULT_THREAD, 0, EAGAIN},
    {"mmap", FAULT_CALL, CALL_MMAP, ENOMEM},
    {"open-emfile", FAULT_CALL, CALL_OPEN, EMFILE},
    {"open-eio", FAULT_CALL, CALL_OPEN, EIO},
    {"read-eio", FAULT_CALL, CALL_READ, EIO},
    {"read-eintr", FAULT_CALL, CALL_READ, EINTR},
    {"read-short", FAULT_CALL, CALL_READ, FAULT_SHORT},
    {"write-enospc", FAULT_CALL, CALL_WRITE, ENOSPC},
    {"write-eio", FAULT_CALL, CALL_WRITE, EIO},
    {"write-eintr", FAULT_CALL, CALL_WRITE, EINTR},
    {"write-short", FAULT_CALL, CALL_WRITE, FAULT_SHORT},
    {"fsync-eio", FAULT_CALL, CALL_SYNC, EIO},
    {"rename-eio", FAULT_CALL, CALL_RENAME, EIO},
    {"close-eio", FAULT_CALL, CALL_CLOSE, EIO},
};

enum { KINDS = sizeof kinds / sizeof kinds[0], WORDS_MAX = 48, KNOWN_MAX = 1 << 16 };

static struct {
    long stride, every, shown, at, from, to; /* every: stride, or more for slow commands */
    int depth;
    const char *only, *kinds, *known, *library, *work, *template, *table;
    bool stays;
    char **programs; /* WORD=PATH */
} options = {.stride = 1, .shown = 5};

static int cases, failures;

typedef struct tally {
    long stacks, sites, tried, missed, of[VERDICTS]; /* stacks: with those that an earlier command had too */
} tally;

static const char *program_path(const char *word);
static bool has_word(const char *list, const char *word);

/* ---- where a call came from ---- */

/* The stack of a call that failed: a copy, since the page serves the next run. */
typedef struct trail {
    int count;
    uint64_t frames[FRAMES_MAX];
    char modules[FRAMES_MAX][MODULE_MAX];
} trail;

static void keep_trail(trail *t)
{
    t->count = run_page->frame_count;
    memcpy(t->frames, run_page->frames, sizeof t->frames);
    memcpy(t->modules, run_page->modules, sizeof t->modules);
}

/* The innermost functions of the program, by addr2line; of a library only its name. */
static void show_stack(const run *r, const trail *t)
{
    char command[1024];
    int used = 0, named = 0;
    const char *program = NULL;
    for (int i = 0; i < t->count && named < 8; i++) {
        const char *path = *t->modules[i]                      ? t->modules[i]
                           : strcmp(r->target, "cuvette") == 0 ? program_path("cuvette")
                                                               : r->words[0];
        if (strstr(path, "/lib") && !program)
            printf("#     %s+0x%lx\n", strrchr(path, '/') + 1, (unsigned long)t->frames[i]);
        if (strstr(path, "/lib") || (program && strcmp(path, program) != 0))
            continue;
        if (!program)
            used = snprintf(command, sizeof command, "addr2line -sCfpe '%s'", path);
        program = path;
        used += snprintf(command + used, sizeof command - (size_t)used, " 0x%lx", (unsigned long)t->frames[i] - 1);
        named++;
    }
    char line[256];
    FILE *tool = program ? popen(command, "r") : NULL;
    while (tool && fgets(line, sizeof line, tool))
        printf("#     %s", line);
    if (tool)
        pclose(tool);
}

/* ---- one kind ---- */

static void try(const reference *ref, const run *r, const fault *f, bool resumes, tally *t)
{
    static const char *const names[] = {"", "", "crash", "silent", "message", "leftover", "leak"};
    char why[512];
    const outcome o = run_with(r, f);
    if (!o.fired) {
        t->missed++;
        listing now = folder_list(r->folder);
        if (!listing_same(&now, &ref->before))
            folder_copy(options.template, r->folder);
        listing_free(&now);
        return;
    }
    static trail where;
    keep_trail(&where);
    const verdict v = judge(ref, r, f, &o, resumes, options.template, why);
    t->tried++;
    t->of[v]++;
    if (v <= REPORTED || t->of[v] > options.shown)
        return;
    printf("# %s, call %ld: %s\n", names[v], f->at, why);
    if (f->class != FAULT_CALL)
        show_stack(r, &where);
}

/* Call stacks that an earlier command had too, such as those of the options, are not tried again. */
static bool is_known(uint64_t hash)
{
    static uint64_t known[KNOWN_MAX];
    uint32_t i = (uint32_t)(hash % KNOWN_MAX);
    while (known[i] && known[i] != hash)
        i = (i + 1) % KNOWN_MAX;
    const bool before = known[i] == hash;
    known[i] = hash;
    return before;
}

static bool in_part(long at)
{
    return at >= options.from && (options.to == 0 || at <= options.to);
}

/* Each distinct call stack once. A thread may come earlier or later than in the run that noted them: such a site is
 * tried again by its hash, which is slower. */
static void try_stacks(const reference *ref, const run *r, const kind *k, fault_place place, bool resumes,
                       bool was_tried, tally *t)
{
    fault f = {.class = k->class, .place = place, .records = true, .error = k->error, .depth = options.depth};
    const outcome recorded = run_with(r, &f);
    (void)recorded;
    folder_copy(options.template, r->folder);
    int count = 0;
    fault_site *sites = malloc(((size_t)run_page->site_count + 1) * sizeof *sites);
    for (int i = 0; i < run_page->site_count; i++)
        if (!is_known(run_page->sites[i].hash))
            sites[count++] = run_page->sites[i];
    t->sites = count;
    t->stacks = run_page->site_count;
    f.records = false;
    if (was_tried) {
        free(sites);
        return;
    }
    f.stays = options.stays;
    if (options.at) {
        f.at = options.at;
        try(ref, r, &f, resumes, t);
    }
    for (long i = options.at ? count : options.every > 1 ? count % options.every : 0; i < count; i += options.every) {
        f.at = sites[i].at;
        if (!in_part(f.at))
            continue;
        f.hash = 0;
        const long missed = t->missed;
        try(ref, r, &f, resumes, t);
        if (t->missed == missed && run_page->fired_hash == sites[i].hash)
            continue;
        if (t->missed > missed) {
            t->missed = missed;
            f.hash = sites[i].hash;
            try(ref, r, &f, resumes, t);
        }
    }
    free(sites);
}

/* counted: the calls of each group in a run without a fault. */
static void try_calls(const reference *ref, const run *r, const kind *k, const outcome *counted, bool resumes, tally *t)
{
    fault f = {.class = FAULT_CALL, .group = k->group, .error = k->error};
    t->sites = counted->by_group[k->group];
    f.stays = options.stays;
    if (options.at) {
        f.at = options.at;
        try(ref, r, &f, resumes, t);
        return;
    }
    for (f.at = 1 + (options.every > 1 ? t->sites % options.every : 0); f.at <= t->sites; f.at += options.every)
        if (in_part(f.at))
            try(ref, r, &f, resumes, t);
}

static void try_kind(const char *name, const reference *ref, const run *r, const kind *k, fault_place place,
                     const outcome *counted, bool resumes)
{
    tally t = {.sites = 0};
    const bool was_tried = options.known && has_word(options.known, name);
    if (k->class != FAULT_CALL)
        try_stacks(ref, r, k, place, resumes, was_tried, &t);
    else if (!was_tried)
        try_calls(ref, r, k, counted, resumes, &t);
    if (was_tried)
        return;
    long bad = t.tried - t.of[UNHARMED] - t.of[REPORTED];
    if (k->class == FAULT_MEMORY && t.stacks == 0) { /* otherwise all checks would pass trivially */
        printf("# no allocation was counted\n");
        bad = 1;
    }
    failures += bad > 0;
    printf("%s %d - %s, %s: %ld of %ld sites failed, %ld reported, %ld unharmed, %ld errors\n", bad ? "not ok" : "ok",
           ++cases, name, k->name, t.tried, t.sites, t.of[REPORTED], t.of[UNHARMED], bad);
    printf("##\t%s\t%s\t%ld\t%ld\t%ld", name, k->name, t.sites, t.tried, t.missed);
    for (int v = 0; v < VERDICTS; v++)
        printf("\t%ld", t.of[v]);
    printf("\n");
    fflush(stdout);
}

/* ---- the table ---- */

static const char *program_path(const char *word)
{
    const size_t length = strlen(word);
    for (char **p = options.programs; *p; p++)
        if (strncmp(*p, word, length) == 0 && (*p)[length] == '=')
            return *p + length + 1;
    errx(3, "no path is given for the program '%s'", word);
}

static bool has_word(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list; (at = strstr(at, word)); at += length)
        if ((at == list || at[-1] == ',') && (at[length] == ',' || at[length] == '\0'))
            return true;
    return false;
}

static void try_command(const char *name, const char *traits, char **words)
{
    const bool resumes = has_word(traits, "resumes"), forked = has_word(traits, "forked");
    char folder[512], out[512], error[512], key[64];
    snprintf(folder, sizeof folder, "%s/folder", options.work);
    snprintf(out, sizeof out, "%s/out", options.work);
    snprintf(error, sizeof error, "%s/err", options.work);
    snprintf(key, sizeof key, "%s", words[0]);
    words[0] = (char *)program_path(key);
    const char *slash = strrchr(words[0], '/');
    const bool serves = strcmp(key, "lab") == 0; /* a client, whose server is the target */
    const run r = {.folder = folder,
                   .words = words,
                   .target = serves  ? "cuvette"
                             : slash ? slash + 1
                                     : words[0],
                   .out = out,
                   .err = error,
                   .library = options.library,
                   .limit_s = 180};
    reference ref;
    if (!reference_make(&ref, &r, options.template)) {
        printf("not ok %d - %s without a fault\n", ++cases, name);
        failures++;
        return;
    }
    folder_copy(options.template, folder);
    outcome counted = {.code = 0};
    if (trace_available() && !forked) {
        counted = run_with(&r, &(fault){.class = FAULT_CALL, .group = CALL_GROUPS});
        folder_copy(options.template, folder);
    }
    options.every = options.stride * (options.stride > 1 && has_word(traits, "slow") ? 4 : 1);
    for (int k = 0; k < KINDS; k++)
        if ((!options.kinds || has_word(options.kinds, kinds[k].name)) &&
            (kinds[k].class != FAULT_CALL || (trace_available() && !forked)))
            try_kind(name, &ref, &r, &kinds[k], forked ? FAULT_IN_FORKED : FAULT_IN_PROGRAM, &counted, resumes);
    reference_free(&ref);
}

static void try_table(void)
{
    FILE *table = fopen(options.table, "r");
    char line[4096];
    if (!table)
        err(3, "%s", options.table);
    while (fgets(line, sizeof line, table)) {
        char *words[WORDS_MAX] = {NULL};
        int count = 0;
        for (char *rest = line, *word; (word = strsep(&rest, " \t\n")) && count < WORDS_MAX - 1;)
            if (*word)
                words[count++] = word;
        if (count < 3 || *words[0] == '#' ||
            (options.only && !has_word(options.only, words[0]) &&
             !(options.known && has_word(options.known, words[0]))))
            continue;
        try_command(words[0], words[1], words + 2);
    }
    fclose(table);
}

int main(int argc, char **argv)
{
    int i = 1;
    for (; i + 1 < argc && strncmp(argv[i], "--", 2) == 0; i++) {
        const char *name = argv[i] + 2;
        if (strcmp(name, "stays") == 0) {
            options.stays = true;
            continue;
        }
        const char *value = argv[++i];
        if (strcmp(name, "every") == 0)
            options.stride = atol(value);
        else if (strcmp(name, "at") == 0)
            options.at = atol(value);
        else if (strcmp(name, "from") == 0)
            options.from = atol(value);
        else if (strcmp(name, "to") == 0)
            options.to = atol(value);
        else if (strcmp(name, "shown") == 0)
            options.shown = atol(value);
        else if (strcmp(name, "depth") == 0)
            options.depth = atoi(value);
        else if (strcmp(name, "only") == 0)
            options.only = value;
        else if (strcmp(name, "kinds") == 0)
            options.kinds = value;
        else if (strcmp(name, "known") == 0)
            options.known = value;
        else if (strcmp(name, "library") == 0)
            options.library = value;
        else if (strcmp(name, "work") == 0)
            options.work = value;
        else if (strcmp(name, "template") == 0)
            options.template = value;
        else
            errx(3, "unknown option --%s", name);
    }
    if (i >= argc || !options.library || !options.work || !options.template || options.stride < 1)
        errx(3, "faults: see the head of faults.c");
    options.table = argv[i];
    options.programs = argv + i + 1;
    char page[512];
    snprintf(page, sizeof page, "%s/page", options.work);
    run_prepare(page);
    try_table();
    return failures > 0 || cases == 0;
}
