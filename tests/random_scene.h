/* Random scenes as text, from the shapes of room_fixture.h: overlapping, rotated solids of all kinds with shuffled and
 * partly equal priorities, and shared indices. Ownership: values. */
#pragma once

#include "room_fixture.h"

#include "probe_fixture.h"

static inline void add_shape(scene_text *t, const solid_shape *s)
{
    add(t, "position: [%.17g, %.17g, %.17g], rotation: [%.17g, %.17g, %.17g], ", s->position.x, s->position.y,
        s->position.z, s->rotation_deg.x, s->rotation_deg.y, s->rotation_deg.z);
    switch (s->kind) {
    case SHAPE_CYLINDER:
        add(t, "shape: cylinder, radius: %.17g, height: %.17g, m: %.17g", s->radius, s->height, s->m);
        if (s->capillary_length > 0.0)
            add(t, ", capillary_length: %.17g, contact_angle_deg: %.17g, contact_radius: %.17g", s->capillary_length,
                s->contact_angle_deg, s->contact_radius);
        break;
    case SHAPE_CUP:
        add(t, "shape: cup, radius: %.17g, height: %.17g, inner_radius: %.17g, floor: %.17g, m: %.17g", s->radius,
            s->height, s->inner_radius, s->floor, s->m);
        break;
    case SHAPE_BOX: add(t, "shape: box, size: [%.17g, %.17g, %.17g]", s->size.x, s->size.y, s->size.z); break;
    case SHAPE_SPHERE: add(t, "shape: sphere, radius: %.17g", s->radius); break;
    case SHAPE_CONE:
        add(t, "shape: cone, radius: %.17g, top_radius: %.17g, height: %.17g", s->radius, s->top_radius, s->height);
        break;
    case SHAPE_PRISM:
        add(t, "shape: prism, radius: %.17g, sides: %d, height: %.17g", s->radius, (int)s->sides, s->height);
        break;
    case SHAPE_TORUS: add(t, "shape: torus, radius: %.17g, tube_radius: %.17g", s->radius, s->tube_radius); break;
    case SHAPE_LENS:
        add(t,
            "shape: lens, radius_1: %.17g, radius_2: %.17g, thickness: %.17g, diameter: %.17g, conic_1: %.17g, "
            "conic_2: %.17g",
            s->radius_1, s->radius_2, s->thickness, s->diameter, s->conic_1, s->conic_2);
        for (int k = 0; k < 3; k++)
            add(t, ", a%d_1: %.17g, a%d_2: %.17g", 4 + 2 * k, s->even_1[k], 4 + 2 * k, s->even_2[k]);
        break;
    case SHAPE_PLANE:
    case SHAPE_MESH:
    case SHAPE_COUNT: add(t, "shape: plane"); break;
    }
}

/* Shared media are 0, the surrounding one, -1 and -2: see room_fill. */
static inline double random_ior(uint64_t *seed, int64_t medium, double outside)
{
    return medium == 0 ? outside : medium == -1 ? 1.33 : medium == -2 ? 1.5 : random_real(seed, 1.0, 2.5);
}

/* Solids s0, s1, ...: all transparent, or as in the room; an opaque solid has a reflectivity and ambient light that add
 * up to at most 1. */
static inline void add_room(scene_text *t, uint64_t *seed, const room *m, double outside, bool all_clear,
                            bool absorbing)
{
    for (int i = 0; i < m->count; i++) {
        add(t, "  s%d: {priority: %d, ", i, (int)m->priority[i]);
        if (m->opaque[i] && !all_clear) {
            const double mirror = random_below(seed, 2) ? random_real(seed, 0.0, 1.0) : 0.0;
            add(t, "reflectivity: %.17g, ambient: %.17g, diffuse: 0.5, ", mirror, 1.0 - mirror);
        } else {
            add(t, "ior: %.17g, transparency: %.17g, reflectivity: 0, ", random_ior(seed, m->medium[i], outside),
                all_clear ? 1.0 : m->shadow_transmittance[i]);
        }
        if (absorbing && random_below(seed, 2))
            add(t, "absorb_per_m: [%.17g, 0, %.17g], ", random_real(seed, 0.0, 0.5), random_real(seed, 0.0, 1.0));
        add_shape(t, &m->shape[i]);
        add(t, "}\n");
    }
}

static inline room random_room(uint64_t *seed, bool on_a_grid)
{
    room m;
    (on_a_grid ? room_fill_on_a_grid : room_fill)(&m, seed);
    scene_geometry_destroy(m.solids);
    m.solids = NULL;
    return m;
}
