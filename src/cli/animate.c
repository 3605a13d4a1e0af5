/* `cuvette animate`: reads scene and scripts, renders the animation, prints its account. */
#include "cli/animate.h"
#include "cli/cli.h"
#include "cli/inert_notes.h"
#include "report/json.h"
#include "cli/outputs.h"
#include "report/report.h"
#include "scene/model/params.h"
#include "scene/assets/slime.h"
#include "base/text.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Sets the parameter script of every slime to --script. */
static status set_scripts(const animate_request *request, scene *s, diagnostic *why)
{
    status result = STATUS_OK;
    for (size_t i = 0; i < s->mesh_count && result == STATUS_OK && request->script_path; i++) {
        if (s->meshes[i].source != MESH_SLIME)
            continue;
        char *path = text_format("%s.script", s->meshes[i].name);
        result = path ? scene_set(s, path, request->script_path, why) : out_of_memory(why);
        if (result != STATUS_OK)
            diagnostic_locate(why, "--script", 0, 0);
        free(path);
    }
    return result;
}

static status choose_duration(animate_request *request, const scene *s, diagnostic *why)
{
    TRY(frame_times_choose(&request->times, s, why));
    TRY(animate_check_length(request, why));
    diagnostic_locate(why, request->input.path, 0, 0);
    return frame_times_check_end(&request->times, s, why);
}

static status read_scene(animate_request *request, const animate_names *names, scene **out, diagnostic *why)
{
    TRY(scene_input_read(&request->input, out, why));
    if (!scene_moves(*out))
        return diagnose_at(why, request->input.path, STATUS_BAD_INPUT,
                           "add a mesh with 'generate: slime', or use 'cuvette render'",
                           "nothing moves in this scene: it has no slime");
    TRY(set_scripts(request, *out, why));
    if (request->rows)
        TRY(outputs_check_place("--rows", request->rows, *out, why));
    if (animate_is_stream(request))
        TRY(outputs_check_place("-o", request->output, *out, why));
    if (names)
        TRY(animate_names_check(names, *out, why));
    return choose_duration(request, *out, why);
}

static void print_summary(const animate_request *request, const scene *s, const animate_account *a)
{
    printf("%" PRId64 " frames of %lldx%lld pixels, %.6g per second -> %s: %" PRId64 " rendered", a->rendered + a->kept,
           (long long)s->render.width, (long long)s->render.height,
           (double)request->times.fps_num / (double)request->times.fps_den, request->output, a->rendered);
    if (a->rendered)
        printf(" in %.4f s each", a->wall_s / (double)a->rendered);
    printf(", %" PRId64 " kept; %.3g s of motion simulated", a->kept, a->simulated_s);
    if (a->step_s > 0)
        printf(" at %.3g s per second", a->simulated_s / a->step_s);
    putchar('\n');
}

static status print_account(const animate_request *request, const scene *s, const animate_definition *d, isa level,
                            const animate_account *a, diagnostic *why)
{
    char hash[32];
    snprintf(hash, sizeof hash, "%016" PRIx64, d->hash);
    json_t *o = json_pack(
        "{s:i,s:s,s:s,s:s,s:o,s:I,s:I,s:I,s:[I,I],s:o,s:o,s:I,s:o,s:o,s:o,s:o,s:o}", "schema", REPORT_SCHEMA, "version",
        CUVETTE_VERSION, "isa", isa_name(level), "definition", hash, "output", json_of_text(request->output), "frames",
        (json_int_t)(a->rendered + a->kept), "rendered", (json_int_t)a->rendered, "kept", (json_int_t)a->kept, "fps",
        (json_int_t)request->times.fps_num, (json_int_t)request->times.fps_den, "start_s",
        json_of_real(request->times.start_s), "simulated_s", json_of_real(a->simulated_s), "steps",
        (json_int_t)a->steps, "step_s", json_of_real(a->step_s), "skin_s", json_of_real(a->skin_s), "wall_s",
        json_of_real(a->wall_s), "wall_s_mean",
        json_of_real(a->rendered ? a->wall_s / (double)a->rendered : (double)NAN), "params", report_params(s));
    return o ? json_print(o, why) : out_of_memory(why);
}

static status make(const animate_request *request, const animate_names *names, job *with, scene *s, diagnostic *why)
{
    scene_motion *motion = NULL;
    animate_definition d = {0};
    animate_account account = {0};
    status result = scene_motion_create(s, &motion, why);
    THEN(result, animate_define(request, s, &d, why));
    if (result == STATUS_OK && names)
        result = animate_index_check(names, &d, frame_times_count(&request->times), request->restart, why);
    THEN(result, animate_check_room(request, names, s, why));
    THEN(result, animate_film(request, names, &d, with, s, motion, &account, why));
    if (result == STATUS_OK && request->json)
        result = print_account(request, s, &d, job_isa(with), &account, why);
    else if (result == STATUS_OK && strcmp(request->output, "-") != 0)
        print_summary(request, s, &account);
    animate_definition_release(&d);
    scene_motion_destroy(motion);
    return result;
}

status command_animate(int argc, char **argv, diagnostic *why)
{
    animate_request request;
    animate_names names = {0};
    scene *s = NULL;
    job *with = NULL;
    status result = animate_request_parse(argc, argv, &request, why);
    const bool in_files = result == STATUS_OK && !animate_is_stream(&request);
    if (in_files)
        result = animate_names_parse(request.output, &names, why);
    THEN(result, scene_input_job(false, &with, why));
    THEN(result, read_scene(&request, in_files ? &names : NULL, &s, why));
    if (result == STATUS_OK && !request.json)
        result = scene_input_lint(s, job_isa(with), why);
    if (result == STATUS_OK && !request.json)
        inert_note_changes(s, &request.input);
    THEN(result, make(&request, in_files ? &names : NULL, with, s, why));
    job_destroy(with);
    scene_destroy(s);
    animate_names_release(&names);
    animate_request_release(&request);
    return result;
}
