/* An example of the engine: a glass ball on a chequered ground. The scene is built by calls, the image is written to
 * standard output as a PPM, and the counts of rays to standard error.
 *
 *   cc -o glass_ball glass_ball.c $(pkg-config --cflags --libs cuvette) && ./glass_ball >ball.ppm */
#include <cuvette.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 320, HEIGHT = 240 };

/* Parameters, each a path and its value. */
static const char *const settings[] = { // clang-format off
    "render.width", "320", "render.height", "240", "render.depth", "6", "render.threads", "2",
    "camera.position", "0,2,-6", "camera.target", "0,1,0", "background.color", "0.5,0.7,0.9",
    "lamp.position", "4,7,-5", "ground.color", "0.85,0.85,0.85", "ground.checker_color", "0.25,0.3,0.35",
    "ground.checker", "0.5", "ground.ambient", "0.1", "ground.diffuse", "0.7", "glass.transparency", "1",
    "glass.medium", "bk7", "glass.specular", "0.6", "glass.shininess", "80", "ball.position", "0,1.01,0"
}; // clang-format on

/* Ends the program with the library's diagnostic unless the status is CUVETTE_OK. */
static void need(cuvette_status status, const cuvette_diagnostic *why)
{
    char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
    if (status == CUVETTE_OK)
        return;
    fprintf(stderr, "glass_ball: %s\n", cuvette_diagnostic_text(why, text, sizeof text));
    exit(1);
}

static cuvette_scene *make_scene(void)
{
    cuvette_diagnostic why;
    cuvette_scene *scene;
    need(cuvette_scene_create(&scene, &why), &why);
    need(cuvette_scene_add_light(scene, "lamp", &why), &why);
    need(cuvette_scene_add_material(scene, "glass", &why), &why);
    need(cuvette_scene_add_solid(scene, "ground", "plane", NULL, &why), &why);
    need(cuvette_scene_add_solid(scene, "ball", "sphere", "glass", &why), &why);
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i += 2)
        need(cuvette_scene_set(scene, settings[i], settings[i + 1], &why), &why);
    need(cuvette_scene_set_double(scene, "ball.radius", 1.0, &why), &why);
    return scene;
}

/* Called for each finished tile; a program with a window would draw the rectangle now. */
static void show(void *context, const cuvette_tile *tile)
{
    size_t *tiles = (size_t *)context;
    tiles[tile->coarse > 1]++;
}

static bool report(void *context, double fraction)
{
    (void)context;
    fprintf(stderr, "%3.0f%%\n", 100.0 * fraction);
    return true; /* false would cancel the render */
}

int main(void)
{
    static unsigned char img[3 * WIDTH * HEIGHT];
    size_t tiles[2] = {0, 0};
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_frame *frame;
    cuvette_scene *scene = make_scene();
    need(cuvette_engine_create(NULL, &engine, &why), &why);

    cuvette_request request = CUVETTE_REQUEST;
    request.width = WIDTH, request.height = HEIGHT;
    request.srgb = img;
    request.preview = 8;
    request.progress = report;
    request.tile = show;
    request.context = tiles;
    need(cuvette_engine_render(engine, scene, &request, &frame, &why), &why);

    cuvette_counters rays;
    cuvette_statistics times;
    rays.size = sizeof rays;
    times.size = sizeof times;
    need(cuvette_frame_counters(frame, &rays, &why), &why);
    need(cuvette_frame_statistics(frame, &times, &why), &why);
    fprintf(
        stderr,
        "film %016llx, %zu preview, %zu tiles, %.3f s; rays: camera %llu, reflect %llu, refract %llu, shadow %llu\n",
        (unsigned long long)cuvette_frame_hash(frame), tiles[1], tiles[0], times.wall_s,
        (unsigned long long)rays.camera, (unsigned long long)rays.reflect, (unsigned long long)rays.refract,
        (unsigned long long)rays.shadow);

    printf("P6\n%d %d\n255\n", WIDTH, HEIGHT);
    fwrite(img, 1, sizeof img, stdout);
    cuvette_frame_destroy(frame);
    cuvette_engine_destroy(engine);
    cuvette_scene_destroy(scene);
    return 0;
}
