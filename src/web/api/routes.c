/* The table of all routes of the API, and the handling of one call. */
#include "report/json.h"
#include "web/api/api.h"

#include <stdlib.h>

typedef enum body_kind { NO_BODY, ANY_BODY, OBJECT, EMPTY } body_kind;

static const struct api_route {
    const char *method, *pattern;
    api_handler *handle;
    body_kind body;
} routes[] = {
    {"GET", "/api/state", api_state, NO_BODY},
    {"GET", "/api/scene", api_scene, NO_BODY},
    {"GET", "/api/params", api_find, NO_BODY},
    {"POST", "/api/set", api_set, ANY_BODY},
    {"POST", "/api/reset", api_reset, ANY_BODY},
    {"POST", "/api/undo", api_undo, NO_BODY},
    {"POST", "/api/redo", api_redo, NO_BODY},
    {"POST", "/api/camera", api_camera, ANY_BODY},
    {"POST", "/api/view", api_view, ANY_BODY},
    {"GET", "/api/scene.yaml", api_scene_file, NO_BODY},
    {"GET", "/api/command", api_command, NO_BODY},
    {"GET", "/api/link", api_link, NO_BODY},
    {"GET", "/api/page.html", api_page, NO_BODY},
    {"GET", "/api/image.png", api_image_png, NO_BODY},
    {"GET", "/api/image.jpg", api_image_jpeg, NO_BODY},
    {"GET", "/api/display.png", api_display, NO_BODY},
    {"GET", "/api/trace", api_trace_json, NO_BODY},
    {"GET", "/api/trace.txt", api_trace_text, NO_BODY},
    {"GET", "/api/trace.svg", api_trace_drawing, NO_BODY},
    {"GET", "/api/beams", api_beams, NO_BODY},
    {"GET", "/api/beams/screen", api_beam_screen, NO_BODY},
    {"GET", "/api/fan", api_fan, NO_BODY},
    {"GET", "/api/fan.csv", api_fan_csv, NO_BODY},
    {"GET", "/api/fan.svg", api_fan_drawing, NO_BODY},
    {"GET", "/api/section", api_section, NO_BODY},
    {"GET", "/api/section.svg", api_section_drawing, NO_BODY},
    {"GET", "/api/realism", api_realism, NO_BODY},
    {"GET", "/api/realism.csv", api_realism_csv, NO_BODY},
    {"GET", "/api/realism/{curve}", api_realism_curve, NO_BODY},
    {"GET", "/api/realism/{curve}/points.csv", api_realism_curve_csv, NO_BODY},
    {"GET", "/api/lens", api_lens, NO_BODY},
    {"GET", "/api/lens.csv", api_lens_csv, NO_BODY},
    {"POST", "/api/reference", api_set_reference, NO_BODY},
    {"DELETE", "/api/reference", api_clear_reference, NO_BODY},
    {"GET", "/api/reference.png", api_reference_image, NO_BODY},
    {"GET", "/api/compare", api_compare, NO_BODY},
    {"GET", "/api/compare.png", api_compare_map, NO_BODY},
    {"GET", "/api/maps", api_maps, NO_BODY},
    {"GET", "/api/maps/rays.png", api_map_of_rays, NO_BODY},
    {"GET", "/api/maps/time.png", api_map_of_time, NO_BODY},
    {"GET", "/api/maps/cut.png", api_map_of_cut, NO_BODY},
    {"POST", "/api/objects", api_add, ANY_BODY},
    {"DELETE", "/api/objects/{name}", api_remove, NO_BODY},
    {"POST", "/api/objects/{name}/move", api_move, ANY_BODY},
    {"POST", "/api/objects/{name}/turn", api_turn, ANY_BODY},
    {"POST", "/api/objects/{name}/scale", api_scale, ANY_BODY},
    {"POST", "/api/objects/{name}/rename", api_rename, ANY_BODY},
    {"POST", "/api/objects/{name}/material", api_material, ANY_BODY},
    {"POST", "/api/objects/{name}/copy", api_copy, NO_BODY},
    {"GET", "/api/objects/{name}/contents", api_contents, NO_BODY},
    {"GET", "/api/files", api_files, NO_BODY},
    {"POST", "/api/open", api_open, ANY_BODY},
    {"POST", "/api/save", api_save, ANY_BODY},
    {"POST", "/api/rescue", api_rescue, OBJECT},
    {"GET", "/api/media", api_media, NO_BODY},
    {"POST", "/api/slime", api_slime, OBJECT},
    {"POST", "/api/slime/grab", api_grab, OBJECT},
    {"POST", "/api/slime/move", api_move_hand, OBJECT},
    {"POST", "/api/slime/release", api_release, OBJECT},
    {"GET", "/api/motion", api_motion, NO_BODY},
    {"POST", "/api/motion/stop", api_motion_stop, EMPTY},
    {"GET", "/api/studies", api_studies, NO_BODY},
    {"POST", "/api/studies", api_study_new, OBJECT},
    {"GET", "/api/studies/{name}", api_study, NO_BODY},
    {"POST", "/api/studies/{name}/run", api_study_run, EMPTY},
    {"POST", "/api/studies/{name}/stop", api_study_stop, EMPTY},
    {"GET", "/api/studies/{name}/rows", api_study_rows, NO_BODY},
    {"GET", "/api/studies/{name}/rows.csv", api_study_rows_csv, NO_BODY},
    {"GET", "/api/studies/{name}/summary.tsv", api_study_summary_tsv, NO_BODY},
    {"GET", "/api/studies/{name}/compare", api_study_compare, NO_BODY},
    {"POST", "/api/studies/{name}/draw", api_study_draw, EMPTY},
    {"GET", "/api/studies/{name}/figure", api_study_figure, NO_BODY},
    {"GET", "/api/figures/{name}", api_figure, NO_BODY},
    {"GET", "/api/machine", api_machine, NO_BODY},
    {"GET", "/api/notes", api_notes, NO_BODY},
    {"GET", "/api/lessons", api_lessons, NO_BODY},
    {"POST", "/api/lessons/{name}/open", api_lesson_open, EMPTY},
    {"GET", "/api/lessons/{name}/measure", api_lesson_measure, NO_BODY},
    {"GET", "/api/lessons/{name}/thumbnail.jpg", api_lesson_thumbnail, NO_BODY},
    {"GET", "/api/thumbnail.jpg", api_thumbnail, NO_BODY},
};
enum { ROUTES = sizeof routes / sizeof *routes };

struct api_bound {
    lab *l;
    const struct api_route *route;
};

/* Reads the body; returns false, with the reply set, after an error. */
static bool read_body(call *c, body_kind kind)
{
    if (kind == NO_BODY)
        return true;
    c->body = http_body_json(c->request, c->reply);
    if (c->body && kind == OBJECT && !json_is_object(c->body))
        http_reply_error(c->reply, 400, "the body is not a JSON object", "send a JSON object");
    else if (c->body && kind == EMPTY && (!json_is_object(c->body) || json_object_size(c->body) > 0))
        http_reply_error(c->reply, 400, "the body must be an empty object", "send {}");
    else
        return c->body;
    return false;
}

static void answer(void *context, const http_request *request, http_reply *reply)
{
    const struct api_bound *bound = context;
    call c = {.l = bound->l, .request = request, .reply = reply};
    if (read_body(&c, bound->route->body)) {
        const status code = bound->route->handle(&c);
        if (code == STATUS_OK && !c.sent)
            http_reply_json(reply, 200, json_incref(c.json));
        else if (code != STATUS_OK && code != STATUS_FAILURE && c.refused)
            http_reply_json(reply, c.refused, json_of_diagnostic(&c.why));
        else if (code != STATUS_OK)
            http_reply_diagnostic(reply, code, &c.why);
    }
    json_decref(c.json);
    json_decref(c.body);
}

status api_bind(lab *l, size_t *count, diagnostic *why)
{
    *count = ROUTES + 1;
    l->routes = calloc(ROUTES + 1, sizeof *l->routes);
    l->bound = calloc(ROUTES, sizeof *l->bound);
    if (!l->routes || !l->bound)
        return out_of_memory(why);
    for (size_t i = 0; i < ROUTES; i++) {
        l->bound[i] = (struct api_bound){l, &routes[i]};
        l->routes[i] = (http_route){routes[i].method, routes[i].pattern, answer, &l->bound[i]};
    }
    l->routes[ROUTES] = (http_route){"GET", "/api/events", http_events, NULL};
    return STATUS_OK;
}
