/* The limits of the scene document: pixels, work and triangles. */
#include "web/session/scene_document.h"
#include "scene/model/scene.h"
#include "scene/model/work.h"

static status check_bounds(const scene *s, diagnostic *why)
{
    const double triangles = scene_planned_triangles(s), rays = scene_camera_rays(&s->render);
    if (s->render.width * s->render.height > DOCUMENT_PIXELS_MAX)
        return diagnose(why, STATUS_BAD_INPUT, "render larger images with `cuvette render`",
                        "%lld x %lld pixels exceed the laboratory's limit of %d", (long long)s->render.width,
                        (long long)s->render.height, DOCUMENT_PIXELS_MAX);
    if (rays > DOCUMENT_WORK_MAX)
        return diagnose(why, STATUS_BAD_INPUT,
                        "use fewer pixels, samples, paths or wavelengths, or run `cuvette render`",
                        "%.3g camera rays exceed the laboratory's limit of %.0e", rays, DOCUMENT_WORK_MAX);
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
