/* Internals of the engine: the content of its handles, and the conversion of the library's errors into those of
 * cuvette.h. Ownership as in cuvette.h. */
#pragma once

#include "base/cancel.h"
#include "base/float_environment.h"
#include "base/isa.h"
#include "base/vec3.h"
#include "cuvette.h"
#include "job/job.h"
#include "scene/model/open.h"

#include <pthread.h>
#include <stdatomic.h>

struct cuvette_scene {
    scene *model;
    pthread_mutex_t loading; /* held while files are loaded; what was loaded is read-only afterwards */
    atomic_int renders;      /* renders in progress */
    atomic_bool advancing;   /* a motion advances its slimes */
    /* the handle and the motions created from it: the last owner frees this struct; destroying the handle frees the
     * model */
    atomic_int owners;
    /* number of changes that invalidate a motion: a slime was changed, a mesh was removed, or another motion was
     * created */
    uint64_t slimes_changed;
    bool grabbed; /* hands moved its slimes, so that its text does not describe their shapes */
};

struct cuvette_engine {
    job *workers;
    atomic_bool busy;
    cancel_token token; /* cuvette_engine_cancel sets it */
};

struct cuvette_frame {
    job_account account;
    size_t solid_count;
    double preview_s;
    scene *scene; /* as it was rendered, for image files; NULL if it cannot be shared */
};

/* Converts the library's status and diagnostic to the caller's; why is written only when code is not STATUS_OK. */
cuvette_status engine_report(status code, const diagnostic *inner, cuvette_diagnostic *why);

/* CUVETTE_BAD_INPUT: `name` must not be NULL. */
cuvette_status engine_missing(const char *name, cuvette_diagnostic *why);

/* CUVETTE_OK when none of the arguments is NULL; names lists them as "name, by", and &engine_list_end ends
 * arguments. */
cuvette_status engine_need(const char *names, const void *const *arguments, cuvette_diagnostic *why);
/* The same, and the first argument, a scene, must not be in use by a render or an advance. */
cuvette_status engine_need_change(const char *names, const void *const *arguments, cuvette_diagnostic *why);
extern const char engine_list_end;

/* The instruction set of that name, or the default one if name is NULL. */
status engine_isa(const char *name, isa *out, diagnostic *why);

/* A render and an advance exclude each other: the one that comes second returns CUVETTE_BUSY. */
cuvette_status engine_begin_render(cuvette_scene *s, cuvette_diagnostic *why);
void engine_end_render(cuvette_scene *s);
cuvette_status engine_begin_advance(cuvette_scene *s, cuvette_diagnostic *why);
void engine_end_advance(cuvette_scene *s);
cuvette_status engine_is_advancing(cuvette_diagnostic *why); /* always CUVETTE_BUSY, with a diagnostic */

/* Creates a handle that owns the model; destroys the model when out of memory. */
cuvette_status engine_own_scene(scene *model, cuvette_scene **out, cuvette_diagnostic *why);

/* Drops one reference; the last one frees the scene. */
void engine_release_scene(cuvette_scene *s);

/* scene_check while other threads may load the scene. */
status engine_check(const cuvette_scene *s, diagnostic *why);

/* Loads the files that the scene names, and its slimes, once; watch as for scene_load_until. */
status engine_load(cuvette_scene *s, const load_watch *watch, diagnostic *why);

/* The caller's progress function, called about ten times per second with a fraction that never decreases. When it
 * returns false, the token is set: the only place where a callback's result ends work. */
typedef struct host_progress {
    bool (*callback)(void *context, double fraction); /* may be NULL */
    void *context;
    float_environment *host; /* the caller's, for the callback */
    double fraction, next_s;
    cancel_token token;
} host_progress;
/* Begins the token, whose ask calls the function even without progress. */
void engine_begin_progress(host_progress *p);
void engine_end_progress(host_progress *p);
/* Calls the function now. */
void engine_report_progress(host_progress *p, double fraction);
/* Calls the function if a tenth of a second has passed. context: a host_progress, because this is a function for
 * load_watch.progress. */
void engine_report_if_due(void *context, double fraction);

/* Copies content, of `known` bytes, into the caller's struct of an older or a newer version, up to the caller's size;
 * the size field with which both begin is not changed. */
cuvette_status engine_copy_struct(const void *content, size_t known, void *out, cuvette_diagnostic *why);

static inline vec3 engine_vector(const double v[3])
{
    return vec3_make(v[0], v[1], v[2]);
}
static inline bool engine_is_finite(const double v[3])
{
    return vec3_is_finite(engine_vector(v));
}
static inline void engine_put_vector(double out[3], vec3 v)
{
    out[0] = v.x, out[1] = v.y, out[2] = v.z;
}
/* Checks a ray of the caller: ray i of a query on the plan p, or, if p is NULL, a single ray whose start is ignored. */
struct plan;
status engine_check_ray(const struct plan *p, const cuvette_ray *ray, size_t i, diagnostic *why);

/* d / |d|, without intermediate over- or underflow; a vector that is a unit vector up to rounding is returned
 * unchanged, to the bit. */
vec3 engine_unit(const double *d);

/* Copies content, which it frees, into the caller's memory. */
cuvette_status engine_copy_text(char *content, char *text, size_t size, size_t *length, cuvette_diagnostic *why);

/* First statement of each function of cuvette.h that can fail: the function computes in the default floating-point
 * environment, and the caller's is restored on every return (the cleanup attribute is one of gcc and clang). Callbacks
 * run in the caller's environment: put float_environment_leave(&host) before and float_environment_enter(&host) after a
 * call of one. inner receives the diagnostics of the library's functions. */
#define ENGINE_ENTER()                                                        \
    float_environment host __attribute__((cleanup(float_environment_leave))); \
    float_environment_enter(&host);                                           \
    __attribute__((unused)) diagnostic inner = {.line = 0}

/* Returns CUVETTE_BAD_INPUT, with a diagnostic in why, when one of the arguments is NULL. An argument whose name in
 * cuvette.h is also a type of the library has another name in the definition: s for a scene; for others
 * ENGINE_NEED_NAMED has both names. */
#define ENGINE_NEED_NAMED(argument, name)     \
    do {                                      \
        if (!(argument))                      \
            return engine_missing(name, why); \
    } while (0)
#define ENGINE_NEED(...) ENGINE_TRY(engine_need(#__VA_ARGS__, ENGINE_LIST(__VA_ARGS__), why))

/* First statement of a function that needs these arguments; ENGINE_CHANGE for one that changes the scene, its first
 * argument: it also returns when the scene is being rendered, or its slimes are being advanced. */
#define ENGINE_CALL(...) \
    ENGINE_ENTER();      \
    ENGINE_NEED(__VA_ARGS__)
#define ENGINE_CHANGE(...) \
    ENGINE_ENTER();        \
    ENGINE_TRY(engine_need_change(#__VA_ARGS__, ENGINE_LIST(__VA_ARGS__), why))

#define ENGINE_LIST(...) ((const void *const[]){__VA_ARGS__, &engine_list_end})
/* Returns the call's result unless that is CUVETTE_OK. */
#define ENGINE_TRY(call)                    \
    do {                                    \
        const cuvette_status needed = call; \
        if (needed != CUVETTE_OK)           \
            return needed;                  \
    } while (0)
