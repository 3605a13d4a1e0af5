/* API: the rays of the scene's beams, as `cuvette trace --beams --json` writes them, and a screen that bins their
 * power. */
#include "web/api/api.h"

#include "base/text.h"
#include "report/trace_writers.h"
#include <stdlib.h>

/* A page draws fewer; about one kilobyte each. */
enum { SEGMENTS_MAX = 20000 };

typedef struct beam_question {
    const lab *lab;
    const char *scene_name;
    beam_screen *screen; /* NULL: the rays */
    char *bytes;
    size_t size;
} beam_question;

static status write_rays(beam_question *q, const scene *s, FILE *out, diagnostic *why)
{
    const beamed b = {s, q->lab->settings.level, q->scene_name, SEGMENTS_MAX, true};
    return beams_write_json(&b, out, why);
}

static status trace_and_write(void *context, scene *s, diagnostic *why)
{
    beam_question *q = context;
    text_writer writer;
    if (q->screen)
        TRY(beam_screen_expose(s, q->lab->settings.level, q->screen, why));
    TRY(text_writer_open(&writer, why));
    const status code =
        q->screen ? beam_screen_write_json(q->screen, writer.stream, why) : write_rays(q, s, writer.stream, why);
    return text_writer_end(&writer, code, &q->bytes, &q->size, why);
}

static status answer(call *c, beam_question *q)
{
    char *file = api_document_file(c);
    q->lab = c->l;
    q->scene_name = file;
    status code = file ? semaphore_acquire(c->l->heavy, &c->why) : out_of_memory(&c->why);
    if (code == STATUS_OK) {
        code = render_worker_with_scene(c->l->render_worker, trace_and_write, q, &c->why);
        semaphore_release(c->l->heavy);
    }
    free(file);
    if (code == STATUS_OK)
        return api_send(c, "application/json", q->bytes, q->size);
    free(q->bytes);
    return code;
}

status api_beams(call *c)
{
    beam_question q = {.screen = NULL};
    return answer(c, &q);
}

#define SCREEN_FORM "give ?centre=X,Y,Z&normal=X,Y,Z&size=WIDTH,HEIGHT&bins=COLUMNS,ROWS&rays=N"

status api_beam_screen(call *c)
{
    double centre[3], normal[3], size[2], bins[2], rays = 0;
    if (!api_query_numbers(c, "centre", 3, centre, SCREEN_FORM) ||
        !api_query_numbers(c, "normal", 3, normal, SCREEN_FORM) ||
        !api_query_numbers(c, "size", 2, size, SCREEN_FORM) || !api_query_numbers(c, "bins", 2, bins, SCREEN_FORM) ||
        !api_query_numbers(c, "rays", 1, &rays, SCREEN_FORM))
        return STATUS_BAD_INPUT;
    const double most = 1e6; /* beam_screen_expose checks the ranges */
    for (int i = 0; i < 2; i++)
        if (!(bins[i] >= -most && bins[i] <= most && rays >= -most && rays <= most))
            return api_refuse(c, 400, "the number of bins or rays is out of range",
                              "give 1 to 512 bins, 1 to 100000 rays");
    beam_screen screen = {.centre = vec3_make(centre[0], centre[1], centre[2]),
                          .normal = vec3_make(normal[0], normal[1], normal[2]),
                          .width = size[0],
                          .height = size[1],
                          .columns = (int)bins[0],
                          .rows = (int)bins[1],
                          .rays_of_beam = (int)rays};
    beam_question q = {.screen = &screen};
    const status code = answer(c, &q);
    beam_screen_release(&screen);
    return code;
}
