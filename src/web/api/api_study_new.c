/* API: a new study of the current scene, from axes and repetitions: its text, its estimated time, its file. */
#include "base/cancel.h"
#include "base/file.h"
#include "base/json_build.h"
#include "base/text.h"
#include "report/json.h"
#include "report/report.h"
#include "study/plan/new_study.h"
#include "study/run/estimate.h"
#include "web/api/api.h"
#include "web/session/studies.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { AXES_READ_MAX = 64 }; /* above STUDY_AXES_MAX, so that a longer list is read and refused */

typedef struct form {
    const char *file;
    bool save, replace;
    double repetitions, warmups;
    const char *axes[AXES_READ_MAX];
    size_t axis_count;
    char *scene, *target; /* paths */
    json_t *settings;     /* PATH=VALUE: the differences of the current scene from its file */
} form;

static status read_axes(call *c, form *f)
{
    const json_t *list = json_object_get(c->body, "axes");
    f->axis_count = json_array_size(list);
    for (size_t i = 0; i < f->axis_count && i < AXES_READ_MAX; i++)
        if (!(f->axes[i] = json_string_value(json_array_get(list, i))))
            return api_refuse(c, 400, "an axis is not a string", "write \"PATH=1,2,3\" or \"PATH=FROM..TO:STEPS\"");
    if (!f->axis_count || f->axis_count > STUDY_AXES_MAX)
        return api_refuse(c, 400, "the number of axes is out of range",
                          "give 1 to 16 axes in 'axes', a list of \"PATH=1,2,3\"");
    return STATUS_OK;
}

static bool is_study_name(const char *name)
{
    const size_t length = strlen(name);
    return length > 6 && strcmp(name + length - 6, ".study") == 0 && name[0] != '.' && !strstr(name, "/.");
}

static status read_frames(call *c, const char *key, double least, double most, const char *range, double *value)
{
    if (!api_read_number(c, key, false, value))
        return STATUS_BAD_INPUT;
    if (!(*value >= least && *value <= most) || *value != (double)(long)*value)
        return diagnose_at(&c->why, key, STATUS_BAD_INPUT, range, "invalid number of %s", key);
    return STATUS_OK;
}

static status read_form(call *c, form *f)
{
    f->repetitions = 6;
    f->warmups = 1;
    if (!api_read_text(c, "file", true, &f->file) || !api_read_flag(c, "save", &f->save) ||
        !api_read_flag(c, "replace", &f->replace))
        return STATUS_BAD_INPUT;
    TRY(read_frames(c, "repetitions", 1, STUDY_REPETITIONS_MAX, "give an integer from 1 to 100000", &f->repetitions));
    TRY(read_frames(c, "warmups", 0, STUDY_WARMUPS_MAX, "give an integer from 0 to 1000", &f->warmups));
    if (!is_study_name(f->file))
        return diagnose_at(&c->why, "file", STATUS_BAD_INPUT, "use a name such as depth.study",
                           "'%.200s' is not a valid study name", f->file);
    return read_axes(c, f);
}

/* The file of the scene, and the settings that differ from it. */
static status find_scene(call *c, form *f)
{
    lab *l = c->l;
    bool complete = false;
    char *file = api_document_file(c);
    scene *s = scene_document_copy(l->scene_document, NULL);
    if (s)
        lab_clear_default_threads(l, s);
    status code = file && s ? STATUS_OK : out_of_memory(&c->why);
    THEN(code, command_settings(l->files, file[0] ? file : NULL, s, 0, &f->scene, &f->settings, &complete, &c->why));
    if (code == STATUS_OK && !complete)
        code = api_refuse(c, 409,
                          f->scene ? "objects of the scene differ from those of its file" : "the scene has no file",
                          "save the scene first");
    scene_destroy(s);
    free(file);
    return code;
}

/* Whether an axis varies the parameter; if so, it is not set for all cells. */
static bool is_varied(const form *f, const char *setting)
{
    const size_t length = strcspn(setting, "=") + 1;
    for (size_t i = 0; i < f->axis_count; i++)
        if (strncmp(f->axes[i], setting, length) == 0)
            return true;
    return false;
}

static status compose(call *c, form *f, char **text, study **planned)
{
    scene *s = NULL;
    const size_t most = json_array_size(f->settings);
    const char **sets = calloc(most + 1, sizeof *sets);
    const study_guard guard = study_guard_of(c->l);
    new_study_order order = {.scene = f->scene,
                             .target = f->target,
                             .axes = f->axes,
                             .axis_count = f->axis_count,
                             .repetitions = (int64_t)f->repetitions,
                             .warmups = (int64_t)f->warmups,
                             .guard = &guard};
    status code = sets ? STATUS_OK : out_of_memory(&c->why);
    for (size_t i = 0; sets && i < most; i++) {
        const char *setting = json_string_value(json_array_get(f->settings, i));
        if (!is_varied(f, setting))
            sets[order.set_count++] = setting;
    }
    order.sets = sets;
    THEN(code, scene_read_below(f->scene, folder_real(c->l->files), &s, &c->why));
    THEN(code, new_study_compose(&order, s, text, planned, &c->why));
    scene_destroy(s);
    free(sets);
    return code;
}

/* The ask of a cancel token: whether the laboratory ends, or a study began to measure. */
static bool is_cancelled(void *context)
{
    const lab *l = context;
    return studies_ending(l->studies) || studies_runs(l->studies, NULL);
}

static json_t *notes_json(const study *s)
{
    json_t *notes = json_array();
    for (size_t i = 0; i < s->note_count; i++)
        json_add(&notes, report_note(s->notes[i].note.place, s->notes[i].note.text, s->notes[i].note.remedy));
    return notes;
}

static status estimate(call *c, const study *s, const char *text)
{
    const study_options options = {.results = c->l->settings.results};
    study_estimate e;
    text_writer writer;
    char *said = NULL;
    TRY(study_check_results(c->l, options.results, s->name, &c->why));
    cancel_token token = {.ask = is_cancelled, .context = c->l};
    cancel_begin(&token);
    const status code = study_estimate_run(s, &options, &e, &c->why);
    cancel_end(&token);
    if (code != STATUS_OK)
        return code;
    TRY(text_writer_open(&writer, &c->why));
    study_estimate_write(writer.stream, s, options.results, &e);
    TRY(text_writer_close(&writer, &said, NULL, &c->why));
    api_reply_json(c, json_pack("{s:o, s:o, s:I, s:I, s:o, s:o, s:o, s:o}", "name", json_of_text(s->name), "text",
                                json_of_text(text), "cells", (json_int_t)e.cells, "rows", (json_int_t)e.rows_most,
                                "least_s", json_of_real(e.least_s), "most_s", json_of_real(e.most_s), "said",
                                json_of_text(said), "notes", notes_json(s)));
    free(said);
    return STATUS_OK;
}

static status check_names(call *c, const form *f, const study *s)
{
    char *other = NULL;
    TRY(study_find(c->l, s->name, &other, &c->why));
    const bool taken = other && strcmp(other, f->file) != 0;
    free(other);
    c->refused = 409;
    if (taken)
        return diagnose_at(&c->why, "file", STATUS_BAD_INPUT, "choose another name", "another study has that name");
    if (!f->replace && access(f->target, F_OK) == 0)
        return diagnose_at(&c->why, "file", STATUS_BAD_INPUT, "choose another name, or set 'replace'",
                           "the file already exists");
    c->refused = 0;
    return STATUS_OK;
}

static status answer(call *c, form *f)
{
    char *text = NULL;
    study *planned = NULL;
    status code = compose(c, f, &text, &planned);
    if (code == STATUS_OK && !f->save)
        code = estimate(c, planned, text);
    else if (code == STATUS_OK && (code = check_names(c, f, planned)) == STATUS_OK &&
             (code = file_write(f->target, text, &c->why)) == STATUS_OK)
        api_reply_json(c, json_pack("{s:o, s:s, s:I}", "name", json_of_text(planned->name), "file", f->file, "cells",
                                    (json_int_t)study_cell_count(planned)));
    study_destroy(planned);
    free(text);
    return code;
}

status api_study_new(call *c)
{
    form f = {.file = NULL};
    if (studies_runs(c->l->studies, NULL))
        return api_refuse(c, 409, "a study is measuring, and the trial frames would disturb it",
                          "wait until the study ends, or stop it");
    status code = read_form(c, &f);
    THEN(code, folder_path(c->l->files, f.file, false, &f.target, &c->why));
    THEN(code, find_scene(c, &f));
    if (code == STATUS_OK && (code = semaphore_acquire(c->l->heavy, &c->why)) == STATUS_OK) {
        code = answer(c, &f);
        semaphore_release(c->l->heavy);
    }
    json_decref(f.settings);
    free(f.scene);
    free(f.target);
    return code;
}
