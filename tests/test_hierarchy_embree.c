/* Tests of the Embree backend: hits on a sphere, or the refusal of a build without Embree. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <cmocka.h>

#include "geometry/mesh_generators.h"
#include "geometry/hierarchy.h"
#include "random_stream.h"

static void count_hit(void *context, const mesh_hit *hit)
{
    int *counts = context;
    counts[hit->facing == FACING_FRONT]++;
}

static double distance_to_sphere(const mesh_ray *r)
{
    double b = vec3_dot(r->origin, r->direction), c = vec3_dot(r->origin, r->origin) - 1.0;
    return -b - sqrt(b * b - c);
}

/* Rays from outside at a unit sphere of 50000 triangles, which are within 1e-3 of it. */
static void embree_hits_the_sphere_at_the_closed_form_distance(void **state)
{
    (void)state;
    mesh *m = NULL;
    hierarchy *h = NULL;
    diagnostic why;
    assert_int_equal(generate_sphere(50000, &m, &why), STATUS_OK);
    const status built = hierarchy_build(m, HIERARCHY_EMBREE, 1, &h, &why);
    if (built == STATUS_BAD_INPUT) {
        assert_string_equal(why.what, "this program was built without Embree");
        assert_null(h);
        mesh_release(m);
        return;
    }
    assert_int_equal(built, STATUS_OK);
    assert_true(hierarchy_describe(h).bytes > 50000 * 12);
    const hierarchy_kernels *kernel = &ISA_BASE_OF(hierarchy_kernels);
    uint64_t seed = 77;
    for (int i = 0; i < 2000; i++) {
        vec3 origin = vec3_scale(random_direction(&seed), 3.0), target = vec3_scale(random_direction(&seed), 0.9);
        mesh_ray ray = {origin,    vec3_normalize(vec3_sub(target, origin)), 0.0, (double)INFINITY, TRIANGLE_NONE,
                        FACING_ANY};
        mesh_hit in, out, none;
        kernel->nearest(h, &ray, &in);
        assert_true(in.triangle != TRIANGLE_NONE && in.facing == FACING_FRONT);
        assert_true(fabs(in.t - distance_to_sphere(&ray)) < 5e-3);
        assert_true(kernel->any(h, &ray));
        ray.facing = FACING_BACK;
        kernel->nearest(h, &ray, &out);
        assert_true(out.triangle != TRIANGLE_NONE && out.facing == FACING_BACK && out.t > in.t);
        ray.skip = out.triangle;
        kernel->nearest(h, &ray, &none);
        assert_true(none.triangle != out.triangle);
        ray = (mesh_ray){origin, ray.direction, 0.0, in.t * 0.99, TRIANGLE_NONE, FACING_ANY};
        assert_false(kernel->any(h, &ray));
        ray.t_max = (double)INFINITY;
        int counts[2] = {0, 0};
        kernel->all(h, &ray, count_hit, counts);
        assert_true(counts[0] >= 1 && counts[1] >= 1);
    }
    hierarchy_destroy(h);
    mesh_release(m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(embree_hits_the_sphere_at_the_closed_form_distance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
