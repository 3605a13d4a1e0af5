/* Whether a parameter acts, or its note is proved, for test_acts.c: what is counted, and what is wrong. */
#pragma once

#include "acts_fixture.h"
#include "scene/model/medium.h"

#include <pthread.h>

enum { RULES_MAX = 500, JOBS_MAX = 240, TEXT_MAX = 1 << 14 };
enum { ATTEMPTS = 2 };   /* of proving a condition in one scene */
enum { FEW_VALUES = 3 }; /* tried in each scene of a parameter whose note is a condition of the table */

/* How often each condition was reported for a parameter of this name, how often its remedy was tried, and how often it
 * proved it. */
typedef struct rule_count {
    const char *rule, *name;
    int reported, attempts, proved;
    char where[240];
} rule_count;

typedef struct tally {
    const char *path;
    int tried, acting, by_one, noted, refused, marked, bad;
    rule_count rules[RULES_MAX];
    int rule_count;
    char text[TEXT_MAX]; /* the failures, one a line */
} tally;

typedef struct visitor {
    acts *a;
    tally *out;
} visitor;

static void complain(tally *out, const char *path, const char *what, const char *more)
{
    const size_t used = strlen(out->text);
    snprintf(out->text + used, sizeof out->text - used, "# %s: %s: %s%s%s\n", out->path, path, what, more ? ": " : "",
             more ? more : "");
    out->bad++;
}

static rule_count *count_of(tally *out, const char *rule, const char *name)
{
    for (int i = 0; i < out->rule_count; i++)
        if (strcmp(out->rules[i].rule, rule) == 0 && strcmp(out->rules[i].name, name) == 0)
            return &out->rules[i];
    assert_true(out->rule_count < RULES_MAX);
    out->rules[out->rule_count] = (rule_count){.rule = rule, .name = name};
    return &out->rules[out->rule_count++];
}

/* The conditions that some scene has proved: one proof is enough, and it takes longer than all else here. Which scene
 * proves a condition depends on the order in time, whether one does not. */
static struct {
    pthread_mutex_t lock;
    struct {
        const char *rule, *name;
    } all[RULES_MAX];
    int count;
} proofs = {.lock = PTHREAD_MUTEX_INITIALIZER};

static bool is_proved(const char *rule, const char *name)
{
    bool found = false;
    pthread_mutex_lock(&proofs.lock);
    for (int i = 0; i < proofs.count && !found; i++)
        found = strcmp(proofs.all[i].rule, rule) == 0 && strcmp(proofs.all[i].name, name) == 0;
    pthread_mutex_unlock(&proofs.lock);
    return found;
}

static void prove(rule_count *rule)
{
    rule->proved++;
    if (is_proved(rule->rule, rule->name))
        return;
    pthread_mutex_lock(&proofs.lock);
    const int i = proofs.count++;
    assert_true(i < RULES_MAX);
    proofs.all[i].rule = rule->rule, proofs.all[i].name = rule->name;
    pthread_mutex_unlock(&proofs.lock);
}

/* Applies the remedy of the note, then that of the next note, until there is none: then the parameter must change the
 * film. */
static bool remedy_works(const acts *a, const char *path, const param *row, const inert_answer *first)
{
    enum { STEPS = 4 };
    inert_answer answer = *first;
    acts helped = {.s = NULL};
    scene *s = scene_clone(a->s);
    bool inert = true;
    for (int i = 0; i < STEPS && inert && s; i++) {
        if (!strchr(answer.note.remedy, '=') || !acts_set_all(s, answer.note.remedy, NULL))
            break;
        inert = param_is_inert(s, path, NULL, &answer);
    }
    if (!s || inert || !acts_of(s, &helped, NULL)) {
        if (inert)
            scene_destroy(s);
        return false;
    }
    acts_values v;
    char *now = NULL;
    bool works = scene_get(helped.s, path, &now, NULL) == STATUS_OK;
    if (works) {
        acts_values_of(helped.s, row, now, &v);
        works = acts_try_sizes(&helped, path, &v, 1).changed > 0;
    }
    free(now);
    acts_close(&helped);
    return works;
}

/* Drops indices of special meaning: where no light is refracted, an index above MIRROR_IOR still makes a mirror, and
 * where no ray continues, the surroundings' index still removes a surface. */
static void drop_special_indices(const inert_answer *answer, const param *row, acts_values *v)
{
    if (strcmp(row->name, "ior") != 0 ||
        (strcmp(answer->rule, "straight") != 0 && strcmp(answer->rule, "not-bent") != 0))
        return;
    for (int i = 0; i < v->count;) {
        const double n = strtod(v->text[i], NULL);
        if (n == 1.0 || n > MIRROR_IOR)
            memmove(v->text[i], v->text[--v->count], sizeof v->text[i]);
        else
            i++;
    }
}

/* Of the table, a row of which has a proof of its own with all values. */
static bool is_condition(const char *rule)
{
    return rule[strcspn(rule, "=!>")] != 0;
}

static void judge_note(visitor *x, const char *path, const param *row, acts_values *v, const inert_answer *answer)
{
    char line[NOTE_LINE_MAX];
    drop_special_indices(answer, row, v);
    if (is_condition(answer->rule) && v->count > FEW_VALUES)
        v->count = FEW_VALUES;
    const acts_outcome o = acts_try(x->a, path, v, 0, 1);
    rule_count *rule = count_of(x->out, answer->rule, row->name);
    x->out->noted++;
    rule->reported++;
    if (o.changed > 0)
        complain(x->out, path, "acts, and yet a note says that it does not",
                 note_line(&answer->note, line, sizeof line));
    if (strcmp(answer->note.place, path) != 0 || !answer->note.text[0] || !answer->note.remedy[0])
        complain(x->out, path, "the note lacks its place, text or remedy", note_line(&answer->note, line, sizeof line));
    if (rule->attempts >= ATTEMPTS || is_proved(answer->rule, row->name))
        return;
    rule->attempts++;
    if (remedy_works(x->a, path, row, answer)) {
        prove(rule);
        const char *slash = strrchr(x->out->path, '/');
        snprintf(rule->where, sizeof rule->where, "%.90s %.120s", slash ? slash + 1 : x->out->path, path);
    } else if (getenv("ACTS_VERBOSE")) {
        printf("# %s %s: not proved here: %s\n", x->out->path, path, note_line(&answer->note, line, sizeof line));
    }
}

/* Parameters marked as not affecting the image: no value may change the film. */
static void judge_mark(visitor *x, const char *path, const acts_values *v)
{
    x->out->marked++;
    if (acts_try(x->a, path, v, 0, 1).changed > 0)
        complain(x->out, path, "changes the film, and yet the table marks it as not affecting it", NULL);
}

static void judge_act(visitor *x, const char *path, const acts_values *v)
{
    const acts_outcome o = acts_try_sizes(x->a, path, v, 2);
    char text[DIAGNOSTIC_TEXT_MAX];
    if (o.changed > 0) {
        x->out->acting++;
        if (o.changed < 2 && o.legal > 1) {
            x->out->by_one++;
            if (getenv("ACTS_VERBOSE"))
                printf("# %s %s: one value of %d acts\n", x->out->path, path, o.legal);
        }
    } else if (o.legal == 0 && o.why.remedy[0])
        x->out->refused++;
    else
        complain(x->out, path, "unexplained: no other value changes the film, and nothing says why",
                 o.legal == 0 ? diagnostic_text(&o.why, text, sizeof text) : NULL);
}

/* Whether ACTS_PATH, if it is set, has the path's last name: objects may have other ones. */
static bool is_selected(const char *path)
{
    const char *wanted = getenv("ACTS_PATH");
    const char *end = strrchr(path, '.'), *wanted_end = wanted ? strrchr(wanted, '.') : NULL;
    return !wanted || strcmp(wanted_end ? wanted_end + 1 : wanted, end ? end + 1 : path) == 0;
}

static status try_parameter(void *context, const char *path, const param *row, const char *value)
{
    visitor *x = context;
    acts_values v;
    inert_answer answer;
    if (!is_selected(path))
        return STATUS_OK;
    acts_values_of(x->a->s, row, value, &v);
    x->out->tried++;
    if (!scene_film_depends_on(x->a->s, path))
        judge_mark(x, path, &v);
    else if (acts_ask(x->a, path, &answer))
        judge_note(x, path, row, &v, &answer);
    else
        judge_act(x, path, &v);
    return STATUS_OK;
}
