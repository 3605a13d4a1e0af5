# table_scene.awk - a random still life that both Cuvette and POV-Ray can say: spheres, boxes, cylinders, cones, prisms,
# tori, lenses, a cup of liquid and a mesh on a chequered ground, of matt, glossy, mirroring, textured and clear
# materials, under two or three lamps of different kinds. The same for one seed with every awk.
#   awk -v seed=1 [-v texture=FILE.png] -f experiments/peers/table_scene.awk >scene.yaml
# The solids are in a grid of cells, so that only the liquid, its cup and its straw overlap.

# Uniform in 0..1: the minimal standard generator, Park and Miller 1988.
function uniform() {
    state = state * 16807 % 2147483647
    return state / 2147483647
}
function between(low, high) { return low + (high - low) * uniform() }
function pick(words,    list, n) { n = split(words, list, " "); return list[1 + int(n * uniform())] }
function color() { return sprintf("[%.3f, %.3f, %.3f]", between(0.1, 0.95), between(0.1, 0.95), between(0.1, 0.95)) }
function turn() { return sprintf("[%.1f, %.1f, %.1f]", between(-40, 40), between(-180, 180), between(-40, 40)) }
function solid(name, x, z,    shape, r, at) {
    shape = pick("sphere box cylinder cone prism torus lens")
    r = between(0.28, 0.42)
    at = sprintf("position: [%.4f, %.4f, %.4f]", x, 0.75, z)
    printf "  %s: {shape: %s, %s, rotation: %s, material: %s, priority: %d, ", name, shape, at, turn(), pick(materials),
        priority++
    if (shape == "sphere") printf "radius: %.4f}\n", r
    else if (shape == "box") printf "size: [%.4f, %.4f, %.4f]}\n", 1.3 * r, between(0.8, 1.5) * r, 1.3 * r
    else if (shape == "cylinder") printf "radius: %.4f, height: %.4f}\n", 0.8 * r, 1.1 * r
    else if (shape == "cone") printf "radius: %.4f, top_radius: %.4f, height: %.4f}\n", r, between(0, 0.6) * r, r
    else if (shape == "prism") printf "radius: %.4f, sides: %d, height: %.4f}\n", 0.9 * r, 3 + int(5 * uniform()), r
    else if (shape == "torus") printf "radius: %.4f, tube_radius: %.4f}\n", 0.7 * r, 0.25 * r
    else printf "diameter: %.4f, thickness: %.4f, radius_1: %.4f, radius_2: %.4f}\n", 1.6 * r, 0.9 * r, 1.2 * r,
        (uniform() < 0.5 ? -1.3 : 1.4) * r
}
BEGIN {
    state = seed * 48271 % 2147483647
    for (i = 0; i < 10; i++) uniform()
    materials = "clay gloss mirror glass tinted" (texture ? " paper" : "")
    print "title: Still life " seed
    print "render: {width: 640, height: 480, depth: 8, beyond: black}"
    printf "camera: {position: [%.3f, %.3f, %.3f], target: [0, 0.6, 0], fov_deg: 38, roll_deg: %.2f}\n",
        between(-2, 2), between(2, 3.5), between(-6.5, -5.5), between(-5, 5)
    printf "background: {kind: gradient, color: %s, horizon: %s, ambient: %s}\n", color(), color(), color()
    if (texture) print "textures: {print: {file: " texture ", filter: bilinear}}"
    print "meshes: {knot: {generate: torus, major: 0.32, minor: 0.12, around: 48, tube: 24}}"
    print "materials:"
    print "  tiles: {color: " color() ", checker: 0.4, checker_color: " color() ", ambient: 0.1, diffuse: 0.7}"
    print "  clay: {color: " color() ", ambient: 0.1, diffuse: 0.75}"
    print "  gloss: {color: " color() ", ambient: 0.1, diffuse: 0.6, specular: 0.5, shininess: 35}"
    print "  mirror: {color: " color() ", ambient: 0.05, diffuse: 0.2, specular: 0.4, shininess: 200,"
    print "    reflectivity: 0.7}"
    printf "  glass: {transparency: 1, ior: %.3f, specular: 0.5, shininess: 90}\n", between(1.3, 1.9)
    printf "  tinted: {transparency: 0.95, ior: %.3f, reflectivity: 0.05, absorb_per_m: [%.3f, %.3f, %.3f]}\n",
        between(1.3, 1.7), between(0, 3), between(0, 3), between(0, 3)
    if (texture) print "  paper: {color: " color() ", texture: print, ambient: 0.15, diffuse: 0.8}"
    print "lights:"
    printf "  lamp: {position: [%.3f, %.3f, %.3f], intensity: 0.6, color: %s}\n", between(2, 5), between(4, 7),
        between(-6, -3), color()
    print "  spot: {kind: cone, half_angle_deg: 30, target: [0, 0, 0], reach: 7, intensity: 0.7,"
    printf "    position: [%.3f, %.3f, %.3f]}\n", between(-5, -2), between(4, 6), between(-4, -1)
    if (uniform() < 0.5)
        print "  sun: {kind: sun, position: [1, 3, -1], target: [0, 0, 0], intensity: 0.3, angular_diameter_deg: 0}"
    print "solids:"
    print "  ground: {shape: plane, material: tiles, priority: -1}"
    priority = 10
    for (row = 0; row < 3; row++)
        for (column = 0; column < 4; column++) {
            x = 1.05 * (column - 1.5); z = 1.1 * (row - 0.8)
            if (row == 0 && column == 1) {
                printf "  cup: {shape: cup, material: glass, position: [%.3f, 0.01, %.3f],\n", x, z
                print "    radius: 0.45, inner_radius: 0.4, height: 0.9, floor: 0.06, priority: 3}"
                printf "  liquid: {shape: cylinder, material: tinted, position: [%.3f, 0.04, %.3f],\n", x, z
                print "    reflectivity: 0, transparency: 1, radius: 0.42, height: 0.6, priority: 2}"
                printf "  straw: {shape: cylinder, material: gloss, position: [%.3f, 0.12, %.3f],\n", x - 0.15, z
                print "    radius: 0.06, height: 1.3, rotation: [0, 0, -14], priority: 5}"
            } else if (row == 1 && column == 2) {
                printf "  knot_1: {shape: mesh, mesh: knot, material: %s, priority: 6,\n", pick("gloss glass mirror")
                printf "    position: [%.3f, 0.7, %.3f], rotation: %s}\n", x, z, turn()
            } else
                solid("s" row column, x, z)
        }
}
