/* The laboratory: start and stop of its parts, and the state that it sends to pages. */
#include "web/lab.h"
#include "base/text.h"
#include "report/json.h"
#include "scene/model/open.h"
#include "scene/model/scene.h"
#include "web/api/api.h"
#include "web/live/images.h"
#include "web/session/session.h"
#include "web/session/studies.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* The most handlers that may do heavy work, with much memory and time, at once. */
enum { HEAVY_AT_ONCE = 2 };

/* --- the state, and its changes --- */

/* What serves the page: the program, or a module in the page's own browser (src/wasm). */
#if defined __EMSCRIPTEN__
static const char engine[] = "browser";
#else
static const char engine[] = "server";
#endif

static json_t *state_json(lab *l)
{
    json_t *state = json_pack("{s:s, s:s}", "version", CUVETTE_VERSION, "engine", engine);
    const bool good =
        state && scene_document_json(l->scene_document, state) && render_worker_json(l->render_worker, state) &&
        json_object_update_new(
            state, json_pack("{s:o, s:o, s:o, s:{s:i, s:i}}", "slime", live_json(render_worker_live(l->render_worker)),
                             "reference", reference_image_json(l->reference_image), "study", studies_json(l->studies),
                             "limits", "pixels", DOCUMENT_PIXELS_MAX, "triangles", DOCUMENT_TRIANGLES_MAX)) == 0 &&
        rescue_json(l->rescue, state);
    return json_if(state, good);
}

static void on_document(void *context)
{
    lab *l = context;
    render_worker_wake(l->render_worker);
    rescue_wake(l->rescue);
    lab_publish_state(l);
}

static void on_image(void *context, const shared_image *img)
{
    lab *l = context;
    if (!lab_is_open(l))
        return;
    lab_publish(l, "image", shared_image_json(img));
    live *live_slime = render_worker_live(l->render_worker);
    if (live_is_on(live_slime))
        lab_publish(l, "slime", live_json(live_slime));
}

/* An unsaved scene is not written while a study runs, so it is written now. */
static void on_study_end(lab *l)
{
    rescue_wake(l->rescue);
}

static void on_state_changed(void *context)
{
    lab_publish_state(context);
}

/* --- start and stop --- */

static status first_scene(const lab *l, scene **out, char **file, diagnostic *why)
{
    *file = NULL;
    if (!l->settings.scene)
        return new_scene(false, out, why);
    TRY(folder_find(l->files, l->settings.scene, file, why));
    if (!*file)
        return diagnose_at(why, l->settings.scene, STATUS_BAD_INPUT,
                           "choose a scene below the folder, or another folder",
                           "is not in the folder of the laboratory");
    return scene_read_below(l->settings.scene, folder_real(l->files), out, why);
}

/* folder_name returns NULL for the folder itself, so a file inside is tested too. */
static bool is_inside(const folder *files, const char *path)
{
    char *any = text_format("%s/any", path), *name = folder_name(files, path),
         *within = any ? folder_name(files, any) : NULL;
    const bool inside = name || within;
    free(any);
    free(name);
    free(within);
    return inside;
}

static status check_results(const lab *l, diagnostic *why)
{
    errno = 0;
    if (is_inside(l->files, l->settings.results))
        return STATUS_OK;
    if (errno == ENOMEM)
        return out_of_memory(why);
    return diagnose_at(why, l->settings.results, STATUS_BAD_INPUT,
                       "set --results to a folder inside the laboratory's folder",
                       "is not in the folder of the laboratory");
}

static status open_document(lab *l, diagnostic *why)
{
    scene *first = NULL;
    char *file = NULL;
    status code = first_scene(l, &first, &file, why);
    if (code == STATUS_OK) {
        lab_set_default_threads(l, first);
        const char *name = file && lab_is_scene_name(file) ? file : NULL;
        code = scene_document_create(first, name, l->files, on_document, l, &l->scene_document, why);
    }
    free(file);
    return code;
}

static status serve(lab *l, diagnostic *why)
{
    size_t count;
    status code = api_bind(l, &count, why);
    const http_settings settings = {.port = l->settings.port,
                                    .routes = l->routes,
                                    .route_count = count,
                                    .files = page_files,
                                    .file_count = page_file_count,
                                    .connections = 128,
                                    .event_clients = 48,
                                    .timeout_s = 30,
                                    .requests_per_s = l->settings.requests_per_s,
                                    .frame_origins = l->settings.frame_origins,
                                    .frame_origin_count = l->settings.frame_origin_count};
    THEN(code, http_start(&settings, &l->server, why));
    pthread_mutex_lock(&l->publish_lock);
    l->open = code == STATUS_OK;
    pthread_mutex_unlock(&l->publish_lock);
    return code;
}

static status start(lab *l, diagnostic *why)
{
    const lab_settings *settings = &l->settings;
    const render_worker_listener listener = {on_image, on_state_changed, l};
    status code = folder_open(settings->folder, &l->files, why);
    THEN(code, check_results(l, why));
    THEN(code, open_document(l, why));
    THEN(code, render_worker_create(l->scene_document, settings->level, &listener, &l->render_worker, why));
    if (code == STATUS_OK &&
        (!(l->sent = sent_scenes_create()) || !(l->reference_image = reference_image_create()) ||
         !(l->heavy = semaphore_create(HEAVY_AT_ONCE)) || !(l->thumbnails = thumbnails_create(settings->level)) ||
         !(l->pixel_maps = pixel_maps_create(settings->level))))
        code = out_of_memory(why);
    THEN(code, studies_create(l, on_study_end, &l->studies, why));
    THEN(code, rescue_create(l, &l->rescue, why));
    THEN(code, serve(l, why));
    return code;
}

typedef struct starting {
    lab *l;
    diagnostic *why;
    status code;
} starting;

static void *start_confined(void *context)
{
    starting *s = context;
    s->code = lab_confine(s->l, s->why);
    THEN(s->code, start(s->l, s->why));
    return NULL;
}

/* A thread inherits the confinement of the thread that starts it: a new thread confines itself and starts all threads
 * of the laboratory, so that the caller's threads are not confined. */
static status start_in_thread(lab *l, diagnostic *why)
{
    starting s = {l, why, STATUS_OK};
    pthread_t thread;
    if (pthread_create(&thread, NULL, start_confined, &s) != 0)
        return diagnose(why, STATUS_FAILURE, "close other programs, or raise the limit on processes (ulimit -u)",
                        "cannot start the laboratory's threads");
    pthread_join(thread, NULL);
    return s.code;
}

status lab_start(const lab_settings *settings, lab **out, diagnostic *why)
{
    *out = NULL;
    lab *l = calloc(1, sizeof *l);
    if (!l)
        return out_of_memory(why);
    *l = (lab){.settings = *settings,
               .state = state_json,
               .state_lock = PTHREAD_MUTEX_INITIALIZER,
               .publish_lock = PTHREAD_MUTEX_INITIALIZER};
    const status code = settings->confine ? start_in_thread(l, why) : start(l, why);
    if (code == STATUS_OK)
        *out = l;
    else
        lab_stop(l);
    return code;
}

/* The order matters: first stop events, then studies and renders so that no handler waits any more, then the server
 * with its handlers. */
void lab_stop(lab *l)
{
    if (!l)
        return;
    pthread_mutex_lock(&l->publish_lock);
    l->open = false;
    pthread_mutex_unlock(&l->publish_lock);
    if (l->heavy)
        semaphore_close(l->heavy);
    if (l->thumbnails)
        thumbnails_end(l->thumbnails);
    if (l->studies)
        studies_end(l->studies);
    if (l->render_worker)
        render_worker_end(l->render_worker);
    http_stop(l->server);
    rescue_destroy(l->rescue, l->leaves_unsaved);
    studies_destroy(l->studies);
    semaphore_destroy(l->heavy);
    pixel_maps_destroy(l->pixel_maps);
    thumbnails_destroy(l->thumbnails);
    sent_scenes_destroy(l->sent);
    reference_image_destroy(l->reference_image);
    render_worker_destroy(l->render_worker);
    scene_document_destroy(l->scene_document);
    folder_close(l->files);
    lab_remove_temporary(l);
    pthread_mutex_destroy(&l->publish_lock);
    pthread_mutex_destroy(&l->state_lock);
    free(l->bound);
    free(l->routes);
    free(l);
}

void lab_leave_unsaved(lab *l)
{
    l->leaves_unsaved = true;
}

const char *lab_address(const lab *l)
{
    return http_address(l->server);
}

const http_server *lab_server(const lab *l)
{
    return l->server;
}
