/* Tests of the list of quantities: names, keys and columns are unique, rows and JSON agree for one frame, and the
 * dictionary in results/README.md agrees with the list. With CUVETTE_RENEW=1 in the environment it is rewritten first
 * (make dictionary). */
#include "base/file.h"
#include "base/text.h"
#include "job/job.h"
#include "report/report.h"
#include "scene/model/scene.h"
#include "study/fit/fit.h"
#include "study/rows/compare_rows.h"
#include "study/rows/rows.h"
#include "study_fixture.h"

/* --- the list --- */

static void expect_unique(const quantity *list, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        assert_true(list[i].name[0] && list[i].meaning[0]);
        assert_true(list[i].column || list[i].json || list[i].page);
        for (size_t k = 0; k < i; k++) {
            assert_string_not_equal(list[i].name, list[k].name);
            if (list[i].json && list[k].json)
                assert_string_not_equal(list[i].json, list[k].json);
            if (list[i].page && list[k].page)
                assert_string_not_equal(list[i].page, list[k].page);
        }
    }
}

static void names_and_keys_are_unique(void **state)
{
    (void)state;
    expect_unique(frame_quantities, frame_quantity_count);
    expect_unique(worker_quantities, worker_quantity_count);
    assert_string_equal(frame_quantities[0].name, "film_hash"); /* in rows it must be the next column */
    assert_ptr_equal(frame_quantity("cpu_s")->name, frame_quantities[3].name);
    assert_null(frame_quantity("cpu"));
}

/* Every value of a row is in the account. */
static void every_column_has_a_key(void **state)
{
    (void)state;
    for (size_t i = 0; i < frame_quantity_count; i++)
        assert_true(!frame_quantities[i].column || frame_quantities[i].json);
    for (size_t i = 0; i < worker_quantity_count; i++)
        assert_true(!worker_quantities[i].column || worker_quantities[i].json);
}

/* --- one frame --- */

static const json_t *find(const json_t *o, const char *key)
{
    char *path = strdup(key), *rest = NULL;
    for (char *word = strtok_r(path, ".", &rest); word && o; word = strtok_r(NULL, ".", &rest))
        o = json_object_get(o, word);
    free(path);
    return o;
}

/* In the format of a row. */
static void put_json(csv_buffer *line, const quantity *q, const json_t *value)
{
    char text[2048] = "";
    size_t size = 0, last = json_array_size(value);
    if (q->type == QUANTITY_SOLIDS) {
        const char *name;
        json_t *count;
        json_object_foreach((json_t *)(uintptr_t)value, name, count) csv_count(line, json_integer_value(count));
    } else if (q->type == QUANTITY_DEPTHS) {
        while (last > 1 && json_integer_value(json_array_get(value, last - 1)) == 0)
            last--;
        for (size_t i = 0; i < last; i++)
            size += (size_t)snprintf(text + size, sizeof text - size, "%s%lld", i ? ";" : "",
                                     (long long)json_integer_value(json_array_get(value, i)));
        csv_text(line, text);
    } else if (json_is_integer(value)) {
        csv_count(line, json_integer_value(value));
    } else if (json_is_real(value)) {
        csv_real(line, json_real_value(value));
    } else {
        csv_text(line, json_string_value(value)); /* NULL of null */
    }
}

static int tell_apart(const quantity *list, size_t count, const job_account *a, int worker, const json_t *account)
{
    int compared = 0;
    for (size_t i = 0; i < count; i++) {
        csv_buffer row = {0}, from_json = {0};
        if (!list[i].column)
            continue;
        const json_t *value = find(account, list[i].json);
        if (!value)
            fail_msg("the account lacks %s", list[i].json);
        row_put(&row, &list[i], a, worker);
        put_json(&from_json, &list[i], value);
        csv_end(&row);
        csv_end(&from_json);
        if (strcmp(row.text, from_json.text) != 0)
            fail_msg("%s: %s is not %s", list[i].name, row.text, from_json.text);
        csv_buffer_free(&row);
        csv_buffer_free(&from_json);
        compared++;
    }
    return compared;
}

/* With meshes, random paths and two threads, so that no value is missing. */
static const char scene_text[] = "render: {width: 24, height: 16, integrator: path, paths: 8, samples: 1, threads: 2}\n"
                                 "camera: {position: [0, 2, -6], target: [0, 1, 0]}\n"
                                 "lights: {lamp: {position: [4, 7, -5]}}\n"
                                 "background: {kind: uniform, color: [0.5, 0.7, 0.9]}\n"
                                 "materials: {matt: {diffuse: 0.8}, clear: {transparency: 1}}\n"
                                 "meshes: {tube: {generate: torus, minor: 0.3}}\n"
                                 "solids:\n"
                                 "  ground: {shape: plane, material: matt}\n"
                                 "  ring: {shape: mesh, mesh: tube, material: matt, position: [0, 1, 0]}\n"
                                 "  ball: {shape: sphere, material: clear, ior: 1.5, position: [1, 1, 0]}\n";

static void rows_and_json_agree(void **state)
{
    char path[400];
    scene *s;
    job *j;
    job_account made;
    diagnostic why = {.what = ""};
    fixture_write(*state, "frame.yaml", scene_text);
    fixture_path(*state, "frame.yaml", path);
    if (scene_read(path, &s, &why) != STATUS_OK)
        fail_msg("%s", why.what);
    assert_int_equal(job_create(&(job_settings){.measured = true}, &j, NULL), STATUS_OK);
    assert_int_equal(job_load(j, s, NULL, NULL), STATUS_OK);
    assert_int_equal(job_render(j, s, &(render_options){.usage = true}, &made, NULL), STATUS_OK);
    json_t *account = report_create(&made, false), *page = report_image_numbers(&made);
    assert_true(tell_apart(frame_quantities, frame_quantity_count, &made, -1, account) > 40);
    for (int i = 0; i < made.result->worker_count; i++) {
        const json_t *one = json_array_get(json_object_get(account, "threads"), (size_t)i);
        assert_int_equal(json_integer_value(json_object_get(one, "worker")), i);
        assert_true(tell_apart(worker_quantities, worker_quantity_count, &made, i, one) > 10);
    }
    for (size_t i = 0; i < frame_quantity_count; i++) {
        const quantity *q = &frame_quantities[i];
        assert_true(!q->page || json_equal(json_object_get(page, q->page), find(account, q->json)));
    }
    assert_true(json_real_value(find(account, "noise.rms")) > 0.0);
    assert_true(json_integer_value(find(account, "meshes.triangles")) > 0);
    json_decref(page);
    json_decref(account);
    job_account_release(&made);
    job_destroy(j);
    scene_destroy(s);
}

/* Values that are equal in all frames, and values over all frames. */
static void values_of_several_frames_are_merged(void **state)
{
    (void)state;
    scene *s = scene_create();
    job *j;
    job_account one, three;
    assert_non_null(s);
    s->render.width = 8, s->render.height = 6;
    assert_int_equal(job_create(&(job_settings){.measured = true}, &j, NULL), STATUS_OK);
    assert_int_equal(job_render(j, s, NULL, &one, NULL), STATUS_OK);
    assert_int_equal(job_repeat(j, s, 3, NULL, &three, NULL), STATUS_OK);
    assert_int_equal(three.count, 3);
    for (size_t i = 0; i < frame_quantity_count; i++) {
        const quantity *q = &frame_quantities[i];
        json_t *a = report_quantity(q, &one, -1), *b = report_quantity(q, &three, -1);
        if (q->merge == QUANTITY_SAME && !json_equal(a, b))
            fail_msg("%s is not the same", q->name);
        json_decref(a);
        json_decref(b);
    }
    const double *t = three.wall_s, middle = fmax(fmin(t[0], t[1]), fmin(fmax(t[0], t[1]), t[2]));
    assert_true(job_account_wall_s(&three) == middle);
    assert_true(three.spent.wall_s >= t[0] + t[1] + t[2]);
    job_account_release(&one);
    job_account_release(&three);
    job_destroy(j);
    scene_destroy(s);
}

/* --- documents --- */

static char *content(const char *path)
{
    FILE *file = fopen(path, "r");
    char *text = calloc(1, 1 << 18);
    assert_non_null(file);
    assert_non_null(text);
    assert_true(fread(text, 1, (1 << 18) - 1, file) > 0);
    fclose(file);
    return text;
}

/* Expects this text in the file between the first `begin` after `after` and the next `end`. */
static void expect_part(const char *path, const char *after, const char *begin, const char *end, const char *part,
                        size_t size)
{
    char *text = content(path), *from = strstr(text, after);
    from = from ? strstr(from, begin) : NULL;
    if (!from)
        fail_msg("%s has no %s after %s", path, begin, after);
    from += strlen(begin);
    char *to = strstr(from, end);
    assert_non_null(to);
    if (getenv("CUVETTE_RENEW")) {
        char *renewed = text_format("%.*s%.*s%s", (int)(from - text), text, (int)size, part, to);
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        assert_true(fputs(renewed, file) >= 0);
        assert_int_equal(fclose(file), 0);
        free(renewed);
    } else if (size != (size_t)(to - from) || memcmp(part, from, size) != 0) {
        fail_msg("%s, %s: differs from the list of quantities; run make dictionary", path, after);
    }
    free(text);
}

static void print_column(void *context, const row_column *c)
{
    fprintf(context, "| `%s` | %s | %s |\n", c->name, c->unit, c->meaning);
}

static void the_dictionary_equals_the_list(void **state)
{
    (void)state;
    static const struct {
        const char *title;
        row_columns *each;
    } tables[] = {{"\n## rows.csv", row_each_column},
                  {"\n## workers.csv", worker_each_column},
                  {"\n## compare.csv", compare_each_column},
                  {"\n## fit.csv", fit_each_column}};
    for (size_t i = 0; i < sizeof tables / sizeof tables[0]; i++) {
        char *text = NULL;
        size_t size;
        FILE *out = open_memstream(&text, &size);
        tables[i].each(print_column, out);
        fclose(out);
        expect_part("results/README.md", tables[i].title, "| column | unit | meaning |\n|---|---|---|\n", "\n\n", text,
                    size - 1);
        free(text);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_and_keys_are_unique),
        cmocka_unit_test(every_column_has_a_key),
        cmocka_unit_test_setup_teardown(rows_and_json_agree, fixture_setup, fixture_teardown),
        cmocka_unit_test(values_of_several_frames_are_merged),
        cmocka_unit_test(the_dictionary_equals_the_list),
    };
    return cmocka_run_group_tests_name("quantities", tests, NULL, NULL);
}
