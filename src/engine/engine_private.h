/* What the engine's handles hold, and how its files turn the library's errors into those of cuvette.h. Not seen from
 * outside. Ownership as cuvette.h says. */
#pragma once

#include "base/vec3.h"
#include "base/float_environment.h"
#include "base/isa.h"
#include "cuvette.h"
#include "job/job.h"
#include "scene/model/open.h"
#include <pthread.h>
#include <stdatomic.h>

struct cuvette_scene {
    scene *model;
    pthread_mutex_t loading; /* held while pictures are read; afterwards they are only looked at */
    atomic_int renders;      /* under way */
    atomic_bool advancing;   /* a motion moves its slimes */
    /* the handle and the motions made of it: the last one frees this struct, the handle's end the model */
    atomic_int owners;
    uint64_t slimes_changed; /* how often what a motion holds of it has: its slimes, their number, their motion */
};

struct cuvette_engine {
    job *workers;
    atomic_bool busy;
};

struct cuvette_frame {
    job_account account;
    size_t solid_count;
    double preview_s;
};

/* The library's status and diagnostic as the caller's; why is written only when code is not STATUS_OK. */
cuvette_status engine_report(status code, const diagnostic *inner, cuvette_diagnostic *why);

/* CUVETTE_BAD_INPUT: `name` must not be NULL. */
cuvette_status engine_missing(const char *name, cuvette_diagnostic *why);

/* CUVETTE_OK when none of the arguments is NULL, whose names stand in a row, "name, by"; &engine_list_end ends them. */
cuvette_status engine_need(const char *names, const void *const *arguments, cuvette_diagnostic *why);
/* The same, and that the first of them, a scene, may be changed now. */
cuvette_status engine_need_change(const char *names, const void *const *arguments, cuvette_diagnostic *why);
extern const char engine_list_end;

/* The instruction set of that name, or the one to use when it is NULL. */
status engine_isa(const char *name, isa *out, diagnostic *why);

/* A render and an advance keep each other out: whoever finds the other there goes away with CUVETTE_BUSY. */
cuvette_status engine_begin_render(cuvette_scene *s, cuvette_diagnostic *why);
void engine_end_render(cuvette_scene *s);
cuvette_status engine_begin_advance(cuvette_scene *s, cuvette_diagnostic *why);
void engine_end_advance(cuvette_scene *s);
cuvette_status engine_is_advancing(cuvette_diagnostic *why); /* CUVETTE_BUSY, and why */

/* One owner less. */
void engine_release_scene(cuvette_scene *s);

/* scene_check, beside others that load the scene. */
status engine_check(const cuvette_scene *s, diagnostic *why);

/* Reads the files that the scene names, once. */
status engine_load(cuvette_scene *s, diagnostic *why);

/* Copies as much of content, of `known` bytes, as the caller's struct, an older or a newer one, has room for; its own
 * size, with which both begin, stays. */
cuvette_status engine_give_struct(const void *content, size_t known, void *out, cuvette_diagnostic *why);

bool engine_is_finite(const double *v); /* of three */
/* Says what is wrong with a ray of the caller's: the i-th that a plan's query is asked, or one alone where p is NULL,
 * whose start does not count. */
struct plan;
status engine_check_ray(const struct plan *p, const cuvette_ray *ray, size_t i, diagnostic *why);

/* d / |d|, without over- or underflow on the way; a unit vector but for rounding stays as it is, to the bit. */
vec3 engine_unit(const double *d);

/* Copies text, which it frees, into the caller's memory. */
cuvette_status engine_give_text(char *content, char *text, size_t size, size_t *length, cuvette_diagnostic *why);

/* Stands first in each function of cuvette.h that can fail: it computes in the default floating-point environment,
 * and whichever way it returns, the caller's is put back (the attribute is one of gcc and clang). The caller's
 * functions run in the caller's: around a call of one stand float_environment_leave(&host) and
 * float_environment_enter(&host). inner is what the library's own functions tell. */
#define ENGINE_ENTER()                                                        \
    float_environment host __attribute__((cleanup(float_environment_leave))); \
    float_environment_enter(&host);                                           \
    __attribute__((unused)) diagnostic inner = {.line = 0}

/* Leaves with CUVETTE_BAD_INPUT, told to why, when one of the arguments is NULL. Where cuvette.h's name of it is a type
 * of the library, the definition has another one: s for a scene, or what ENGINE_NEED_NAMED is told. */
#define ENGINE_NEED_NAMED(argument, name)     \
    do {                                      \
        if (!(argument))                      \
            return engine_missing(name, why); \
    } while (0)
#define ENGINE_NEED(...) ENGINE_TRY(engine_need(#__VA_ARGS__, ENGINE_LIST(__VA_ARGS__), why))

/* The beginning of a function that needs these arguments; and of one that changes the scene, which is the first of
 * them: that leaves also when the scene is being rendered. */
#define ENGINE_CALL(...) \
    ENGINE_ENTER();      \
    ENGINE_NEED(__VA_ARGS__)
#define ENGINE_CHANGE(...) \
    ENGINE_ENTER();        \
    ENGINE_TRY(engine_need_change(#__VA_ARGS__, ENGINE_LIST(__VA_ARGS__), why))

#define ENGINE_LIST(...) ((const void *const[]){__VA_ARGS__, &engine_list_end})
/* Leaves with what the call returns unless that is CUVETTE_OK. */
#define ENGINE_TRY(call)                    \
    do {                                    \
        const cuvette_status needed = call; \
        if (needed != CUVETTE_OK)           \
            return needed;                  \
    } while (0)
