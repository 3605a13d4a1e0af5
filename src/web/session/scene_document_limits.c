/* The limits of the scene document: pixels, work and triangles. */
#include "web/session/scene_document.h"
#include "web/live/passes.h"
#include "scene/model/scene.h"

#include <math.h>

/* The triangles that its parameters imply; triangles of files are counted on loading. */
static double triangles_of(const mesh_entry *m)
{
    switch ((mesh_maker)m->source) {
    case MESH_SPARSE:
    case MESH_DENSE:
    case MESH_SPHERE: return (double)m->count;
    case MESH_ICOSPHERE: return 20.0 * pow(4.0, (double)m->level);
    case MESH_TORUS: return 2.0 * (double)m->around * (double)m->tube;
    case MESH_LATHE: return 2.0 * (double)m->around * (double)m->profile.count;
    case MESH_TERRAIN: return 2.0 * (double)m->around * (double)m->tube + 4.0 * (double)(m->around + m->tube);
    case MESH_SLIME: return 20.0 * pow(4.0, (double)m->slime.level);
    case MESH_BOX:
    case MESH_FILE:
    case MESH_ARRAYS: break;
    }
    return 12.0;
}

static status check_bounds(const scene *s, diagnostic *why)
{
    double triangles = 0.0;
    for (size_t i = 0; i < s->mesh_count; i++)
        triangles += triangles_of(&s->meshes[i]);
    if (s->render.width * s->render.height > DOCUMENT_PIXELS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "render larger images with `cuvette render`",
                        "%lld x %lld pixels exceed the laboratory's limit of %d", (long long)s->render.width,
                        (long long)s->render.height, DOCUMENT_PIXELS_MAX);
    if (passes_work(&s->render, 1, false) > DOCUMENT_WORK_MAX)
        return diagnose(why, STATUS_BAD_INPUT,
                        "use fewer pixels, samples, paths or wavelengths, or run `cuvette render`",
                        "%.3g camera rays exceed the laboratory's limit of %.0e", passes_work(&s->render, 1, false),
                        DOCUMENT_WORK_MAX);
    if (triangles > DOCUMENT_TRIANGLES_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "use smaller meshes, or run `cuvette render`",
                        "%.0f triangles exceed the laboratory's limit of %d", triangles, DOCUMENT_TRIANGLES_MAX);
    return STATUS_OK;
}

status scene_document_check(const scene *s, const folder *files, diagnostic *why)
{
    status code = scene_check(s, why);
    THEN(code, check_bounds(s, why));
    return code == STATUS_OK && files ? folder_check_scene(files, s, why) : code;
}

status scene_document_limit(scene *s, const folder *files, diagnostic *why)
{
    return scene_limit(s, files ? folder_real(files) : NULL, DOCUMENT_TRIANGLES_MAX, why);
}
