/* The slime toy: its net of masses and springs, and its surface. */
#include "geometry/mesh/mesh_generators.h"
#include "softbody/softbody_private.h"
#include <stdlib.h>

/* --- the net: masses at the vertices of an icosphere, springs along its edges, across neighbouring faces, and through
 * the body --- */

/* An edge of a face: its two masses, and the opposite corner. */
typedef struct side {
    uint32_t low, high, across;
} side;

static int by_ends(const void *a, const void *b)
{
    const side *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return p->across < q->across ? -1 : p->across > q->across;
}

/* Damping is proportional to stiffness (Rayleigh's second term); its coefficient is given for springs along edges. If
 * these have no stiffness, only they are damped. */
static void add_spring(const softbody_settings *s, toy_net *n, uint32_t a, uint32_t b, double stiffness)
{
    const double damping = s->stiffness > 0.0                        ? s->damping * (stiffness / s->stiffness)
                           : n->spring_count < 3 * n->face_count / 2 ? s->damping
                                                                     : 0.0;
    const double rest = vec3_length(vec3_sub(n->position[b], n->position[a]));
    n->springs[n->spring_count++] = (softbody_spring){{a, b}, rest, stiffness, damping};
}

/* Each edge of a closed surface occurs twice: one spring along it, and one between the two opposite corners. */
static status add_edges(const softbody_settings *s, toy_net *n, diagnostic *why)
{
    const size_t count = 3 * n->face_count;
    side *sides = malloc(count * sizeof *sides);
    if (!sides)
        return out_of_memory(why);
    for (size_t i = 0; i < count; i++) {
        const uint32_t *corner = n->faces[i / 3].corner, a = corner[i % 3], b = corner[(i + 1) % 3];
        sides[i] = (side){a < b ? a : b, a < b ? b : a, corner[(i + 2) % 3]};
    }
    qsort(sides, count, sizeof *sides, by_ends);
    for (size_t i = 0; i < count; i += 2)
        add_spring(s, n, sides[i].low, sides[i].high, s->stiffness);
    for (size_t i = 0; i < count; i += 2)
        add_spring(s, n, sides[i].across, sides[i + 1].across, s->bending);
    free(sides);
    return STATUS_OK;
}

typedef struct located_mass {
    vec3 at;
    uint32_t mass;
} located_mass;

static int by_place(const void *a, const void *b)
{
    const vec3 p = ((const located_mass *)a)->at, q = ((const located_mass *)b)->at;
    if (p.x != q.x)
        return p.x < q.x ? -1 : 1;
    if (p.y != q.y)
        return p.y < q.y ? -1 : 1;
    return p.z < q.z ? -1 : p.z > q.z;
}

/* Adds the springs through the body. An icosphere has the exact opposite of each vertex, computed by the same
 * operations with the other sign. unit: the vertices on the unit sphere. */
static status add_diameters(const softbody_settings *s, const vec3 *unit, toy_net *n, diagnostic *why)
{
    located_mass *by_position = malloc(n->mass_count * sizeof *by_position);
    if (!by_position)
        return out_of_memory(why);
    for (size_t i = 0; i < n->mass_count; i++)
        by_position[i] = (located_mass){vec3_add(unit[i], vec3_make(0.0, 0.0, 0.0)), (uint32_t)i}; /* no -0 */
    qsort(by_position, n->mass_count, sizeof *by_position, by_place);
    const double stiffness = s->through / (0.5 * (double)n->mass_count);
    status code = STATUS_OK;
    for (size_t i = 0; i < n->mass_count && code == STATUS_OK; i++) {
        const located_mass wanted = {vec3_add(vec3_scale(unit[i], -1.0), vec3_make(0.0, 0.0, 0.0)), 0};
        const located_mass *found = bsearch(&wanted, by_position, n->mass_count, sizeof *by_position, by_place);
        if (!found)
            code = diagnose(why, STATUS_FAILURE, "report this as a bug", "mass %zu has no opposite mass", i);
        else if (found->mass > i)
            add_spring(s, n, (uint32_t)i, found->mass, stiffness);
    }
    free(by_position);
    return code;
}

/* Masses are the merged vertices, in the order of their first use. */
static status place_masses(const softbody_settings *s, const mesh *sphere, vec3 *unit, toy_net *n, diagnostic *why)
{
    uint32_t *same;
    TRY(mesh_weld(sphere, &same, why));
    for (size_t v = 0; v < sphere->vertex_count; v++) {
        if (same[v] != v) {
            n->mass_of[v] = n->mass_of[same[v]];
            continue;
        }
        n->mass_of[v] = (uint32_t)n->mass_count;
        unit[n->mass_count] = sphere->vertices[v];
        n->position[n->mass_count++] = vec3_add(s->position, vec3_scale(sphere->vertices[v], s->radius));
    }
    free(same);
    for (size_t t = 0; t < sphere->triangle_count; t++)
        for (int k = 0; k < 3; k++)
            n->faces[t].corner[k] = n->mass_of[sphere->triangles[t].corner[k]];
    n->face_count = sphere->triangle_count;
    return STATUS_OK;
}

status toy_net_create(const softbody_settings *s, toy_net *out, diagnostic *why)
{
    *out = (toy_net){0};
    mesh *sphere;
    TRY(generate_icosphere((int)s->level, &sphere, why));
    status code = STATUS_OK;
    vec3 *unit = malloc(sphere->vertex_count * sizeof *unit);
    out->position = malloc(sphere->vertex_count * sizeof *out->position);
    out->mass_of = malloc(sphere->vertex_count * sizeof *out->mass_of);
    out->faces = malloc(sphere->triangle_count * sizeof *out->faces);
    /* per face 1.5 springs along edges, as many across, and a quarter through the body */
    out->springs = malloc(4 * sphere->triangle_count * sizeof *out->springs);
    if (!unit || !out->position || !out->mass_of || !out->faces || !out->springs)
        code = diagnose(why, STATUS_FAILURE, "use a lower level", "out of memory for a slime");
    THEN(code, place_masses(s, sphere, unit, out, why));
    THEN(code, add_edges(s, out, why));
    THEN(code, add_diameters(s, unit, out, why));
    free(unit);
    mesh_release(sphere);
    if (code != STATUS_OK)
        toy_net_release(out);
    return code;
}

void toy_net_release(toy_net *n)
{
    free(n->position);
    free(n->springs);
    free(n->faces);
    free(n->mass_of);
    *n = (toy_net){0};
}

/* --- the surface as a mesh, and its intersection with rays --- */

/* The doubled sum of the area vectors of the faces around each mass: area weighting needs no angles. */
static void sum_areas(const softbody *b, vec3 *area)
{
    for (size_t i = 0; i < b->face_count; i++) {
        const uint32_t *corner = b->faces[i].corner;
        const vec3 a = vectors_at(b->at, corner[0]);
        const vec3 n = vec3_cross(vec3_sub(vectors_at(b->at, corner[1]), a), vec3_sub(vectors_at(b->at, corner[2]), a));
        for (int k = 0; k < 3; k++)
            area[corner[k]] = vec3_add(area[corner[k]], n);
    }
}

status softbody_move_surface(const softbody *b, mesh *surface, diagnostic *why)
{
    vec3 *area = calloc(b->net.count, sizeof *area), *vertices = malloc(surface->vertex_count * sizeof *vertices);
    vec3 *normals = malloc(surface->vertex_count * sizeof *normals);
    status code = STATUS_FAILURE;
    if (area && vertices && normals) {
        sum_areas(b, area);
        for (size_t v = 0; v < surface->vertex_count; v++) {
            vertices[v] = vectors_at(b->at, b->mass_of[v]);
            normals[v] = area[b->mass_of[v]];
        }
        code = mesh_move(surface, vertices, normals, why);
    } else {
        diagnose(why, code, "use a lower level", "out of memory for a slime's surface");
    }
    free(area);
    free(vertices);
    free(normals);
    return code;
}

status softbody_surface(const softbody *b, mesh **out, diagnostic *why)
{
    *out = NULL;
    if (b->surface_level < 0)
        return diagnose(why, STATUS_BAD_INPUT, "use a slime toy", "a net of masses and springs has no surface");
    mesh *surface;
    status code = generate_icosphere(b->surface_level, &surface, why);
    if (code == STATUS_OK && (code = softbody_move_surface(b, surface, why)) != STATUS_OK)
        mesh_release(surface);
    *out = code == STATUS_OK ? surface : NULL;
    return code;
}

/* Moller and Trumbore, "Fast, minimum storage ray/triangle intersection", JGT 2(1), 1997; front faces only. slack:
 * tolerance beyond an edge, as a fraction of the face. */
static bool meets(const softbody *b, const mesh_triangle *face, double slack, vec3 origin, vec3 direction, double *t)
{
    const vec3 a = vectors_at(b->at, face->corner[0]);
    const vec3 p = vec3_sub(vectors_at(b->at, face->corner[1]), a), q = vec3_sub(vectors_at(b->at, face->corner[2]), a);
    const vec3 across = vec3_cross(direction, q);
    const double det = vec3_dot(p, across);
    if (!(det > 0.0))
        return false;
    const vec3 away = vec3_sub(origin, a);
    const double u = vec3_dot(away, across);
    const vec3 turned = vec3_cross(away, p);
    const double v = vec3_dot(direction, turned);
    *t = vec3_dot(q, turned) / det;
    const double beyond = slack * det;
    return u >= -beyond && v >= -beyond && u + v <= det + beyond && *t >= 0.0;
}

static double nearest_front(const softbody *b, double slack, vec3 origin, vec3 direction)
{
    double nearest = INFINITY, t;
    for (size_t i = 0; i < b->face_count; i++)
        if (meets(b, &b->faces[i], slack, origin, direction, &t) && t < nearest)
            nearest = t;
    return nearest;
}

bool softbody_pick(const softbody *b, vec3 origin, vec3 direction, vec3 *where)
{
    double nearest = nearest_front(b, 0.0, origin, direction);
    if (!(nearest < INFINITY)) /* along an edge rounding can miss both faces */
        nearest = nearest_front(b, 1e-9, origin, direction);
    if (nearest < INFINITY)
        *where = vec3_add(origin, vec3_scale(direction, nearest));
    return nearest < INFINITY;
}
