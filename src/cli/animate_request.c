#include "cli/animate.h"
#include "base/number.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "scene/model/params.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { KEY_SCRIPT = 0x100, KEY_DURATION, KEY_FPS, KEY_START, KEY_ROWS, KEY_RESTART, KEY_JSON };

#define SECONDS_MAX 86400.0 /* of the parameter time_s */
enum { FRAMES_MAX = 10000000, RATE_PART_MAX = 1000000 };

static const struct argp_option options[] = {
    {"output", 'o', "PATTERN", 0,
     "frames as pictures, numbered from 0 by one %d or %05d in the name: .png, .jpg or .pfm; or one film, .y4m (- for "
     "standard output)",
     0},
    {"script", KEY_SCRIPT, "FILE", 0, "what hands do with the slimes, for all of them", 0},
    {"duration", KEY_DURATION, "S", 0, "seconds; when not said 2 more than the script has, or 4 without one", 0},
    {"fps", KEY_FPS, "N", 0, "frames a second, as 25 (the default) or 30000/1001", 0},
    {"start", KEY_START, "S", 0, "the first frame's time, in seconds after the motion's beginning; 0 when not said", 0},
    {"set", 's', "PATH=VALUE", 0, "set a parameter, as 'toy.stiffness=80'; may be given many times", 0},
    {"rows", KEY_ROWS, "FILE", 0, "append a row a frame, once, to a .csv: times, counts, energies", 0},
    {"restart", KEY_RESTART, NULL, 0, "remove the frames of the film that is there, and begin anew", 0},
    {"json", KEY_JSON, NULL, 0, "print the account as one JSON object", 0},
    {0},
};

static status wrong(const char *option, const char *value, const char *remedy, const char *what, diagnostic *why)
{
    char where[512];
    snprintf(where, sizeof where, "%s %s", option, value);
    diagnose(why, STATUS_BAD_INPUT, remedy, "%s", what);
    diagnostic_locate(why, where, 0, 0);
    return STATUS_BAD_INPUT;
}

static status take_seconds(const char *option, const char *value, double *out, diagnostic *why)
{
    if (!number_parse_real(value, out) || *out < 0 || *out > SECONDS_MAX)
        return wrong(option, value, "give seconds, from 0 to 86400", "is no such time", why);
    return STATUS_OK;
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

static status take_rate(const char *value, animate_request *request, diagnostic *why)
{
    char whole[32];
    const size_t length = strcspn(value, "/");
    int64_t num = 0, den = 1;
    bool right = length < sizeof whole;
    if (right) {
        snprintf(whole, sizeof whole, "%.*s", (int)length, value);
        right = number_parse_int(whole, &num) && (!value[length] || number_parse_int(value + length + 1, &den));
    }
    if (!right || num < 1 || den < 1 || num > RATE_PART_MAX || den > RATE_PART_MAX)
        return wrong("--fps", value, "give an integer or a fraction of integers up to 1000000, as 25 or 30000/1001",
                     "is no rate of frames", why);
    const int64_t divisor = common_divisor(num, den);
    request->fps_num = num / divisor;
    request->fps_den = den / divisor;
    return STATUS_OK;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    animate_request *request = input->request;
    status result = STATUS_OK;
    switch (key) {
    case 'o': request->output = value; break;
    case 's': scene_input_change(&request->input, "--set", NULL, value); break;
    case KEY_SCRIPT: request->script = value; break;
    case KEY_DURATION:
        request->has_duration = true;
        result = take_seconds("--duration", value, &request->duration_s, input->why);
        break;
    case KEY_FPS: result = take_rate(value, request, input->why); break;
    case KEY_START: result = take_seconds("--start", value, &request->start_s, input->why); break;
    case KEY_ROWS: request->rows = value; break;
    case KEY_RESTART: request->restart = true; break;
    case KEY_JSON: request->json = true; break;
    case ARGP_KEY_ARG: result = scene_input_name(&request->input, value, input->why); break;
    default: return ARGP_ERR_UNKNOWN;
    }
    return result == STATUS_OK ? 0 : EINVAL;
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "SCENE",
    .doc = "Render a film of the scene file SCENE, whose slimes move.\v"
           "Frame k shows the time START + k / FPS; there are DURATION times FPS of them, rounded, at least one. "
           "Frames that are there already are "
           "not rendered again: a film that was stopped goes on when it is asked for again. For example:\n"
           "  cuvette animate experiments/scenes/slime.yaml -o frames/%05d.png\n"
           "  cuvette animate experiments/scenes/slime.yaml -o - | ffmpeg -i - slime.mp4",
};

static status check_output(const animate_request *request, diagnostic *why)
{
    if (!request->output) {
        diagnose(why, STATUS_BAD_INPUT, "add -o frames/%05d.png for pictures, -o NAME.y4m for a film",
                 "nothing is asked for");
        diagnostic_locate(why, "animate", 0, 0);
        return STATUS_BAD_INPUT;
    }
    const bool to_stdout = strcmp(request->output, "-") == 0;
    if (to_stdout && request->json)
        return wrong("--json", "", "name a file by -o", "standard output cannot hold film and account", why);
    if (to_stdout && isatty(STDOUT_FILENO))
        return wrong("-o", "-", "send it into a file or another program", "a terminal shows no films", why);
    if (request->restart && animate_is_stream(request))
        return wrong("--restart", "", "leave it out", "a film in one file always begins anew", why);
    return STATUS_OK;
}

static status check_rows(const animate_request *request, diagnostic *why)
{
    static const char *const endings[] = {".csv"};
    size_t which;
    if (!request->rows)
        return STATUS_OK;
    status result = outputs_ending("--rows", request->rows, endings, 1, "end it in .csv", &which, why);
    return result == STATUS_OK ? outputs_check_folder("--rows", request->rows, why) : result;
}

/* A script is named from the working folder, but the parameter's is looked for in the scene's. */
static status find_script(animate_request *request, diagnostic *why)
{
    if (!request->script)
        return STATUS_OK;
    struct stat about;
    if (stat(request->script, &about) == 0 && !S_ISREG(about.st_mode))
        return wrong("--script", request->script, "name a regular file: a script is read more than once",
                     "is no regular file", why);
    request->script_path = realpath(request->script, NULL);
    if (request->script_path)
        return STATUS_OK;
    char what[160];
    snprintf(what, sizeof what, "cannot open: %s", strerrordesc_np(errno));
    return wrong("--script", request->script, "check the path", what, why);
}

status animate_request_parse(int argc, char **argv, animate_request *out, diagnostic *why)
{
    *out = (animate_request){.fps_num = 25, .fps_den = 1};
    status result = scene_input_prepare(&out->input, "animate", argc, why);
    out->input.from_beginning = true;
    if (result == STATUS_OK)
        result = options_parse(&parser, 0, argc, argv, out, why);
    if (result == STATUS_OK)
        result = scene_input_check(&out->input, why);
    if (result == STATUS_OK)
        result = check_output(out, why);
    if (result == STATUS_OK)
        result = check_rows(out, why);
    return result == STATUS_OK ? find_script(out, why) : result;
}

void animate_request_release(animate_request *request)
{
    scene_input_release(&request->input);
    free(request->script_path);
    *request = (animate_request){0};
}

bool animate_is_stream(const animate_request *request)
{
    const size_t length = strlen(request->output);
    return strcmp(request->output, "-") == 0 || (length > 4 && strcasecmp(request->output + length - 4, ".y4m") == 0);
}

double animate_time_s(const animate_request *request, int64_t frame)
{
    return request->start_s + (double)(frame * request->fps_den) / (double)request->fps_num;
}

int64_t animate_count(const animate_request *request)
{
    return (int64_t)fmax(1, round(request->duration_s * (double)request->fps_num / (double)request->fps_den));
}

status animate_check_length(const animate_request *request, diagnostic *why)
{
    const double frames = request->duration_s * (double)request->fps_num / (double)request->fps_den;
    if (frames <= FRAMES_MAX && request->start_s + request->duration_s <= SECONDS_MAX)
        return STATUS_OK;
    diagnose(why, STATUS_BAD_INPUT, "give a --duration with at most 10000000 frames, that ends within 86400 s",
             "the film is too long");
    diagnostic_locate(why, "animate", 0, 0);
    return STATUS_BAD_INPUT;
}
