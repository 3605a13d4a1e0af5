/* Every control acts, or says why it does not: for each shipped scene and each parameter that `cuvette params SCENE` prints, other legal
 * values change the film, or a note says why none does, or the table marks the parameter as one of how a frame is computed. A note is
 * proved by its remedy: with what it says set, the parameter changes the film. A parameter that the table gains is tried, too. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "acts_fixture.h"

#include <glob.h>
#include <pthread.h>
#include <stdatomic.h>

enum { RULES_MAX = 100, SCENES_MAX = 64, TEXT_MAX = 1 << 16 };

/* How often each condition was said, and proved by its remedy. */
typedef struct rule_count { const char *rule; int said, proved; char where[160]; } rule_count;

typedef struct account {
    const char *path;
    int tried, acting, by_one, noted, refused, marked, bad;
    rule_count rules[RULES_MAX];
    int rule_count;
    char text[TEXT_MAX]; /* what is bad, a line each */
} account;

typedef struct visitor { acts *a; account *out; } visitor;

static void complain(account *out, const char *path, const char *what, const char *more)
{
    const size_t used = strlen(out->text);
    snprintf(out->text + used, sizeof out->text - used, "# %s: %s: %s%s%s\n", out->path, path, what, more ? ": " : "", more ? more : "");
    out->bad++;
}

static rule_count *count_of(account *out, const char *rule)
{
    for (int i = 0; i < out->rule_count; i++)
        if (strcmp(out->rules[i].rule, rule) == 0)
            return &out->rules[i];
    assert_true(out->rule_count < RULES_MAX);
    out->rules[out->rule_count] = (rule_count){.rule = rule};
    return &out->rules[out->rule_count++];
}

/* What the remedy says is done, and what the next note says, until there is none: then the parameter changes the film. */
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
        inert = inert_ask(s, path, NULL, &answer);
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

static void judge_note(visitor *x, const char *path, const param *row, const acts_values *v, const inert_answer *answer)
{
    char line[NOTE_LINE_MAX];
    const acts_outcome o = acts_try(x->a, path, v, 0, 1);
    rule_count *rule = count_of(x->out, answer->rule);
    x->out->noted++;
    rule->said++;
    if (o.changed > 0)
        complain(x->out, path, "acts, and yet a note says that it does not", note_line(&answer->note, line, sizeof line));
    if (strcmp(answer->note.place, path) != 0 || !answer->note.text[0] || !answer->note.remedy[0])
        complain(x->out, path, "the note lacks its place, text or remedy", note_line(&answer->note, line, sizeof line));
    if (remedy_works(x->a, path, row, answer)) {
        rule->proved++;
        snprintf(rule->where, sizeof rule->where, "%.90s %.60s", strrchr(x->out->path, '/') + 1, path);
    } else if (getenv("ACTS_VERBOSE")) {
        printf("# %s %s: not proved here: %s\n", x->out->path, path, note_line(&answer->note, line, sizeof line));
    }
}

/* Marked as how: no value may change the film, but for Embree's hierarchy, whose row says so itself. */
static void judge_mark(visitor *x, const char *path, acts_values *v)
{
    for (int i = 0; i < v->count; i++)
        if (strcmp(v->text[i], "embree") == 0)
            memmove(v->text[i], v->text[--v->count], sizeof v->text[i]);
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

static status try_parameter(void *context, const char *path, const param *row, const char *value)
{
    visitor *x = context;
    acts_values v;
    inert_answer answer;
    acts_values_of(x->a->s, row, value, &v);
    x->out->tried++;
    if (row->is_how)
        judge_mark(x, path, &v);
    else if (inert_ask(x->a->s, path, &x->a->counters, &answer))
        judge_note(x, path, row, &v, &answer);
    else
        judge_act(x, path, &v);
    return STATUS_OK;
}

static void try_scene(account *out)
{
    acts a;
    diagnostic why = {.what = ""};
    if (!acts_open(out->path, &a, &why)) {
        complain(out, "", "cannot be rendered", why.what);
        return;
    }
    visitor x = {&a, out};
    scene_each_param(a.s, try_parameter, &x);
    acts_close(&a);
}

/* --- all scenes, on two threads --- */

typedef struct bench { account *accounts; int count; atomic_int next; } bench;

static void *work(void *context)
{
    bench *b = context;
    for (int i; (i = atomic_fetch_add(&b->next, 1)) < b->count;)
        try_scene(&b->accounts[i]);
    return NULL;
}

static void run(bench *b)
{
    pthread_t other;
    assert_int_equal(pthread_create(&other, NULL, work, b), 0);
    work(b);
    pthread_join(other, NULL);
}

static void add_rules(account *all, const account *one)
{
    for (int i = 0; i < one->rule_count; i++) {
        rule_count *r = count_of(all, one->rules[i].rule);
        r->said += one->rules[i].said;
        r->proved += one->rules[i].proved;
        if (one->rules[i].proved && !r->where[0])
            memcpy(r->where, one->rules[i].where, sizeof r->where);
    }
}

static void add_account(account *all, const account *one)
{
    printf("# %-38s tried %4d, acting %3d, noted %3d, refused %d, marked %2d, unexplained or wrong %d\n", one->path, one->tried, one->acting,
           one->noted, one->refused, one->marked, one->bad);
    printf("%s", one->text);
    all->tried += one->tried, all->acting += one->acting, all->by_one += one->by_one, all->noted += one->noted;
    all->refused += one->refused, all->marked += one->marked, all->bad += one->bad;
    add_rules(all, one);
}

static account accounts[SCENES_MAX], all;

static void every_parameter_of_every_shipped_scene_acts_or_says_why_not(void **state)
{
    (void)state;
    glob_t found;
    const char *only = getenv("ACTS_SCENE");
    assert_int_equal(glob("experiments/scenes/*.yaml", 0, NULL, &found), 0);
    bench b = {.accounts = accounts};
    for (size_t i = 0; i < found.gl_pathc && b.count < SCENES_MAX; i++)
        if (!only || strstr(found.gl_pathv[i], only))
            accounts[b.count++].path = found.gl_pathv[i];
    run(&b);
    for (int i = 0; i < b.count; i++)
        add_account(&all, &accounts[i]);
    printf("# all: tried %d, acting %d (%d by one value alone), noted %d, refused with a remedy %d, marked %d, unexplained: %d\n", all.tried,
           all.acting, all.by_one, all.noted, all.refused, all.marked, all.bad);
    globfree(&found);
    assert_int_equal(all.bad, 0);
}

static void each_note_is_proved(void **state)
{
    (void)state;
    int unproved = 0;
    for (int i = 0; i < all.rule_count; i++) {
        const rule_count *r = &all.rules[i];
        printf("# %-18s said %3d, proved %3d, as in %s\n", r->rule, r->said, r->proved, r->where);
        unproved += r->proved == 0;
    }
    assert_int_equal(unproved, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_parameter_of_every_shipped_scene_acts_or_says_why_not),
        cmocka_unit_test(each_note_is_proved),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
