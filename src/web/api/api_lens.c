/* API: the report on the lens of the scene, as `cuvette lens report` writes it, and scenes of lens files. The report
 * works on a copy of the scene, so that the image is rendered meanwhile. */
#include "base/text.h"
#include "lens/lens.h"
#include "report/param_rows.h"
#include "report/report.h"
#include "scene/lens/lens_prescription.h"
#include "scene/model/scene.h"
#include "web/api/api.h"

#include <stdlib.h>
#include <string.h>

/* Reads a list such as ?field=0,10,20, which may be empty. */
static bool read_list(call *c, const char *key, double *list, size_t *count, const char *remedy)
{
    const char *text = http_query_value(c->request, key);
    *count = text && *text ? 1 : 0;
    for (const char *at = text; *count && *at; at++)
        *count += *at == ',';
    if (*count > LENS_LIST_MAX) {
        api_refuse(c, 400, "a list is too long", "give at most 24 numbers");
        return false;
    }
    return *count == 0 || api_query_numbers(c, key, (int)*count, list, remedy);
}

static bool read_light(call *c, lens_light *with)
{
    return read_list(c, "field", with->field, &with->fields, "give ?field=0,10,20: degrees, or heights in mm") &&
           read_list(c, "wavelength", with->lambda_nm, &with->wavelengths, "give ?wavelength=588,486,656 in nm");
}

/* *title: of the scene, or the name of its file, newly allocated; NULL after an error or if memory runs out. */
static status make_report(call *c, lens_report *out, char **title)
{
    lens_light with;
    const char *system = http_query_value(c->request, "system");
    *out = (lens_report){0};
    *title = NULL;
    if (!read_light(c, &with))
        return STATUS_BAD_INPUT;
    TRY(semaphore_acquire(c->l->heavy, &c->why));
    scene *s = scene_document_copy(c->l->scene_document, NULL);
    status code = s ? scene_load(s, &c->why) : out_of_memory(&c->why);
    THEN(code, lens_report_of_scene(s, system && *system ? system : NULL, &with, c->l->settings.level,
                                    &lens_options_usual, out, &c->why));
    if (code == STATUS_OK)
        *title = s->title && s->title[0] ? strdup(s->title) : api_document_file(c);
    scene_destroy(s);
    semaphore_release(c->l->heavy);
    return code;
}

status api_lens(call *c)
{
    lens_report report;
    char *title;
    TRY(make_report(c, &report, &title));
    const status code = title ? api_reply_json(c, lens_json(&report, title)) : out_of_memory(&c->why);
    free(title);
    lens_report_release(&report);
    return code;
}

status api_lens_csv(call *c)
{
    lens_report report;
    text_writer writer;
    char *bytes = NULL, *title;
    size_t size = 0;
    TRY(make_report(c, &report, &title));
    free(title);
    status code = text_writer_open(&writer, &c->why);
    if (code == STATUS_OK) {
        lens_write_csv(&report, writer.stream);
        code = text_writer_end(&writer, STATUS_OK, &bytes, &size, &c->why);
    }
    lens_report_release(&report);
    return code == STATUS_OK ? api_send(c, "text/csv", bytes, size) : code;
}

/* --- scenes of lens files --- */

status api_lens_file(const char *name, const char *text, const char *root, scene **out, char note[LENS_NOTE_MAX],
                     diagnostic *why)
{
    const lens_glasses glasses = {.root = root};
    lens_prescription p = lens_prescription_empty();
    status code =
        text ? lens_file_parse(name, text, strlen(text), &glasses, &p, why) : lens_file_read(name, &glasses, &p, why);
    THEN(code, locate_failure(why, name, lens_scene_create(&p, &glasses, out, why)));
    memcpy(note, p.note, LENS_NOTE_MAX);
    lens_prescription_release(&p);
    return code;
}
