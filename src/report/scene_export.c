/* Exports of scenes: notes on parameters that are set and not said, and the file. */
#include "report/scene_export.h"
#include "base/text.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"

#include <stdlib.h>
#include <string.h>

/* --- notes on parameters that are set --- */

typedef struct walk {
    const scene *s;
    export_format format;
    export_notes *notes;
} walk;

/* Whether a solid has the value from its material, which has a note of its own. */
static bool is_of_material(const scene *s, const param_place *at)
{
    const int index =
        at->object_group == PARAM_SOLID && at->row->group == PARAM_MATERIAL ? s->solids[at->index].material_index : -1;
    return index >= 0 && param_values_match(at->row, &s->solids[at->index].surface, &s->materials[index].value);
}

static status visit(void *context, const param_place *at)
{
    walk *w = context;
    bool known;
    const char *reason = export_reason(at->row, w->format, &known);
    if (!reason || !reason[0] || is_of_material(w->s, at))
        return STATUS_OK;
    char *value = param_place_text(w->s, at), *fallback = param_default_text(at->row);
    const bool is_set = value && fallback && strcmp(value, fallback) != 0;
    char *path =
        is_set ? text_format("%s.%s", param_place_group_name(w->s, at->object_group, at->index), at->row->name) : NULL;
    const status code = value && fallback && (path || !is_set) ? STATUS_OK : out_of_memory(NULL);
    if (path)
        export_note(w->notes, path, "%s", reason);
    free(path);
    free(value);
    free(fallback);
    return code;
}

static status note_parameters(const scene *s, export_format format, export_notes *notes)
{
    walk w = {s, format, notes};
    status code = STATUS_OK;
    for (int group = 0; group < PARAM_GROUP_COUNT && code == STATUS_OK; group++)
        code = param_place_each(s, (param_group)group, visit, &w);
    return code;
}

/* --- the scene --- */

/* Notes for all formats. */
static void note_scene(const export_work *w)
{
    const scene_geometry *g = w->p->geometry;
    for (int r = 1; r <= g->region_count; r++)
        if (w->p->layered && w->p->layered->surface[r] && export_has_branches(w->s))
            export_note(w->notes, export_name(w, r),
                        "a metal or a film reflects at all angles as at normal incidence, in three channels");
}

/* Writes "// TEXT" with the notes; a comment ends with its line. */
static void put_head(const scene *s, const export_notes *n, char *const *texts, FILE *out)
{
    fputs("// ", out);
    for (const char *c = s->title[0] ? s->title : "A scene without a title"; *c; c++)
        putc((unsigned char)*c < ' ' ? ' ' : *c, out);
    fprintf(out, "\n//\n// Exported by Cuvette. To render it with POV-Ray 3.7, in its folder, FILE being its name:\n");
    int side = 1;
    while ((side + 1) * (side + 1) <= (int)s->render.samples)
        side++;
    fprintf(out, "//   povray +IFILE +OFILE.png +W%d +H%d +FN8 File_Gamma=sRGB -D -J %s", (int)s->render.width,
            (int)s->render.height, side > 1 ? "+A0 +AM1 " : "-A\n");
    if (side > 1)
        fprintf(out, "+R%d\n", side);
    fprintf(out, "//\n// %s\n",
            n->count ? "What POV-Ray cannot say, or says otherwise:" : "POV-Ray can say all of it.");
    for (size_t i = 0; i < n->count; i++) {
        fputs("// - ", out);
        for (const char *c = texts[i]; *c; c++)
            putc((unsigned char)*c < ' ' ? ' ' : *c, out);
        putc('\n', out);
    }
    putc('\n', out);
}

static status take_notes(const export_notes *n, scene_export *out, diagnostic *why)
{
    if (n->failed || !(out->notes = calloc(n->count + 1, sizeof *out->notes)))
        return out_of_memory(why);
    for (; out->note_count < n->count; out->note_count++)
        if (!(out->notes[out->note_count] = export_note_text(n, out->note_count, why)))
            return out_of_memory(why);
    return STATUS_OK;
}

static status write_pov(const export_work *w, scene_export *out, diagnostic *why)
{
    text_writer body, all;
    char *text = NULL;
    TRY(text_writer_open(&body, why));
    TRY(text_writer_end(&body, pov_scene_write(w, body.stream, why), &text, NULL, why));
    status code = take_notes(w->notes, out, why);
    THEN(code, text_writer_open(&all, why));
    if (code == STATUS_OK) {
        put_head(w->s, w->notes, out->notes, all.stream);
        fputs(text, all.stream);
        code = text_writer_end(&all, STATUS_OK, &out->bytes, &out->size, why);
    }
    free(text);
    return code;
}

static status write_gltf(const export_work *w, bool binary, scene_export *out, diagnostic *why)
{
    text_writer all;
    TRY(text_writer_open(&all, why));
    TRY(text_writer_end(&all, gltf_scene_write(w, binary, all.stream, why), &out->bytes, &out->size, why));
    return take_notes(w->notes, out, why);
}

status scene_export_make(const scene *s, export_format format, const char *path, scene_export *out, diagnostic *why)
{
    export_notes notes = {.list = NULL};
    plan *p = NULL;
    *out = (scene_export){.bytes = NULL};
    TRY(plan_build(s, &p, why));
    const export_work w = {s, p, path, &notes};
    status code = note_parameters(s, format, &notes) == STATUS_OK ? STATUS_OK : out_of_memory(why);
    if (code == STATUS_OK) {
        note_scene(&w);
        code = format == EXPORT_POV ? write_pov(&w, out, why) : write_gltf(&w, format == EXPORT_GLB, out, why);
    }
    plan_destroy(p);
    export_notes_release(&notes);
    if (code != STATUS_OK)
        scene_export_release(out);
    return code;
}

void scene_export_release(scene_export *e)
{
    for (size_t i = 0; i < e->note_count; i++)
        free(e->notes[i]);
    free(e->notes);
    free(e->bytes);
    *e = (scene_export){.bytes = NULL};
}
