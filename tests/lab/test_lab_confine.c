/* Tests that loading a scene reads nothing outside the laboratory's folder: neither files that a model refers to,
 * nor a link that replaces a file between the check of the scene and its loading; and that the limit of triangles
 * holds. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/file.h"
#include "base/os_process.h"
#include "image/image.h"
#include "lab_fixture.h"
#include "scene/model/scene.h"
#include "study/study.h"
#include "web/session/session.h"
#include <sys/wait.h>

/* The laboratory's folder is above/lab. Except for links and scenes, every file exists in both. */
typedef struct room {
    char *above, *inside;
    lab_room lab;
} room;

#define TRIANGLE "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl a\nf 1/1 2/2 3/3\n"
#define GLTF(buffer, img)                                                                                              \
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"              \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":2},\"indices\":1,\"material\":0}]}]," \
    "\"materials\":[{\"name\":\"a\",\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}],\"textures\":[{"   \
    "\"source\":0}],"                                                                                                  \
    "\"images\":[{\"uri\":\"" img "\"}],"                                                                              \
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"},"                          \
    "{\"bufferView\":1,\"componentType\":5123,\"count\":3,\"type\":\"SCALAR\"},"                                       \
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"}],"                                        \
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36},{\"buffer\":0,\"byteOffset\":36,\"byteLength\":6}],"            \
    "\"buffers\":[{\"byteLength\":42,\"uri\":\"" buffer "\"}]}"
#define SCENE(more)                                                                                                  \
    "render: {width: 16, height: 12}\ncamera: {position: [0, 0, -6], target: [0, 0, 0]}\nlights: {lamp: {position: " \
    "[4, 8, -6]}}\n" more
#define BODY(file) SCENE("meshes: {body: {file: '" file "'}}\nsolids: {it: {shape: mesh, mesh: body}}\n")

static void put_bytes(const room *r, const char *name, const void *bytes, size_t size)
{
    char *path = text_format("%s/%s", r->above, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
    free(path);
}

static void put(const room *r, const char *name, const char *text)
{
    put_bytes(r, name, text, strlen(text));
}

static void put_everywhere(const room *r, const char *name, const void *bytes, size_t size)
{
    char *inside = text_format("lab/%s", name);
    put_bytes(r, name, bytes, size);
    put_bytes(r, inside, bytes, size);
    free(inside);
}

static void remove_file(const room *r, const char *name)
{
    char *path = text_format("%s/%s", r->inside, name);
    unlink(path);
    free(path);
}

/* Replaces a file of the folder by a link. */
static void put_link(const room *r, const char *name, const char *target)
{
    remove_file(r, name);
    char *path = text_format("%s/%s", r->inside, name);
    assert_int_equal(symlink(target, path), 0);
    free(path);
}

static void put_images(const room *r)
{
    image *blank = NULL;
    unsigned char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(image_create(4, 2, &blank, NULL), STATUS_OK);
    assert_int_equal(image_encode(blank, IMAGE_PNG, 8, true, &bytes, &size, NULL), STATUS_OK);
    put_everywhere(r, "p.png", bytes, size);
    free(bytes);
    image_destroy(blank);
}

static void put_files(const room *r)
{
    static const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    static const uint16_t order[3] = {0, 1, 2};
    static const char paint[] = "newmtl a\nKd 1 0 0\n", model[] = TRIANGLE;
    static const char pull[] = "hands: {left: [{time_s: 0.5, grab: [0, 1, -6], towards: [0, 0, 1], reach: 0.3}]}\n";
    unsigned char buffer[42];
    memcpy(buffer, corners, sizeof corners);
    memcpy(buffer + sizeof corners, order, sizeof order);
    put_everywhere(r, "b.bin", buffer, sizeof buffer);
    put_everywhere(r, "a.mtl", paint, sizeof paint - 1);
    put_everywhere(r, "plain.obj", model, sizeof model - 1);
    put_everywhere(r, "pull.yaml", pull, sizeof pull - 1);
    put_images(r);
}

static bool kernel_confines(void)
{
    int state = 1;
    const pid_t child = fork();
    if (child == 0)
        _exit(!os_confine_files(NULL, 0));
    return waitpid(child, &state, 0) == child && state == 0;
}

static int enter(void **state)
{
    room *r = calloc(1, sizeof *r);
    char place[] = "/tmp/cuvette-confine-XXXXXX";
    r->above = strdup(mkdtemp(place));
    r->inside = text_format("%s/lab", r->above);
    assert_int_equal(mkdir(r->inside, 0700), 0);
    put_files(r);
    snprintf(r->lab.results, sizeof r->lab.results, "%s/results", r->inside);
    const lab_settings settings = {.folder = r->inside,
                                   .results = r->lab.results,
                                   .level = isa_best(),
                                   .threads = 2,
                                   .requests_per_s = 1e9,
                                   .confine = true};
    diagnostic why = {.what = ""};
    if (lab_start(&settings, &r->lab.lab, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    r->lab.server = lab_server(r->lab.lab);
    *state = r;
    return 0;
}

static int leave(void **state)
{
    room *r = *state;
    lab_stop(r->lab.lab);
    nftw(r->above, room_unlink, 16, FTW_DEPTH | FTW_PHYS);
    free(r->inside);
    free(r->above);
    free(r);
    return 0;
}

static void open_scene(const room *r, const char *yaml)
{
    put(r, "lab/scene.yaml", yaml);
    room_post(&r->lab, "/api/open", "{\"file\": \"scene.yaml\"}");
}

/* The error of the current scene in the state: "" if it was rendered. */
static char *trouble(const room *r)
{
    char *reply = client_ask(r->lab.server, "GET", "/api/image.png?wait=1", "", NULL);
    const int code = reply_code(reply);
    free(reply);
    json_t *state = room_get(&r->lab, "/api/state");
    const json_t *bad = json_object_get(state, "trouble");
    assert_int_equal(code, json_is_null(bad) ? 200 : 409);
    if (!json_is_null(bad))
        assert_true(json_string_length(json_object_get(bad, "remedy")) > 0);
    const char *error = json_string_value(json_object_get(bad, "error"));
    char *text = strdup(error ? error : "");
    json_decref(state);
    return text;
}

static void is_loaded(const room *r, const char *what)
{
    char *message = trouble(r);
    if (message[0])
        fail_msg("%s: %s", what, message);
    free(message);
}

/* word: a part of the expected error. */
static void is_refused(const room *r, const char *what, const char *word)
{
    char *message = trouble(r);
    if (!strstr(message, word) || strchr(message, '\n') ||
        (!strstr(message, BELOW_WHAT) && !strstr(message, "No such file")))
        fail_msg("%s: '%s'", what, message);
    free(message);
}

/* --- files that models refer to --- */

static void open_obj(const room *r, const char *library)
{
    char *text = text_format("mtllib %s\n" TRIANGLE, library);
    put(r, "lab/m.obj", text);
    open_scene(r, BODY("m.obj"));
    free(text);
}

static void material_libraries_outside_the_folder_are_refused(void **state)
{
    const room *r = *state;
    char *sub = text_format("%s/sub", r->inside);
    assert_int_equal(mkdir(sub, 0700), 0);
    free(sub);
    put_link(r, "out.mtl", "../a.mtl");
    put_link(r, "in.mtl", "a.mtl");
    put_link(r, "up", "..");
    char *absolute = text_format("%s/a.mtl", r->above);
    const char *const bad[] = {"../a.mtl", "sub/../../a.mtl", "out.mtl", "up/a.mtl", absolute};
    const char *const good[] = {"a.mtl", "in.mtl", "sub/../a.mtl", "up/lab/a.mtl"};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        open_obj(r, bad[i]);
        is_refused(r, bad[i], bad[i]);
    }
    for (size_t i = 0; i < sizeof good / sizeof *good; i++) {
        open_obj(r, good[i]);
        is_loaded(r, good[i]);
    }
    free(absolute);
}

/* The name of a library is absolute, and the model is in the working directory. */
static void absolute_material_libraries_outside_the_folder_are_refused(void **state)
{
    const room *r = *state;
    char here[4096];
    assert_non_null(getcwd(here, sizeof here));
    assert_int_equal(chdir(r->inside), 0);
    for (int outside = 0; outside < 2; outside++) {
        char *text = text_format("mtllib %s/a.mtl\n" TRIANGLE, outside ? r->above : r->inside);
        put(r, "lab/m.obj", text);
        scene *s = NULL;
        diagnostic why = {.what = ""};
        assert_int_equal(scene_read_text("", BODY("m.obj"), sizeof BODY("m.obj") - 1, &s, NULL), STATUS_OK);
        assert_int_equal(scene_limit(s, r->inside, 0, NULL), STATUS_OK);
        assert_int_equal(scene_load(s, &why), outside ? STATUS_BAD_INPUT : STATUS_OK);
        assert_true(!outside || (strstr(why.what, BELOW_WHAT) && why.remedy[0]));
        scene_destroy(s);
        free(text);
    }
    assert_int_equal(chdir(here), 0);
}

static void images_of_materials_outside_the_folder_are_refused(void **state)
{
    const room *r = *state;
    put_link(r, "out.png", "../p.png");
    put_link(r, "in.png", "p.png");
    char *absolute = text_format("%s/p.png", r->above), *own = text_format("%s/p.png", r->inside);
    const char *const bad[] = {"../p.png", "..\\p.png", "%2e%2e/p.png", "out.png", absolute}, *const good[] = {"p.png",
                                                                                                               "in.png",
                                                                                                               own};
    for (size_t i = 0; i < sizeof bad / sizeof *bad + sizeof good / sizeof *good; i++) {
        const bool is_bad = i < sizeof bad / sizeof *bad;
        const char *name = is_bad ? bad[i] : good[i - sizeof bad / sizeof *bad];
        char *text = text_format("newmtl a\nKd 1 1 1\nmap_Kd %s\n", name);
        put(r, "lab/m.mtl", text);
        open_obj(r, "m.mtl");
        if (is_bad)
            is_refused(r, name, ".png");
        else
            is_loaded(r, name);
        free(text);
    }
    free(own);
    free(absolute);
}

static void buffers_and_images_of_gltf_outside_the_folder_are_refused(void **state)
{
    const room *r = *state;
    put(r, "lab/m.gltf", GLTF("../b.bin", "p.png"));
    open_scene(r, BODY("m.gltf"));
    is_refused(r, "a buffer above", "../b.bin");
    put_link(r, "out.bin", "../b.bin");
    put(r, "lab/m2.gltf", GLTF("out.bin", "p.png"));
    open_scene(r, BODY("m2.gltf"));
    is_refused(r, "a linked buffer", "out.bin");
    put(r, "lab/m3.gltf", GLTF("b.bin", "../p.png"));
    open_scene(r, BODY("m3.gltf"));
    is_refused(r, "a texture above", "../p.png");
    put(r, "lab/m4.gltf", GLTF("b.bin", "p.png"));
    open_scene(r, BODY("m4.gltf"));
    is_loaded(r, "all of it within");
}

/* A model is loaded before it is added to the document. */
static void added_models_are_confined_to_the_folder(void **state)
{
    const room *r = *state;
    put(r, "lab/m.obj", "mtllib ../a.mtl\n" TRIANGLE);
    char *message = room_refused(&r->lab, "POST", "/api/objects", "{\"kind\": \"model\", \"file\": \"m.obj\"}", 400);
    assert_non_null(strstr(message, "../a.mtl"));
    assert_non_null(strstr(message, BELOW_WHAT));
    free(message);
    put(r, "lab/m.obj", "mtllib a.mtl\n" TRIANGLE);
    room_post(&r->lab, "/api/objects", "{\"kind\": \"model\", \"file\": \"m.obj\"}");
    is_loaded(r, "a model that is added");
}

/* The kernel refuses what the laboratory's own checks would let pass: another importer, which stands outside. */
static void programs_outside_the_folder_are_not_started(void **state)
{
    const room *r = *state;
    if (!kernel_confines() || !getenv("CUVETTE_IMPORT"))
        skip();
    char *importer = text_format("%s/importer", r->above), *before = strdup(getenv("CUVETTE_IMPORT"));
    char *copying = text_format("cp '%s' '%s'", before, importer);
    assert_int_equal(system(copying), 0);
    setenv("CUVETTE_IMPORT", importer, 1);
    put(r, "lab/program.obj", TRIANGLE);
    put(r, "lab/again.obj", TRIANGLE);
    open_scene(r, BODY("program.obj"));
    char *message = trouble(r);
    setenv("CUVETTE_IMPORT", before, 1);
    assert_non_null(strstr(message, "Permission denied"));
    open_scene(r, BODY("again.obj"));
    is_loaded(r, "with the importer of the start");
    free(message);
    free(copying);
    free(before);
    free(importer);
}

static void temporary_folders_of_killed_laboratories_are_removed(void **state)
{
    (void)state;
    if (!kernel_confines())
        skip();
    const char *place = getenv("TMPDIR");
    char *left = text_format("%s/cuvette-tmp-left", place ? place : "/tmp"), *file = text_format("%s/a.svg", left);
    assert_true(mkdir(left, 0700) == 0 && symlink("/etc/passwd", file) == 0);
    lab_room first;
    room_open(&first, NULL);
    assert_int_equal(access(left, F_OK), -1);
    assert_int_equal(access("/etc/passwd", F_OK), 0);
    char *own = strdup(lab_temporary_folder(first.lab));
    lab_room other;
    room_open(&other, NULL);
    assert_int_equal(access(own, F_OK), 0); /* in use */
    room_close(&other);
    room_close(&first);
    assert_int_equal(access(own, F_OK), -1);
    free(own);
    free(file);
    free(left);
}

/* --- files replaced after the check --- */

/* The message is about the model's own file, not about one that it names. */
static void is_refused_for_the_file_itself(const room *r)
{
    char *message = trouble(r);
    assert_null(strstr(message, "needs"));
    free(message);
}

static void files_replaced_by_links_after_the_check_are_refused(void **state)
{
    const room *r = *state;
    static const struct {
        const char *file, *scene;
    } cases[] = {
        {"p.png", SCENE("textures: {cloth: {file: p.png}}\nsolids: {it: {shape: sphere, texture: cloth}}\n")},
        {"p.png", SCENE("background: {kind: image, image: p.png}\n")},
        {"plain.obj", BODY("plain.obj")},
        {"pull.yaml", SCENE("meshes: {body: {generate: slime, level: 2, time_s: 0.05, script: pull.yaml}}\nsolids: "
                            "{it: {shape: mesh, mesh: body}}\n")},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        put_files(r);
        render_worker_suspend(r->lab.lab->render_worker, "a file is exchanged");
        open_scene(r, cases[i].scene); /* passes the check */
        char *target = text_format("../%s", cases[i].file);
        put_link(r, cases[i].file, target);
        render_worker_suspend(r->lab.lab->render_worker, NULL);
        is_refused(r, cases[i].scene, cases[i].file);
        is_refused_for_the_file_itself(r);
        free(target);
        remove_file(r, cases[i].file);
        put_files(r);
        room_post(&r->lab, "/api/open", "{\"new\": true}");
        room_post(&r->lab, "/api/undo", "{}");
        is_loaded(r, cases[i].scene);
    }
}

/* Scenes without a file are confined too. */
static void new_scenes_are_confined_to_the_folder(void **state)
{
    const room *r = *state;
    char *change =
        text_format("{\"set\": {\"background.kind\": \"image\", \"background.image\": \"%s/p.png\"}}", r->inside);
    for (int opened = 0; opened < 2; opened++) { /* the first scene, then an opened one */
        if (opened)
            room_post(&r->lab, "/api/open", "{\"new\": true}");
        remove_file(r, "p.png");
        put_images(r);
        render_worker_suspend(r->lab.lab->render_worker, "a file is exchanged");
        room_post(&r->lab, "/api/set", change);
        put_link(r, "p.png", "../p.png");
        render_worker_suspend(r->lab.lab->render_worker, NULL);
        is_refused(r, "a sky", "background.image");
    }
    free(change);
}

static status let_all_pass(void *context, const char *path, diagnostic *why)
{
    (void)context, (void)path, (void)why;
    return STATUS_OK;
}

static status let_all_load(void *context, const scene *setting, diagnostic *why)
{
    (void)context, (void)setting, (void)why;
    return STATUS_OK;
}

/* As if each file were replaced by a link just after the check. */
static void scenes_and_studies_replaced_by_links_are_refused(void **state)
{
    const room *r = *state;
    put(r, "s.yaml", SCENE(""));
    put(r, "t.study", "study: t\nscene: lab/s.yaml\ngrid: [{render.depth: [1, 2]}]\n");
    put(r, "lab/t.study", "study: t\nscene: s.yaml\ngrid: [{render.depth: [1, 2]}]\n");
    put_link(r, "s.yaml", "../s.yaml");
    put_link(r, "u.study", "../t.study");
    char *scene_path = text_format("%s/s.yaml", r->inside);
    for (int within = 0; within < 2; within++) {
        const char *root = within ? r->above : r->inside;
        scene *s = NULL;
        diagnostic why = {.what = ""};
        assert_int_equal(scene_read_below(scene_path, root, &s, &why), within ? STATUS_OK : STATUS_BAD_INPUT);
        assert_string_equal(within ? s->limits.root : why.what, within ? root : BELOW_WHAT);
        scene_destroy(s);
        for (int k = 0; k < 2; k++) {
            char *path = text_format("%s/%s.study", r->inside, k ? "u" : "t");
            const study_guard guard = {.may_open = let_all_pass, .may_load = let_all_load, .root = root};
            study *t = NULL;
            if (!within) {
                assert_int_equal(study_read_guarded(path, &guard, &t, &why), STATUS_BAD_INPUT);
                assert_string_equal(why.what, BELOW_WHAT);
            } else if (k == 0) {
                assert_int_equal(study_read_guarded(path, &guard, &t, &why), STATUS_OK);
                assert_string_equal(t->base->limits.root, root);
            }
            study_destroy(t);
            free(path);
        }
    }
    free(scene_path);
}

/* --- paths below a folder --- */

static bool opens(const room *r, const char *name, const char *root)
{
    char *path = text_format("%s/%s", r->above, name);
    const int fd = below_open(path, root);
    const int error = errno;
    free(path);
    if (fd >= 0)
        close(fd);
    else
        assert_true(error == EXDEV || error == ENOENT);
    return fd >= 0;
}

static void only_paths_below_the_root_are_opened(void **state)
{
    const room *r = *state;
    char *beginning = text_format("%s/la", r->above);
    put_link(r, "to-itself", ".");
    assert_true(opens(r, "lab/a.mtl", r->inside));
    assert_true(opens(r, "lab/../lab/to-itself/a.mtl", r->inside));
    assert_true(opens(r, "a.mtl", NULL) && opens(r, "a.mtl", "") && opens(r, "a.mtl", r->above));
    assert_false(opens(r, "a.mtl", r->inside));
    assert_false(opens(r, "lab/../a.mtl", r->inside));
    assert_false(opens(r, "lab/a.mtl", beginning));     /* the name only begins like the folder's */
    assert_false(opens(r, "lab/to-itself", r->inside)); /* the folder itself is not below it */
    assert_false(opens(r, "lab/nothing", r->inside));
    free(beginning);
}

/* --- triangles --- */

/* The second of two meshes that exceed the limit together is dropped. */
static void meshes_are_dropped_when_their_sum_exceeds_the_triangle_limit(void **state)
{
    const room *r = *state;
    static const char two[] =
        SCENE("meshes: {one: {file: plain.obj}, two: {file: plain.obj}, more: {generate: box}}\n");
    char *name = text_format("%s/any.yaml", r->inside);
    const struct {
        size_t limit, loaded;
        const char *word;
    } cases[] = {{0, 3, NULL}, {14, 3, NULL}, {13, 2, "14 triangles"}, {1, 1, "2 triangles"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        scene *s = NULL;
        diagnostic why = {.what = ""};
        assert_int_equal(scene_read_text(name, two, sizeof two - 1, &s, NULL), STATUS_OK);
        assert_int_equal(scene_limit(s, NULL, cases[i].limit, NULL), STATUS_OK);
        scene *copy = scene_clone(s); /* has the same limit */
        assert_int_equal(scene_load(copy, &why), cases[i].word ? STATUS_BAD_INPUT : STATUS_OK);
        size_t loaded = 0;
        for (size_t k = 0; k < copy->mesh_count; k++)
            loaded += copy->meshes[k].data != NULL;
        assert_int_equal(loaded, cases[i].loaded);
        assert_true(!cases[i].word || (strstr(why.what, cases[i].word) && why.remedy[0]));
        scene_destroy(copy);
        scene_destroy(s);
    }
    free(name);
}

/* The importer stops at a single file that exceeds the limit. */
static void a_file_above_the_triangle_limit_is_refused(void **state)
{
    const room *r = *state;
    put(r, "lab/two.obj", TRIANGLE "f 1 3 2\n");
    static const char one[] = SCENE("meshes: {one: {file: two.obj}}\n");
    char *name = text_format("%s/any.yaml", r->inside);
    scene *s = NULL;
    diagnostic why = {.what = ""};
    assert_int_equal(scene_read_text(name, one, sizeof one - 1, &s, NULL), STATUS_OK);
    assert_int_equal(scene_limit(s, NULL, 1, NULL), STATUS_OK);
    assert_int_equal(scene_load(s, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "more triangles than the limit of 1"));
    assert_null(s->meshes[0].data);
    scene_destroy(s);
    free(name);
}

/* The document's check counts a file as a few triangles; the real number is known after loading. */
static void the_lab_enforces_the_triangle_limit_after_loading(void **state)
{
    const room *r = *state;
    char *path = text_format("%s/many.obj", r->inside);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    free(path);
    fputs("v 0 0 0\nv 1 0 0\nv 0 1 0\n", file);
    for (int i = 0; i < 100; i++)
        fprintf(file, "v 0 0 %d\nf 1 2 %d\n", i + 1, i + 4);
    assert_int_equal(fclose(file), 0);
    open_scene(r, SCENE("meshes: {many: {file: many.obj}, sparse: {generate: sparse, count: 3999900}}\n"));
    is_loaded(r, "just as many");
    open_scene(r, SCENE("meshes: {many: {file: many.obj}, sparse: {generate: sparse, count: 3999901}}\n"));
    char *message = trouble(r);
    assert_non_null(strstr(message, "4000001 triangles"));
    free(message);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(material_libraries_outside_the_folder_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(absolute_material_libraries_outside_the_folder_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(images_of_materials_outside_the_folder_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(buffers_and_images_of_gltf_outside_the_folder_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(added_models_are_confined_to_the_folder, enter, leave),
        cmocka_unit_test_setup_teardown(programs_outside_the_folder_are_not_started, enter, leave),
        cmocka_unit_test(temporary_folders_of_killed_laboratories_are_removed),
        cmocka_unit_test_setup_teardown(files_replaced_by_links_after_the_check_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(new_scenes_are_confined_to_the_folder, enter, leave),
        cmocka_unit_test_setup_teardown(scenes_and_studies_replaced_by_links_are_refused, enter, leave),
        cmocka_unit_test_setup_teardown(only_paths_below_the_root_are_opened, enter, leave),
        cmocka_unit_test_setup_teardown(meshes_are_dropped_when_their_sum_exceeds_the_triangle_limit, enter, leave),
        cmocka_unit_test_setup_teardown(a_file_above_the_triangle_limit_is_refused, enter, leave),
        cmocka_unit_test_setup_teardown(the_lab_enforces_the_triangle_limit_after_loading, enter, leave),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
