#include "lint/parts.h"

#include "geometry/shapes/shape.h"

#include <math.h>

#define CAMERA_CLOSE 1e-9 /* fraction of the scene's extent: a camera so close to a surface does not count as inside */

/* The priority index of the medium at the camera and in a neighbourhood around it; -1 if it is not constant there. */
static int medium_about(const plan *made)
{
    const vec3 eye = made->view.eye;
    const double far = CAMERA_CLOSE * fmax(1.0, fmax(fabs(eye.x), fmax(fabs(eye.y), fabs(eye.z))));
    const int priority_index =
        scene_geometry_priority_index(made->geometry, scene_geometry_inside(made->geometry, eye));
    for (int i = 0; i < 6; i++) {
        const double by = i % 2 ? far : -far;
        const vec3 at = vec3_add(eye, vec3_make(i / 2 == 0 ? by : 0.0, i / 2 == 1 ? by : 0.0, i / 2 == 2 ? by : 0.0));
        if (scene_geometry_priority_index(made->geometry, scene_geometry_inside(made->geometry, at)) != priority_index)
            return -1;
    }
    return priority_index;
}

/* An orthographic camera whose image cuts an opaque solid, on a lattice of its rays: often the ground, for a wide image
 * that is seen from little above. */
static void lint_parallel(const lint_room *room)
{
    enum { ACROSS = 16 };
    const plan *made = room->made;
    int inside = 0, found = 0;
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        const double u = (2.0 * (i % ACROSS) + 1.0) / ACROSS - 1.0, v = (2.0 * (i / ACROSS) + 1.0) / ACROSS - 1.0;
        const camera_ray r =
            camera_ray_through(&made->view, u * made->view.half_width, v * made->view.half_height, 0.0, 0.0);
        const int at = scene_geometry_priority_index(made->geometry, scene_geometry_inside(made->geometry, r.origin));
        if (made->geometry->regions[at].opaque)
            inside++, found = at;
    }
    if (inside > 0)
        note_give(room->taker, "camera", "position", "move the camera away from it, or lower camera.view_height",
                  "%d%% of the orthographic camera's rays start inside %s, which is opaque",
                  (100 * inside + ACROSS * ACROSS - 1) / (ACROSS * ACROSS), lint_solid(room, found)->name);
}

bool lint_camera(const lint_room *room)
{
    if (room->made->view.parallel) {
        lint_parallel(room);
        return false;
    }
    const int priority_index = medium_about(room->made);
    if (priority_index <= 0)
        return false;
    const solid *around = lint_solid(room, priority_index);
    const bool opaque = room->made->geometry->regions[priority_index].opaque,
               in_wall = !opaque && shape_of(&around->shape)->hollow;
    if (opaque && shape_of(&around->shape)->unbounded)
        note_give(room->taker, "camera", "position", "move the camera to the other side of the plane",
                  "the camera is below the surface of %s, which is opaque", around->name);
    else if (opaque)
        note_give(room->taker, "camera", "position", "move the camera out of it",
                  "the camera is inside %s, which is opaque", around->name);
    else if (in_wall)
        note_give(room->taker, "camera", "position", "move the camera out of the wall, into the vessel or away from it",
                  "the camera is inside the wall of %s", around->name);
    return opaque || in_wall;
}
