/* The oracle of fault injection. */
#include "judge.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WHY_MAX = 400 };

/* ---- reference ---- */

static char *masked(const char *text)
{
    char *copy = strdup(text);
    mask_numbers(copy);
    return copy;
}

static bool clean_run(const run *r, const char *template)
{
    folder_copy(template, r->folder);
    const outcome o = run_with(r, &(fault){.class = FAULT_NONE});
    if (o.code == 0)
        return true;
    char *said = file_text(r->err, NULL);
    printf("# without a fault: exit %d: %s\n", o.code, said);
    free(said);
    return false;
}

bool reference_make(reference *ref, const run *r, const char *template)
{
    *ref = (reference){.out = NULL};
    ref->before = folder_list(template);
    if (!clean_run(r, template))
        return false;
    ref->out = file_text(r->out, NULL);
    ref->err = file_text(r->err, NULL);
    ref->after = folder_list(r->folder);
    ref->live = run_page->live_at_end;
    ref->descriptors = run_page->descriptors_at_end;
    if (!clean_run(r, template))
        return false;
    char *again = file_text(r->out, NULL);
    ref->out_varies = strcmp(again, ref->out) != 0;
    free(again);
    listing after = folder_list(r->folder);
    ref->file_varies = calloc(ref->after.count + 1, sizeof *ref->file_varies);
    for (size_t i = 0; i < ref->after.count; i++) {
        const entry *e = listing_find(&after, ref->after.entries[i].name);
        const entry *first = &ref->after.entries[i];
        ref->file_varies[i] = !e || e->masked != first->masked ? 2 : e->hash != first->hash ? 1 : 0;
    }
    listing_free(&after);
    return true;
}

void reference_free(reference *ref)
{
    free(ref->out);
    free(ref->err);
    free(ref->file_varies);
    listing_free(&ref->before);
    listing_free(&ref->after);
}

/* ---- files ---- */

/* The first difference between what is there and what should be; false: none. */
static bool files_differ(const reference *ref, const listing *now, char *why)
{
    for (size_t i = 0; i < ref->after.count; i++) {
        const entry *wanted = &ref->after.entries[i], *got = listing_find(now, wanted->name);
        const char *wrong = !got                                                        ? "is missing"
                            : ref->file_varies[i] == 1 && got->masked != wanted->masked ? "differs, numbers apart"
                            : ref->file_varies[i] == 0 && got->hash != wanted->hash     ? "differs"
                                                                                        : NULL;
        if (wrong)
            return snprintf(why, WHY_MAX, "%s %s", wanted->name, wrong) > 0;
    }
    for (size_t i = 0; i < now->count; i++)
        if (!listing_find(&ref->after, now->entries[i].name))
            return snprintf(why, WHY_MAX, "%s should not be there", now->entries[i].name) > 0;
    return false;
}

/* A fact of the machine that cannot be read is null in JSON, which is documented; only in output with such facts. */
static void mask_nulls(char *text)
{
    for (char *at; (at = strstr(text, "null"));) {
        *at = '#';
        memmove(at + 1, at + 4, strlen(at + 4) + 1);
    }
}

/* The same in rows, NA; and hexadecimal hashes of what varies, such as the environment's, whose digits are masked. */
static void mask_facts(char *text)
{
    char *to = text;
    for (const char *c = text; *c;) {
        const size_t word = strcspn(c, "\t\n, \""), hex = strspn(c, "0123456789abcdef#");
        const bool is_hash = word >= 5 && hex == word && memchr(c, '#', word);
        const bool is_masked = is_hash || (word == 2 && memcmp(c, "NA", 2) == 0);
        if (is_masked)
            *to++ = '#';
        else
            memmove(to, c, word), to += word;
        c += word;
        if (*c)
            *to++ = *c++;
    }
    *to = '\0';
}

/* The time of a frame, which two runs may share by chance and a third not: "in 0.002 s (0.5 million". */
static void mask_speed(char *text)
{
    for (char *at = text; (at = strstr(at, " rays in ")); at++) {
        const size_t length = strcspn(at, ")\n");
        for (size_t i = strlen(" rays in "); i < length; i++)
            at[i] = '#';
        const size_t rest = strlen(" rays in ") + 1; /* one sign, whatever its length was */
        memmove(at + rest, at + length, strlen(at + length) + 1);
    }
}

/* The same of rows of a measured time: toy,rate.step_s,1.04e-06,NA. */
static void mask_wall_times(char *text)
{
    static const char *const begins[] = {"rate.step_s,", "rate.simulated_s_per_s,"};
    for (int i = 0; i < 2; i++)
        for (char *at = text; (at = strstr(at, begins[i]));) {
            at += strlen(begins[i]);
            const size_t length = strcspn(at, ",\n");
            memmove(at, at + length, strlen(at + length) + 1);
        }
}

/* What other programs do at the moment, which differs from run to run: "load #", "others use #% of the machine". */
static void mask_load(char *text)
{
    static const char *const begins[] = {"\"load ", "\"others use "};
    for (int i = 0; i < 2; i++)
        for (char *at; (at = strstr(text, begins[i]));) {
            const char *end = strchr(at + 1, '"');
            const bool last = end && end[1] != ',', first = at[-1] == '[';
            if (!end)
                break;
            end += last ? 1 : 3; /* with the comma behind it, or without the one before */
            at -= last && !first ? 2 : 0;
            memmove(at, end, strlen(end) + 1);
        }
}

/* The estimate of a study's time, which trial frames give: "small: less than 0.1 s, from trial frames". */
static void mask_estimate(char *text)
{
    for (char *at = text, *end; (end = strstr(at, " s, from trial frames")); at = strchr(at, ',')) {
        while (end > at && memchr(at, '\n', (size_t)(end - at)))
            at = (char *)memchr(at, '\n', (size_t)(end - at)) + 1;
        char *from = memchr(at, ':', (size_t)(end - at));
        if (!from)
            return;
        memmove(from + 1, end, strlen(end) + 1);
    }
}

static int shown_length(const char *line)
{
    const size_t length = strcspn(line, "\n");
    return length < 150 ? (int)length : 150;
}

static bool output_differs(const reference *ref, const char *out, char *why)
{
    char *a = ref->out_varies ? masked(ref->out) : strdup(ref->out), *b = ref->out_varies ? masked(out) : strdup(out);
    if (ref->out_varies) {
        mask_nulls(a);
        mask_nulls(b);
        mask_facts(a);
        mask_facts(b);
        mask_load(a);
        mask_load(b);
    }
    mask_speed(a);
    mask_speed(b);
    mask_wall_times(a);
    mask_wall_times(b);
    mask_estimate(a);
    mask_estimate(b);
    size_t at = 0, line = 0;
    for (; a[at] && a[at] == b[at]; at++)
        line = a[at] == '\n' ? at + 1 : line;
    const bool differs = a[at] != b[at];
    snprintf(why, WHY_MAX, "exit 0 with another output: '%.*s' instead of '%.*s'", shown_length(b + line), b + line,
             shown_length(a + line), a + line);
    free(a);
    free(b);
    return differs;
}

/* ---- messages ---- */

/* GnuTLS, which libmicrohttpd loads, prints on its own when its start fails; the server works without it. */
static bool is_foreign(const char *line)
{
    return strncmp(line, "Error in GnuTLS initialization", 30) == 0;
}

/* Lines of standard error that a run without a fault does not print, and that are not notes; *last is one of them. */
static int new_lines(const reference *ref, const char *err, char *last)
{
    int count = 0;
    char *copy = strdup(err), *usual = masked(ref->err);
    for (char *rest = copy, *line; (line = strsep(&rest, "\n"));) {
        char *plain = masked(line);
        if (*line && !strstr(usual, plain) && strncmp(line, "cuvette: note:", 14) != 0 && !is_foreign(line)) {
            count++;
            snprintf(last, WHY_MAX / 2, "%s", line);
        }
        free(plain);
    }
    free(copy);
    free(usual);
    return count;
}

static bool names_cause(const fault *f, const char *line)
{
    if (f->class == FAULT_MEMORY)
        return strstr(line, "memory") || strstr(line, "thread"); /* a thread needs memory */
    if (f->class == FAULT_THREAD)
        return strstr(line, "thread");
    switch (f->error) {
    case ENOMEM: return strstr(line, "memory") || strstr(line, "thread") || strstr(line, "Cannot allocate");
    case EMFILE: return strstr(line, "open files");
    case ENOSPC: return strstr(line, "No space") || strstr(line, "a write failed"); /* stdio forgets the reason */
    case EINTR: return strstr(line, "Interrupted") || strstr(line, "a write failed");
    case EIO: return strstr(line, "Input/output") || strstr(line, "cannot be read") || strstr(line, "a write failed");
    default: return false;
    }
}

/* Whether standard error is one line that blames the right party; why: what is wrong with it. */
static bool good_message(const reference *ref, const fault *f, const char *err, char *why)
{
    char line[WHY_MAX / 2] = "";
    const int count = new_lines(ref, err, line);
    const char *wrong = count == 0                           ? "no message"
                        : count > 1                          ? "several messages"
                        : strncmp(line, "cuvette: ", 9) != 0 ? "a foreign message"
                        : !names_cause(f, line)              ? "another cause"
                        : !strstr(line, "; ")                ? "no remedy"
                                                             : NULL;
    if (wrong)
        snprintf(why, WHY_MAX, "%s: %s", wrong, line);
    return !wrong;
}

/* Whether the output itself has the error: a list with an entry that could not be made, a disturbance that could not be
 * looked for, or assumed processors. The cause must be in the text that begins so, not anywhere. */
static bool output_reports(const fault *f, const char *out)
{
    static const char *const begins[] = {"\"error\":", "\"unknown: "};
    for (int i = 0; i < 2; i++)
        for (const char *at = out; (at = strstr(at, begins[i])); at++) {
            char value[WHY_MAX / 2];
            snprintf(value, sizeof value, "%.*s", 120, at);
            const bool memory = strstr(value, "out of memory") || strstr(value, strerror(ENOMEM));
            if (f->class == FAULT_MEMORY ? memory : names_cause(f, value))
                return true;
        }
    return strstr(out, "hwloc failed");
}

/* ---- the verdict ---- */

static verdict judge_success(const reference *ref, const run *r, const fault *f, const outcome *o, const listing *now,
                             char *why)
{
    char line[WHY_MAX / 2];
    char *out = file_text(r->out, NULL), *err = file_text(r->err, NULL);
    verdict v = UNHARMED;
    if (files_differ(ref, now, why)) {
        v = SILENT;
    } else if (o->must_report) {
        snprintf(why, WHY_MAX, "exit 0, although data may not be on the disk");
        v = SILENT;
    } else if (f->place == FAULT_IN_PROGRAM && output_differs(ref, out, why) && !output_reports(f, out)) {
        v = SILENT; /* a child that fails is replaced by an assumption, which the output says */
    } else if (new_lines(ref, err, line) > 0) {
        snprintf(why, WHY_MAX, "exit 0 with a message: %s", line);
        v = MESSAGE;
    }
    free(out);
    free(err);
    return v;
}

/* A command that goes on where it stopped: the second run completes it. */
static bool goes_on(const reference *ref, const run *r, char *why)
{
    const outcome again = run_with(r, &(fault){.class = FAULT_NONE});
    if (again.code != 0) {
        char *said = file_text(r->err, NULL);
        snprintf(why, WHY_MAX, "the next run ends with %d: %.200s", again.code, said);
        free(said);
        return false;
    }
    listing now = folder_list(r->folder);
    const bool good = !files_differ(ref, &now, why);
    listing_free(&now);
    return good;
}

/* Files that a failed command has changed or left; whole ones are no fault: the image, when then its account cannot be
 * printed. */
static bool leaves_files(const reference *ref, const listing *now, char *why)
{
    for (size_t i = 0; i < now->count; i++) {
        const entry *is = &now->entries[i], *was = listing_find(&ref->before, is->name),
                    *whole = listing_find(&ref->after, is->name);
        if ((was && was->hash == is->hash) ||
            (whole && (whole->hash == is->hash || ref->file_varies[whole - ref->after.entries])))
            continue;
        return snprintf(why, WHY_MAX, "exit 1, and leaves %s", is->name) > 0;
    }
    for (size_t i = 0; i < ref->before.count; i++)
        if (!listing_find(now, ref->before.entries[i].name))
            return snprintf(why, WHY_MAX, "exit 1, and removes %s", ref->before.entries[i].name) > 0;
    return false;
}

static verdict judge_failure(const reference *ref, const run *r, const fault *f, const listing *now, bool resumes,
                             char *why)
{
    char *err = file_text(r->err, NULL);
    verdict v = good_message(ref, f, err, why) ? REPORTED : MESSAGE;
    free(err);
    if (v == REPORTED && !resumes && !listing_same(now, &ref->before))
        v = leaves_files(ref, now, why) ? LEFTOVER : REPORTED;
    if (v == REPORTED && resumes && !goes_on(ref, r, why))
        v = LEFTOVER;
    return v;
}

static verdict judge_leak(const reference *ref, int ended, long live, int descriptors, char *why)
{
    if (ended && descriptors > ref->descriptors) {
        snprintf(why, WHY_MAX, "%d descriptors are open at the end instead of %d", descriptors, ref->descriptors);
        return LEAK;
    }
    if (ended && live > ref->live) {
        snprintf(why, WHY_MAX, "%ld blocks are allocated at the end instead of %ld", live, ref->live);
        return LEAK;
    }
    return UNHARMED;
}

verdict judge(const reference *ref, const run *r, const fault *f, const outcome *o, bool resumes, const char *template,
              char *why)
{
    const long live = run_page->live_at_end;
    const int descriptors = run_page->descriptors_at_end, ended = run_page->ended;
    verdict v;
    *why = '\0';
    listing now = folder_list(r->folder);
    if (o->timed_out || o->code >= 124) {
        v = CRASH;
        snprintf(why, WHY_MAX, o->timed_out ? "does not end" : "ends by signal %d", o->code - 128);
    } else if (o->code == 0) {
        v = judge_success(ref, r, f, o, &now, why);
    } else if (o->code == 1) {
        v = judge_failure(ref, r, f, &now, resumes, why);
    } else {
        char *err = file_text(r->err, NULL);
        v = MESSAGE;
        snprintf(why, WHY_MAX, "exit %d: %.300s", o->code, err);
        free(err);
    }
    if (v == UNHARMED || v == REPORTED) {
        const verdict leak = judge_leak(ref, ended, live, descriptors, why);
        v = leak == LEAK ? LEAK : v;
    }
    if (resumes || !listing_same(&now, &ref->before))
        folder_copy(template, r->folder);
    listing_free(&now);
    return v;
}
