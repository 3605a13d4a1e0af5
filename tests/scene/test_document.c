/* Tests of the YAML tree: node kinds, locations, limits, and helpers of readers. Faulty files are also tested in
 * test_bad_scenes.c. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "base/budget.h"
#include "scene/data/document.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static document *parse(const char *text)
{
    document *d;
    assert_int_equal(document_parse("t.yaml", text, strlen(text), &d, NULL), STATUS_OK);
    return d;
}

static void expect_error(const char *text, size_t size, long line, long column)
{
    document *d = (document *)(uintptr_t)1;
    diagnostic why = {.what = ""};
    assert_int_equal(document_parse("t.yaml", text, size, &d, &why), STATUS_BAD_INPUT);
    assert_null(d);
    assert_string_equal(why.file, "t.yaml");
    assert_int_equal(why.line, line);
    assert_int_equal(why.column, column);
    assert_true(why.what[0]);
    assert_int_equal(document_parse("t.yaml", text, size, &d, NULL), STATUS_BAD_INPUT);
}

static void nodes_have_kind_text_and_location(void **state)
{
    (void)state;
    document *d = parse("a: 1\nlist:\n  - x\n  - 'y z'\nmap: {k: v, é: \"\"}\nnone:\n");
    const node *root = document_root(d);
    assert_string_equal(document_name(d), "t.yaml");
    assert_int_equal(root->kind, NODE_MAP);
    assert_int_equal(root->count, 4);
    const node *list = node_get(root, "list");
    assert_int_equal(list->kind, NODE_LIST);
    assert_int_equal(list->count, 2);
    assert_null(list->keys);
    assert_string_equal(list->items[1]->text, "y z");
    assert_true(list->items[1]->quoted);
    assert_false(list->items[0]->quoted);
    assert_int_equal(list->items[1]->line, 4);
    assert_int_equal(list->items[1]->column, 5);
    const node *map = node_get(root, "map");
    assert_int_equal(map->kind, NODE_MAP);
    assert_int_equal(node_get(map, "é")->column, 16); /* characters, not bytes */
    assert_string_equal(node_get(root, "none")->text, "");
    assert_null(node_get(root, "nothing"));
    assert_null(node_get(list, "x"));
    assert_null(node_get(NULL, "x"));
    document_destroy(d);
    document_destroy(NULL);
}

static void any_root_and_line_ending_are_read(void **state)
{
    (void)state;
    static const char *const lists[] = {"[1, 2]", "\xef\xbb\xbf[1, 2]", "---\n- 1\n- 2\n...\n", "- 1\r\n- 2\r\n"};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++) {
        document *d = parse(lists[i]);
        assert_int_equal(document_root(d)->count, 2);
        assert_string_equal(document_root(d)->items[1]->text, "2");
        assert_int_equal(document_root(d)->column, 1);
        document_destroy(d);
    }
}

static char *repeat(const char *head, const char *part, size_t count, const char *tail)
{
    char *text = malloc(strlen(head) + strlen(part) * count + strlen(tail) + 1), *end;
    assert_non_null(text);
    end = stpcpy(text, head);
    for (size_t i = 0; i < count; i++)
        end = stpcpy(end, part);
    stpcpy(end, tail);
    return text;
}

static void nesting_is_limited_to_sixteen_levels(void **state)
{
    (void)state;
    document *d = parse("[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]");
    document_destroy(d);
    const char *deeper = "[[[[[[[[[[[[[[[[[1]]]]]]]]]]]]]]]]]";
    expect_error(deeper, strlen(deeper), 1, 17);
}

static void size_and_number_of_values_are_limited(void **state)
{
    (void)state;
    char *some = repeat("[", "0,", 99999, "0]");
    document *d = parse(some);
    assert_int_equal(document_root(d)->count, 100000);
    document_destroy(d);
    free(some);
    expect_error("a: 1\n", (256 << 20) + 1, 1, 1); /* the text is not read */
    if (!getenv("CHECK"))                          /* what follows needs 1.2 GiB */
        return;
    char *many = repeat("[", "0,", (1 << 24) - 1, "0]"); /* with the list itself: one too many */
    expect_error(many, strlen(many), 1, 1 << 25);
    free(many);
}

/* The tree is refused before it takes more memory than the budget leaves. */
static void the_tree_keeps_the_memory_budget(void **state)
{
    (void)state;
    char *many = repeat("[", "0,", 999999, "0]");
    memory_budget_set(1 << 20);
    document *d;
    diagnostic why = {.what = ""};
    assert_int_equal(document_parse("many.yaml", many, strlen(many), &d, &why), STATUS_BAD_INPUT);
    assert_non_null(strstr(why.what, "many.yaml needs about"));
    assert_null(d);
    memory_budget_set(0);
    assert_int_equal(document_parse("many.yaml", many, strlen(many), &d, &why), STATUS_OK);
    assert_int_equal(document_root(d)->count, 1000000);
    assert_string_equal(document_root(d)->items[999999]->text, "0");
    assert_int_equal(document_root(d)->items[999999]->column, 2000000);
    document_destroy(d);
    free(many);
}

static void cyclic_or_ambiguous_yaml_is_refused(void **state)
{
    (void)state;
    expect_error("a: &x 1\n", 8, 1, 4);
    expect_error("a: *x\n", 6, 1, 4);
    expect_error("a: !t 1\n", 8, 1, 4);
    expect_error("a: &x [*x]\n", 11, 1, 4);
    expect_error("a: 1\nb: 2\na: 3\n", 15, 3, 1);
    expect_error("a: 1\n---\nb: 1\n", 14, 2, 1);
    expect_error("", 0, 1, 1);
    expect_error("\n# x\n", 5, 1, 1);
    expect_error("\x89PNG", 4, 1, 1);
    expect_error("\xff\xd8\xff\xe0", 4, 1, 1);
    expect_error("a: \"x\\0y\"", 9, 1, 4);
    expect_error("a: b\n\tc: d\n", 11, 2, 1);
    expect_error("\xff\xfe"
                 "a",
                 3, 1, 1);
}

static void an_unknown_key_is_reported_with_the_nearest_word(void **state)
{
    (void)state;
    static const char *const words[] = {"depth", "width"};
    document *d = parse("width: 1\ndetph: 2\n"), *far = parse("zebra: 1\n"), *good = parse("depth: 1\n");
    diagnostic why = {.what = ""};
    assert_int_equal(node_check_keys(good, document_root(good), words, 2, &why), STATUS_OK);
    assert_int_equal(node_check_keys(d, document_root(d), words, 2, &why), STATUS_BAD_INPUT);
    assert_int_equal(why.line, 2);
    assert_string_equal(why.remedy, "did you mean 'depth'?");
    assert_int_equal(node_check_keys(far, document_root(far), words, 2, &why), STATUS_BAD_INPUT);
    assert_string_equal(why.remedy, "the keys here are: depth, width");
    assert_int_equal(node_error(d, document_root(d)->items[1], &why, "r", "w %d", 5), STATUS_BAD_INPUT);
    char text[DIAGNOSTIC_TEXT_MAX];
    assert_string_equal(diagnostic_text(&why, text, sizeof text), "t.yaml:2:8: w 5; r");
    document_destroy(d);
    document_destroy(far);
    document_destroy(good);
}

static void the_remedy_for_an_unknown_key_suggests_the_right_word(void **state)
{
    (void)state;
    static const char *const words[] = {"radius",        "ior", "yaw_deg", "pitch_deg", "checker",
                                        "checker_color", "m",   "shape",   "color"};
    static const struct {
        const char *key, *remedy;
    } cases[] = {
        {"n", "did you mean 'ior'?"},
        {"Index", "did you mean 'ior'?"},
        {"refractive_index", "did you mean 'ior'?"},
        {"type", "did you mean 'shape'?"},
        {"colour", "did you mean 'color'?"},
        {"yaw", "did you mean 'yaw_deg'?"},
        {"raduis", "did you mean 'radius'?"},
        {"chec", "the keys here are: "},  /* the key begins two words */
        {"alpha", "the keys here are: "}, /* transparency is not in this list of words */
        {"io", "the keys here are: "},
        {"r", "the keys here are: "},
        {"5", "a decimal comma? write 1.5; a vector is [0, 1, 2]"},
        {"0.25", "a decimal comma? write 1.5; a vector is [0, 1, 2]"},
        {"radius:2", "put a space after the colon"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[100], remedy[100];
        snprintf(text, sizeof text, "{%s: 1}", cases[i].key);
        document *d = parse(text);
        diagnostic why = {.what = ""};
        assert_int_equal(node_check_keys(d, document_root(d), words, sizeof words / sizeof *words, &why),
                         STATUS_BAD_INPUT);
        snprintf(remedy, strlen(cases[i].remedy) + 1, "%s", why.remedy);
        assert_string_equal(remedy, cases[i].remedy);
        document_destroy(d);
    }
}

static void value_text_has_the_command_lines_syntax(void **state)
{
    (void)state;
    static const struct {
        const char *yaml, *text;
    } cases[] = {
        {"v: 8", "8"},           {"v: [0, 2.75, -6]", "0,2.75,-6"},
        {"v: []", ""},           {"v: [a]", "a"},
        {"v: {a: 1}", NULL},     {"v: [[1], 2]", NULL},
        {"v: ['1,2', 3]", NULL}, {"v: 'a b'", "a b"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        document *d = parse(cases[i].yaml);
        char *text = node_value_text(node_get(document_root(d), "v"));
        if (cases[i].text)
            assert_string_equal(text, cases[i].text);
        else
            assert_null(text);
        free(text);
        document_destroy(d);
    }
}

static void files_are_read_and_missing_files_are_named(void **state)
{
    (void)state;
    char folder[] = "/tmp/test_document_XXXXXX", path[64];
    assert_non_null(mkdtemp(folder));
    snprintf(path, sizeof path, "%s/a.yaml", folder);
    document *d;
    diagnostic why = {.what = ""};
    assert_int_equal(document_read_below(path, NULL, &d, &why), STATUS_BAD_INPUT);
    assert_null(d);
    assert_string_equal(why.file, path);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("a: [1\n", file);
    fclose(file);
    assert_int_equal(document_read_below(path, NULL, &d, &why), STATUS_BAD_INPUT);
    assert_int_equal(why.line, 2);
    assert_true(truncate(path, 1) == 0);
    assert_int_equal(document_read_below(path, NULL, &d, &why), STATUS_OK);
    assert_string_equal(document_root(d)->text, "a");
    assert_string_equal(document_name(d), path);
    document_destroy(d);
    unlink(path);
    rmdir(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nodes_have_kind_text_and_location),
        cmocka_unit_test(any_root_and_line_ending_are_read),
        cmocka_unit_test(nesting_is_limited_to_sixteen_levels),
        cmocka_unit_test(size_and_number_of_values_are_limited),
        cmocka_unit_test(the_tree_keeps_the_memory_budget),
        cmocka_unit_test(cyclic_or_ambiguous_yaml_is_refused),
        cmocka_unit_test(an_unknown_key_is_reported_with_the_nearest_word),
        cmocka_unit_test(the_remedy_for_an_unknown_key_suggests_the_right_word),
        cmocka_unit_test(value_text_has_the_command_lines_syntax),
        cmocka_unit_test(files_are_read_and_missing_files_are_named),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
