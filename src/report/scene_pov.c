/* A scene in POV-Ray 3.7's language (its reference manual, sections 3.3 to 3.7; what its words compute was read in its
 * source, backend/render/trace.cpp): camera, sky, lights; solids are in pov_solids.c. */
#include "base/array.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "report/scene_export.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { POV_LEVELS_MAX = 256 };

/* In a text of the language. */
static void put_text(const pov *v, const char *text)
{
    putc('"', v->out);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\')
            putc('\\', v->out);
        putc(*text, v->out);
    }
    putc('"', v->out);
}

/* --- settings, camera --- */

static void note_settings(const export_work *w)
{
    const render_settings *r = &w->s->render;
    export_notes *n = w->notes;
    const bool branches = export_has_branches(w->s);
    if (branches && r->beyond != DEPTH_LIMIT_BLACK)
        export_note(n, "render.beyond", "beyond the depth limit is black");
    if (branches && r->depth >= POV_LEVELS_MAX)
        export_note(n, "render.depth", "rays end after 255 surfaces");
    if (branches && r->weights == WEIGHTS_CONSTANT)
        export_note(n, "render.weights", "with constant weights, total reflection reflects all of the light");
    if (branches && r->min_weight > 0.0)
        export_note(n, "render.min_weight", "branches are cut by adc_bailout, which also cuts the light of textures");
    if (r->shadows == SHADOWS_OPAQUE)
        export_note(n, "render.shadows", "clear solids do not block light");
    export_note(
        n, NULL,
        "POV-Ray's tolerances are lengths, from 1e-6 to 1e-3 scene units: surfaces closer than that are missed, "
        "and media that touch or overlap meet in a margin of %g",
        pov_margin(w->p));
}

static void put_settings(const pov *v)
{
    const render_settings *r = &v->w->s->render;
    const bool branches = export_has_branches(v->w->s);
    const int64_t levels = branches && r->depth < POV_LEVELS_MAX ? r->depth + 1 : branches ? POV_LEVELS_MAX : 1;
    fprintf(v->out, "#version 3.7;\nglobal_settings {\n  assumed_gamma 1\n  max_trace_level %d\n  adc_bailout ",
            (int)levels);
    pov_number(v->out, r->min_weight);
    fputs("\n  ambient_light ", v->out);
    pov_light(v, v->w->s->background.ambient);
    fputs("\n}\n#default { finish { ambient 0 diffuse 0 } }\n", v->out);
    fputs("#declare Pass = texture { pigment { rgbt 1 } finish { ambient 0 diffuse 0 } }\n\n", v->out);
}

static void put_lens(const pov *v)
{
    const camera_frame *f = &v->w->p->view;
    if (!camera_lens_is_sampled(v->w->s))
        return;
    if (f->parallel) {
        export_note(v->w->notes, "camera.aperture", "an orthographic camera has no lens: everything is in focus");
        return;
    }
    export_note(v->w->notes, "camera.aperture", "rays are spread over the lens and the pixel by another pattern");
    pov_named(v, "\n  aperture", 2.0 * f->lens_radius);
    fputs(" focal_point ", v->out);
    pov_vector(v->out, vec3_add(f->eye, vec3_scale(f->forward, f->focus)));
    fprintf(v->out, " blur_samples %d variance 0", (int)v->w->s->render.samples);
}

static void put_camera(const pov *v)
{
    const camera_frame *f = &v->w->p->view;
    fprintf(v->out, "camera {\n  %slocation ", f->parallel ? "orthographic " : "");
    pov_vector(v->out, f->eye);
    fputs("\n  direction ", v->out);
    pov_vector(v->out, f->forward);
    fputs("\n  right ", v->out);
    pov_vector(v->out, vec3_scale(f->right, 2.0 * f->half_width));
    fputs("\n  up ", v->out);
    pov_vector(v->out, vec3_scale(f->up, 2.0 * f->half_height));
    put_lens(v);
    fputs("\n}\n\n", v->out);
}

/* --- images --- */

/* image_map { png "PATH" gamma srgb interpolate 2 } */
static status put_image_map(const pov *v, const char *path, bool encoded, bool smooth)
{
    char *moved = NULL;
    TRY(write_moved_path(path, scene_path(v->w->s), v->w->path, &moved, v->why));
    fprintf(v->out, "image_map { %s ", pov_image_word(path));
    put_text(v, moved);
    fprintf(v->out, " gamma %s%s }", encoded ? "srgb" : "1.0", smooth ? " interpolate 2" : "");
    free(moved);
    return STATUS_OK;
}

/* Declares a function of u and v with the image's colour. Outside of the unit square an image repeats, is mirrored, or
 * goes on with its edge: its outermost texels are there half a texel inside. */
static status declare_image(const pov *v, const char *name, const char *path, bool encoded, int64_t filter,
                            const int64_t wrap[2], const int size[2])
{
    fprintf(v->out, "#declare %s_map = pigment { ", name);
    TRY(put_image_map(v, path, encoded, filter != TEXTURE_NEAREST));
    fprintf(v->out, " }\n#declare %s_at = function { pigment { %s_map } }\n", name, name);
    static const char *const channels[] = {"red", "green", "blue"};
    for (int c = 0; c < 3; c++) {
        fprintf(v->out, "#declare %s_%s = function(x, y, z) { %s_at(", name, channels[c], name);
        for (int k = 0; k < 2; k++) {
            const char letter = "xy"[k];
            if (wrap[k] != TEXTURE_REPEAT)
                fprintf(v->out, "min(max(");
            if (wrap[k] == TEXTURE_CLAMP)
                fprintf(v->out, "%c", letter);
            else if (wrap[k] == TEXTURE_MIRROR)
                fprintf(v->out, "1 - abs(%c - 2*floor(%c/2) - 1)", letter, letter);
            else
                fprintf(v->out, "%c - floor(%c)", letter, letter);
            if (wrap[k] != TEXTURE_REPEAT)
                fprintf(v->out, ", 0.5/%d), 1 - 0.5/%d)", size[k], size[k]);
            fputs(", ", v->out);
        }
        fprintf(v->out, "0).%s }\n", channels[c]);
    }
    return STATUS_OK;
}

static status put_images(const pov *v)
{
    const scene *s = v->w->s;
    for (size_t i = 0; i < s->texture_count; i++) {
        const texture_entry *t = &s->textures[i];
        const int64_t wrap[2] = {t->wrap_u, t->wrap_v};
        int size[2];
        char name[32];
        snprintf(name, sizeof name, "Image_%zu", i + 1);
        if (!pov_image_word(t->path)) {
            export_note(v->w->notes, t->name, "POV-Ray does not read images of this format: convert it to PNG");
            continue;
        }
        if (t->filter == TEXTURE_TRILINEAR)
            export_note(v->w->notes, t->name, "images have no smaller levels: the filter is bilinear");
        texture_size(t->data, &size[0], &size[1]);
        fprintf(v->out, "// %s\n", t->name);
        TRY(declare_image(v, name, t->path, t->space == TEXTURE_SRGB, t->filter, wrap, size));
        putc('\n', v->out);
    }
    return STATUS_OK;
}

/* --- sky --- */

static double brightest(const image *img)
{
    float most = 1.0F;
    for (size_t i = 0; i < 3 * (size_t)img->width * (size_t)img->height; i++)
        most = fmaxf(most, img->pixel[i]);
    return (double)most;
}

static status put_image_sky(const pov *v, const background *b)
{
    static const int64_t wrap[2] = {TEXTURE_REPEAT, TEXTURE_CLAMP};
    const double gain = v->gain * b->brightness;
    TRY(declare_image(v, "Sky", b->image_path, true, TEXTURE_BILINEAR, wrap,
                      (const int[]){b->img->width, b->img->height}));
    fputs("sky_sphere {\n  pigment {\n    ", v->out);
    pov_image_pigment(v, "Sky", "0.5 + atan2(x, z)/(2*pi)", "0.5 + atan2(y, sqrt(x*x + z*z))/pi",
                      vec3_make(gain, gain, gain), brightest(b->img));
    fputs("\n  }\n}\n\n", v->out);
    return STATUS_OK;
}

static status put_sky(const pov *v)
{
    const background *b = &v->w->s->background;
    const bool gradient = b->kind == BACKGROUND_GRADIENT || b->kind == BACKGROUND_RAIN;
    if (b->kind == BACKGROUND_IMAGE && b->img && pov_image_word(b->image_path))
        return put_image_sky(v, b);
    if (b->kind == BACKGROUND_IMAGE)
        export_note(v->w->notes, "background.image", "POV-Ray does not read images of this format: convert it to PNG");
    if (b->kind == BACKGROUND_RAIN)
        export_note(v->w->notes, "background.kind", "rain is left out; its sky is a gradient");
    if (b->kind == BACKGROUND_CIE)
        export_note(v->w->notes, "background.kind", "a CIE sky is left out; the sky has the colour of its zenith");
    if (gradient) {
        fputs("sky_sphere {\n  pigment { function { min(max(y, 0), 1) } color_map { [0 ", v->out);
        pov_light(v, b->horizon);
        fputs("] [1 ", v->out);
        pov_light(v, b->color);
        fputs("] } }\n}\n\n", v->out);
    } else {
        fputs("background { ", v->out);
        pov_light(v, b->color);
        fputs(" }\n\n", v->out);
    }
    return STATUS_OK;
}

/* --- lights --- */

/* The half-angle of the cone, and how the light falls within it: by the cosine to the power `tightness`. A soft cone is
 * linear in the cosine; POV-Ray's is a cubic, but of 90 degrees it is the cosine itself in both. */
static void put_cone(const pov *v, const light *l)
{
    const bool lambert = light_is_flat(l), soft = lambert || l->kind == LIGHT_SOFT_CONE;
    const double angle = lambert ? 90.0 : l->half_angle_deg;
    if (angle > 90.0) {
        if (soft || angle < 180.0)
            export_note(v->w->notes, l->name, "a cone of more than 90 degrees shines in all directions");
        return;
    }
    if (soft && angle < 90.0)
        export_note(v->w->notes, l->name, "the light of a soft cone falls by a cubic, not linearly in the cosine");
    pov_named(v, "\n  spotlight radius", soft && angle < 90.0 ? 0.0 : angle);
    pov_named(v, "falloff", angle);
    fprintf(v->out, " tightness %d point_at ", soft && angle == 90.0 ? 1 : 0);
    pov_vector(v->out, l->target);
}

/* POV-Ray's factor is 2 / (1 + (d / f)^2): with f far below the reach it is (f / d)^2 times 2. */
#define FADE_SHARE 1e-4

static vec3 emitted(const light *l)
{
    const double share = l->reach > 0.0 && l->kind != LIGHT_SUN ? 0.5 / (FADE_SHARE * FADE_SHARE) : 1.0;
    return vec3_scale(l->color, l->intensity * share);
}

static void put_area(const pov *v, const light *l)
{
    const export_work *w = v->w;
    const double size = l->kind == LIGHT_SUN ? 0.0 : light_extent(l);
    if (!scene_has_soft_shadows(&w->s->render) && !integrator_traits_of(&w->s->render)->by_chance)
        return;
    if (l->kind == LIGHT_SUN && l->angular_diameter_deg > 0.0)
        export_note(w->notes, l->name, "the sun has no size");
    if (size == 0.0)
        return;
    export_note(w->notes, l->name, "the area of a light is sampled at 16 x 16 points, without regard to its direction");
    if (!light_is_flat(l)) {
        pov_named(v, "\n  area_light x*", 2.0 * size);
        pov_named(v, ", y*", 2.0 * size);
        fputs(", 16, 16 circular orient", v->out);
        return;
    }
    const lamp_shape shape = lamp_shape_of(l);
    fputs("\n  area_light ", v->out);
    pov_vector(v->out, vec3_scale(shape.right, 2.0 * shape.half_width));
    fputs(", ", v->out);
    pov_vector(v->out, vec3_scale(shape.up, 2.0 * shape.half_height));
    fprintf(v->out, ", 16, 16%s", shape.round ? " circular" : "");
}

static void put_lamp(const pov *v, const light *l, const light *given)
{
    const double far = 1e3 * (1.0 + v->g->extent);
    const bool sun = l->kind == LIGHT_SUN;
    const vec3 at = sun ? vec3_scale(vec3_normalize(l->position), far) : l->position;
    fprintf(v->out, "light_source { // %s\n  ", given->name);
    pov_vector(v->out, at);
    putc(' ', v->out);
    pov_light(v, emitted(l));
    if (sun)
        fputs("\n  parallel point_at 0", v->out);
    else if (light_has_cone(l))
        put_cone(v, l);
    put_area(v, given);
    if (l->reach > 0.0 && !sun)
        pov_named(v, "\n  fade_power 2 fade_distance", FADE_SHARE * l->reach);
    fputs("\n}\n\n", v->out);
}

/* --- the scene --- */

status pov_scene_write(const export_work *w, FILE *out, diagnostic *why)
{
    const pov v = {w, w->p->geometry, exp2(w->s->camera.exposure), out, why};
    note_settings(w);
    put_settings(&v);
    put_camera(&v);
    TRY(put_sky(&v));
    for (int i = 0; i < w->p->light_count; i++)
        put_lamp(&v, &w->p->lights[i], &w->s->lights[i]);
    TRY(put_images(&v));
    return pov_solids_write(&v);
}
