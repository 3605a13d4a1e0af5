/* `cuvette lesson`: lists the lessons of the laboratory's gallery, checks them without a browser, and prints one with
 * its measured curve. */
#include "lesson/lesson.h"
#include "base/json_build.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/scene_input.h"
#include "report/json.h"
#include "report/report.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FILES_MAX = 256 };

typedef struct lesson_request {
    const char *files[FILES_MAX];
} lesson_request;

/* Calls `act` for the lessons on the command line; without any, for the lessons that come with the program. */
static status each_lesson(const lesson_request *request, status (*act)(const lesson *l, isa level, diagnostic *why),
                          diagnostic *why)
{
    lesson_list installed = {.path = NULL};
    isa level;
    TRY(scene_input_isa(&level, why));
    if (!request->files[0]) {
        char *folder = lesson_folder();
        const status code = folder ? lesson_list_find(folder, &installed, why)
                                   : options_wrong("lesson", NULL, why, "name the files of lessons",
                                                   "the lessons that come with the program are not installed");
        free(folder);
        TRY(code);
    }
    const char *const *files = installed.path ? (const char *const *)installed.path : request->files;
    status code = STATUS_OK;
    for (size_t i = 0; code == STATUS_OK && (installed.path ? i < installed.count : i < FILES_MAX && files[i]); i++) {
        lesson *l = NULL;
        code = lesson_read(files[i], &l, why);
        THEN(code, act(l, level, why));
        lesson_destroy(l);
    }
    lesson_list_release(&installed);
    return code;
}

static status print_row(const lesson *l, isa level, diagnostic *why)
{
    (void)level, (void)why;
    printf("%-16s %-34s %s\n", l->name, l->title, l->path);
    return STATUS_OK;
}

static void print_pass(const lesson *l, const lesson_result *r)
{
    printf("pass  %-16s %s = %.10g%s%s; ", l->name, l->reading, r->measured, l->unit[0] ? " " : "", l->unit);
    if (lesson_is_timed(l))
        printf("%d times, no tolerance\n", r->points.count);
    else
        printf("largest error of %d points %.1e, tolerance %.1e\n", r->points.count, r->error, l->tolerance);
}

static status check_one(const lesson *l, isa level, diagnostic *why)
{
    lesson_result *r = malloc(sizeof *r);
    status code = r ? lesson_check(l, level, r, why) : out_of_memory(why);
    if (code == STATUS_OK)
        print_pass(l, r);
    free(r);
    return code;
}

static status print_lesson(const lesson *l, isa level, diagnostic *why)
{
    lesson_result *r = malloc(sizeof *r);
    status code = r ? lesson_measure(l, l->start, level, r, why) : out_of_memory(why);
    json_t *all = code == STATUS_OK ? lesson_json(l) : NULL;
    if (all)
        json_add_as(&all, "result", lesson_result_json(l, r));
    free(r);
    return code == STATUS_OK ? json_print(all, why) : code;
}

#define FILES                                                                         \
    .arguments_at = offsetof(lesson_request, files), .argument_limit = FILES_MAX - 1, \
    .excess = "unexpected argument '%.128s'", .excess_remedy = "give at most 255 files at a time"

static const command_form list_form = {
    .synopsis = "[FILE...]",
    FILES,
    .about = "List lessons: name, title, file. Without FILE, list those that come with the program."};
static const command_form check_form = {
    .synopsis = "[FILE...]",
    FILES,
    .about =
        "Read lessons, trace the curve of each and compare it with theory. Without FILE, check those that come with "
        "the program. The exit status is 2 at the first invalid lesson, or the first curve beyond its tolerance."};
static const command_form show_form = {
    .synopsis = "FILE...",
    FILES,
    .about = "Print lessons as JSON, as the laboratory's page reads them, with the measured curve and theory."};

static status list(int argc, char **argv, diagnostic *why)
{
    lesson_request request = {.files = {NULL}};
    TRY(command_form_read(&list_form, argc, argv, &request, why));
    return each_lesson(&request, print_row, why);
}

static status check(int argc, char **argv, diagnostic *why)
{
    lesson_request request = {.files = {NULL}};
    TRY(command_form_read(&check_form, argc, argv, &request, why));
    return each_lesson(&request, check_one, why);
}

static status show(int argc, char **argv, diagnostic *why)
{
    lesson_request request = {.files = {NULL}};
    TRY(command_form_read(&show_form, argc, argv, &request, why));
    return each_lesson(&request, print_lesson, why);
}

status command_lesson(int argc, char **argv, diagnostic *why)
{
    static const command commands[] = {
        {"list", "list the lessons", list},
        {"check", "check lessons, and their curves against theory", check},
        {"show", "print lessons and their curves as JSON", show},
    };
    return command_dispatch(commands, sizeof commands / sizeof *commands,
                            "Lessons: guided experiments of the laboratory's gallery, which 'cuvette lab' shows.", argc,
                            argv, why);
}
