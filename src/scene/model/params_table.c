/* The table itself: a new parameter is one new row here, and a field in the struct of its group (render_settings.h,
 * material.h, light.h, solids.h, mesh_entry.h, view_settings.h). */
#include "scene/model/medium.h"
#include "scene/model/params.h"
#include "scene/model/mesh_entry.h"
#include "scene/model/light.h"
#include "scene/model/solids.h"

#include <stddef.h>
#include <string.h>

static const char *const off_on[] = {"off", "on", NULL};
static const char *const sample_counts[] = {"1", "4", "9", "16", "25", "36", "49", "64", NULL};
static const char *const weights_words[] = {"fresnel", "constant", NULL};
static const char *const transmission_words[] = {"refract", "simple", NULL};
static const char *const depth_limit_words[] = {"sky", "black", "mean", NULL};
static const char *const radiance_words[] = {"classic", "basic", NULL};
static const char *const shadows_words[] = {"off", "opaque", "attenuated", NULL};
static const char *const schedule_words[] = {"columns", "rows", "tiles", "dynamic", NULL};
static const char *const pin_words[] = {"none", "compact", "scatter", NULL};
static const char *const lighting_words[] = {"lambert", "phong", "whitted", NULL};
static const char *const spectrum_words[] = {"rgb", "spectral", NULL};
static const char *const accel_words[] = {"none", "sphere", "octant", "bvh", "embree", NULL};
static const char *const texturing_words[] = {"perspective", "affine", NULL};
static const char *const shading_words[] = {"flat", "smooth", "gouraud", NULL};
/* arrays: what a program gave, which no file can say */
static const char *const source_words[] = {"file",  "sparse",  "dense", "sphere", "icosphere", "torus",
                                           "lathe", "terrain", "box",   "slime",  "arrays",    NULL};
static const char *const motion_words[] = {"euler", "verlet", "implicit", NULL};
static const char *const filter_words[] = {"nearest", "bilinear", "trilinear", NULL};
static const char *const wrap_words[] = {"repeat", "mirror", "clamp", NULL};
static const char *const space_words[] = {"srgb", "linear", NULL};
static const char *const light_words[] = {"point", "cone", "soft_cone", NULL};
static const char *const background_words[] = {"uniform", "gradient", "picture", NULL};

enum { ON_SLIME = 1 << MESH_SLIME, ON_ALL = 0 };

/* Positions and lengths stay where doubles still resolve 1e-10 of a scene unit. */
#define FAR 1e6
/* Well under the film's 524288, with room for many lights. */
#define BRIGHT 1e4

/* A row whose name is that of its field, or of the field's last part; further members follow the place. */
#define ROW(group, name, kind, unit, low, high, above, fallback, meaning, words, ...)    \
    {                                                                                    \
        group, name, kind, unit, low, high, above, fallback, meaning, words, __VA_ARGS__ \
    }
#define OF(type, field) ON_ALL, .offset = offsetof(type, field)
/* How, not what: see param.performance_only. */
#define PERFORMANCE(field) OF(render_settings, field), .performance_only = true
/* Of a slime alone. */
#define SLIME(field) ON_SLIME, .offset = offsetof(mesh_entry, slime.field)
/* Of some shapes: see geometry/shapes/shape.h. */
#define SHAPE(field) OF(solid, field), .by_shape = true

#define INTEGER(group, type, field, unit, low, high, fallback, meaning) \
    ROW(group, #field, PARAM_INT, unit, low, high, false, fallback, meaning, NULL, OF(type, field))
#define REAL(group, type, field, unit, low, high, fallback, meaning) \
    ROW(group, #field, PARAM_REAL, unit, low, high, false, fallback, meaning, NULL, OF(type, field))
#define POSITIVE(group, type, field, unit, high, fallback, meaning) \
    ROW(group, #field, PARAM_REAL, unit, 0, high, true, fallback, meaning, NULL, OF(type, field))
#define CHOICE(group, type, field, words, fallback, meaning) \
    ROW(group, #field, PARAM_CHOICE, "", 0, 0, false, fallback, meaning, words, OF(type, field))
#define VECTOR(group, type, field, fallback, meaning) \
    ROW(group, #field, PARAM_VECTOR, "scene units", -FAR, FAR, false, fallback, meaning, NULL, OF(type, field))
#define COLOR(group, type, field, high, fallback, meaning) \
    ROW(group, #field, PARAM_COLOR, "", 0, high, false, fallback, meaning, NULL, OF(type, field))
#define LIST(group, type, field, unit, high, fallback, meaning) \
    ROW(group, #field, PARAM_LIST, unit, -(high), high, false, fallback, meaning, NULL, OF(type, field))
#define PERFORMANCE_INTEGER(field, unit, low, high, fallback, meaning) \
    ROW(PARAM_RENDER, #field, PARAM_INT, unit, low, high, false, fallback, meaning, NULL, PERFORMANCE(field))
#define PERFORMANCE_CHOICE(field, words, fallback, meaning) \
    ROW(PARAM_RENDER, #field, PARAM_CHOICE, "", 0, 0, false, fallback, meaning, words, PERFORMANCE(field))
#define PERFORMANCE_REAL(field, unit, low, high, fallback, meaning) \
    ROW(PARAM_RENDER, #field, PARAM_REAL, unit, low, high, false, fallback, meaning, NULL, PERFORMANCE(field))
#define SLIME_REAL(field, unit, low, high, above, fallback, meaning) \
    ROW(PARAM_MESH, #field, PARAM_REAL, unit, low, high, above, fallback, meaning, NULL, SLIME(field))
#define SLIME_VECTOR(field, unit, high, fallback, meaning) \
    ROW(PARAM_MESH, #field, PARAM_VECTOR, unit, -(high), high, false, fallback, meaning, NULL, SLIME(field))
#define SLIME_CHOICE(field, words, fallback, meaning) \
    ROW(PARAM_MESH, #field, PARAM_CHOICE, "", 0, 0, false, fallback, meaning, words, SLIME(field))
#define LENGTH(field, fallback, meaning) \
    ROW(PARAM_SOLID, #field, PARAM_REAL, "scene units", 0, FAR, true, fallback, meaning, NULL, SHAPE(shape.field))

/* In the order in which they are listed and printed; the groups stand together.
 *
 * A material's terms are all 0 by default: a picture then shows no term of Phong's sum, and no branch of the tree, that
 * its scene does not name, and clear glass needs no line that takes a matte coat off again. A colour multiplies,
 * so it is white; a shininess without a specular coefficient does nothing, 80 is the one of the reference scene. ior
 * is vacuum's, so that nothing bends unasked. */
static const param table[] = {
    INTEGER(PARAM_RENDER, render_settings, width, "px", 1, 65536, "800", "width of the picture"),
    INTEGER(PARAM_RENDER, render_settings, height, "px", 1, 65536, "600", "height of the picture"),
    INTEGER(PARAM_RENDER, render_settings, depth, "", 0, 64, "4", "recursion depth: 0 follows camera rays only"),
    {PARAM_RENDER, "samples", PARAM_INT, "", 1, SCENE_SAMPLES_MAX, false, "1",
     "camera rays a pixel, through the middles of as many equal cells; 1 for no antialiasing", sample_counts,
     OF(render_settings, samples)},
    CHOICE(PARAM_RENDER, render_settings, integrator, integrator_words, "whitted",
           "how light is followed: to the first surface, through reflections and refractions, along random paths, or "
           "not: a depth buffer, or layers of what camera rays meet first"),
    CHOICE(PARAM_RENDER, render_settings, layer, layer_words, "normal",
           "which layer the image shows under integrator aov: the normal, colour, distance, number of the solid or of "
           "its material, or position of the point that is met first"),
    CHOICE(PARAM_RENDER, render_settings, lighting, lighting_words, "whitted",
           "diffuse light alone, specular light too, or reflected and refracted light as well; not of the path "
           "integrator"),
    CHOICE(PARAM_RENDER, render_settings, weights, weights_words, "fresnel",
           "share of the reflected and refracted branch: Fresnel's equations, or each material's constants"),
    CHOICE(PARAM_RENDER, render_settings, transmission, transmission_words, "refract",
           "at clear surfaces light is bent by Snell's law; or it goes straight on, with each material's constants as "
           "weights"),
    CHOICE(PARAM_RENDER, render_settings, beyond, depth_limit_words, "sky",
           "what a ray beyond the last depth brings back: the sky behind it, nothing, or the mean of the sky over all "
           "directions"),
    CHOICE(PARAM_RENDER, render_settings, radiance, radiance_words, "classic",
           "what rays carry: radiance as if no medium changed it (Whitted), or L / n^2, which refraction keeps"),
    CHOICE(PARAM_RENDER, render_settings, shadows, shadows_words, "attenuated",
           "what stands in a light's way: nothing, every solid, or each by what it lets straight through; no caustics"),
    REAL(PARAM_RENDER, render_settings, min_weight, "", 0, 1, "0",
         "branches whose throughput is under this are not followed; 0 follows the whole tree"),
    INTEGER(PARAM_RENDER, render_settings, paths, "", 1, 1048576, "16", "paths a pixel of the path integrator"),
    CHOICE(PARAM_RENDER, render_settings, roulette, off_on, "off",
           "paths that have become faint end by chance, the others weigh more for it; path integrator"),
    INTEGER(PARAM_RENDER, render_settings, seed, "", 0, 2147483647, "1", "seed of all that is drawn by chance"),
    CHOICE(PARAM_RENDER, render_settings, polarisation, off_on, "off",
           "on carries each ray's Stokes vector through Fresnel's equations; off takes the unpolarised mean at each "
           "interface"),
    CHOICE(PARAM_RENDER, render_settings, spectrum, spectrum_words, "rgb",
           "three channels at one wavelength's indices, or wavelengths of their own indices, seen by the CIE 1931 "
           "observer"),
    INTEGER(PARAM_RENDER, render_settings, wavelengths, "", 1, 65536, "32",
            "wavelengths a camera ray of the spectral film, 380 to 780 nm"),
    REAL(PARAM_RENDER, render_settings, lambda_nm, "nm", 200, 2000, "587.5618",
         "wavelength at which the rgb film takes refractive indices; the default is the d line"),
    POSITIVE(PARAM_RENDER, render_settings, unit_m, "m", 1e6, "1", "length of one scene unit, for absorption"),
    PERFORMANCE_INTEGER(threads, "", 1, 1024, "1", "workers"),
    PERFORMANCE_CHOICE(pool, off_on, "on", "workers wait between frames; off starts fresh ones for each"),
    PERFORMANCE_CHOICE(
        schedule, schedule_words, "dynamic",
        "how the picture is shared: fixed blocks of columns or rows, fixed tiles, or tiles as workers ask"),
    PERFORMANCE_INTEGER(tile, "px", 1, 65536, "32", "edge of a tile"),
    PERFORMANCE_CHOICE(pin, pin_words, "none",
                       "workers bound to processing units: not, next to each other, or far from each other"),
    PERFORMANCE_CHOICE(
        accel, accel_words, "bvh",
        "hierarchy over a mesh's triangles: none, one sphere, the report's tree of spheres, boxes, or Embree's "
        "(not the same film)"),
    PERFORMANCE_INTEGER(build_threads, "", 0, 1024, "0", "threads that build hierarchies; 0 is one a processing unit"),
    PERFORMANCE_CHOICE(keep, off_on, "on", "meshes keep their hierarchies; off builds them anew for every frame"),
    PERFORMANCE_REAL(rebuild, "", 1, 1e6, "1.5",
                     "boxes around a mesh that moves are built anew when rays are expected to cost so many times more"),
    CHOICE(PARAM_RENDER, render_settings, texturing, texturing_words, "perspective",
           "how the depth buffer runs through textures: right, or straight across the picture"),

    VECTOR(PARAM_CAMERA, camera, position, "0,1,-6", "where the eye stands"),
    VECTOR(PARAM_CAMERA, camera, target, "0,1,0", "point in the middle of the picture; takes the place of the angles"),
    REAL(PARAM_CAMERA, camera, yaw_deg, "deg", -360, 360, "0",
         "direction: 0 along +z, 90 along +x; takes the place of the target"),
    REAL(PARAM_CAMERA, camera, pitch_deg, "deg", -90, 90, "0",
         "elevation: 90 looks straight up; takes the place of the target"),
    REAL(PARAM_CAMERA, camera, roll_deg, "deg", -360, 360, "0",
         "turn about the direction of view: positive leans the camera to its right, and the image turns "
         "counter-clockwise"),
    POSITIVE(PARAM_CAMERA, camera, fov_deg, "deg", 179, "45", "vertical field of view"),

    CHOICE(PARAM_BACKGROUND, background, kind, background_words, "uniform",
           "one colour, a vertical gradient, or an equirectangular picture"),
    COLOR(PARAM_BACKGROUND, background, color, BRIGHT, "0.53,0.75,0.92", "linear colour; of a gradient, at the zenith"),
    COLOR(PARAM_BACKGROUND, background, horizon, BRIGHT, "1,1,1",
          "linear colour of a gradient at the horizon and below"),
    {PARAM_BACKGROUND, "picture", PARAM_PATH, "", 0, 0, false, "",
     "PNG, JPEG, PFM or 24-bit BMP file, from the scene file's folder; makes the kind picture", NULL,
     OF(background, image_path)},
    COLOR(PARAM_BACKGROUND, background, ambient, BRIGHT, "1,1,1", "ambient light, I_a of Phong's sum"),

    REAL(PARAM_BACKGROUND, background, ior, "", 0.1, 100, "1",
         "refractive index of what surrounds all solids, relative to vacuum"),
    CHOICE(PARAM_BACKGROUND, background, medium, surrounding_words, "ior",
           "what surrounds all solids: as ior says, or from the catalogue"),
    COLOR(PARAM_BACKGROUND, background, absorb_per_m, 1e9, "0,0,0",
          "its absorption by channel, 1/m, on ways that end at a surface or a light; the sky's light is as given where "
          "it arrives"),

    {PARAM_MESH, "generate", PARAM_CHOICE, "", 0, 0, false, "file", "which body is computed; file: it is read",
     source_words, OF(mesh_entry, source)},
    {PARAM_MESH, "file", PARAM_PATH, "", 0, 0, false, "", "OBJ, PLY, STL or glTF file, from the scene file's folder",
     NULL, OF(mesh_entry, path)},
    INTEGER(PARAM_MESH, mesh_entry, count, "", 1, 100000000, "10000",
            "triangles of sparse and dense; of sphere, the nearest 20 f^2"),
    INTEGER(PARAM_MESH, mesh_entry, level, "", 0, 11, "4",
            "bisections of an icosphere or slime: 20 * 4^level triangles; of a slime at most 7"),
    POSITIVE(PARAM_MESH, mesh_entry, major, "scene units", FAR, "1",
             "of a torus: from the axis to the middle of the tube"),
    POSITIVE(PARAM_MESH, mesh_entry, minor, "scene units", FAR, "0.4", "of a torus: radius of the tube"),
    INTEGER(PARAM_MESH, mesh_entry, around, "", 3, 16384, "64",
            "segments around the axis of a torus or lathe; cells of terrain along x"),
    INTEGER(PARAM_MESH, mesh_entry, tube, "", 3, 16384, "32",
            "segments around a torus's tube; cells of terrain along z"),
    LIST(PARAM_MESH, mesh_entry, profile, "scene units", FAR, "[0,0,1,0,1,1,0,1]",
         "of a lathe: radius, height, radius, height and so on"),
    REAL(PARAM_MESH, mesh_entry, crease_deg, "deg", 0, 180, "30",
         "a lathe's profile keeps an edge where it turns by more"),
    {PARAM_MESH, "size", PARAM_VECTOR, "scene units", 0, FAR, true, "1,1,1",
     "edges of a box; of terrain, with the height of its hills as y", NULL, OF(mesh_entry, size)},
    REAL(PARAM_MESH, mesh_entry, depth, "scene units", 0, FAR, "0",
         "of terrain: its flat bottom lies so far below y = 0; 0 leaves it open"),
    INTEGER(PARAM_MESH, mesh_entry, seed, "", 0, 2147483647, "1", "of terrain: which hills"),
    {PARAM_MESH, "time_s", PARAM_REAL, "s", 0, 86400, false, "0",
     "of a slime: the moment that is shown, after its beginning", NULL, ON_SLIME,
     .offset = offsetof(mesh_entry, time_s)},
    {PARAM_MESH, "script", PARAM_PATH, "", 0, 0, false, "",
     "of a slime: YAML file of what hands do with it, from the scene file's folder", NULL, ON_SLIME,
     .offset = offsetof(mesh_entry, script_path)},
    SLIME_REAL(radius, "scene units", 0, 1e3, true, "1", "of a slime's sphere at rest"),
    SLIME_VECTOR(position, "scene units", FAR, "0,1,0", "of a slime's centre at the beginning, in the mesh's frame"),
    SLIME_VECTOR(velocity, "scene units/s", 1e3, "0,0,0", "of all of a slime at the beginning"),
    SLIME_REAL(mass_kg, "kg", 1e-6, 1e6, false, "1", "of a slime, shared evenly by its vertices"),
    SLIME_REAL(stiffness, "N/scene unit", 0, 1e9, false, "10", "of a slime's springs along edges, each"),
    SLIME_REAL(bending, "N/scene unit", 0, 1e9, false, "4", "of its springs across two neighbouring faces, each"),
    SLIME_REAL(through, "N/scene unit", 0, 1e9, false, "100", "of its springs from side to side, all together"),
    SLIME_REAL(damping, "N s/scene unit", 0, 1e6, false, "0.04", "of a slime's springs along their length"),
    SLIME_REAL(pressure, "N/scene unit^2", 0, 1e9, false, "300",
               "of a slime of no volume; it falls with the volume, to none at rest"),
    SLIME_VECTOR(gravity, "scene units/s^2", 1e6, "0,-9.81,0", "on a slime"),
    SLIME_CHOICE(ground, off_on, "on", "a floor under a slime, at ground_y of the mesh's frame"),
    SLIME_REAL(ground_y, "scene units", -FAR, FAR, false, "0", "height of a slime's floor"),
    SLIME_REAL(restitution, "", 0, 1, false, "0.3",
               "share of a vertex's speed against the floor with which it comes back"),
    SLIME_REAL(friction, "", 0, 1e3, false, "2", "coefficient of Coulomb's law between a slime and its floor"),
    SLIME_CHOICE(
        integrator, motion_words, "euler",
        "of a slime: semi-implicit Euler, velocity Verlet, or backward Euler, which stiff springs cannot blow up"),
    SLIME_REAL(dt_s, "s", 1e-9, 1, false, "0.001",
               "step of a slime's motion; the default holds up to level 4, above it wants less, or adaptive"),
    SLIME_CHOICE(adaptive, off_on, "off", "splits a slime's steps until they are stable and short against its springs"),
    {PARAM_MESH, "threads", PARAM_INT, "", 1, 1024, false, "1",
     "that move a slime; at most one for each 4096 masses is started", NULL, ON_SLIME,
     .offset = offsetof(mesh_entry, slime.threads), .performance_only = true},

    {PARAM_TEXTURE, "file", PARAM_PATH, "", 0, 0, false, "",
     "PNG, JPEG, PFM or 24-bit BMP file, from the scene file's folder", NULL, OF(texture_entry, path)},
    CHOICE(PARAM_TEXTURE, texture_entry, filter, filter_words, "trilinear",
           "one texel, the four around the point, or these of two of a pyramid of smaller pictures"),
    CHOICE(PARAM_TEXTURE, texture_entry, wrap_u, wrap_words, "repeat",
           "what lies to the left and right of the picture"),
    CHOICE(PARAM_TEXTURE, texture_entry, wrap_v, wrap_words, "repeat", "what lies above and below it"),
    CHOICE(PARAM_TEXTURE, texture_entry, space, space_words, "srgb",
           "what a PNG, JPEG or BMP file's numbers are: coded light, or light"),

    CHOICE(PARAM_LIGHT, light, kind, light_words, "point",
           "shines all around, within a cone, or in a cone from full on its axis to nothing at its edge, linear in the "
           "angle's cosine"),
    VECTOR(PARAM_LIGHT, light, position, "0,10,0", "where the light stands"),
    VECTOR(PARAM_LIGHT, light, target, "0,0,0", "point that a cone is aimed at"),
    REAL(PARAM_LIGHT, light, half_angle_deg, "deg", 0.001, 180, "30",
         "a of a cone, from its axis to its edge; of a soft cone's light (cos t - cos a) / (1 - cos a) goes into the "
         "angle t"),
    COLOR(PARAM_LIGHT, light, color, BRIGHT, "1,1,1", "linear colour, times intensity"),
    REAL(PARAM_LIGHT, light, intensity, "", 0, BRIGHT, "1", "factor of the colour; at every distance, or at reach"),
    REAL(PARAM_LIGHT, light, radius, "scene units", 0, FAR, "0",
         "of the sphere that shines, which the path integrator sees; 0 is a point"),
    REAL(PARAM_LIGHT, light, reach, "scene units", 0, FAR, "0",
         "distance at which intensity holds, less with the square of the distance; 0 for the same everywhere"),

    /* A solid has these too, by its own name (liquid.ior): see param_find. */
    COLOR(PARAM_MATERIAL, material, color, 1, "1,1,1",
          "linear colour of ambient, diffuse and emitted light; inside a clear solid what is left of light after "
          "tint_distance"),
    REAL(PARAM_MATERIAL, material, ambient, "", 0, 1, "0", "k_a of Phong's sum"),
    REAL(PARAM_MATERIAL, material, diffuse, "", 0, 1, "0", "k_d of Phong's sum"),
    REAL(PARAM_MATERIAL, material, specular, "", 0, 1, "0", "k_s of Phong's sum"),
    REAL(PARAM_MATERIAL, material, shininess, "", 0, 100000, "80",
         "n of Phong's sum: the larger, the smaller the highlight"),
    REAL(PARAM_MATERIAL, material, emission, "", 0, BRIGHT, "0",
         "k_e of Phong's sum: the surface sends out k_e times its colour, without a lamp"),
    REAL(PARAM_MATERIAL, material, reflectivity, "", 0, 1, "0",
         "share reflected by an opaque surface; by every surface under constant weights or simple transmission; under "
         "Fresnel's a clear "
         "surface's coating: R + (1 - R) reflectivity"),
    REAL(PARAM_MATERIAL, material, transparency, "", 0, 1, "0",
         "share of the refracted light that passes; 0 is opaque"),
    REAL(PARAM_MATERIAL, material, ior, "", 0.1, 1e9, "1",
         "refractive index, relative to vacuum; above 10000 a clear surface is a mirror that nothing passes"),
    CHOICE(PARAM_MATERIAL, material, medium, medium_words, "ior",
           "what gives the index: ior, a law with coefficients, or a medium of the catalogue (cuvette media)"),
    LIST(PARAM_MATERIAL, material, coefficients, "", 1e6, "[]",
         "of the law: cauchy A,B,C.. n = A + B/L^2 + C/L^4; sellmeier B1,C1,B2,C2.. (um^2); table nm,n,nm,n.. (L in "
         "um)"),
    COLOR(PARAM_MATERIAL, material, absorb_per_m, 1e9, "0,0,0",
          "absorption coefficient of Beer and Lambert by channel, 1/m"),
    LIST(PARAM_MATERIAL, material, absorb_spectrum, "nm, 1/m", 1e9, "[]",
         "the same by wavelength, as nm,1/m,nm,1/m..; takes the place of absorb_per_m"),
    POSITIVE(PARAM_MATERIAL, material, tint_distance, "scene units", FAR, "1",
             "way inside a clear solid after which white light has its color; beside what absorb_per_m takes"),
    {PARAM_MATERIAL, "texture", PARAM_WORD, "", 0, 0, false, "", "name of a texture, whose colour multiplies color",
     NULL, OF(material, texture)},
    REAL(PARAM_MATERIAL, material, texture_size, "scene units", 0, FAR, "0",
         "edge of one picture of the texture on solids that are no meshes; 0 spreads one over each face (of a plane: "
         "1)"),
    REAL(PARAM_MATERIAL, material, checker, "scene units", 0, FAR, "0",
         "edge of checker cells in the solid's frame; 0 for none"),
    COLOR(PARAM_MATERIAL, material, checker_color, 1, "0,0,0", "linear colour of every second checker cell"),

    {PARAM_SOLID, "position", PARAM_VECTOR, "scene units", -FAR, FAR, false, "0,0,0",
     "centre of a box, sphere or torus, of the base of a cylinder, cup, cone or prism, a point of a plane, a mesh's "
     "origin",
     NULL, OF(solid, shape.position)},
    {PARAM_SOLID, "rotation", PARAM_VECTOR, "deg", -360, 360, false, "0,0,0", "turn about x, then y, then z", NULL,
     OF(solid, shape.rotation_deg)},
    LENGTH(radius, "1",
           "radius; of a cup, of its outside; of a cone, at its base; of a prism, of the circle about its corners; of "
           "a torus, of the circle in the middle of its tube"),
    LENGTH(height, "1", "height above the base"),
    {PARAM_SOLID, "m", PARAM_REAL, "", 0.001, 1000, false, "1",
     "ellipse x^2 + m^2 z^2 = radius^2, of a cup's hollow too, with inner_radius; 1 is a circle", NULL, SHAPE(shape.m)},
    LENGTH(inner_radius, "0.9",
           "radius of the hollow; the wall is radius - inner_radius thick along x, 1/m of that along z"),
    LENGTH(floor, "0.1", "thickness of the bottom"),
    {PARAM_SOLID, "sides", PARAM_INT, "", 3, 60, false, "6", "of a prism: 3 has a triangle for its base", NULL,
     SHAPE(shape.sides)},
    {PARAM_SOLID, "top_radius", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "of a cone, at its top: 0 for a point, else it is a frustum", NULL, SHAPE(shape.top_radius)},
    LENGTH(tube_radius, "0.25", "of a torus, of its tube; less than radius"),
    {PARAM_SOLID, "size", PARAM_VECTOR, "scene units", 0, FAR, true, "1,1,1", "edges along x, y and z", NULL,
     SHAPE(shape.size)},
    {PARAM_SOLID, "mesh", PARAM_WORD, "", 0, 0, false, "", "name of a mesh", NULL, SHAPE(mesh)},
    {PARAM_SOLID, "scale", PARAM_VECTOR, "", 0, FAR, true, "1,1,1", "of a mesh, along its own axes", NULL,
     SHAPE(shape.scale)},
    {PARAM_SOLID, "copies", PARAM_VECTOR, "", 1, 100000, false, "1,1,1",
     "how often a mesh stands along each of its own axes", NULL, SHAPE(shape.copies)},
    {PARAM_SOLID, "spacing", PARAM_VECTOR, "scene units", -FAR, FAR, false, "1,1,1",
     "from copy to copy along its own axes, after scale; copies may touch, not overlap", NULL, SHAPE(shape.spacing)},
    {PARAM_SOLID, "shading", PARAM_CHOICE, "", 0, 0, false, "smooth",
     "of a mesh: by its triangles, by normals between its vertices, or light between them", shading_words,
     SHAPE(shading)},
    INTEGER(PARAM_SOLID, solid, priority, "", -1000000, 1000000, "0",
            "where solids overlap the highest one is there; of equal ones the first listed"),
    CHOICE(PARAM_SOLID, solid, visible, off_on, "on", "off leaves the solid out of the picture altogether"),
};

enum { TABLE_COUNT = sizeof table / sizeof table[0] };

size_t param_count(void)
{
    return TABLE_COUNT;
}

const param *param_at(size_t index)
{
    return index < TABLE_COUNT ? &table[index] : NULL;
}

const char *param_group_name(param_group group)
{
    static const char *const names[] = {"render",  "camera", "background", "mesh",
                                        "texture", "light",  "material",   "solid"};
    return (size_t)group < PARAM_GROUP_COUNT ? names[group] : "";
}

static const param *find_own(param_group group, const char *name)
{
    for (size_t i = 0; i < TABLE_COUNT; i++)
        if (table[i].group == group && strcmp(table[i].name, name) == 0)
            return &table[i];
    return NULL;
}

const param *param_find(param_group group, const char *name)
{
    const param *row = find_own(group, name);
    return !row && group == PARAM_SOLID ? find_own(PARAM_MATERIAL, name) : row;
}
