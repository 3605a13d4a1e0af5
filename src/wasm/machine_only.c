/* The parts of the laboratory that need a machine: studies, rescued scenes, confinement. In a browser their
 * routes return an error that names the command of the program. */
#include "web/api/api.h"
#include "web/session/session.h"
#include "web/session/studies.h"

#include <errno.h>

enum { NOT_HERE = 501 };

static status refuse(call *c, const char *what, const char *remedy)
{
    return api_refuse(c, NOT_HERE, what, remedy);
}

static status no_study(call *c)
{
    return refuse(c, "studies measure times, and times measured in a browser are not comparable",
                  "save the scene, and run: cuvette study run FILE.study");
}

#define STUDY_ROUTE(name)   \
    status name(call *c)    \
    {                       \
        return no_study(c); \
    }
STUDY_ROUTE(api_studies)
STUDY_ROUTE(api_study)
STUDY_ROUTE(api_study_run)
STUDY_ROUTE(api_study_stop)
STUDY_ROUTE(api_study_rows)
STUDY_ROUTE(api_study_rows_csv)
STUDY_ROUTE(api_study_summary_tsv)
STUDY_ROUTE(api_study_compare)
STUDY_ROUTE(api_study_draw)
STUDY_ROUTE(api_study_figure)
STUDY_ROUTE(api_study_new)
STUDY_ROUTE(api_figure)

status api_machine(call *c)
{
    return refuse(c, "a browser does not describe the machine that it runs on", "run: cuvette machine");
}

/* --- functions that the rest of the laboratory calls --- */

status studies_create(lab *l, void (*ended)(lab *l), studies **out, diagnostic *why)
{
    (void)ended;
    (void)l, (void)why;
    *out = NULL;
    return STATUS_OK;
}

void studies_end(studies *st)
{
    (void)st;
}

void studies_destroy(studies *st)
{
    (void)st;
}

bool studies_runs(studies *st, const char *name)
{
    (void)st, (void)name;
    return false;
}

bool studies_ending(void *st)
{
    (void)st;
    return false;
}

json_t *studies_json(studies *st)
{
    (void)st;
    return json_null();
}

/* The page keeps unsaved scenes in the browser. */
status rescue_create(lab *l, rescue **out, diagnostic *why)
{
    (void)l, (void)why;
    *out = NULL;
    return STATUS_OK;
}

void rescue_destroy(rescue *r, bool leave)
{
    (void)r, (void)leave;
}

void rescue_wake(rescue *r)
{
    (void)r;
}

static status nothing_rescued(diagnostic *why)
{
    return diagnose(why, STATUS_BAD_INPUT, "open a scene", "no scene was rescued");
}

status rescue_open(rescue *r, const char *id, uint64_t *generation, diagnostic *why)
{
    (void)r, (void)id, (void)generation;
    return nothing_rescued(why);
}

status rescue_discard(rescue *r, const char *id, diagnostic *why)
{
    (void)r, (void)id;
    return nothing_rescued(why);
}

bool rescue_json(rescue *r, json_t *state)
{
    (void)r;
    return json_object_set_new(state, "rescued", json_array()) == 0 &&
           json_object_set_new(state, "unkept", json_null()) == 0;
}

status lab_confine(lab *l, diagnostic *why)
{
    (void)l, (void)why;
    return STATUS_OK;
}

void lab_remove_temporary(lab *l)
{
    (void)l;
}
