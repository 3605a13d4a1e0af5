/* The parameter table: a new parameter is a row here, and a field in the struct of its group (render_settings.h,
 * material.h, lights.h, solids.h, view_settings.h). */
#include "scene/model/lights.h"
#include "scene/model/medium.h"
#include "scene/model/params.h"
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
static const char *const caustics_words[] = {"off", "photons", NULL};
static const char *const schedule_words[] = {"columns", "rows", "tiles", "dynamic", NULL};
static const char *const pin_words[] = {"none", "compact", "scatter", NULL};
static const char *const lighting_words[] = {"lambert", "phong", "whitted", NULL};
static const char *const spectrum_words[] = {"rgb", "spectral", NULL};
static const char *const accel_words[] = {"none", "sphere", "octant", "bvh", NULL};
static const char *const sampler_words[] = {"philox", "sobol", NULL};
static const char *const pixel_filter_words[] = {"centre", "box", NULL};
static const char *const light_sampling_words[] = {"all", "one", NULL};
static const char *const texturing_words[] = {"perspective", "affine", NULL};
static const char *const shading_words[] = {"flat", "smooth", "gouraud", NULL};
/* arrays: triangles from a program that uses the library; a scene file cannot contain them */
static const char *const source_words[] = {"file",  "sparse",  "dense", "sphere", "icosphere", "torus",
                                           "lathe", "terrain", "box",   "slime",  "arrays",    NULL};
static const char *const handedness_words[] = {"file", "right", "left", NULL};
static const char *const motion_words[] = {"euler", "verlet", "implicit", NULL};
static const char *const filter_words[] = {"nearest", "bilinear", "trilinear", NULL};
static const char *const alpha_words[] = {"opaque", "mask", "blend", NULL};
static const char *const wrap_words[] = {"repeat", "mirror", "clamp", NULL};
static const char *const space_words[] = {"srgb", "linear", NULL};
static const char *const reference_words[] = {"air", "vacuum", NULL};
static const char *const projection_words[] = {"perspective", "orthographic", NULL};
static const char *const analyser_words[] = {"none", "linear", "circular_left", "circular_right", NULL};
static const char *const sheet_words[] = {"none", "polariser", "circular_left", "circular_right", "retarder", NULL};
static const char *const tone_words[] = {"none", "reinhard", "aces", NULL};
static const char *const light_words[] = {"point", "cone", "soft_cone", "disc", "rectangle", "sun", NULL};
/* as enum lamp_spectrum */
static const char *const lamp_words[] = {"color", "black_body", "sodium", "mercury", "hydrogen", "line", "data", NULL};
static const char *const profile_words[] = {"uniform", "gaussian", NULL};
static const char *const beam_words[] = {"pencil", "fan", "sheet", "bundle", NULL};
static const char *const side_form_words[] = {"round", "biconic", "toric", NULL};
static const char *const pattern_words[] = {"spiral", "rings", "square", "sobol", NULL};
static const char *const background_words[] = {"uniform", "gradient", "image", "rain", "cie", NULL};

enum { ON_SLIME = 1 << MESH_SLIME, ON_ALL = 0 };

/* Positions and lengths are limited so that doubles resolve 1e-10 of a scene unit. */
#define FAR 1e6
/* Far below the film's limit of 524288, with room for many lights. */
#define BRIGHT 1e4

/* Positional members up to `choices`; then OF(struct, field), which gives `makers` and `offset`; then designated
 * members. */
#define ROW(group, name, kind, unit, low, high, above, fallback, meaning, words, ...)    \
    {                                                                                    \
        group, name, kind, unit, low, high, above, fallback, meaning, words, __VA_ARGS__ \
    }
#define OF(type, field) ON_ALL, .offset = offsetof(type, field)
#define PERFORMANCE(field) OF(render_settings, field), .performance_only = true
/* For the display of images, on which the film does not depend. */
#define SHOWN(field) OF(camera, field), .performance_only = true
/* For random paths only: see param.by_chance. */
#define BY_CHANCE(field) OF(render_settings, field), .by_chance = true
/* For slimes only. */
#define SLIME(field) ON_SLIME, .offset = offsetof(mesh_entry, slime.field)
/* Sliders: two decades on both sides of the default and the value, for positive numbers of any size; or five decades
 * from 0 to a usual maximum. */
#define DECADES .slider = {.log_from = 1}
#define UP_TO(most) .slider = {0, most, 0, 1e-5 * (most)}
#define COEFFICIENT .coefficient = true, UP_TO(100)
/* Parameters of beams. If a beam does not light the scene, the film does not depend on it (scene_film_depends_on); it
 * never depends on how beams are traced and drawn (BEAM_SHOWN). */
#define BEAM(field) OF(beam, field)
#define BEAM_SHOWN(field) OF(beam, field), .performance_only = true
#define BEAM_REAL(field, unit, low, high, fallback, meaning) \
    ROW(PARAM_BEAM, #field, PARAM_REAL, unit, low, high, false, fallback, meaning, NULL, BEAM(field))
#define BEAM_INTEGER(field, low, high, fallback, meaning) \
    ROW(PARAM_BEAM, #field, PARAM_INT, "", low, high, false, fallback, meaning, NULL, BEAM_SHOWN(field))
#define BEAM_CHOICE(field, words, fallback, meaning) \
    ROW(PARAM_BEAM, #field, PARAM_CHOICE, "", 0, 0, false, fallback, meaning, words, BEAM(field))
#define BEAM_VECTOR(field, unit, fallback, meaning) \
    ROW(PARAM_BEAM, #field, PARAM_VECTOR, unit, -FAR, FAR, false, fallback, meaning, NULL, BEAM(own.field))
/* For some shapes: see geometry/shapes/shape.h. */
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
/* A coefficient of an even asphere. */
#define ASPHERIC(side, power, at, unit)                                               \
    {                                                                                 \
        PARAM_SOLID, "a" #power "_" #side, PARAM_REAL, unit, -1e30, 1e30, false, "0", \
            "lens: coefficient of r^" #power " in the sag of side " #side             \
            " at a distance r from the axis, added to its "                           \
            "sphere or conic (an even asphere)",                                      \
            NULL, SHAPE(shape.even_##side[at])                                        \
    }
#define ODD(side, power, at, unit)                                                         \
    {                                                                                      \
        PARAM_SOLID, "a" #power "_" #side, PARAM_REAL, unit, -1e30, 1e30, false, "0",      \
            "lens: coefficient of r^" #power " in the sag of side " #side ", as a4_" #side \
            " (an odd asphere; 1 alone: an axicon's cone)",                                \
            NULL, SHAPE(shape.odd_##side[at])                                              \
    }
#define LENGTH(field, fallback, meaning) \
    ROW(PARAM_SOLID, #field, PARAM_REAL, "scene units", 0, FAR, true, fallback, meaning, NULL, SHAPE(shape.field))

/* Rows in the order in which they are listed and printed, by group.
 *
 * A material's coefficients default to 0: an image shows only the terms of Phong's equation and the branches of the ray
 * tree that its scene enables, and clear glass needs no line that removes a diffuse coat. A colour is a factor, so it
 * defaults to white. shininess has no effect without a specular coefficient; 80 is the value of the published rod
 * scene. ior defaults to vacuum, so that nothing refracts. */
static const param table[] = {
    INTEGER(PARAM_RENDER, render_settings, width, "px", 1, 65536, "800", "width of the image"),
    INTEGER(PARAM_RENDER, render_settings, height, "px", 1, 65536, "600", "height of the image"),
    ROW(PARAM_RENDER, "depth", PARAM_INT, "", 0, DEPTH_TREE_MAX, false, "4",
        "recursion depth; 0: camera rays only; unlimited: random paths only", NULL, OF(render_settings, depth),
        .automatic = "unlimited", .automatic_value = DEPTH_UNLIMITED),
    {PARAM_RENDER, "samples", PARAM_INT, "", 1, SCENE_SAMPLES_MAX, false, "1",
     "camera rays per pixel, through the centres of a regular grid of cells; 1: no antialiasing", sample_counts,
     OF(render_settings, samples)},
    CHOICE(PARAM_RENDER, render_settings, integrator, integrator_words, "whitted",
           "ray casting (first hit only), Whitted ray tracing, path tracing, a z-buffer rasteriser, or the AOV "
           "layers of the first hits"),
    CHOICE(PARAM_RENDER, render_settings, layer, layer_words, "normal",
           "layer shown by integrator aov: normal, albedo, distance, index of the solid or of its material, or "
           "position of the first hit"),
    CHOICE(PARAM_RENDER, render_settings, lighting, lighting_words, "whitted",
           "diffuse shading; diffuse and specular shading; or these plus reflection and refraction; not used by "
           "integrator path"),
    CHOICE(PARAM_RENDER, render_settings, weights, weights_words, "fresnel",
           "weights of the reflected and refracted rays: from the Fresnel equations, or from the material's "
           "constants"),
    CHOICE(PARAM_RENDER, render_settings, transmission, transmission_words, "refract",
           "at transparent surfaces: refraction by Snell's law, or straight transmission weighted by the "
           "material's constants"),
    CHOICE(PARAM_RENDER, render_settings, beyond, depth_limit_words, "sky",
           "radiance of a ray beyond the depth limit: the sky in its direction, black, or the mean of the sky "
           "over all directions"),
    CHOICE(PARAM_RENDER, render_settings, radiance, radiance_words, "classic",
           "quantity carried by rays: radiance L, unchanged by refraction (Whitted), or basic radiance L / n^2, "
           "which refraction conserves"),
    CHOICE(PARAM_RENDER, render_settings, shadows, shadows_words, "attenuated",
           "shadow rays: none, blocked by every solid, or attenuated by transparent solids without refraction "
           "(no caustics)"),
    CHOICE(PARAM_RENDER, render_settings, soft_shadows, off_on, "off",
           "on: each ray of whitted and raycast samples one random point of a light with a size, so that with many "
           "samples shadows have soft edges; off: its centre"),
    CHOICE(PARAM_RENDER, render_settings, caustics, caustics_words, "off",
           "light that mirrors and transparent solids throw on matte surfaces: none, or by photons traced from the "
           "lamps; then shadows are opaque and radiance is basic"),
    ROW(PARAM_RENDER, "photons", PARAM_INT, "", 1, 67108864, false, "300000",
        "photons that the lamps send towards mirrors and transparent solids, for caustics", NULL,
        OF(render_settings, photons), DECADES),
    REAL(PARAM_RENDER, render_settings, min_weight, "", 0, 1, "0",
         "rays with a throughput below this are not traced; 0: trace the whole tree"),
    ROW(PARAM_RENDER, "paths", PARAM_INT, "", 1, 1048576, false, "16", "paths per pixel of integrator path", NULL,
        OF(render_settings, paths), DECADES),
    ROW(PARAM_RENDER, "error", PARAM_REAL, "", 0, 1e3, false, "0",
        "target standard error of a pixel for integrator path: a pilot render chooses the number of paths, at most "
        "render.paths; 0: render.paths everywhere",
        NULL, BY_CHANCE(error)),
    ROW(PARAM_RENDER, "sampler", PARAM_CHOICE, "", 0, 0, false, "sobol",
        "sample points of integrator path: independent random numbers (Philox), or a scrambled Sobol sequence, whose "
        "error falls faster",
        sampler_words, BY_CHANCE(sampler), .first_default = "philox"),
    ROW(PARAM_RENDER, "filter", PARAM_CHOICE, "", 0, 0, false, "box",
        "pixel filter of integrator path: through the centres of the grid of render.samples only, or the mean over the "
        "pixel (random points)",
        pixel_filter_words, BY_CHANCE(filter), .first_default = "centre"),
    ROW(PARAM_RENDER, "light_sampling", PARAM_CHOICE, "", 0, 0, false, "one",
        "lights that integrator path samples at a matte surface: all, or one, chosen at random by its brightness there",
        light_sampling_words, BY_CHANCE(light_sampling), .first_default = "all"),
    CHOICE(PARAM_RENDER, render_settings, roulette, off_on, "off",
           "Russian roulette: faint paths end at random, and the survivors' weights are raised; integrator path"),
    CHOICE(PARAM_RENDER, render_settings, energy_compensation, off_on, "off",
           "rough surfaces: off: light that one facet reflects to another is lost; on: it is added again; "
           "integrator path"),
    INTEGER(PARAM_RENDER, render_settings, seed, "", 0, 2147483647, "1", "seed of the random numbers"),
    CHOICE(PARAM_RENDER, render_settings, polarisation, off_on, "off",
           "on: trace the Stokes vector of each ray (Mueller matrices of the Fresnel equations); off: average "
           "both polarisations at each interface"),
    CHOICE(PARAM_RENDER, render_settings, spectrum, spectrum_words, "rgb",
           "rgb: three channels with the refractive indices of one wavelength; spectral: sampled wavelengths "
           "with their own indices, weighted by the CIE 1931 observer"),
    INTEGER(PARAM_RENDER, render_settings, wavelengths, "", 1, 65536, "32",
            "wavelengths per camera ray of the spectral film, from 380 to 780 nm"),
    REAL(PARAM_RENDER, render_settings, lambda_nm, "nm", 200, 2000, "587.5618",
         "wavelength of the refractive indices of the rgb film; the default is the d line"),
    POSITIVE(PARAM_RENDER, render_settings, unit_m, "m", 1e6, "1",
             "length of one scene unit, for absorption and birefringence"),
    ROW(PARAM_RENDER, "threads", PARAM_INT, "", 1, 1024, false, "1",
        "worker threads; auto: one per processing unit that the process may use", NULL, PERFORMANCE(threads),
        .automatic = "auto"),
    PERFORMANCE_CHOICE(pool, off_on, "on", "keep worker threads between frames; off: start new threads for each frame"),
    PERFORMANCE_CHOICE(
        schedule, schedule_words, "dynamic",
        "distribution of the image over the workers: fixed blocks of columns, of rows, fixed tiles, or tiles "
        "on demand"),
    PERFORMANCE_INTEGER(tile, "px", 1, 65536, "32", "edge of a tile"),
    PERFORMANCE_INTEGER(tiles_per_worker, "", 0, 1024, "4",
                        "minimum number of tiles per worker: the edge of a tile is halved until it is reached; 0: "
                        "always render.tile"),
    PERFORMANCE_CHOICE(pin, pin_words, "none",
                       "thread pinning: none, on adjacent processing units, or on distant ones"),
    PERFORMANCE_CHOICE(accel, accel_words, "bvh",
                       "acceleration structure of a mesh: none, one bounding sphere, the published rod report's octree "
                       "of spheres, or a BVH"),
    PERFORMANCE_INTEGER(build_threads, "", 0, 1024, "0", "threads that build hierarchies; 0: one per processing unit"),
    PERFORMANCE_CHOICE(keep, off_on, "on",
                       "keep the hierarchies of meshes between frames; off: rebuild them for every frame"),
    PERFORMANCE_REAL(
        rebuild, "", 1, 1e6, "1.5",
        "rebuild the BVH of a deforming mesh when its expected cost exceeds its cost at the last build by this "
        "factor"),
    PERFORMANCE_CHOICE(count_tests, off_on, "off",
                       "count the boxes, spheres and triangles of meshes that each ray tests, in a separate traversal "
                       "that adds to the time"),
    CHOICE(PARAM_RENDER, render_settings, texturing, texturing_words, "perspective",
           "texture interpolation of the rasteriser: perspective-correct or affine"),

    VECTOR(PARAM_CAMERA, camera, position, "0,1,-6", "position of the camera"),
    VECTOR(PARAM_CAMERA, camera, target, "0,1,0", "point at the centre of the image; replaces the angles"),
    REAL(PARAM_CAMERA, camera, yaw_deg, "deg", -360, 360, "0", "azimuth: 0 along +z, 90 along +x; replaces the target"),
    REAL(PARAM_CAMERA, camera, pitch_deg, "deg", -90, 90, "0", "elevation: 90 looks straight up; replaces the target"),
    REAL(PARAM_CAMERA, camera, roll_deg, "deg", -360, 360, "0",
         "rotation about the viewing direction: positive tilts the camera to its right and turns the image "
         "counter-clockwise"),
    CHOICE(
        PARAM_CAMERA, camera, projection, projection_words, "perspective",
        "perspective: rays from one point; orthographic: parallel rays, so that sizes do not depend on the distance"),
    POSITIVE(PARAM_CAMERA, camera, fov_deg, "deg", 179, "45", "vertical field of view of a perspective camera"),
    POSITIVE(PARAM_CAMERA, camera, view_height, "scene units", FAR, "5",
             "height of an orthographic camera's image in the scene"),
    REAL(PARAM_CAMERA, camera, aperture, "scene units", 0, FAR, "0",
         "diameter of a thin lens, which blurs what is out of focus and needs several rays per pixel; 0: a pinhole"),
    POSITIVE(PARAM_CAMERA, camera, focus, "scene units", FAR, "6",
             "distance of the plane in focus from the camera, along the viewing direction"),
    CHOICE(
        PARAM_CAMERA, camera, analyser, analyser_words, "none",
        "ideal polarising filter before the eye, with render.polarisation: none, linear, or for left- or right-handed "
        "circular light"),
    REAL(PARAM_CAMERA, camera, analyser_angle_deg, "deg", -360, 360, "0",
         "axis of a linear analyser: 0 transmits a field along the image's width, 90 along its height"),
    ROW(PARAM_CAMERA, "exposure", PARAM_REAL, "stops", -64, 64, false, "0",
        "images with 8 bits show the radiance times 2^exposure; films and files of floats or 16 bits stay as they are",
        NULL, SHOWN(exposure)),
    ROW(PARAM_CAMERA, "tone", PARAM_CHOICE, "", 0, 0, false, "none",
        "tone curve of images with 8 bits: none, Reinhard et al. 2002 (equation 4), or Narkowicz's fit of ACES",
        tone_words, SHOWN(tone)),
    ROW(PARAM_CAMERA, "white", PARAM_REAL, "", 0, 1e6, true, "4",
        "tone curve reinhard: the least luminance, after the exposure, that is white", NULL, SHOWN(white)),

    CHOICE(PARAM_BACKGROUND, background, kind, background_words, "uniform",
           "one colour, a vertical gradient, an equirectangular image, a gradient with sunlit rain in front of it: "
           "rainbows; or a CIE standard general sky, whose luminance depends on the sun"),
    COLOR(PARAM_BACKGROUND, background, color, BRIGHT, "0.53,0.75,0.92",
          "linear colour; of a gradient or a CIE sky: at the zenith"),
    COLOR(PARAM_BACKGROUND, background, horizon, BRIGHT, "1,1,1",
          "linear colour of a gradient at the horizon and below, and of a CIE sky below the horizon"),
    {PARAM_BACKGROUND, "image", PARAM_PATH, "", 0, 0, false, "",
     IMAGE_FORMATS " file, relative to the scene file; sets kind to image", NULL, OF(background, image_path)},
    REAL(PARAM_BACKGROUND, background, brightness, "", 0, BRIGHT, "1", "factor of the radiance of the image"),
    REAL(PARAM_BACKGROUND, background, rain, "", 0, BRIGHT, "0.3",
         "brightness of the rain: its radiance if drops scattered sunlight evenly in all directions"),
    ROW(PARAM_BACKGROUND, "drops", PARAM_CHOICE, "", 0, 0, false, "water", "liquid of the rain's drops, in air",
        surrounding_words + SURROUNDING_CATALOGUE + DROPS_FIRST, OF(background, drops)),
    REAL(PARAM_BACKGROUND, background, sun_elevation_deg, "deg", -90, 90, "20",
         "elevation of the sun that shines on the rain or in a CIE sky, unless a light is a sun; it is not drawn"),
    REAL(PARAM_BACKGROUND, background, sun_azimuth_deg, "deg", -360, 360, "180",
         "azimuth of the background's sun: 0 along +z, 90 along +x; 180 is behind a camera along +z"),
    INTEGER(PARAM_BACKGROUND, background, sky_type, "", 1, CIE_SKY_TYPES, "12",
            "type of a CIE standard general sky (ISO 15469), from 1, overcast, to 15; 12: the standard clear sky"),
    COLOR(PARAM_BACKGROUND, background, ambient, BRIGHT, "1,1,1", "ambient light, I_a of the Phong model"),

    REAL(PARAM_BACKGROUND, background, ior, "", 0.1, 100, "1",
         "refractive index of the surrounding medium, relative to vacuum"),
    CHOICE(PARAM_BACKGROUND, background, medium, surrounding_words, "ior",
           "the surrounding medium: given by ior, or one of the catalogue"),
    ROW(PARAM_BACKGROUND, "absorb_per_m", PARAM_COLOR, "", 0, 1e9, false, "0,0,0",
        "absorption coefficient of the surrounding medium by channel, 1/m, along rays that end at a surface "
        "or a light; light from the sky is not attenuated",
        NULL, OF(background, absorb_per_m), COEFFICIENT),

    {PARAM_MESH, "generate", PARAM_CHOICE, "", 0, 0, false, "file", "generated shape; file: read the mesh from a file",
     source_words, OF(mesh_entry, source)},
    {PARAM_MESH, "file", PARAM_PATH, "", 0, 0, false, "",
     "OBJ, PLY, STL or glTF file, or a file of points (.xyz), relative to the scene file", NULL, OF(mesh_entry, path)},
    CHOICE(PARAM_MESH, mesh_entry, handedness, handedness_words, "file",
           "axes of the file; the z of right-handed ones changes its sign, because the world is left-handed; file: "
           "right, but left for a file of points"),
    ROW(PARAM_MESH, "count", PARAM_INT, "", 1, 100000000, false, "10000",
        "number of triangles of sparse and dense; of sphere: the nearest 20 f^2", NULL, OF(mesh_entry, count), DECADES),
    INTEGER(PARAM_MESH, mesh_entry, level, "", 0, 11, "4",
            "subdivision level of an icosphere or slime: 20 * 4^level triangles; of a slime at most 7"),
    POSITIVE(PARAM_MESH, mesh_entry, major, "scene units", FAR, "1",
             "torus: distance from the axis to the centre of the tube"),
    POSITIVE(PARAM_MESH, mesh_entry, minor, "scene units", FAR, "0.4", "torus: radius of the tube"),
    INTEGER(PARAM_MESH, mesh_entry, around, "", 3, 16384, "64",
            "torus and lathe: segments around the axis; terrain: cells along x"),
    INTEGER(PARAM_MESH, mesh_entry, tube, "", 3, 16384, "32",
            "torus: segments around the tube; terrain: cells along z"),
    LIST(PARAM_MESH, mesh_entry, profile, "scene units", FAR, "[0,0,1,0,1,1,0,1]",
         "lathe: the profile as radius, height, radius, height and so on"),
    REAL(PARAM_MESH, mesh_entry, crease_deg, "deg", 0, 180, "30",
         "lathe: crease angle; the profile has a sharp edge where it turns by more"),
    {PARAM_MESH, "size", PARAM_VECTOR, "scene units", 0, FAR, true, "1,1,1",
     "box: edge lengths; terrain: extent, with the height of the hills as y", NULL, OF(mesh_entry, size)},
    REAL(PARAM_MESH, mesh_entry, depth, "scene units", 0, FAR, "0",
         "terrain: depth of the flat bottom below y = 0; 0: open below"),
    INTEGER(PARAM_MESH, mesh_entry, seed, "", 0, 2147483647, "1", "terrain: seed of the hills"),
    {PARAM_MESH, "time_s", PARAM_REAL, "s", 0, 86400, false, "0", "slime: simulated time of the shown state", NULL,
     ON_SLIME, .offset = offsetof(mesh_entry, time_s)},
    {PARAM_MESH, "script", PARAM_PATH, "", 0, 0, false, "", "slime: YAML script of grabs, relative to the scene file",
     NULL, ON_SLIME, .offset = offsetof(mesh_entry, script_path)},
    ROW(PARAM_MESH, "radius", PARAM_REAL, "scene units", 0, 1e3, true, "1", "slime: radius of the sphere at rest", NULL,
        SLIME(radius), .slider = {0.01, 2.5, 0.01, 0}),
    SLIME_VECTOR(position, "scene units", FAR, "0,1,0", "slime: initial position of the centre, in the mesh's frame"),
    SLIME_VECTOR(velocity, "scene units/s", 1e3, "0,0,0", "slime: initial velocity"),
    ROW(PARAM_MESH, "mass_kg", PARAM_REAL, "kg", 1e-6, 1e6, false, "1",
        "slime: total mass, distributed evenly over the vertices", NULL, SLIME(mass_kg), DECADES),
    ROW(PARAM_MESH, "stiffness", PARAM_REAL, "N/scene unit", 0, 1e9, false, "10",
        "slime: stiffness of each edge spring", NULL, SLIME(stiffness), UP_TO(200)),
    SLIME_REAL(bending, "N/scene unit", 0, 1e9, false, "4",
               "slime: stiffness of each bending spring, across two adjacent faces"),
    SLIME_REAL(through, "N/scene unit", 0, 1e9, false, "100",
               "slime: total stiffness of the springs through the interior"),
    ROW(PARAM_MESH, "damping", PARAM_REAL, "N s/scene unit", 0, 1e6, false, "0.04", "slime: damping along each spring",
        NULL, SLIME(damping), UP_TO(2)),
    ROW(PARAM_MESH, "pressure", PARAM_REAL, "N/scene unit^2", 0, 1e9, false, "300",
        "slime: pressure at zero volume; it decreases linearly with the volume to zero at rest", NULL, SLIME(pressure),
        UP_TO(5000)),
    ROW(PARAM_MESH, "gravity", PARAM_VECTOR, "scene units/s^2", -1e6, 1e6, false, "0,-9.81,0",
        "slime: gravitational acceleration", NULL, SLIME(gravity), .slider = {-30, 30, 0.05, 0}),
    SLIME_CHOICE(ground, off_on, "on", "slime: a floor at height ground_y of the mesh's frame"),
    SLIME_REAL(ground_y, "scene units", -FAR, FAR, false, "0", "slime: height of the floor"),
    SLIME_REAL(restitution, "", 0, 1, false, "0.3", "slime: coefficient of restitution at the floor"),
    SLIME_REAL(friction, "", 0, 1e3, false, "2", "slime: Coulomb friction coefficient at the floor"),
    SLIME_CHOICE(integrator, motion_words, "euler",
                 "slime: time integrator: semi-implicit Euler, velocity Verlet, or backward Euler, which is stable "
                 "for stiff springs"),
    ROW(PARAM_MESH, "dt_s", PARAM_REAL, "s", 1e-9, 1, false, "0.001",
        "slime: time step; the default is stable up to level 4; above it, use a smaller step or adaptive", NULL,
        SLIME(dt_s), DECADES),
    SLIME_CHOICE(adaptive, off_on, "off",
                 "slime: split time steps until they are stable and change no spring's length by more than a tenth"),
    {PARAM_MESH, "threads", PARAM_INT, "", 1, 1024, false, "1",
     "slime: simulation threads; at most one per 4096 masses is started", NULL, ON_SLIME,
     .offset = offsetof(mesh_entry, slime.threads), .performance_only = true},

    {PARAM_TEXTURE, "file", PARAM_PATH, "", 0, 0, false, "",
     IMAGE_FORMATS " file; its path is relative to the scene file's folder", NULL, OF(texture_entry, path)},
    CHOICE(PARAM_TEXTURE, texture_entry, filter, filter_words, "trilinear",
           "nearest texel; bilinear, of four texels; or trilinear, of two mipmap levels"),
    CHOICE(PARAM_TEXTURE, texture_entry, wrap_u, wrap_words, "repeat", "horizontal wrap mode"),
    CHOICE(PARAM_TEXTURE, texture_entry, wrap_v, wrap_words, "repeat", "vertical wrap mode"),
    CHOICE(PARAM_TEXTURE, texture_entry, space, space_words, "srgb",
           "values of a PNG, JPEG or BMP file: colours, by its colour space or sRGB; or linear, the numbers in it"),

    {PARAM_DATA, "file", PARAM_PATH, "", 0, 0, false, "",
     "file of optical data by wavelength: of refractiveindex.info (.yml), a glass catalogue (.agf), or a table of "
     "numbers (.csv and others); its path is relative to the scene file's folder",
     NULL, OF(data_entry, path)},
    {PARAM_DATA, "glass", PARAM_WORD, "", 0, 0, false, "", "glass of a catalogue; empty if it has only one", NULL,
     OF(data_entry, glass)},
    {PARAM_DATA, "column", PARAM_WORD, "", 0, 0, false, "",
     "column of a table: its name in the header, or its number from 2; empty: the second, and a third of k", NULL,
     OF(data_entry, column)},
    REAL(PARAM_DATA, data_entry, scale, "", -1e9, 1e9, "1", "factor of the values, such as 0.01 for percent"),
    CHOICE(PARAM_DATA, data_entry, relative_to, reference_words, "air",
           "what a refractive index is relative to: air, as in glass catalogues and by refractometers, or vacuum"),

    CHOICE(PARAM_LIGHT, light, kind, light_words, "point",
           "point light, spotlight with a hard edge, or spotlight whose intensity falls to zero at the edge, "
           "linear in the cosine of the angle; a disc or a rectangle that emits by Lambert's law on one side; or a "
           "sun, infinitely far away in the direction from target to position"),
    VECTOR(PARAM_LIGHT, light, position, "0,10,0", "position of the light, or of its centre"),
    VECTOR(PARAM_LIGHT, light, target, "0,0,0", "point at which a spotlight, a disc, a rectangle or a sun is aimed"),
    REAL(PARAM_LIGHT, light, half_angle_deg, "deg", 0.001, 180, "30",
         "half-angle a of a spotlight's cone; a soft cone has the falloff (cos t - cos a) / (1 - cos a) at "
         "angle t"),
    COLOR(PARAM_LIGHT, light, color, BRIGHT, "1,1,1", "linear colour, multiplied by intensity"),
    REAL(PARAM_LIGHT, light, intensity, "", 0, BRIGHT, "1",
         "multiplies the light's colour: at all distances, or, if reach is set, at that distance"),
    CHOICE(PARAM_LIGHT, light, spectrum, lamp_words, "color",
           "spectrum of the light: smooth, from its colour (white: D65); of a black body; the lines of sodium, mercury "
           "or hydrogen; one line; or of a file (spectrum_data); all but the first have the brightness of white and "
           "replace the colour"),
    {PARAM_LIGHT, "spectrum_data", PARAM_WORD, "", 0, 0, false, "",
     "data with the spectral power of the light by wavelength, in any unit, if spectrum is data", NULL,
     OF(light, spectrum_data), .names = "data"},
    REAL(PARAM_LIGHT, light, temperature_k, "K", LAMP_COLDEST_K, LAMP_HOTTEST_K, "2856",
         "temperature of a black body; 2856: CIE illuminant A, an incandescent lamp"),
    REAL(PARAM_LIGHT, light, line_nm, "nm", OBSERVER_LOW_NM, OBSERVER_HIGH_NM, "632.8",
         "wavelength of a light of one line; 632.8: a helium-neon laser"),
    REAL(PARAM_LIGHT, light, radius, "scene units", 0, FAR, "0",
         "radius of the emitting sphere or disc, sampled by integrator path and with render.soft_shadows; 0: a point"),
    REAL(PARAM_LIGHT, light, width, "scene units", 0, FAR, "1",
         "width of a rectangle, horizontal unless it is aimed straight up or down: then along x; 0: a point"),
    REAL(PARAM_LIGHT, light, height, "scene units", 0, FAR, "1", "height of a rectangle; 0: a point"),
    REAL(PARAM_LIGHT, light, roll_deg, "deg", -360, 360, "0", "rotation of a rectangle about its axis"),
    REAL(PARAM_LIGHT, light, angular_diameter_deg, "deg", 0, 90, "0.53",
         "angular diameter of a sun, sampled by integrator path and with render.soft_shadows; 0.53: the real sun; 0: "
         "parallel light"),
    REAL(PARAM_LIGHT, light, reach, "scene units", 0, FAR, "0",
         "distance at which the intensity applies, with inverse-square falloff; 0: no falloff"),
    REAL(PARAM_LIGHT, light, polarised, "", 0, 1, "0",
         "degree of linear polarisation of the light, with render.polarisation; 0: unpolarised"),
    REAL(PARAM_LIGHT, light, polarisation_deg, "deg", -360, 360, "0",
         "direction of a polarised light's field about its axis, of a point light about each ray: 0 is horizontal, 90 "
         "upright (of an axis straight up or down, 0 is along x)"),

    BEAM_CHOICE(
        kind, beam_words, "pencil",
        "rays from one point in a cone (pencil) or in a plane (fan), or parallel rays in a plane (sheet) or over "
        "a disc (bundle)"),
    {PARAM_BEAM, "follows", PARAM_WORD, "", 0, 0, false, "",
     "name of a solid with which the beam moves, turns and is scaled: its position, target, direction, normal and "
     "widths are then in that solid's frame",
     NULL, BEAM(follows), .names = "solid"},
    BEAM_VECTOR(position, "scene units", "-3,1,0", "start of the axis"),
    BEAM_VECTOR(target, "scene units", "0,1,0", "point on the axis"),
    BEAM_VECTOR(direction, "", "0,0,0", "direction of the axis, of any length; 0,0,0: towards the target"),
    BEAM_VECTOR(normal, "", "0,0,0",
                "fan and sheet: normal of the plane of the rays; 0,0,0: up for a horizontal beam, else horizontal"),
    BEAM_INTEGER(rays, 1, BEAM_RAYS_MAX, "1", "number of rays of each wavelength and field point; 1: only the axis"),
    BEAM_REAL(angle_deg, "deg", 0, 179, "10", "pencil and fan: full angle between the outermost rays"),
    ROW(PARAM_BEAM, "width", PARAM_REAL, "scene units", 0, FAR, false, "0.5",
        "sheet and bundle: distance between the outermost rays", NULL, BEAM(own.width)),
    ROW(PARAM_BEAM, "pattern", PARAM_CHOICE, "", 0, 0, false, "spiral",
        "places of the rays of a pencil and a bundle, each in an equal part of the cone or disc: a spiral; the largest "
        "number of full rings (1, 7, 19, 37, 61, ... rays) or the largest square grid that `rays` suffices for; or the "
        "points of Sobol'",
        pattern_words, BEAM_SHOWN(pattern)),
    BEAM_INTEGER(field_columns, 1, BEAM_FIELDS_MAX, "1",
                 "number of field points side by side: starts of a pencil or fan, directions of a sheet or bundle, "
                 "which all pass the same disc at the position"),
    BEAM_INTEGER(field_rows, 1, BEAM_FIELDS_MAX, "1", "number of field points one above the other"),
    ROW(PARAM_BEAM, "field_deg", PARAM_REAL, "deg", 0, 170, false, "10",
        "sheet and bundle: full angle between the outermost field points, in both directions", NULL,
        BEAM_SHOWN(field_deg)),
    ROW(PARAM_BEAM, "field_width", PARAM_REAL, "scene units", 0, FAR, false, "1",
        "pencil and fan: distance between the outermost field points, in both directions", NULL,
        BEAM_SHOWN(own.field_width)),
    BEAM_CHOICE(white, off_on, "off", "on: white light, as several wavelengths; off: only lambda_nm"),
    BEAM_REAL(lambda_nm, "nm", 200, 2000, "587.5618", "wavelength in vacuum; the default is the d line"),
    BEAM_INTEGER(wavelengths, 1, 64, "7", "wavelengths of white light, evenly from 400 to 700 nm, of equal power"),
    BEAM_REAL(power, "", 0, 1e9, "1", "total power of all rays and field points at their starts, in any unit"),
    ROW(PARAM_BEAM, "branches", PARAM_CHOICE, "", 0, 0, false, "on",
        "on: at each surface the reflected and the refracted ray; off: only the refracted ray, or the reflected one "
        "if there is none",
        off_on, BEAM_SHOWN(branches)),
    BEAM_INTEGER(depth, 0, BEAM_DEPTH_MAX, "8",
                 "number of surfaces at which a ray is followed; with both branches at most 64"),
    ROW(PARAM_BEAM, "min_fraction", PARAM_REAL, "", 0, 1, false, "0.01",
        "rays with a smaller fraction of the power are not followed", NULL, BEAM_SHOWN(min_fraction)),
    ROW(PARAM_BEAM, "color", PARAM_COLOR, "", 0, 1, false, "0,0,0",
        "linear colour of the drawn lines; black: the colour of the wavelength", NULL, BEAM_SHOWN(color)),
    BEAM_CHOICE(visible, off_on, "on", "off: the beam is left out"),
    BEAM_CHOICE(lights, off_on, "off",
                "on: the beam also lights matte surfaces, with render.caustics=photons; its irradiance is its power "
                "per area, whatever its wavelength and its number of rays"),
    BEAM_CHOICE(profile, profile_words, "uniform",
                "profile of a beam that lights: even over its angle or width, or gaussian, exp(-2 r^2 / w^2) with 2 w "
                "as its angle or width"),

    /* Solids have these rows as well, by their own names (liquid.ior): see param_find. */
    COLOR(PARAM_MATERIAL, material, color, 1, "1,1,1",
          "linear colour of ambient, diffuse and emitted light; in a transparent solid: transmittance over "
          "tint_distance"),
    {PARAM_MATERIAL, "color_data", PARAM_WORD, "", 0, 0, false, "",
     "data with the reflectance of the surface by wavelength, 0 to 1, or of a transparent solid the transmittance over "
     "tint_distance; replaces color",
     NULL, OF(material, color_data), .names = "data"},
    REAL(PARAM_MATERIAL, material, ambient, "", 0, 1, "0", "k_a of the Phong model"),
    REAL(PARAM_MATERIAL, material, diffuse, "", 0, 1, "0", "k_d of the Phong model"),
    REAL(PARAM_MATERIAL, material, specular, "", 0, 1, "0", "k_s of the Phong model"),
    REAL(PARAM_MATERIAL, material, shininess, "", 0, 100000, "80",
         "exponent n of the Phong model: larger values give smaller highlights"),
    REAL(PARAM_MATERIAL, material, emission, "", 0, BRIGHT, "0",
         "k_e of the Phong model: the surface emits k_e times its colour, even with no light"),
    REAL(PARAM_MATERIAL, material, reflectivity, "", 0, 1, "0",
         "reflectance of the surface; on a transparent surface with render.weights=fresnel an ideal half mirror, "
         "whose total is R + (1 - R) reflectivity with the Fresnel reflectance R"),
    REAL(PARAM_MATERIAL, material, transparency, "", 0, 1, "0",
         "fraction of the light not reflected (with constant weights or simple transmission: of the incident light) "
         "that enters the solid; 0: opaque"),
    ROW(PARAM_MATERIAL, "ior", PARAM_REAL, "", 0, 1e9, true, "1",
        "refractive index, relative to vacuum: at least 0.1, of a metal (with extinction) any; above 10000 a "
        "transparent surface is treated as a perfect mirror",
        NULL, OF(material, ior), .slider = {1, 2.5, 0.01, 0}),
    REAL(PARAM_MATERIAL, material, extinction, "", 0, 100, "0",
         "k of the complex refractive index ior - i k; above 0, an opaque surface reflects as this metal, and its "
         "reflectivity is not used"),
    CHOICE(PARAM_MATERIAL, material, medium, medium_words, "ior",
           "source of the index: ior, a dispersion law with coefficients, or a medium of the "
           "catalogue (cuvette media); metals are opaque and reflect by their complex index"),
    LIST(PARAM_MATERIAL, material, coefficients, "", 1e6, "[]",
         "coefficients of the dispersion law at L in um; cauchy: A,B,C,... in n = A + B/L^2 + C/L^4 + ...; "
         "sellmeier: B1,C1,B2,C2,... (C in um^2); table: L,n,L,n,... in nm"),
    {PARAM_MATERIAL, "medium_data", PARAM_WORD, "", 0, 0, false, "",
     "data with the refractive index, if medium is data; k makes a transparent medium absorb, and an opaque one a "
     "metal",
     NULL, OF(material, medium_data), .names = "data"},
    REAL(PARAM_MATERIAL, material, extraordinary_ior, "", 0, 5, "0",
         "extraordinary index of a uniaxial crystal, relative to vacuum, at every wavelength, for integrator whitted; "
         "its ordinary index is set by ior or medium; 0: not a crystal"),
    {PARAM_MATERIAL, "optic_axis", PARAM_VECTOR, "", -1000, 1000, false, "0,1,0",
     "optic axis of a crystal, in the solid's frame, of any length", NULL, OF(material, optic_axis)},
    REAL(PARAM_MATERIAL, material, film_thickness_nm, "nm", 0, 20000, "0",
         "thickness of a transparent film on the surface (soap, oil), whose two faces interfere; 0: none"),
    REAL(PARAM_MATERIAL, material, film_ior, "", 1, 5, "1.4", "refractive index of the film, relative to vacuum"),
    {PARAM_MATERIAL, "coating", PARAM_LAYERS, "", 0, 0, false, "none",
     "layers on the surface, from outside to inside, whose light interferes: a named design (cuvette media), or INDEX "
     "THICKNESS, ... with an index that is a number, n+ki, a medium, a metal or data, and a thickness in nm or as "
     "550/4, a quarter of the wavelength 550 nm in the layer; 10x(...) repeats layers",
     NULL, OF(material, coating)},
    {PARAM_MATERIAL, "coating_data", PARAM_WORD, "", 0, 0, false, "",
     "data with the index of the coating's layers `data`", NULL, OF(material, coating_data), .names = "data"},
    CHOICE(
        PARAM_MATERIAL, material, sheet, sheet_words, "none",
        "what each passage through the transparent solid does to the light's polarisation, with render.polarisation: "
        "a linear polariser, one for left- or right-handed light, or a retarder (wave plate)"),
    {PARAM_MATERIAL, "sheet_axis", PARAM_VECTOR, "", -1000, 1000, false, "1,0,0",
     "axis of a polariser (of the transmitted field) or a retarder (the slow axis), in the solid's frame; its "
     "projection across a ray counts",
     NULL, OF(material, sheet_axis)},
    REAL(PARAM_MATERIAL, material, sheet_pass, "", 0, 1, "1",
         "transmittance of a polariser for light polarised along its axis, or circularly in its own handedness"),
    REAL(PARAM_MATERIAL, material, sheet_block, "", 0, 1, "0",
         "transmittance of a polariser for light polarised across its axis, or circularly in the other handedness"),
    REAL(PARAM_MATERIAL, material, retardance_deg, "deg", -36000, 36000, "0",
         "retardance of a retarder at each passage, at every wavelength; 90: a quarter-wave plate"),
    REAL(PARAM_MATERIAL, material, birefringence, "", -1, 1, "0",
         "difference of a retarder's indices along and across its axis; 360 degrees times this, times the path in the "
         "solid over the wavelength, is added to retardance_deg"),
    REAL(PARAM_MATERIAL, material, roughness, "", 0, 1, "0",
         "alpha of the GGX microfacets of a surface that reflects or refracts rays (ground glass, brushed metal), for "
         "integrator path; 0: smooth"),
    ROW(PARAM_MATERIAL, "absorb_per_m", PARAM_COLOR, "", 0, 1e9, false, "0,0,0",
        "Beer-Lambert absorption coefficient by channel, 1/m", NULL, OF(material, absorb_per_m), COEFFICIENT),
    LIST(PARAM_MATERIAL, material, absorb_spectrum, "nm, 1/m", 1e9, "[]",
         "Beer-Lambert absorption coefficient by wavelength, as nm,1/m,nm,1/m,...; replaces absorb_per_m"),
    {PARAM_MATERIAL, "absorb_data", PARAM_WORD, "", 0, 0, false, "",
     "data with the Beer-Lambert absorption coefficient by wavelength, 1/m; replaces absorb_per_m and absorb_spectrum",
     NULL, OF(material, absorb_data), .names = "data"},
    REAL(PARAM_MATERIAL, material, scatter_per_m, "1/m", 0, 1e9, "0",
         "scattering coefficient of a transparent solid's medium (milk, fog), for integrator path: over a length d, "
         "exp(-scatter_per_m d) of the light is not scattered; 0: clear"),
    {PARAM_MATERIAL, "scatter_data", PARAM_WORD, "", 0, 0, false, "",
     "data with the scattering coefficient by wavelength, 1/m; replaces scatter_per_m", NULL,
     OF(material, scatter_data), .names = "data"},
    REAL(PARAM_MATERIAL, material, asymmetry, "", -0.999, 0.999, "0",
         "mean cosine g of the scattering angle, by the phase function of Henyey and Greenstein; 0: evenly in all "
         "directions, near 1: almost straight on (milk: 0.9)"),
    POSITIVE(PARAM_MATERIAL, material, tint_distance, "scene units", FAR, "1",
             "distance in a transparent solid over which white light is filtered to 'color'; absorption by "
             "absorb_per_m is added"),
    {PARAM_MATERIAL, "texture", PARAM_WORD, "", 0, 0, false, "", "texture whose colour multiplies 'color'", NULL,
     OF(material, texture), .names = "texture"},
    REAL(PARAM_MATERIAL, material, texture_size, "scene units", 0, FAR, "0",
         "side length of one copy of the texture, on solids other than meshes; 0: one per face (on a plane: 1 scene "
         "unit)"),
    CHOICE(
        PARAM_MATERIAL, material, alpha, alpha_words, "opaque",
        "what the texture's alpha means on an opaque solid: opaque: nothing; mask: below alpha_cutoff the surface is "
        "not there, for any ray; blend: a ray meets the fraction alpha of the surface, and goes straight on with the "
        "rest"),
    REAL(PARAM_MATERIAL, material, alpha_cutoff, "", 0, 1, "0.5",
         "with alpha mask: the least alpha at which the surface is there"),
    REAL(PARAM_MATERIAL, material, checker, "scene units", 0, FAR, "0",
         "side length of the checker cells, in the solid's frame; 0: no checker"),
    COLOR(PARAM_MATERIAL, material, checker_color, 1, "0,0,0", "linear colour of alternate checker cells"),

    /* Before the place, which a solid that follows another one does not have. */
    {PARAM_SOLID, "follows", PARAM_WORD, "", 0, 0, false, "",
     "name of an earlier solid with which this one moves, turns and is scaled: instead of a position it has an offset, "
     "and its rotation and scale are in that solid's frame",
     NULL, OF(solid, follows), .names = "solid"},
    {PARAM_SOLID, "position", PARAM_VECTOR, "scene units", -FAR, FAR, false, "0,0,0",
     "centre of a box, sphere or torus; centre of the base of a cylinder, cup, cone or prism; vertex of side 1 of a "
     "lens; "
     "a point on a plane; origin of a mesh",
     NULL, OF(solid, shape.position)},
    {PARAM_SOLID, "rotation", PARAM_VECTOR, "deg", -360, 360, false, "0,0,0",
     "rotation about the fixed axes x, then y, then z; counter-clockwise for an eye that looks along the axis", NULL,
     OF(solid, rotation_deg)},
    VECTOR(PARAM_SOLID, solid, offset, "0,0,0",
           "with follows: from that solid's position to this one's, along that solid's own axes and in its scale"),
    LENGTH(radius, "1", "radius; cup: outer; cone: base; prism: circumradius; torus: major radius"),
    LENGTH(height, "1", "height above the base"),
    {PARAM_SOLID, "m", PARAM_REAL, "", 0.001, 1000, false, "1",
     "ellipticity: the cross-section is x^2 + m^2 z^2 = radius^2 (inner_radius for a cup's hollow); 1: circular", NULL,
     SHAPE(shape.m)},
    {PARAM_SOLID, "capillary_length", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "cylinder: sqrt(surface tension / (density g)) of a liquid, 2.7 mm for water: its top is then the surface of "
     "Young and Laplace in a tube, with the same volume; 0: a level top",
     NULL, SHAPE(shape.capillary_length)},
    {PARAM_SOLID, "contact_angle_deg", PARAM_REAL, "deg", 1, 179, false, "20",
     "cylinder with a capillary_length: angle within the liquid at which its top meets the wall; 90: level", NULL,
     SHAPE(shape.contact_angle_deg)},
    {PARAM_SOLID, "contact_radius", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "cylinder with a capillary_length: radius at which its top meets the wall, for a cylinder that extends into the "
     "wall; 0: its radius",
     NULL, SHAPE(shape.contact_radius)},
    LENGTH(inner_radius, "0.9",
           "cup: radius of the hollow; the wall has thickness radius - inner_radius along x, and this divided by m "
           "along z"),
    {PARAM_SOLID, "floor", PARAM_REAL, "scene units", 0, FAR, false, "0.1",
     "cup: thickness of the bottom; 0: none, the cup is a tube or ring", NULL, SHAPE(shape.floor)},
    {PARAM_SOLID, "sides", PARAM_INT, "", 3, 60, false, "6", "prism: number of sides; 3: a triangular base", NULL,
     SHAPE(shape.sides)},
    {PARAM_SOLID, "top_radius", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "cone: radius at the top; 0: a point, otherwise a frustum", NULL, SHAPE(shape.top_radius)},
    LENGTH(tube_radius, "0.25", "torus: radius of the tube; less than radius"),
    {PARAM_SOLID, "radius_1", PARAM_REAL, "scene units", -FAR, FAR, false, "1",
     "lens: radius of curvature of side 1, at the position; above 0 if its centre is above it, towards side 2 "
     "(convex); "
     "0: flat",
     NULL, SHAPE(shape.radius_1)},
    {PARAM_SOLID, "radius_2", PARAM_REAL, "scene units", -FAR, FAR, false, "-1",
     "lens: radius of curvature of side 2; below 0 if its centre is below it, towards side 1 (convex); 0: flat", NULL,
     SHAPE(shape.radius_2)},
    LENGTH(thickness, "0.3", "lens: distance between its sides on the axis"),
    LENGTH(diameter, "1", "lens: diameter of its rim, a cylinder"),
    {PARAM_SOLID, "diameter_1", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "lens: diameter of side 1, which beyond it is a level ring up to the rim; 0: that of the rim", NULL,
     SHAPE(shape.diameter_1)},
    {PARAM_SOLID, "diameter_2", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "lens: diameter of side 2, as diameter_1", NULL, SHAPE(shape.diameter_2)},
    {PARAM_SOLID, "chamfer_1", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "lens: length along the radius of a bevel of 45 degrees between side 1 and the rim; 0: none", NULL,
     SHAPE(shape.chamfer_1)},
    {PARAM_SOLID, "chamfer_2", PARAM_REAL, "scene units", 0, FAR, false, "0",
     "lens: length of the bevel of side 2, as chamfer_1", NULL, SHAPE(shape.chamfer_2)},
    {PARAM_SOLID, "conic_1", PARAM_REAL, "", -1000, 1000, false, "0",
     "lens: conic constant of side 1; 0: sphere, -1: paraboloid, below: hyperboloid, others: ellipsoid", NULL,
     SHAPE(shape.conic_1)},
    {PARAM_SOLID, "conic_2", PARAM_REAL, "", -1000, 1000, false, "0", "lens: conic constant of side 2, as conic_1",
     NULL, SHAPE(shape.conic_2)},
    ASPHERIC(1, 4, 0, "1/scene units^3"),
    ASPHERIC(1, 6, 1, "1/scene units^5"),
    ASPHERIC(1, 8, 2, "1/scene units^7"),
    ASPHERIC(1, 10, 3, "1/scene units^9"),
    ASPHERIC(1, 12, 4, "1/scene units^11"),
    ASPHERIC(1, 14, 5, "1/scene units^13"),
    ASPHERIC(1, 16, 6, "1/scene units^15"),
    ASPHERIC(1, 18, 7, "1/scene units^17"),
    ASPHERIC(1, 20, 8, "1/scene units^19"),
    ASPHERIC(2, 4, 0, "1/scene units^3"),
    ASPHERIC(2, 6, 1, "1/scene units^5"),
    ASPHERIC(2, 8, 2, "1/scene units^7"),
    ASPHERIC(2, 10, 3, "1/scene units^9"),
    ASPHERIC(2, 12, 4, "1/scene units^11"),
    ASPHERIC(2, 14, 5, "1/scene units^13"),
    ASPHERIC(2, 16, 6, "1/scene units^15"),
    ASPHERIC(2, 18, 7, "1/scene units^17"),
    ASPHERIC(2, 20, 8, "1/scene units^19"),
    ODD(1, 1, 0, ""),
    ODD(1, 2, 1, "1/scene units^1"),
    ODD(1, 3, 2, "1/scene units^2"),
    ODD(1, 5, 3, "1/scene units^4"),
    ODD(1, 7, 4, "1/scene units^6"),
    ODD(1, 9, 5, "1/scene units^8"),
    ODD(1, 11, 6, "1/scene units^10"),
    ODD(1, 13, 7, "1/scene units^12"),
    ODD(1, 15, 8, "1/scene units^14"),
    ODD(2, 1, 0, ""),
    ODD(2, 2, 1, "1/scene units^1"),
    ODD(2, 3, 2, "1/scene units^2"),
    ODD(2, 5, 3, "1/scene units^4"),
    ODD(2, 7, 4, "1/scene units^6"),
    ODD(2, 9, 5, "1/scene units^8"),
    ODD(2, 11, 6, "1/scene units^10"),
    ODD(2, 13, 7, "1/scene units^12"),
    ODD(2, 15, 8, "1/scene units^14"),
    {PARAM_SOLID, "form_1", PARAM_CHOICE, "", 0, 0, false, "round",
     "lens: form of side 1: round; biconic, with another radius and conic constant along x; or toric, the curve of "
     "radius_1 along z, with its coefficients, turned about a line (a cylinder, if radius_1_x is 0)",
     side_form_words, SHAPE(shape.form_1)},
    {PARAM_SOLID, "form_2", PARAM_CHOICE, "", 0, 0, false, "round", "lens: form of side 2, as form_1", side_form_words,
     SHAPE(shape.form_2)},
    {PARAM_SOLID, "radius_1_x", PARAM_REAL, "scene units", -FAR, FAR, false, "0",
     "lens with a form_1 of biconic or toric: radius of curvature of side 1 along the solid's own x, of which radius_1 "
     "is then that along z; 0: flat",
     NULL, SHAPE(shape.radius_1_x)},
    {PARAM_SOLID, "radius_2_x", PARAM_REAL, "scene units", -FAR, FAR, false, "0",
     "lens with a form_2 of biconic or toric: radius of side 2 along x, as radius_1_x", NULL, SHAPE(shape.radius_2_x)},
    {PARAM_SOLID, "conic_1_x", PARAM_REAL, "", -1000, 1000, false, "0",
     "lens with a form_1 of biconic: conic constant of side 1 along x, of which conic_1 is then that along z", NULL,
     SHAPE(shape.conic_1_x)},
    {PARAM_SOLID, "conic_2_x", PARAM_REAL, "", -1000, 1000, false, "0",
     "lens with a form_2 of biconic: conic constant of side 2 along x, as conic_1_x", NULL, SHAPE(shape.conic_2_x)},
    {PARAM_SOLID, "size", PARAM_VECTOR, "scene units", 0, FAR, true, "1,1,1", "edge lengths along x, y and z", NULL,
     SHAPE(shape.size)},
    {PARAM_SOLID, "mesh", PARAM_WORD, "", 0, 0, false, "", "name of a mesh", NULL, SHAPE(mesh), .names = "mesh"},
    {PARAM_SOLID, "material_1", PARAM_WORD, "", 0, 0, false, "",
     "material whose surface (coating, film, roughness; paint or metal if it is opaque) the first end has: side 1 of a "
     "lens, the bottom of other solids; none: the solid's own",
     NULL, SHAPE(ends[0]), .names = "material"},
    {PARAM_SOLID, "material_2", PARAM_WORD, "", 0, 0, false, "",
     "the same for the second end: side 2 of a lens, the top of other solids", NULL, SHAPE(ends[1]),
     .names = "material"},
    {PARAM_SOLID, "material_rim", PARAM_WORD, "", 0, 0, false, "",
     "the same for the rest of its surface: the rim of a lens, the sides of other solids", NULL, SHAPE(ends[2]),
     .names = "material"},
    {PARAM_SOLID, "points", PARAM_WORD, "", 0, 0, false, "",
     "name of a mesh with a file of points (.xyz): a copy of the solid is at each of them, along the solid's own axes "
     "from its position",
     NULL, SHAPE(points), .names = "mesh"},
    {PARAM_SOLID, "scale", PARAM_VECTOR, "", -FAR, FAR, false, "1,1,1",
     "of the solid, about its position and along its own axes, with its textures; of a solid at points: of the points; "
     "a "
     "negative number mirrors",
     NULL, SHAPE(scale), .not_zero = true, .slider = {0.001, 2.5, 0.001, 0}},
    {PARAM_SOLID, "copies", PARAM_VECTOR, "", 1, 100000, false, "1,1,1",
     "mesh: number of copies along each of its own axes", NULL, SHAPE(shape.copies)},
    {PARAM_SOLID, "spacing", PARAM_VECTOR, "scene units", -FAR, FAR, false, "1,1,1",
     "mesh: distance between copies along its own axes, after scaling; copies may touch but not overlap", NULL,
     SHAPE(shape.spacing)},
    {PARAM_SOLID, "shading", PARAM_CHOICE, "", 0, 0, false, "smooth",
     "shading of a mesh: flat, Phong (interpolated normals) or Gouraud (interpolated light)", shading_words,
     SHAPE(shading)},
    INTEGER(PARAM_SOLID, solid, priority, "", -1000000, 1000000, "0",
            "where solids overlap, the one with the highest priority is present; among equals the one listed first"),
    CHOICE(PARAM_SOLID, solid, visible, off_on, "on", "off: the solid is left out of the scene"),
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
    static const char *const names[] = {"render", "camera", "background", "mesh",     "texture",
                                        "data",   "light",  "beam",       "material", "solid"};
    return (size_t)group < PARAM_GROUP_COUNT ? names[group] : "";
}

/* The first row of a group: the rows are in the order of their groups. */
static size_t first_row(param_group group)
{
    size_t low = 0, high = TABLE_COUNT;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (table[middle].group < group)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static const param *find_row(param_group group, const char *name)
{
    for (size_t i = first_row(group); i < TABLE_COUNT && table[i].group == group; i++)
        if (table[i].name[0] == name[0] && strcmp(table[i].name, name) == 0)
            return &table[i];
    return NULL;
}

const param *param_find(param_group group, const char *name)
{
    const param *row = find_row(group, name);
    return !row && group == PARAM_SOLID ? find_row(PARAM_MATERIAL, name) : row;
}
