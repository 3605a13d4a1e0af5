/* The command line of `cuvette animate`; the definition of an animation, which distinguishes its frames from those of
 * others; and whether an animation fits on its file system. */
#include "base/budget.h"
#include "base/hash.h"
#include "base/number.h"
#include "cli/animate.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/terminal.h"
#include "image/image.h"
#include "image/video.h"
#include "report/json.h"
#include "scene/assets/slime.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"
#include "study/plan/identity.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SECONDS_MAX 86400.0 /* upper limit of the parameter time_s */
enum { FRAMES_MAX = 10000000, RATE_PART_MAX = 1000000 };

static status parse_seconds(const command_option *o, void *request, const char *value, diagnostic *why)
{
    double *seconds = (double *)((char *)request + o->at);
    const bool is_time = number_parse_real(value, seconds) && *seconds >= 0 && *seconds <= SECONDS_MAX;
    char name[32];
    snprintf(name, sizeof name, "--%s", o->name);
    return is_time ? STATUS_OK : options_wrong(name, value, why, "use 0 to 86400 seconds", "invalid time");
}

static int64_t common_divisor(int64_t a, int64_t b)
{
    while (b != 0) {
        int64_t rest = a % b;
        a = b;
        b = rest;
    }
    return a;
}

static status parse_rate(const command_option *o, void *context, const char *value, diagnostic *why)
{
    animate_request *request = context;
    (void)o;
    char numerator[32];
    const size_t length = strcspn(value, "/");
    int64_t num = 0, den = 1;
    bool right = length < sizeof numerator;
    if (right) {
        snprintf(numerator, sizeof numerator, "%.*s", (int)length, value);
        right = number_parse_int(numerator, &num) && (!value[length] || number_parse_int(value + length + 1, &den));
    }
    if (!right || num < 1 || den < 1 || num > RATE_PART_MAX || den > RATE_PART_MAX)
        return options_wrong("--fps", value, why,
                             "use an integer or a fraction of integers up to 1000000, such as 25 or 30000/1001",
                             "invalid frame rate");
    const int64_t divisor = common_divisor(num, den);
    request->times.fps_num = num / divisor;
    request->times.fps_den = den / divisor;
    return STATUS_OK;
}

static const command_option options[] = {
    {"output", 'o', "PATTERN",
     "write frames, " IMAGE_ENDINGS ", numbered from 0 by one %d or %05d in the name; or one .y4m video "
     "(-: to standard output)",
     OPTION_FILLS(option_text, animate_request, output)},
    {"script", 0, "FILE", "read the hand script of all slimes from FILE",
     OPTION_FILLS(option_text, animate_request, script)},
    {"duration", 0, "S", "length in seconds (default: 2 more than the script, or 4 without a script)",
     OPTION_FILLS(parse_seconds, animate_request, times.duration_s)},
    {"fps", 0, "N", "frames per second, such as 25 (the default) or 30000/1001", .store = parse_rate},
    {"start", 0, "S", "time of the first frame, in seconds since the start of the motion (default: 0)",
     OPTION_FILLS(parse_seconds, animate_request, times.start_s)},
    OPTION_SET("'toy.stiffness=80'"),
    OPTION_MEMORY,
    {"rows", 0, "FILE", "append one row per frame to a .csv: times, counts, energies",
     OPTION_FILLS(option_text, animate_request, rows)},
    {"restart", 0, NULL, "remove the existing frames and start again",
     OPTION_FILLS(option_flag, animate_request, restart)},
    {"json", 0, NULL, "print the account as one JSON object", OPTION_FILLS(option_flag, animate_request, json)},
    {0},
};

static status check_output(const animate_request *request, diagnostic *why)
{
    if (!request->output)
        return options_wrong("animate", NULL, why,
                             "add -o frames/%05d.png for images, or -o NAME.y4m for one video file",
                             "no output is given");
    const bool to_stdout = strcmp(request->output, "-") == 0;
    if (to_stdout && request->json)
        return options_wrong("--json", "", why, "name a file with -o",
                             "standard output cannot carry both the video and the account");
    if (to_stdout && isatty(STDOUT_FILENO))
        return options_wrong("-o", "-", why, "redirect it into a file or a pipe", "a terminal cannot show a video");
    if (request->restart && animate_is_stream(request))
        return options_wrong("--restart", "", why, "remove it", "a video file is always written from the start");
    return STATUS_OK;
}

static status check_rows(const animate_request *request, diagnostic *why)
{
    static const char *const endings[] = {".csv"};
    size_t which;
    if (!request->rows)
        return STATUS_OK;
    TRY(outputs_ending("--rows", request->rows, endings, 1, "use a name that ends in .csv", &which, why));
    return outputs_check_folder("--rows", request->rows, why);
}

/* --script is relative to the working folder, whereas the parameter script is relative to the scene's folder. */
static status find_script(animate_request *request, diagnostic *why)
{
    if (!request->script)
        return STATUS_OK;
    struct stat about;
    if (stat(request->script, &about) == 0 && !S_ISREG(about.st_mode))
        return options_wrong("--script", request->script, why,
                             "use a regular file, since a script is read more than once", "not a regular file");
    request->script_path = realpath(request->script, NULL);
    if (request->script_path)
        return STATUS_OK;
    if (errno == ENOMEM)
        return out_of_memory(why);
    return options_wrong("--script", request->script, why, "check the path", "cannot open: %s", strerrordesc_np(errno));
}

static status check_request(void *context, diagnostic *why)
{
    animate_request *request = context;
    TRY(check_output(request, why));
    TRY(check_rows(request, why));
    return find_script(request, why);
}

static const scene_command animate_command = {
    .name = "animate",
    .form = {.options = options,
             .synopsis = "SCENE",
             SCENE_WORD("animate", "-o FILE for an output, "),
             .about =
                 "Render an animation of the scene file SCENE, whose slimes move.\vFrame k shows the time START + k / "
                 "FPS; there are DURATION times FPS frames, rounded, at least one. Existing frames are not rendered "
                 "again: the same command resumes an interrupted animation. For example:\n"
                 "  cuvette animate experiments/scenes/slime.yaml -o frames/%05d.png\n"
                 "  cuvette animate experiments/scenes/slime.yaml -o - | ffmpeg -i - slime.mp4"},
    .check = check_request,
};

status animate_request_parse(int argc, char **argv, animate_request *out, diagnostic *why)
{
    *out = (animate_request){.input.from_beginning = true, .times = {.duration_s = -1, .fps_num = 25, .fps_den = 1}};
    return scene_command_read(&animate_command, argc, argv, out, why);
}

void animate_request_release(animate_request *request)
{
    scene_input_release(&request->input);
    free(request->script_path);
    *request = (animate_request){0};
}

bool animate_is_stream(const animate_request *request)
{
    return strcmp(request->output, "-") == 0 || y4m_is_named(request->output);
}

status animate_check_length(const animate_request *request, diagnostic *why)
{
    const double frames = request->times.duration_s * (double)request->times.fps_num / (double)request->times.fps_den;
    if (frames <= FRAMES_MAX && request->times.start_s + request->times.duration_s <= SECONDS_MAX)
        return STATUS_OK;
    return options_wrong("animate", NULL, why, "shorten --duration: at most 10000000 frames, which end within 86400 s",
                         "the animation is too long");
}

/* --- the definition --- */

static bool is_time_of_slime(const param *row)
{
    return row->group == PARAM_MESH && strcmp(row->name, "time_s") == 0;
}

typedef struct visit_state {
    const scene *of;
    json_t *into;
} visit_state;

/* Skips parameters that change no film (but not those of the camera, which also determine how the film is shown), beams
 * without light, time_s of slimes, which the frame sets, and file names: only contents count, so that a folder may be
 * moved. */
static status add_param(void *context, const char *path, const param *row, const char *value)
{
    const visit_state *state = context;
    const bool dark_beam = row->group == PARAM_BEAM && strcmp(row->name, "lights") == 0 && strcmp(value, "off") == 0;
    if ((!scene_film_depends_on(state->of, path) && row->group != PARAM_CAMERA) || dark_beam ||
        row->type == PARAM_PATH || is_time_of_slime(row))
        return STATUS_OK;
    json_object_del(state->into, path); /* so that the last assignment is the last entry */
    return json_object_set_new(state->into, path, json_of_text(value)) == 0 ? STATUS_OK : STATUS_FAILURE;
}

static bool add_request(json_t *parameters, const animate_request *request)
{
    char fps[64], start[NUMBER_TEXT_MAX];
    snprintf(fps, sizeof fps, "%" PRId64 "/%" PRId64, request->times.fps_num, request->times.fps_den);
    return json_object_set_new(parameters, "--fps", json_string(fps)) == 0 &&
           json_object_set_new(parameters, "--start", json_string(number_format(request->times.start_s, start))) == 0;
}

static void hash_parameters(uint64_t *hash, json_t *parameters)
{
    const char *path;
    json_t *value;
    json_object_foreach(parameters, path, value)
    {
        const char *text = json_string_value(value);
        *hash = hash_bytes(*hash, path, strlen(path) + 1);
        *hash = hash_bytes(*hash, text, strlen(text) + 1);
    }
}

/* Hashes shape and material of each solid, which are not parameters. */
static void hash_solids(uint64_t *hash, const scene *s)
{
    for (size_t i = 0; i < s->solid_count; i++) {
        const int64_t words[] = {s->solids[i].shape.kind, s->solids[i].material_index};
        *hash = hash_words(*hash, words, 2);
    }
}

status animate_define(const animate_request *request, const scene *s, animate_definition *out, diagnostic *why)
{
    *out = (animate_definition){.parameters = json_object(), .hash = HASH_START};
    visit_state state = {s, out->parameters};
    if (!out->parameters || !add_request(out->parameters, request) ||
        scene_each_param(s, add_param, &state) != STATUS_OK)
        return out_of_memory(why);
    hash_parameters(&out->hash, out->parameters);
    hash_solids(&out->hash, s);
    TRY(identity_hash_files(&out->hash, s, why));
    out->hash = hash_finish(out->hash);
    return STATUS_OK;
}

void animate_definition_release(animate_definition *d)
{
    json_decref(d->parameters);
    *d = (animate_definition){0};
}

/* --- room on the file system --- */

/* Counts the frames that do not exist yet; frames that --restart removes make room for new ones. */
static double count_missing(const animate_names *names, int64_t count)
{
    double missing = 0;
    for (int64_t k = 0; k < count; k++) {
        char *path = animate_name(names, k);
        missing += path && access(path, F_OK) != 0;
        free(path);
    }
    return missing;
}

static void add_stream(double width, double height, double frames, disk_room *to)
{
    const double chroma = ceil(width / 2) * ceil(height / 2), frame = width * height + 2 * chroma + 6; /* 4:2:0 */
    disk_room_add(to, 1, frames * frame, frames * frame + 100);
}

static bool is_device(const char *path)
{
    struct stat about;
    return strcmp(path, "-") == 0 || (stat(path, &about) == 0 && !S_ISREG(about.st_mode));
}

status animate_check_room(const animate_request *request, const animate_names *names, const scene *s, diagnostic *why)
{
    enum { ROW_MOST = 600 };
    disk_room needed = {0};
    char note[DISK_ROOM_TEXT_MAX];
    const int64_t count = frame_times_count(&request->times);
    const double width = (double)s->render.width, height = (double)s->render.height;
    if (!names && is_device(request->output))
        return STATUS_OK;
    if (names)
        image_room(image_format_of(request->output), width, height, count_missing(names, count), &needed);
    else
        add_stream(width, height, (double)count, &needed);
    if (request->rows)
        disk_room_add(&needed, 1, 0, ROW_MOST * (double)count);
    const char *place = names ? names->folder : request->output;
    TRY(disk_room_check(&needed, disk_room_free(place), place, "the animation", note, why));
    if (note[0] && !request->json)
        terminal_note(note);
    return STATUS_OK;
}
