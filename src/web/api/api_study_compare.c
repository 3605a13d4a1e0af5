/* API: two sides of a study compared as by `cuvette study compare`: runs, cells, or values of an axis. */
#include "base/text.h"
#include "study/summary/contrast.h"
#include "web/api/api.h"
#include "web/api/study_json.h"
#include "web/session/study_files.h"
#include <stdlib.h>
#include <string.h>

/* The results folder of that name, which holds rows of the study. */
static status take_run(call *c, const char *run, const study *s, char **results)
{
    char *rows = text_format("%s/%s/rows.csv", run, s->name);
    status code = rows ? folder_path(c->l->files, rows, true, results, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        (*results)[strlen(*results) - strlen(rows) + strlen(run)] = 0;
        code = study_check_results(c->l, *results, s->name, &c->why);
    }
    free(rows);
    return code;
}

/* A side of the laboratory's results: a folder, which side_read would take anywhere, is not among its items. */
static status take_side(call *c, const study *s, const char *key, study_side *side)
{
    const char *results = c->l->settings.results, *text = http_query_value(c->request, key);
    TRY(side_read(s, text, results, side, &c->why));
    if (side->results == results)
        return STATUS_OK;
    return api_refuse(c, 400, "a side names a results folder", "use ?with=FOLDER to compare with a folder");
}

static status compare(call *c, const study *s, const study_side *a, const study_side *b)
{
    contrast *made = NULL;
    TRY(contrast_make(s, a, b, &(contrast_options){.column = NULL}, &made, NULL, &c->why));
    json_t *json = contrast_json(s, made, STUDY_JSON_CELLS_MAX);
    contrast_destroy(made);
    return json ? api_reply_json(c, json) : out_of_memory(&c->why);
}

static status compare_runs(call *c, const study *s, const char *with)
{
    char *other = NULL;
    TRY(take_run(c, with, s, &other));
    const study_side a = side_of_folder(c->l->settings.results), b = side_of_folder(other);
    const status code = compare(c, s, &a, &b);
    free(other);
    return code;
}

static status compare_sides(call *c, const study *s)
{
    study_side a = {.text = NULL}, b = {.text = NULL};
    status code = take_side(c, s, "a", &a);
    THEN(code, take_side(c, s, "b", &b));
    THEN(code, compare(c, s, &a, &b));
    side_release(&a);
    side_release(&b);
    return code;
}

status api_study_compare(call *c)
{
    const char *with = http_query_value(c->request, "with");
    const bool sides = http_query_value(c->request, "a") && http_query_value(c->request, "b");
    study *s;
    if (!sides && (!with || !with[0]))
        return api_refuse(c, 400, "it is not said what to compare",
                          "add ?with=FOLDER, one of the study's runs, or ?a=SIDE&b=SIDE, such as a=cell=0&b=cell=1");
    TRY(api_take_study(c, &s));
    const status code = sides ? compare_sides(c, s) : compare_runs(c, s, with);
    study_destroy(s);
    return code;
}
