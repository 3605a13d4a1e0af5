/* The hierarchies that the plan of a frame (render/core/plan.c) takes from the meshes. */
#include "geometry/hierarchy/hierarchy.h"
#include "scene/model/integrators.h"
#include "scene/model/scene.h"
#include "scene/package/package.h"

status scene_build_hierarchies(const scene *s, diagnostic *why)
{
    if (!s->render.keep || integrator_traits_of(&s->render)->drawn)
        return STATUS_OK;
    for (size_t i = 0; i < s->solid_count; i++) {
        const mesh_entry *m = s->solids[i].visible ? scene_mesh_of(s, &s->solids[i]) : NULL;
        const hierarchy *built;
        if (m && m->data)
            TRY(hierarchy_of_mesh(m->data, (hierarchy_kind)s->render.accel, scene_build_threads(&s->render), &built,
                                  why));
    }
    return STATUS_OK;
}
