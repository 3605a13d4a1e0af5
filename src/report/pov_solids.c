/* Textures and solids in POV-Ray's language.
 *
 * POV-Ray keeps a list of the solids that a ray is in. At a surface it refracts from the last entered solid into the
 * next, and not at all where the ray leaves another than the last: an overlap belongs to the solid that is entered
 * last. Our media have priorities instead. So the shape of a clear solid is cut out of all that it displaces, but
 * moved inwards by a thin margin: a ray enters the next solid before it leaves the first, within the margin, and is
 * refracted once, between the right indices. POV-Ray would still reflect a part where the ray leaves the first
 * solid, and computes this part as if the second one began there. This is prevented by an interior_texture, which is
 * clear where the surface lies in the other solid. */
#include "base/array.h"
#include "base/text.h"
#include "geometry/shapes/shape.h"
#include "report/scene_export.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdlib.h>

/* Solids within this fraction of the scene's extent touch. */
#define TOUCHING 1e-9
enum { POV_VERTEX_TEXTURES_MAX = 1 << 15 };

/* How a region is written. */
typedef struct part {
    solid_shape shape;
    bounds3 box;
    double margin;
    bool grows;        /* its surface moves outwards, into a solid that it touches */
    int *cut, *within; /* regions cut out of it; clear ones that it may reach into */
    size_t cut_count, within_count;
    const shading_material *texture; /* of Texture_NUMBER, if shared */
    int number;
} part;

typedef struct solids {
    pov to;
    part *parts; /* by region */
    int textures;
} solids;

/* The number of a texture's entry in the scene, -1: none, or its file cannot be read by POV-Ray. */
static int entry_of(const solids *v, const shading_material *m)
{
    const scene *s = v->to.w->s;
    for (size_t i = 0; m->img && i < s->texture_count; i++)
        if (s->textures[i].data == m->img && pov_image_word(s->textures[i].path))
            return (int)i;
    return -1;
}

/* --- textures --- */

/* What of a clear surface's own light is left: POV-Ray multiplies it by the opacity. */
static double own_light(const solids *v, int r, const material *m, double k)
{
    if (!export_is_clear(v->to.w, r) || k == 0.0)
        return k;
    if (m->transparency < 1.0)
        return k / (1.0 - m->transparency);
    export_note(v->to.w->notes, export_name(v->to.w, r), "a surface that lets all light through has no matte light");
    return 0.0;
}

static void put_reflection(const solids *v, int r, const material *m)
{
    const render_settings *s = &v->to.w->s->render;
    FILE *out = v->to.out;
    if (!export_has_branches(v->to.w->s))
        return;
    if (v->to.w->p->layered && v->to.w->p->layered->surface[r] && !export_is_clear(v->to.w, r)) {
        fputs(" reflection { ", out);
        pov_color(&v->to, export_layered_color(v->to.w, r));
        fputs(" }", out);
    } else if (export_is_clear(v->to.w, r) && !scene_has_constant_weights(s)) {
        if (m->reflectivity > 0.0)
            export_note(v->to.w->notes, export_name(v->to.w, r),
                        "a half mirror does not dim the shadow of a clear solid");
        pov_named(&v->to, "reflection {",
                  m->reflectivity); /* a half mirror reflects a fraction of what the interface lets in */
        fputs(", 1 fresnel on } conserve_energy", out);
    } else if (m->reflectivity > 0.0) {
        pov_named(&v->to, "reflection {", m->reflectivity);
        fputs(" }", out);
    }
}

static void put_finish(const solids *v, int r, const shading_material *sm)
{
    const material *m = &sm->surface;
    const bool shines = v->to.w->s->render.lighting != LIGHTING_LAMBERT && m->specular > 0.0;
    fputs(" finish {", v->to.out);
    pov_named(&v->to, "ambient", own_light(v, r, m, m->ambient));
    pov_named(&v->to, "diffuse", own_light(v, r, m, m->diffuse));
    if (shines) {
        pov_named(&v->to, "phong", m->specular);
        pov_named(&v->to, "phong_size", m->shininess);
    }
    if (m->emission > 0.0 && !sm->glows)
        pov_named(&v->to, "emission", v->to.gain * own_light(v, r, m, m->emission));
    if (sm->glows && sm->surface.color.x > 0.0 && sm->surface.color.y > 0.0 && sm->surface.color.z > 0.0) {
        const vec3 c = sm->surface.color, e = vec3_scale(sm->glow, v->to.gain * m->emission);
        fputs(" emission ", v->to.out);
        pov_color(&v->to, vec3_make(e.x / c.x, e.y / c.y, e.z / c.z));
    } else if (sm->glows) {
        export_note(v->to.w->notes, export_name(v->to.w, r), "a black surface does not glow");
    }
    put_reflection(v, r, m);
    fputs(" }", v->to.out);
}

/* A colour, with what the surface lets through. */
static void put_plain(const solids *v, vec3 c, double transparency)
{
    if (transparency == 0.0) {
        pov_color(&v->to, c);
        return;
    }
    const double n[4] = {c.x, c.y, c.z, transparency};
    for (int k = 0; k < 4; k++) {
        fputs(k ? ", " : "rgbt <", v->to.out);
        pov_number(v->to.out, n[k]);
    }
    putc('>', v->to.out);
}

static status put_image_of(const solids *v, int r, const shading_material *sm, int entry)
{
    const solid_shape *shape = &v->parts[r].shape;
    const bool on_mesh = shape_of(shape)->triangles;
    char name[32];
    snprintf(name, sizeof name, "Image_%d", entry + 1);
    if (on_mesh) {
        pov_image_pigment(&v->to, name, "x", "y", sm->surface.color, 1.0);
        return STATUS_OK;
    }
    text_writer u, w;
    char *at_u = NULL, *at_v = NULL;
    TRY(text_writer_open(&u, v->to.why));
    status code = text_writer_open(&w, v->to.why);
    if (code != STATUS_OK) {
        text_writer_abandon(&u);
        return code;
    }
    const bool said = pov_mapping(shape, sm->surface.texture_size, u.stream, w.stream);
    code = text_writer_end(&u, STATUS_OK, &at_u, NULL, v->to.why);
    const status other = text_writer_end(&w, STATUS_OK, &at_v, NULL, v->to.why);
    if (code == STATUS_OK && other == STATUS_OK && said)
        pov_image_pigment(&v->to, name, at_u, at_v, sm->surface.color, 1.0);
    else if (!said) {
        export_note(v->to.w->notes, export_name(v->to.w, r), "an image on this shape is left out");
        put_plain(v, sm->surface.color, 0.0);
    }
    free(at_u);
    free(at_v);
    return code == STATUS_OK ? other : code;
}

/* A chequer's cells are a millionth larger, so that faces at a multiple of their size lie in the cell inside. */
static status put_pigment(const solids *v, int r, const shading_material *sm)
{
    const material *m = &sm->surface;
    const double through = export_is_clear(v->to.w, r) ? m->transparency : 0.0;
    const int entry = entry_of(v, sm);
    const bool partial = shading_material_is_partial(sm);
    if (sm->img && entry < 0)
        export_note(v->to.w->notes, export_name(v->to.w, r), "an image inside a mesh file is left out");
    if (partial)
        export_note(v->to.w->notes, export_name(v->to.w, r), "the alpha of an image is left out: the surface is whole");
    fprintf(v->to.out, "pigment { %s", entry >= 0 && shape_of(&v->parts[r].shape)->triangles ? "uv_mapping " : "");
    if (entry >= 0) {
        TRY(put_image_of(v, r, sm, entry));
    } else if (m->checker > 0.0) {
        fputs("checker ", v->to.out);
        put_plain(v, m->color, through);
        putc(' ', v->to.out);
        put_plain(v, m->checker_color, through);
        pov_named(&v->to, "scale", m->checker * (1.0 + 1e-6));
    } else {
        put_plain(v, m->color, through);
    }
    fputs(" }", v->to.out);
    return STATUS_OK;
}

static status put_texture(const solids *v, int r, const shading_material *sm)
{
    fputs("texture { ", v->to.out);
    TRY(put_pigment(v, r, sm));
    put_finish(v, r, sm);
    fputs(" }", v->to.out);
    return STATUS_OK;
}

/* Whether the texture depends on the region's shape. */
static bool has_own_texture(const solids *v, int r)
{
    return v->to.w->p->shading_materials[r].mat->img != NULL;
}

static status declare_textures(solids *v)
{
    for (int r = 1; r <= v->to.g->region_count; r++) {
        part *one = &v->parts[r];
        const shading_material *m = v->to.w->p->shading_materials[r].mat;
        one->texture = m;
        for (int other = r - 1; other > 0 && !one->number && !has_own_texture(v, r); other--)
            if (v->parts[other].texture == m && export_is_clear(v->to.w, r) == export_is_clear(v->to.w, other))
                one->number = v->parts[other].number;
        if (one->number)
            continue;
        one->number = ++v->textures;
        fprintf(v->to.out, "#declare Texture_%d = // %s\n  ", one->number, export_name(v->to.w, r));
        TRY(put_texture(v, r, m));
        putc('\n', v->to.out);
    }
    putc('\n', v->to.out);
    return STATUS_OK;
}

/* --- which solids meet --- */

static bool add_number(int **list, size_t *count, int number)
{
    if (!room_for_one(list, *count, sizeof **list))
        return false;
    (*list)[(*count)++] = number;
    return true;
}

static bool apart(bounds3 a, bounds3 b, double by)
{
    return a.low.x > b.high.x + by || b.low.x > a.high.x + by || a.low.y > b.high.y + by || b.low.y > a.high.y + by ||
           a.low.z > b.high.z + by || b.low.z > a.high.z + by;
}

/* `high` displaces `low` where they overlap. */
static status meet(solids *v, int low, int high)
{
    part *a = &v->parts[low], *b = &v->parts[high];
    const bool low_clear = export_is_clear(v->to.w, low), high_clear = export_is_clear(v->to.w, high);
    const double near = TOUCHING * v->to.g->extent;
    if ((!low_clear && !high_clear) || apart(a->box, b->box, near))
        return STATUS_OK;
    const double gap = export_gap(&a->shape, &b->shape);
    if (gap > near)
        return STATUS_OK;
    if (gap >= -near)
        (high_clear ? b : a)->grows = true;
    if (!high_clear || (gap >= -near && !low_clear)) /* the opaque surface is in the clear solid, and met first */
        return STATUS_OK;
    const bool cuts = pov_shape_can_inset(&b->shape);
    bool room = add_number(&a->cut, &a->cut_count, cuts ? high : -high);
    if (low_clear)
        room &= add_number(&b->within, &b->within_count, low);
    if (!cuts)
        export_note(
            v->to.w->notes, export_name(v->to.w, high),
            "this shape is not cut out of the solids that it displaces: the overlap belongs to the solid that a "
            "ray enters last");
    if (!cuts && low_clear)
        room &= add_number(&a->within, &a->within_count, high);
    return room ? STATUS_OK : out_of_memory(v->to.why);
}

static status find_meetings(solids *v)
{
    const double margin = pov_margin(v->to.w->p);
    for (int r = 1; r <= v->to.g->region_count; r++) {
        part *one = &v->parts[r];
        one->shape = scene_geometry_shape(v->to.g, r);
        const shape_rule *rule = shape_of(&one->shape);
        one->box = shape_world_box(&one->shape);
        one->margin = fmin(margin, rule->thickness ? shape_thickness(&one->shape) / 8.0 : margin);
    }
    for (int r = 1; r <= v->to.g->region_count; r++) /* each pair with a clear solid once */
        for (int other = 1; other <= v->to.g->region_count && export_is_clear(v->to.w, r); other++)
            if (other < r || (other > r && !export_is_clear(v->to.w, other)))
                TRY(meet(v, other < r ? other : r, other < r ? r : other));
    return STATUS_OK;
}

/* --- solids --- */

static status put_shape(const solids *v, int r, double inset)
{
    bool exact = true;
    TRY(pov_shape_write(&v->parts[r].shape, inset, v->to.out, &exact, v->to.why));
    if (!exact)
        export_note(v->to.w->notes, export_name(v->to.w, r), "the curved sides of this shape are triangles");
    return STATUS_OK;
}

/* A solid that grows does so by two margins, and what it displaces begins one margin inside of it, which is beyond the
 * faces that it had in common with others. */
static double outset(const part *p)
{
    return p->grows ? -2.0 * p->margin : 0.0;
}

static double cut_inset(const part *p)
{
    return outset(p) + p->margin;
}

static void put_mesh_name(const solids *v, int r)
{
    fprintf(v->to.out, "Mesh_%d", r);
}

/* The triangles of a mesh, or the shape, in its own frame. */
static status put_body(const solids *v, int r, double inset)
{
    if (!shape_of(&v->parts[r].shape)->triangles)
        return put_shape(v, r, inset);
    fputs("object { ", v->to.out);
    put_mesh_name(v, r);
    fputs(" }", v->to.out);
    return STATUS_OK;
}

/* The scale of a mesh, and where the shape is. */
static void put_place(const solids *v, int r)
{
    const solid_shape *s = &v->parts[r].shape;
    if (shape_of(s)->triangles && (s->scale.x != 1.0 || s->scale.y != 1.0 || s->scale.z != 1.0)) {
        fputs(" scale ", v->to.out);
        pov_vector(v->to.out, s->scale);
    }
    if (shape_of(s)->triangles && s->copies.x * s->copies.y * s->copies.z > 1.0) {
        fputs(" translate <I, J, K>*", v->to.out);
        pov_vector(v->to.out, s->spacing);
    }
    pov_placement_write(s, v->to.out);
}

/* Where the surface lies in a clear solid into which the region's rays go on, they have entered that solid already. */
static status put_interior_texture(const solids *v, int r)
{
    const part *p = &v->parts[r];
    if (p->within_count == 0)
        return STATUS_OK;
    fputs("\n    interior_texture {", v->to.out);
    for (size_t i = 0; i < p->within_count; i++) {
        const int other = p->within[i];
        fprintf(v->to.out, "%s object { object { ", i ? "texture {" : "");
        TRY(put_body(v, other, outset(&v->parts[other])));
        put_place(v, other);
        fputs(" }", v->to.out);
    }
    fprintf(v->to.out, " texture { Texture_%d }", p->number);
    for (size_t i = 0; i < p->within_count; i++)
        fprintf(v->to.out, ", texture { Pass } }%s", i + 1 < p->within_count ? " }" : "");
    fputs(" }", v->to.out);
    return STATUS_OK;
}

/* The absorption of a medium in 1 / scene unit. */
static void put_interior(const solids *v, int r)
{
    const plan *p = v->to.w->p;
    const vec3 a = p->absorption[r];
    if (!export_is_clear(v->to.w, r))
        return;
    pov_named(&v->to, "\n  interior { ior",
              v->to.w->s->render.transmission == TRANSMISSION_SIMPLE ? 1.0 : p->ior[r] / p->ior[0]);
    if (a.x > 0.0 || a.y > 0.0 || a.z > 0.0) {
        fputs(" media { absorption ", v->to.out);
        pov_color(&v->to, a);
        fputs(" method 2 intervals 1 samples 1, 1 }", v->to.out);
    }
    fputs(" } hollow", v->to.out);
}

/* What a clear solid takes away from this one has the surface of the solid that owns the interface: the clear one, but
 * of an opaque solid its own. */
static status put_cut(const solids *v, int r, int high)
{
    fputs("\n  object { ", v->to.out);
    TRY(put_shape(v, high, cut_inset(&v->parts[high])));
    pov_placement_write(&v->parts[high].shape, v->to.out);
    if (export_is_clear(v->to.w, r)) {
        fprintf(v->to.out, "\n    texture { Texture_%d } interior_texture { Pass }", v->parts[high].number);
    } else {
        fprintf(v->to.out, "\n    texture { Texture_%d", v->parts[r].number);
        pov_placement_write(&v->parts[r].shape, v->to.out);
        fputs(" }", v->to.out);
    }
    fputs(" }", v->to.out);
    return STATUS_OK;
}

static size_t real_cuts(const part *p)
{
    size_t count = 0;
    for (size_t i = 0; i < p->cut_count; i++)
        count += p->cut[i] > 0;
    return count;
}

static status put_solid(const solids *v, int r, bool textured)
{
    const part *p = &v->parts[r];
    const size_t cuts = real_cuts(p);
    fprintf(v->to.out, "%s { // %s\n  ", cuts ? "difference" : "object", export_name(v->to.w, r));
    if (cuts)
        fputs("object { ", v->to.out);
    TRY(put_body(v, r, outset(p)));
    if (!textured)
        fprintf(v->to.out, "\n    texture { Texture_%d }", p->number);
    put_place(v, r);
    TRY(put_interior_texture(v, r));
    if (cuts)
        fputs(" }", v->to.out);
    for (size_t i = 0; i < p->cut_count; i++)
        if (p->cut[i] > 0)
            TRY(put_cut(v, r, p->cut[i]));
    put_interior(v, r);
    fprintf(v->to.out, "%s\n}\n", v->to.w->s->render.shadows == SHADOWS_OFF ? " no_shadow" : "");
    return STATUS_OK;
}

/* --- meshes --- */

/* The textures of a mesh's slots, or of its vertices, for a texture_list. */
static status texture_list(const solids *v, int r, const mesh *m, bool by_vertex, FILE *to)
{
    const region_materials *of = &v->to.w->p->shading_materials[r];
    solids inside = *v;
    inside.to.out = to;
    const size_t count = by_vertex ? m->vertex_count : (size_t)of->count;
    fprintf(to, "  texture_list { %zu", count);
    for (size_t i = 0; i < count; i++) {
        shading_material one = of->mat[by_vertex ? 0 : i];
        if (by_vertex) {
            const float *c = m->colors[i];
            one.surface.color = vec3_make(one.surface.color.x * (double)c[0], one.surface.color.y * (double)c[1],
                                          one.surface.color.z * (double)c[2]);
        }
        fputs(",\n    ", to);
        TRY(put_texture(&inside, r, &one));
    }
    fputs(" }\n", to);
    return STATUS_OK;
}

static void note_mesh(const solids *v, int r, const mesh *m)
{
    const region_materials *of = &v->to.w->p->shading_materials[r];
    const char *name = export_name(v->to.w, r);
    if (!m->single)
        export_note(v->to.w->notes, name, "the vertices of a mesh have single precision");
    if (of->shading == SHADING_GOURAUD)
        export_note(v->to.w->notes, name, "Gouraud's shading is left out: normals are interpolated");
    if (!m->closed && export_is_clear(v->to.w, r))
        export_note(v->to.w->notes, name, "a clear mesh that is not closed has no inside: its light is not right");
    if (of->mat->vertex_colors && (of->count > 1 || m->vertex_count > POV_VERTEX_TEXTURES_MAX))
        export_note(v->to.w->notes, name, "the colours of the vertices are left out");
}

/* Declares the triangles of a region's mesh; *textured: with its textures. */
static status declare_mesh(const solids *v, int r, bool *textured)
{
    const mesh *m = v->parts[r].shape.mesh;
    const region_materials *of = &v->to.w->p->shading_materials[r];
    const bool by_vertex = of->mat->vertex_colors && of->count == 1 && m->vertex_count <= POV_VERTEX_TEXTURES_MAX,
               by_slot = of->count > 1;
    text_writer to;
    char *head = NULL;
    note_mesh(v, r, m);
    TRY(text_writer_open(&to, v->to.why));
    const status code = by_vertex || by_slot ? texture_list(v, r, m, by_vertex, to.stream) : STATUS_OK;
    TRY(text_writer_end(&to, code, &head, NULL, v->to.why));
    fputs("#declare ", v->to.out);
    put_mesh_name(v, r);
    fputs(" = ", v->to.out);
    pov_mesh_write(m, of->shading != SHADING_FLAT, head, by_slot, by_vertex, v->to.out);
    putc('\n', v->to.out);
    free(head);
    *textured = by_vertex || by_slot;
    return STATUS_OK;
}

/* Copies of a mesh are written as loops. */
static status put_mesh_solid(const solids *v, int r, bool textured)
{
    const vec3 n = v->parts[r].shape.copies;
    const bool many = n.x * n.y * n.z > 1.0;
    if (many)
        fprintf(v->to.out, "#for (I, 0, %.0f)\n#for (J, 0, %.0f)\n#for (K, 0, %.0f)\n", n.x - 1.0, n.y - 1.0,
                n.z - 1.0);
    TRY(put_solid(v, r, textured));
    if (many)
        fputs("#end\n#end\n#end\n", v->to.out);
    return STATUS_OK;
}

static status put_all(solids *v)
{
    TRY(find_meetings(v));
    TRY(declare_textures(v));
    bool *textured = calloc((size_t)v->to.g->region_count + 1, sizeof *textured);
    status code = textured ? STATUS_OK : out_of_memory(v->to.why);
    for (int r = 1; r <= v->to.g->region_count && code == STATUS_OK; r++)
        if (shape_of(&v->parts[r].shape)->triangles)
            code = declare_mesh(v, r, &textured[r]);
    for (int r = 1; r <= v->to.g->region_count && code == STATUS_OK; r++)
        code = put_mesh_solid(v, r, textured[r]);
    free(textured);
    return code;
}

status pov_solids_write(const pov *to)
{
    const size_t regions = (size_t)to->g->region_count + 1;
    solids v = {.to = *to, .parts = calloc(regions, sizeof *v.parts)};
    const status code = v.parts ? put_all(&v) : out_of_memory(to->why);
    for (size_t r = 0; v.parts && r < regions; r++) {
        free(v.parts[r].cut);
        free(v.parts[r].within);
    }
    free(v.parts);
    return code;
}
