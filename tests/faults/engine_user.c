/* A program that uses the library (cuvette.h): each argument is a part of the interface. It prints what it computes,
 * so that the oracle compares it, and what a call that fails says, as the program `cuvette` does. The library must
 * leave no memory and no descriptor behind, whatever failed. */
#include "base/json_build.h"
#include "cuvette.h"

#include <stdio.h>
#include <string.h>

static cuvette_diagnostic why;

#define DO(call)                            \
    do {                                    \
        const cuvette_status did_ = (call); \
        if (did_ != CUVETTE_OK)             \
            return did_;                    \
    } while (0)

static bool show_parameter(void *context, const cuvette_parameter *p)
{
    (void)context;
    printf("%s=%s\n", p->path, p->value);
    return true;
}

static cuvette_status build(cuvette_scene *s)
{
    const double by[3] = {1, 0, 0};
    DO(cuvette_scene_add_light(s, "lamp", &why));
    DO(cuvette_scene_add_material(s, "glass", &why));
    DO(cuvette_scene_add_solid(s, "ball", "sphere", NULL, &why));
    DO(cuvette_scene_set(s, "glass.ior", "1.5", &why));
    DO(cuvette_scene_give_material(s, "ball", "glass", &why));
    DO(cuvette_scene_move(s, "ball", by, &why));
    DO(cuvette_scene_rename(s, "ball", "bead", &why));
    DO(cuvette_scene_set_double(s, "bead.radius", 0.5, &why));
    DO(cuvette_scene_each_parameter(s, show_parameter, NULL, &why));
    return cuvette_scene_write(s, "built.yaml", &why);
}

static cuvette_status use_scene(void)
{
    cuvette_scene *s = NULL, *other = NULL;
    cuvette_status code = cuvette_scene_create(&s, &why);
    code = code ? code : build(s);
    code = code ? code : cuvette_scene_read("things.yaml", &other, &why);
    code = code ? code : cuvette_scene_load(other, NULL, NULL, &why);
    code = code ? code : cuvette_scene_check(other, &why);
    cuvette_scene_destroy(other);
    cuvette_scene_destroy(s);
    return code;
}

static cuvette_status render(const cuvette_scene *s, cuvette_engine *engine, cuvette_frame **frame)
{
    float rgb[8 * 6 * 3];
    cuvette_request request = CUVETTE_REQUEST;
    request.width = 8;
    request.height = 6;
    request.rgb = rgb;
    DO(cuvette_engine_render(engine, s, &request, frame, &why));
    printf("%016llx\n", (unsigned long long)cuvette_frame_hash(*frame));
    return cuvette_frame_write(*frame, "film.png", 8, &why);
}

static cuvette_status use_frame(void)
{
    cuvette_scene *s = NULL;
    cuvette_engine *engine = NULL;
    cuvette_frame *frame = NULL;
    cuvette_status code = cuvette_scene_read("things.yaml", &s, &why);
    code = code ? code : cuvette_engine_create(NULL, &engine, &why);
    code = code ? code : render(s, engine, &frame);
    cuvette_frame_destroy(frame);
    cuvette_engine_destroy(engine);
    cuvette_scene_destroy(s);
    return code;
}

static cuvette_status ask(const cuvette_query *q)
{
    cuvette_ray ray = {.origin = {-3, 1.5, 0.4}, .direction = {1, 0, 0}};
    cuvette_hit hit;
    cuvette_tree *tree = NULL;
    cuvette_fan *fan = NULL;
    const cuvette_fan_rule rule = {.size = sizeof rule, .from = {-3, 1.5, 0}, .to = {3, 1.5, 0}, .rays = 5, .width = 1};
    DO(cuvette_query_nearest(q, &ray, 1, &hit, &why));
    printf("%d %.17g\n", (int)hit.solid, hit.distance);
    DO(cuvette_query_trace(q, &ray, &tree, &why));
    cuvette_status code = cuvette_tree_write(tree, "tree.json", &why);
    cuvette_tree_destroy(tree);
    code = code ? code : cuvette_query_fan(q, &rule, &fan, &why);
    code = code ? code : cuvette_fan_write(fan, "fan.csv", &why);
    cuvette_fan_destroy(fan);
    return code;
}

static cuvette_status use_query(void)
{
    cuvette_scene *s = NULL;
    cuvette_query *q = NULL;
    cuvette_status code = cuvette_scene_read("rod.yaml", &s, &why);
    code = code ? code : cuvette_query_create(s, NULL, &q, &why);
    code = code ? code : ask(q);
    cuvette_query_destroy(q);
    cuvette_scene_destroy(s);
    return code;
}

static cuvette_status use_motion(void)
{
    cuvette_scene *s = NULL;
    cuvette_motion *m = NULL;
    cuvette_slime slime = {.size = sizeof slime};
    cuvette_status code = cuvette_scene_read("slime.yaml", &s, &why);
    code = code ? code : cuvette_motion_create(s, &m, &why);
    code = code ? code : cuvette_motion_advance(m, 0.02, &why);
    code = code ? code : cuvette_motion_state(m, "toy", &slime, &why);
    if (code == CUVETTE_OK)
        printf("%.17g %.17g\n", slime.center[1], slime.elastic);
    cuvette_motion_destroy(m);
    cuvette_scene_destroy(s);
    return code;
}

static cuvette_status use_images(void)
{
    cuvette_image *a = NULL, *b = NULL;
    cuvette_comparison all = {.size = sizeof all};
    int width = 0, height = 0;
    cuvette_status code = cuvette_image_read("a.png", &a, &why);
    code = code ? code : cuvette_image_read("a.jpg", &b, &why);
    const float *left = cuvette_image_rgb(a, &width, &height), *right = cuvette_image_rgb(b, &width, &height);
    code = code ? code : cuvette_compare(width, height, left, right, NULL, &all, &why);
    if (code == CUVETTE_OK)
        printf("%.17g %.17g\n", all.mse, all.ssim);
    cuvette_image_destroy(a);
    cuvette_image_destroy(b);
    return code;
}

static cuvette_status run_study(const cuvette_study *study)
{
    const cuvette_run run = {.size = sizeof run, .results = "results"};
    size_t rows = 0;
    char *text = NULL;
    DO(cuvette_study_run(study, &run, &rows, &why));
    DO(cuvette_study_summary(study, "results", "main", &text, NULL, &why));
    puts(text);
    cuvette_text_destroy(text);
    return CUVETTE_OK;
}

static cuvette_status use_study(void)
{
    cuvette_study *study = NULL;
    cuvette_status code = cuvette_study_read("small.study", &study, &why);
    code = code ? code : run_study(study);
    cuvette_study_destroy(study);
    return code;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        cuvette_status (*use)(void);
    } parts[] = {{"scene", use_scene},   {"frame", use_frame},   {"query", use_query},
                 {"motion", use_motion}, {"images", use_images}, {"study", use_study}};
    json_memory_reserve();       /* as cuvette.h advises */
    static char output[1 << 16]; /* printf is not what is tested */
    setvbuf(stdout, output, _IOFBF, sizeof output);
    for (size_t i = 0; argc == 2 && i < sizeof parts / sizeof *parts; i++) {
        if (strcmp(argv[1], parts[i].name) != 0)
            continue;
        cuvette_status code = parts[i].use();
        if (code == CUVETTE_OK && fflush(stdout) != 0) {
            fprintf(stderr, "cuvette: standard output: a write failed; give it room\n");
            return CUVETTE_FAILURE;
        }
        char text[CUVETTE_DIAGNOSTIC_TEXT_MAX];
        if (code != CUVETTE_OK)
            fprintf(stderr, "cuvette: %s\n", cuvette_diagnostic_text(&why, text, sizeof text));
        return (int)code;
    }
    fprintf(stderr, "engine_user scene|frame|query|motion|images|study\n");
    return 2;
}
