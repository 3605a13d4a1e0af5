/* The job: the single interface for rendering, used by the program, studies, the laboratory and the engine. A job
 * chooses the instruction set, keeps the renderer and its threads between frames, reads the machine's topology when a
 * scene pins threads, loads scenes, renders frames, supervises them (progress, a time limit, a memory quota) and
 * returns their results (job/account.h). The caller's token (base/cancel.h) ends its work.
 *
 * Ownership: job_create allocates, job_destroy releases; scenes are borrowed for a call; the caller owns accounts. One
 * thread at a time uses a job. No global state: several jobs may exist in one process.
 *
 * Errors: STATUS_INTERRUPTED when cancelled, with the finished part in the account; STATUS_BAD_INPUT for an
 * invalid scene and for a frame over the quota; STATUS_FAILURE for a frame over its time limit, when out of memory, and
 * when threads cannot be started or bound. The diagnostic describes the error. */
#pragma once

#include "job/account.h"
#include "render/frame/renderer.h"
#include "scene/model/open.h"

/* --- sharing ---
 *
 * The interface by which a job shares its frames with other processes (src/mpi): each renders a part of the tiles of
 * every frame. The job calls begin before and end after it renders its part. The rest is as without sharing, because
 * end completes the result of the frame. Ownership: the job borrows the interface for its life.
 * Errors: STATUS_BAD_INPUT for outputs that cannot be shared, STATUS_INTERRUPTED when cancelled, and what the other
 * processes report. */

typedef struct job_distribution {
    /* Sends the loaded scene to the other processes, and begins to hand out its tiles; *tiles: those of this process.
     * Until end returns, one thread at a time calls requested->progress about every 0.1 s with the fraction of the
     * frame that all processes have finished. From begin to end, a cancel token of the implementation may be active on
     * the calling thread, so that an error of another process cancels the frame. */
    status (*begin)(void *context, const scene *s, const render_options *requested, const tile_source **tiles,
                    diagnostic *why);
    /* rendered, result: what the renderer returned for this process; result may be NULL after an error. Waits for the
     * other processes, and completes *result with the film, variance, counts, times and workers of all. Returns the
     * status of the frame. */
    status (*end)(void *context, status rendered, render_result *result, diagnostic *why);
    void *context; /* passed to begin and end */
} job_distribution;

/* --- jobs --- */

typedef struct job job;

/* Zeros are valid settings. */
typedef struct job_settings {
    const isa *level; /* NULL: isa_choose */
    /* measure usage, hardware counters and hashes of frames: costs about 0.1 ms and one pass over the film */
    bool measured;
    bool fresh_peak;   /* reset the peak of memory at the beginning of each frame, if the system allows it */
    bool keeps_meshes; /* keep meshes of loaded scenes for scenes that are loaded later (mesh_cache_load) */
    const job_distribution *sharing; /* NULL: frames are not shared */
    double time_s;                   /* time limit of a frame; 0: none */
    uint64_t memory_bytes;           /* limit for a frame's film and maps; 0: none */
} job_settings;

status job_create(const job_settings *settings, job **out, diagnostic *why);
void job_destroy(job *j); /* NULL is allowed */

isa job_isa(const job *j);
/* The machine's topology, read at the first call; the job owns it. */
status job_machine(job *j, const topology **out, diagnostic *why);

/* The machine's noise in the last NOISE_WINDOW_S, without frequency_drop; unknown unless `measured` is set. */
machine_noise job_noise(job *j);

/* Loads the files that a scene names; the scene was validated when it was read or changed. watch: as for
 * scene_load_until, or NULL. */
status job_load(job *j, scene *s, const load_watch *watch, diagnostic *why);

/* Renders one frame of a loaded scene. options: as for renderer_render, or NULL. Release *out whatever the return
 * value. */
status job_render(job *j, const scene *s, const render_options *options, job_account *out, diagnostic *why);

/* Renders `frames` frames. STATUS_FAILURE if the hashes of their films differ, because then the times measure different
 * work. Outputs that options requests in addition to the film disturb the times: with more than one frame, these
 * outputs come from one additional frame, which is not measured. progress receives the fraction of all frames. */
status job_repeat(job *j, const scene *s, size_t frames, const render_options *options, job_account *out,
                  diagnostic *why);

/* --- the mesh cache ---
 *
 * Meshes of recently loaded scenes, so that a scene that is loaded again need not rebuild its triangles and
 * hierarchies. Ownership: the cache owns copies of scenes, which share their meshes; mesh_cache_clear releases them. */

enum { MESH_CACHE_SCENES = 64 };
/* The maximum number of triangles in all meshes of the cache; a mesh with its hierarchies uses about 200 bytes per
 * triangle. */
#define MESH_CACHE_TRIANGLES 16000000u

typedef struct mesh_cache {
    scene *scenes[MESH_CACHE_SCENES];
    size_t count;
} mesh_cache;

/* Loads a scene like scene_load_until, but uses meshes of the cache and adds newly built ones to it. */
status mesh_cache_load(mesh_cache *cache, scene *s, const load_watch *watch, diagnostic *why);
void mesh_cache_clear(mesh_cache *cache);
