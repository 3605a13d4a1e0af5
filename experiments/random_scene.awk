# random_scene.awk - a random scene of spheres for benchmarks, the same for one seed with every awk.
#   awk -v seed=1 -v solids=64 [-v lights=1] [-v cloud=FILE.xyz] -f experiments/random_scene.awk >scene.yaml
# The camera looks along +z at a cube of edge 2. The radius falls with the square root of the number of spheres, so that
# their total cross-section stays the same: a camera ray meets as many of 10^5 as of 10. Seed 1: equal clay spheres that
# reflect 30 % of the light. Other seeds: random fractions of matt, reflecting and glass spheres, and a random
# cross-section, all drawn before the spheres, so that a seed means the same for every number of them. With cloud, the
# centres are written to that file, and the scene has one solid at all of them: equal spheres, as those of seed 1.

# Uniform in 0..1: the minimal standard generator, Park and Miller 1988.
function uniform() {
    state = state * 16807 % 2147483647
    return state / 2147483647
}
BEGIN {
    if (!lights) lights = 1
    state = seed * 48271 % 2147483647
    for (i = 0; i < 10; i++) uniform()
    mirrors = 1; glasses = 0; cover = 1
    if (seed != 1) {
        mirrors = uniform()
        glasses = 0.3 * uniform()
        cover = 0.5 + uniform()
    }
    print "camera: {position: [0, 0, -3], target: [0, 0, 0], fov_deg: 45}"
    print "materials:"
    print "  clay: {color: [0.85, 0.55, 0.3], ambient: 0.1, diffuse: 0.7}"
    print "  glaze: {color: [0.85, 0.55, 0.3], ambient: 0.1, diffuse: 0.6, reflectivity: 0.3}"
    print "  glass: {transparency: 1, ior: 1.5}"
    radius = 0.9 * sqrt(cover / solids)
    if (cloud) {
        name = cloud
        sub(/.*\//, "", name)
        print "meshes: {centres: {file: " name "}}"
        print "solids:"
        printf "  s: {shape: sphere, points: centres, radius: %.6f, material: glaze}\n", radius
    } else
        print "solids:"
    for (i = 0; i < solids; i++) {
        kind = uniform() < glasses ? "glass" : uniform() < mirrors ? "glaze" : "clay"
        if (cloud) {
            printf "%.5f %.5f %.5f\n", 2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1 >cloud
            continue
        }
        printf "  s%d: {shape: sphere, position: [%.5f, %.5f, %.5f], radius: %.6f, material: %s, priority: %d}\n", i,
            2 * uniform() - 1, 2 * uniform() - 1, 2 * uniform() - 1, radius, kind, i
    }
    print "lights:"
    print "  l0: {position: [2, 3, -4], intensity: " 1 / lights "}"
    for (i = 1; i < lights; i++)
        printf "  l%d: {position: [%.4f, %.4f, %.4f], intensity: %.6f}\n", i, 8 * uniform() - 4, 2 + 2 * uniform(),
            -2 - 4 * uniform(), 1 / lights
}
