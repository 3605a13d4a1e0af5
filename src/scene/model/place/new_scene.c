#include "scene/model/place/new_scene.h"

static const char text[] =
    "title: A new scene\n"
    "render: {width: 800, height: 600, depth: 6}\n"
    "camera: {position: [0, 1.8, -6], target: [0, 0.8, 0], fov_deg: 40}\n"
    "background: {kind: gradient, color: [0.25, 0.45, 0.75], horizon: [0.85, 0.9, 0.95]}\n"
    "materials:\n"
    "  paving: {color: [0.8, 0.8, 0.78], ambient: 0.25, diffuse: 0.7, checker: 1, checker_color: [0.45, 0.47, 0.5]}\n"
    "lights:\n"
    "  lamp: {position: [5, 9, -7]}\n"
    "solids:\n"
    "  ground: {shape: plane, material: paving}\n";

status new_scene(scene **out, diagnostic *why)
{
    return scene_read_text("", text, sizeof text - 1, out, why);
}
