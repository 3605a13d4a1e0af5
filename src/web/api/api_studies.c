/* Studies and what came of them: the section "Studies" of web/README.md. */
#include "base/number.h"
#include "base/text.h"
#include "report/json.h"
#include "web/api/api_machine.h"
#include "web/session/figures.h"
#include "web/lab_private.h"
#include "web/session/studies.h"
#include "web/session/study_files.h"
#include "web/api/study_json.h"
#include <stdlib.h>
#include <string.h>

static void reply(http_reply *r, status code, json_t *value, const diagnostic *why)
{
    if (code == STATUS_OK)
        http_reply_json(r, 200, value);
    else
        http_reply_diagnostic(r, code, why);
}

/* --- what there is --- */

static void add_progress(const lab *l, const study *s, json_t *told)
{
    const char *results = l->settings.results;
    study_progress progress = {0};
    diagnostic why = {.what = ""};
    status code = study_check_results(l, results, s->name, &why);
    if (code == STATUS_OK)
        code = study_status(s, results, &progress, &why);
    json_object_set_new(told, "cells_done", json_integer((json_int_t)progress.cells_done));
    json_object_set_new(told, "rows", json_integer((json_int_t)progress.rows));
    json_object_set_new(told, "warmups", json_integer((json_int_t)progress.warmups));
    json_object_set_new(told, "marked", json_integer((json_int_t)progress.rows_marked));
    if (code != STATUS_OK)
        json_object_set_new(told, "error", json_of_diagnostic(&why));
}

/* A study of the list; one that cannot be read (s NULL) has its error. */
static json_t *study_json(const lab *l, const char *name, const char *file, const study *s, const diagnostic *why)
{
    json_t *told = json_pack("{s:o, s:o, s:b}", "name", json_of_text(name), "file", json_of_text(file), "running",
                             studies_runs(l->studies, name));
    if (told && s && study_json_about(s, told))
        add_progress(l, s, told);
    if (told && !s)
        json_object_set_new(told, "error", json_of_diagnostic(why));
    return told;
}

typedef struct listing {
    const lab *l;
    json_t *studies, *names; /* names: those so far, with their files */
} listing;

static bool list_one(void *context, const char *name, const char *file)
{
    listing *list = context;
    study *s = NULL;
    diagnostic why = {.what = ""};
    study_open(list->l, file, &s, &why);
    const char *earlier = json_string_value(json_object_get(list->names, name));
    if (earlier) {
        diagnose(&why, STATUS_BAD_INPUT, "give one of them another name", "%s has this name too", earlier);
        diagnostic_locate(&why, file, 0, 0);
        study_destroy(s);
        s = NULL;
    } else {
        json_object_set_new(list->names, name, json_string(file)); /* a name that is not UTF-8 is no study's */
    }
    json_array_append_new(list->studies, study_json(list->l, name, file, s, &why));
    study_destroy(s);
    return true;
}

static void get_studies(void *context, const http_request *q, http_reply *r)
{
    (void)q;
    const lab *l = context;
    listing list = {.l = l, .studies = json_array(), .names = json_object()};
    diagnostic why = {.what = ""};
    const status code = study_each(l, list_one, &list, &why);
    char *results = folder_name(l->files, l->settings.results);
    json_t *told =
        json_pack("{s:o, s:O}", "results", results ? json_of_text(results) : json_null(), "studies", list.studies);
    free(results);
    json_decref(list.names);
    json_decref(list.studies);
    if (code == STATUS_OK)
        http_reply_json(r, 200, told);
    else
        reply(r, code, NULL, &why);
    if (code != STATUS_OK)
        json_decref(told);
}

/* The study of the path's {name}; false with the reply set. One that is there and cannot be read gives *file all the
 * same. */
static status take_study(const lab *l, const http_request *q, study **s, char **file, http_reply *r, diagnostic *why)
{
    const char *name = http_path_value(q, "name");
    *s = NULL;
    *file = NULL;
    status code = study_find(l, name, file, why);
    if (code == STATUS_OK && !*file) {
        http_reply_error(r, 404, "there is no study of that name", "GET /api/studies lists them");
        return STATUS_BAD_INPUT;
    }
    if (code == STATUS_OK)
        code = study_open(l, *file, s, why);
    if (code == STATUS_OK)
        code = study_check_results(l, l->settings.results, (*s)->name, why);
    if (code != STATUS_OK) {
        study_destroy(*s);
        *s = NULL;
        reply(r, code, NULL, why);
    }
    return code;
}

static void get_study(void *context, const http_request *q, http_reply *r)
{
    const lab *l = context;
    study *s;
    char *file;
    diagnostic why = {.what = ""};
    const status code = take_study(l, q, &s, &file, r, &why);
    if (file) {
        const char *name = http_path_value(q, "name");
        json_t *told = study_json(l, name, file, s, &why), *summary = NULL;
        if (s && study_json_summary(s, l->settings.results, &summary, &why) != STATUS_OK)
            json_object_set_new(told, "error", json_of_diagnostic(&why));
        json_object_set_new(told, "summary", summary ? summary : json_null());
        json_object_set_new(told, "runs", s ? study_runs(l, s->name) : json_array());
        json_object_set_new(told, "figures", s ? figures_of(l, s->name) : json_array());
        json_object_set_new(told, "drawable", s ? figures_drawable(l, s->name) : json_array());
        if (code == STATUS_OK || code == STATUS_BAD_INPUT)
            http_reply_json(r, 200, told);
        else
            json_decref(told);
    }
    study_destroy(s);
    free(file);
}

/* --- run and stop --- */

static void reply_state(lab *l, status code, http_reply *r, const diagnostic *why)
{
    reply(r, code, code == STATUS_OK ? studies_tell(l->studies) : NULL, why);
}

static bool take_nothing(const http_request *q, http_reply *r)
{
    json_t *body = http_body_json(q, r);
    const bool fits = json_is_object(body) && json_object_size(body) == 0;
    if (body && !fits)
        http_reply_error(r, 400, "there is nothing to say here", "send {}");
    json_decref(body);
    return fits;
}

static void post_run(void *context, const http_request *q, http_reply *r)
{
    lab *l = context;
    study *s;
    char *file = NULL;
    diagnostic why = {.what = ""};
    if (take_nothing(q, r) && take_study(l, q, &s, &file, r, &why) == STATUS_OK)
        reply_state(l, studies_start(l->studies, s, &why), r, &why);
    free(file);
}

static void post_stop(void *context, const http_request *q, http_reply *r)
{
    lab *l = context;
    diagnostic why = {.what = ""};
    if (take_nothing(q, r))
        reply_state(l, studies_stop(l->studies, http_path_value(q, "name"), &why), r, &why);
}

/* --- what was measured --- */

static void get_rows(void *context, const http_request *q, http_reply *r)
{
    const lab *l = context;
    const char *text = http_query_value(q, "from");
    int64_t from = 0;
    study *s;
    char *file;
    json_t *told = NULL;
    diagnostic why = {.what = ""};
    if (text && (!number_parse_int(text, &from) || from < 0)) {
        http_reply_error(r, 400, "from is not a number of rows", "write ?from=N with N from 0");
        return;
    }
    if (take_study(l, q, &s, &file, r, &why) == STATUS_OK) {
        const status code = study_json_rows(s, l->settings.results, (size_t)from, &told, &why);
        reply(r, code, told, &why);
    }
    study_destroy(s);
    free(file);
}

/* The folder of results of that name, which holds rows of the study. */
static status take_run(const lab *l, const char *run, const study *s, char **results, diagnostic *why)
{
    char *rows = text_format("%s/%s/rows.csv", run, s->name);
    status code = rows ? folder_path(l->files, rows, true, results, why) : out_of_memory(why);
    if (code == STATUS_OK) {
        (*results)[strlen(*results) - strlen(rows) + strlen(run)] = 0;
        code = study_check_results(l, *results, s->name, why);
    }
    free(rows);
    return code;
}

static void get_compare(void *context, const http_request *q, http_reply *r)
{
    const lab *l = context;
    const char *with = http_query_value(q, "with");
    study *s;
    char *file, *other = NULL;
    json_t *told = NULL;
    diagnostic why = {.what = ""};
    if (!with || !with[0]) {
        http_reply_error(r, 400, "with what is not said", "write ?with=FOLDER, one of the study's runs");
        return;
    }
    if (take_study(l, q, &s, &file, r, &why) == STATUS_OK) {
        status code = take_run(l, with, s, &other, &why);
        if (code == STATUS_OK)
            code = study_json_compare(s, l->settings.results, other, &told, &why);
        reply(r, code, told, &why);
    }
    free(other);
    study_destroy(s);
    free(file);
}

/* --- figures --- */

static void get_figure(void *context, const http_request *q, http_reply *r)
{
    const lab *l = context;
    char *svg = NULL;
    size_t size = 0;
    diagnostic why = {.what = ""};
    const status code = figure_read(l, http_path_value(q, "name"), &svg, &size, &why);
    if (code == STATUS_OK)
        http_reply_bytes(r, 200, "image/svg+xml", svg, size);
    else if (code == STATUS_BAD_INPUT)
        http_reply_error(r, 404, "there is no such figure", "GET /api/studies/{name} lists those of a study");
    else
        reply(r, code, NULL, &why);
}

static void draw(lab *l, const study *s, http_reply *r)
{
    char *said = NULL;
    bool whole;
    diagnostic why = {.what = ""};
    if (studies_is_running(l->studies)) {
        http_reply_error(r, 409, "a study measures, and drawing would disturb it",
                         "draw when it has ended, or stop it");
        return;
    }
    if (!studies_begin_drawing(l->studies)) {
        http_reply_error(r, 409, "figures are being drawn", "wait for them");
        return;
    }
    const status code = figures_draw(l, s, &said, &whole, &why);
    studies_end_drawing(l->studies);
    json_t *told = code == STATUS_OK ? json_pack("{s:o, s:o, s:b}", "figures", figures_of(l, s->name), "said",
                                                 json_of_text(said), "complete", whole)
                                     : NULL;
    reply(r, code, told, &why);
    free(said);
}

static void post_draw(void *context, const http_request *q, http_reply *r)
{
    lab *l = context;
    study *s = NULL;
    char *file = NULL;
    diagnostic why = {.what = ""};
    if (take_nothing(q, r) && take_study(l, q, &s, &file, r, &why) == STATUS_OK)
        draw(l, s, r);
    study_destroy(s);
    free(file);
}

static const http_route routes[] = {
    {"GET", "/api/studies", get_studies, NULL},
    {"GET", "/api/studies/{name}", get_study, NULL},
    {"POST", "/api/studies/{name}/run", post_run, NULL},
    {"POST", "/api/studies/{name}/stop", post_stop, NULL},
    {"GET", "/api/studies/{name}/rows", get_rows, NULL},
    {"GET", "/api/studies/{name}/compare", get_compare, NULL},
    {"POST", "/api/studies/{name}/draw", post_draw, NULL},
    {"GET", "/api/figures/{name}", get_figure, NULL},
    {"GET", "/api/machine", api_machine, NULL},
};
const lab_routes study_routes = {routes, sizeof routes / sizeof *routes};
