/* A render in turns, for scripts: each turn renders tiles for a while, so that the script can show them, be cancelled
 * and do other work in between. The film equals that of cuvette_engine_render, because tiles add exactly. */
#include "base/json_build.h"
#include "engine/engine_private.h"
#include "measure/clock.h"
#include "render/frame/renderer.h"
#include "report/json.h"
#include "scene/model/integrators.h"
#include "scene/model/render_settings.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"
#include "wasm/api/results.h"
#include "wasm/exports.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SIDE_MAX = 32, SIDE_MIN = 4, RAYS_OF_TILE = 4096 };

/* A turn lasts at least this multiple of its preparation, which every turn repeats. */
static const double setup_factor = 3.0;

struct wasm_render {
    cuvette_scene *source; /* refuses changes until the end */
    bool locked;           /* the source refuses changes now */
    scene view;            /* borrows what the source owns */
    job *worker;
    bool at_once; /* the render cannot be divided into turns */
    tiled_frame sum;
    int64_t next, reported; /* the next tile to render; the next that wasm_render_tiles reports */
    ray_counters counters;
    bool has_photons; /* the photons are counted: every turn counts the same ones */
    double until_s, budget_s, wall_s;
    bool began; /* the turn has begun a tile */
    codec_bytes bytes;
};

/* Each turn would trace all photons again; render.error needs the noise of the whole image. */
static bool must_be_undivided(const render_settings *r)
{
    return scene_has_caustics(r) || (r->error > 0.0 && r->integrator == INTEGRATOR_PATH);
}

/* The side of the tiles: smaller with many rays per pixel, so that a tile always takes about the same time. */
static int side_of(const render_settings *r)
{
    const double per_pixel = scene_camera_rays(r) / ((double)r->width * (double)r->height);
    int side = SIDE_MAX;
    while (side > SIDE_MIN && per_pixel * side * side > RAYS_OF_TILE)
        side /= 2;
    return side;
}

static status begin(wasm_render *r, int coarse, diagnostic *why)
{
    const scene *s = r->source->model;
    TRY(engine_check(r->source, why));
    TRY(engine_load(r->source, NULL, why));
    TRY(scene_build_hierarchies(s, why));
    TRY(job_create(&(job_settings){.level = NULL}, &r->worker, why));
    r->view = *s;
    r->view.render.threads = 1;
    r->view.render.width = (s->render.width + coarse - 1) / coarse;
    r->view.render.height = (s->render.height + coarse - 1) / coarse;
    r->at_once = must_be_undivided(&r->view.render);
    codec_bytes_prepare(&r->bytes);
    return tiled_frame_begin(&r->view, side_of(&r->view.render), &r->sum, why);
}

wasm_render *wasm_render_create(cuvette_scene *of, int coarse)
{
    diagnostic why = {.line = 0};
    wasm_render *r = calloc(1, sizeof *r);
    if (!r) {
        results_report(out_of_memory(&why), &why);
        return NULL;
    }
    r->source = of;
    if (results_note(engine_begin_render(of, &results_last)) != CUVETTE_OK) {
        free(r);
        return NULL;
    }
    r->locked = true;
    atomic_fetch_add(&of->owners, 1);
    if (results_report(begin(r, coarse < 1 ? 1 : coarse, &why), &why) != CUVETTE_OK) {
        wasm_render_destroy(r);
        return NULL;
    }
    return r;
}

static void unlock_scene(wasm_render *r)
{
    if (r->locked)
        engine_end_render(r->source);
    r->locked = false;
}

void wasm_render_destroy(wasm_render *r)
{
    if (!r)
        return;
    unlock_scene(r);
    tiled_frame_release(&r->sum);
    job_destroy(r->worker);
    engine_release_scene(r->source);
    free(r);
}

/* --- turns --- */

static int side(const wasm_render *r)
{
    return r->sum.places.tile;
}

static bool next(void *context, int worker, image_tile *out)
{
    wasm_render *r = context;
    (void)worker;
    const double now_s = clock_wall_s();
    if (!r->began) /* the preparation has ended */
        r->until_s = now_s + fmax(r->budget_s, setup_factor * (now_s - r->until_s));
    else if (now_s >= r->until_s)
        return false;
    r->began = true;
    return r->next < r->sum.places.tile_count && schedule_tile(&r->sum.places, r->next, out) && ++r->next;
}

static void done(void *context, const image_tile *rect, const film *rendered, const double *variance)
{
    wasm_render *r = context;
    (void)variance;
    film_store_tile(r->sum.img, rect->x0, rect->y0, rect->x1, rect->y1, rendered->sum);
}

/* Adds the counters of a turn; every turn counts the same photons. */
static void count(wasm_render *r, const ray_counters *turn)
{
    ray_counters c = *turn;
    if (r->has_photons)
        c.photon = 0;
    r->has_photons = true;
    ray_counters_add(&r->counters, &c);
}

static status render_tiles(wasm_render *r, diagnostic *why)
{
    const tile_source source = {.side = side(r), .next = next, .done = done, .context = r};
    const render_options options = {.source = r->at_once ? NULL : &source};
    job_account account;
    r->began = false;
    r->until_s = clock_wall_s();
    const status code = job_render(r->worker, &r->view, &options, &account, why);
    if (code == STATUS_OK) {
        count(r, &account.result->counters);
        if (r->at_once) {
            tiled_frame_release(&r->sum);
            r->sum.img = account.result->img;
            account.result->img = NULL;
            r->next = r->sum.places.tile_count;
        }
    }
    job_account_release(&account);
    return code;
}

int wasm_render_turn(wasm_render *r, double budget_s)
{
    diagnostic why = {.line = 0};
    const double began_s = clock_wall_s();
    r->budget_s = budget_s;
    const status code = r->next < r->sum.places.tile_count ? render_tiles(r, &why) : STATUS_OK;
    r->wall_s += clock_wall_s() - began_s;
    if (code != STATUS_OK || r->next == r->sum.places.tile_count)
        unlock_scene(r);
    return (int)results_report(code, &why);
}

double wasm_render_fraction(const wasm_render *r)
{
    return (double)r->next / (double)r->sum.places.tile_count;
}

/* --- results --- */

char *wasm_render_tiles(wasm_render *r)
{
    json_t *list = json_array();
    image_tile at;
    if (r->at_once && r->reported < r->next) {
        r->reported = r->next;
        json_add(&list, json_pack("[i,i,i,i]", 0, 0, r->sum.img->width, r->sum.img->height));
    }
    for (; r->reported < r->next && schedule_tile(&r->sum.places, r->reported, &at); r->reported++)
        json_add(&list, json_pack("[i,i,i,i]", at.x0, at.y0, at.x1, at.y1));
    return results_text(list);
}

void wasm_render_srgb(const wasm_render *r, int x0, int y0, int x1, int y1, unsigned char *rgba)
{
    const size_t pixels = (size_t)(x1 - x0) * (size_t)(y1 - y0);
    unsigned char *rgb = rgba + pixels; /* at the end; the loop reads a pixel before it overwrites the pixel's bytes */
    canvas_bytes(r->sum.img, &r->bytes, x0, y0, x1, y1, rgb, 3 * (size_t)(x1 - x0));
    for (size_t i = 0; i < pixels; i++) {
        memmove(rgba + 4 * i, rgb + 3 * i, 3);
        rgba[4 * i + 3] = 255;
    }
}

void wasm_render_rgb(const wasm_render *r, float *rgb)
{
    const film *img = r->sum.img;
    film_read(img, 0, 0, img->width, img->height, rgb, 3 * (size_t)img->width);
}

static json_t *throughput(const int64_t units[3])
{
    double v[3];
    for (int i = 0; i < 3; i++)
        v[i] = (double)units[i] / COUNTERS_CUT_ONE;
    return results_vector(v);
}

static json_t *counters_json(const ray_counters *c)
{
    json_t *depths = json_array();
    for (int i = 0; i <= COUNTERS_DEPTH_MAX; i++)
        json_add(&depths, json_integer((json_int_t)c->by_depth[i]));
    return json_pack("{s:I,s:I,s:I,s:I,s:I,s:I,s:I,s:I,s:o,s:o,s:o}", "camera", (json_int_t)c->camera, "reflect",
                     (json_int_t)c->reflect, "refract", (json_int_t)c->refract, "shadow", (json_int_t)c->shadow,
                     "photon", (json_int_t)c->photon, "total_internal", (json_int_t)c->total_internal, "cut_depth",
                     (json_int_t)c->cut_depth, "cut_weight", (json_int_t)c->cut_weight, "cut_depth_throughput",
                     throughput(c->cut_depth_throughput), "cut_weight_throughput", throughput(c->cut_weight_throughput),
                     "by_depth", depths);
}

char *wasm_render_result(const wasm_render *r)
{
    char hash[17];
    snprintf(hash, sizeof hash, "%016" PRIx64, film_hash(r->sum.img));
    return results_text(json_pack("{s:i,s:i,s:s,s:o,s:o}", "width", r->sum.img->width, "height", r->sum.img->height,
                                  "hash", hash, "counters", counters_json(&r->counters), "wall_s",
                                  json_of_real(r->wall_s)));
}
