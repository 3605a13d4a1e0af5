/* An example of the engine: a slime that is grabbed under a pixel, drawn aside and released. Five moments are written
 * side by side to standard output as a PPM, and the state of the slime to standard error.
 *   cc -o slime slime.c $(pkg-config --cflags --libs cuvette) && ./slime >slime.ppm */
#include <cuvette.h>
#include <stdio.h>
#include <stdlib.h>

enum { WIDTH = 160, HEIGHT = 120, FRAMES = 5, ROW = 3 * WIDTH * FRAMES };

/* Parameters, each a path and its value. */
static const char *const settings[] = { // clang-format off
    "render.width", "160", "render.height", "120", "render.depth", "6", "render.threads", "2",
    "camera.position", "0,2,-6", "camera.target", "0,0.9,0", "background.color", "0.5,0.7,0.9",
    "ground.ambient", "0.1", "lamp.position", "4,7,-5", "ground.checker", "0.5", "ground.diffuse", "0.8",
    "ground.checker_color", "0.25,0.3,0.35", "toy.generate", "slime", "toy.level", "3", "toy.dt_s", "0.002",
    "body.mesh", "toy", "body.priority", "1", "body.ior", "1.2", "body.transparency", "0.9",
    "body.absorb_per_m", "2.2,0.25,1.8"
}; // clang-format on

/* Ends the program with the library's diagnostic unless the status is CUVETTE_OK. */
static void need(cuvette_status status, const cuvette_diagnostic *why)
{
    char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
    if (status == CUVETTE_OK)
        return;
    fprintf(stderr, "slime: %s\n", cuvette_diagnostic_text(why, text, sizeof text));
    exit(1);
}

static cuvette_scene *make_scene(void)
{
    cuvette_diagnostic why;
    cuvette_scene *scene;
    need(cuvette_scene_create(&scene, &why), &why);
    need(cuvette_scene_add_light(scene, "lamp", &why), &why);
    need(cuvette_scene_add_mesh(scene, "toy", &why), &why);
    need(cuvette_scene_add_solid(scene, "ground", "plane", NULL, &why), &why);
    need(cuvette_scene_add_solid(scene, "body", "mesh", NULL, &why), &why);
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i += 2)
        need(cuvette_scene_set(scene, settings[i], settings[i + 1], &why), &why);
    return scene;
}

/* Grabs the slime as a mouse would: at the first hit of a pixel's ray. */
static int grab_under(cuvette_motion *motion, const cuvette_scene *scene, double x, double y)
{
    cuvette_diagnostic why;
    cuvette_query *query;
    cuvette_ray ray;
    int hand;
    need(cuvette_query_create(scene, NULL, &query, &why), &why);
    need(cuvette_query_camera_ray(query, x, y, &ray, &why), &why);
    need(cuvette_motion_grab(motion, "body", &ray, 0.35, &hand, NULL, &why), &why);
    cuvette_query_destroy(query);
    return hand;
}

static void render(cuvette_engine *engine, const cuvette_scene *scene, const cuvette_motion *motion, unsigned char *rgb)
{
    cuvette_diagnostic why;
    cuvette_frame *frame;
    cuvette_slime slime;
    cuvette_request request = CUVETTE_REQUEST;
    request.width = WIDTH, request.height = HEIGHT, request.srgb = rgb, request.srgb_stride = ROW;
    need(cuvette_engine_render(engine, scene, &request, &frame, &why), &why);
    slime.size = sizeof slime;
    need(cuvette_motion_state(motion, "toy", &slime, &why), &why);
    fprintf(stderr, "film %016llx at %.2f s: centre %.4f, %.4f, %.4f, volume %.4f, %llu masses held\n",
            (unsigned long long)cuvette_frame_hash(frame), slime.time_s, slime.center[0], slime.center[1],
            slime.center[2], slime.volume, (unsigned long long)slime.held);
    cuvette_frame_destroy(frame);
}

int main(void)
{
    static unsigned char img[ROW * HEIGHT];
    static const double by[3] = {-0.9, 0.6, -0.2};
    int hand = CUVETTE_NO_HAND;
    cuvette_diagnostic why;
    cuvette_engine *engine;
    cuvette_motion *motion;
    cuvette_scene *scene = make_scene();
    need(cuvette_engine_create(NULL, &engine, &why), &why);
    need(cuvette_motion_create(scene, &motion, &why), &why);
    for (int i = 0; i < FRAMES; i++) {
        need(cuvette_motion_advance(motion, 0.4 * i, &why), &why);
        if (i == 1 && (hand = grab_under(motion, scene, 65, 60)) >= 0)
            need(cuvette_motion_move(motion, hand, by, &why), &why);
        if (i == 3 && hand >= 0)
            need(cuvette_motion_release(motion, hand, &why), &why);
        render(engine, scene, motion, img + 3 * WIDTH * i);
    }
    printf("P6\n%d %d\n255\n", WIDTH * FRAMES, HEIGHT);
    fwrite(img, 1, sizeof img, stdout);
    cuvette_motion_destroy(motion);
    cuvette_engine_destroy(engine);
    cuvette_scene_destroy(scene);
    return 0;
}
