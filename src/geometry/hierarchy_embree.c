/* Without Embree. */
#include "geometry/hierarchy_private.h"

bool hierarchy_embree_there(void) { return false; }
void hierarchy_embree_destroy(hierarchy *h) { h->foreign = NULL; }
void hierarchy_embree_nearest(const hierarchy *h, const mesh_ray *ray, mesh_hit *hit)
{
    (void)h, (void)ray;
    *hit = (mesh_hit){.triangle = TRIANGLE_NONE};
}
bool hierarchy_embree_any(const hierarchy *h, const mesh_ray *ray) { (void)h, (void)ray; return false; }
void hierarchy_embree_all(const hierarchy *h, const mesh_ray *ray, mesh_visit *visit, void *context) { (void)h, (void)ray, (void)visit, (void)context; }
status hierarchy_build_embree(hierarchy *h, int threads, diagnostic *why)
{
    (void)h, (void)threads;
    return diagnose(why, STATUS_BAD_INPUT, "choose none, sphere, octant or bvh", "this program was built without Embree");
}
