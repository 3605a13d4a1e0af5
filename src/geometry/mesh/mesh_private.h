/* Inside a mesh: the state that its owners share, the steps of mesh_finish, and common code of the generators. Private
 * to src/geometry/mesh and src/geometry/hierarchy. */
#pragma once

#include "geometry/mesh/mesh.h"
#include <pthread.h>

/* --- owners and hierarchies --- */

/* Whether triangles use all vertices of a mesh; mesh_move computes it once. */
enum mesh_used { MESH_USED_UNKNOWN, MESH_USED_ALL, MESH_USED_SOME };

/* The state that the owners of a mesh share. mesh.c creates it (all zero but owners and the mutex) and, at the last
 * release, calls `destroy` on each hierarchy before it frees the mesh; hierarchy.c builds under the mutex and stores
 * finished hierarchies. owners and hierarchies are accessed only with the compiler's __atomic operations; destroy is
 * set under the mutex before the first hierarchy is stored. */
struct mesh_shared {
    long owners;
    enum mesh_used used;                          /* read and written only by the owner that moves the mesh */
    pthread_mutex_t mutex;                        /* held while a hierarchy is built, so that each is built only once */
    hierarchy *hierarchies[HIERARCHY_KIND_COUNT]; /* NULL until first used */
    void (*destroy)(hierarchy *h);                /* NULL while there is no hierarchy */
    const mesh **operands; /* hierarchy_operands: written under the mutex; NULL until first used, or after a move */
    int operand_count;
};

/* Releases the operands, while no other thread uses the mesh. */
void mesh_forget_operands(mesh *m);

/* --- steps of mesh_finish --- */

/* Checks that indices and slots are in range and coordinates finite and within MESH_FAR. The message of
 * STATUS_BAD_INPUT names the triangle or vertex. */
status mesh_check(const mesh *m, diagnostic *why);

/* Sets m->closed or m->hole, and flips triangles with the wrong winding. m has passed mesh_check. */
status mesh_close(mesh *m, diagnostic *why);

/* --- edges (edges.c) ---
 *
 * A half-edge is an edge of one triangle: 3 t + k runs from corner k of triangle t to the next one. Triangles with two
 * corners at one position have none. */

#define MESH_NO_EDGES "out of memory for the edges of a mesh"

typedef struct half_edge {
    uint32_t higher, half; /* higher: of the positions of its ends; see edge_lists */
} half_edge;

/* edges[start[v]] .. edges[start[v + 1] - 1] are the half-edges whose lower position is v, sorted by the higher one and
 * then by `half`. same: mesh_weld. After a failure, too, edge_lists_free releases them. */
typedef struct edge_lists {
    uint32_t *same, *start;
    half_edge *edges;
} edge_lists;
status edge_lists_make(const mesh *m, edge_lists *lists, diagnostic *why);
void edge_lists_free(edge_lists *lists);

/* The position where a half-edge begins. */
static inline uint32_t mesh_half_begins(const mesh *m, const uint32_t *same, uint32_t half)
{
    return same[m->triangles[half / 3].corner[half % 3]];
}

static inline bool mesh_has_distinct_corners(const uint32_t *same, const uint32_t *corner)
{
    const uint32_t a = same[corner[0]], b = same[corner[1]], c = same[corner[2]];
    return a != b && b != c && c != a;
}

/* The list of the numbers 0 to count - 1, with room for one more. no_memory: the message. */
status mesh_number_all(size_t count, const char *no_memory, uint32_t **out, diagnostic *why);

/* The first triangle of a connected part, in an array where a triangle points to an earlier one of its part. */
static inline uint32_t mesh_part_of(uint32_t *parts, uint32_t triangle)
{
    for (; parts[triangle] != triangle; triangle = parts[triangle])
        parts[triangle] = parts[parts[triangle]];
    return triangle;
}

typedef struct edge_findings {
    size_t odd;     /* the lowest half-edge whose edge an odd number of triangles share; SIZE_MAX: none */
    int sharing;    /* the number */
    size_t crowded; /* the lowest half-edge whose edge more than two triangles share; SIZE_MAX: none */
    size_t edges;   /* edges shared by two */
    size_t against; /* of these, edges with the same direction in both triangles */
    size_t joined;  /* of these, edges that joined two parts */
} edge_findings;

/* Classifies each edge, and pairs the half-edges of those that two triangles share; mates and parts may be NULL. */
edge_findings edge_lists_pair(const mesh *m, const edge_lists *lists, uint32_t *mates, uint32_t *parts);

/* The pairs of all half-edges of a mesh in which an even number of triangles share each edge, and two neighbours at an
 * edge of two agree. */
typedef struct mesh_crowds {
    uint32_t *parts; /* mesh_part_of: triangles of one shell */
    uint32_t *twins; /* the first triangle that has this one's corners, and faces the same way; UINT32_MAX: cancelled */
    struct edge_fault {
        size_t half; /* the lowest half-edge whose edge has the fault; SIZE_MAX: there is none */
        int sharing;
        mesh_fault kind;
    } fault;
} mesh_crowds;
status mesh_crowds_make(const mesh *m, const edge_lists *lists, mesh_crowds *out, diagnostic *why);
void mesh_crowds_free(mesh_crowds *c);

/* --- agreement of neighbours (mesh_topology.c) --- */

/* The half-edge on the other side of each half-edge, and the positions that are one (mesh_weld). UINT32_MAX: its edge
 * is not shared by two triangles, or its triangle has two equal corners. */
typedef struct mesh_neighbours {
    uint32_t *same, *mates;
    size_t crowded; /* the lowest half-edge whose edge more than two triangles share; SIZE_MAX: none */
} mesh_neighbours;
status mesh_neighbours_make(const mesh *m, mesh_neighbours *out, diagnostic *why);
void mesh_neighbours_free(mesh_neighbours *n);

/* Turns triangles so that neighbours agree, as mesh_finish describes, and counts them. On a one-sided surface nothing
 * is turned, and *against is a half-edge where neighbours cannot agree; else SIZE_MAX. The mates are then invalid. */
status mesh_turn_alike(mesh *m, const uint32_t *same, const uint32_t *mates, size_t *turned, size_t *against,
                       diagnostic *why);

/* Sets m->bounds and m->single from the vertices that triangles use. */
void mesh_find_bounds(mesh *m);

/* Makes every normal a unit vector. A zero normal becomes the front normal of the first adjacent triangle that has an
 * area, or +y if none has. */
void mesh_normalize(mesh *m);

/* --- generators --- */

/* Finishes a generated mesh and returns it; releases it on failure. A mesh that should be closed and is not has
 * features too small for doubles: STATUS_BAD_INPUT. A generator may leave its loops early when it is cancelled: the
 * result is then STATUS_INTERRUPTED. */
status generate_finish(mesh *m, bool must_be_closed, mesh **out, diagnostic *why);

/* Whether x is greater than 0 and at most MESH_FAR. */
bool generate_is_length(double x);

/* Texture coordinates by direction. u = 1/2 + longitude / 360 is 1/2 at -z, which faces a viewer in front, and
 * increases to the viewer's right, +x; the longitude is -180..180 degrees. v is 0 at -y and 1 at +y. */
double generate_longitude_deg(vec3 p);
double generate_latitude_v(vec3 p);
/* Unit vector of longitude 360 u - 180 with u = at / around; identical bits at 0 and at around. */
vec3 generate_azimuth(int at, int around);

/* Adds two triangles between four corners of a grid: seen from the front, b is to the right of a, c above b, d above
 * a. */
void generate_quad(mesh *m, size_t *triangle, size_t a, size_t b, size_t c, size_t d);
