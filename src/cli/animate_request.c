#include "cli/animate.h"
#include "base/number.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SECONDS_MAX 86400.0 /* of the parameter time_s */
enum { FRAMES_MAX = 10000000, RATE_PART_MAX = 1000000 };

static status take_seconds(const command_option *o, void *request, const char *value, diagnostic *why)
{
    double *seconds = (double *)((char *)request + o->at);
    const bool is_time = number_parse_real(value, seconds) && *seconds >= 0 && *seconds <= SECONDS_MAX;
    char name[32];
    snprintf(name, sizeof name, "--%s", o->name);
    return is_time ? STATUS_OK : options_wrong(name, value, why, "give seconds, from 0 to 86400", "is no such time");
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

static status take_rate(const command_option *o, void *into, const char *value, diagnostic *why)
{
    animate_request *request = into;
    (void)o;
    char whole[32];
    const size_t length = strcspn(value, "/");
    int64_t num = 0, den = 1;
    bool right = length < sizeof whole;
    if (right) {
        snprintf(whole, sizeof whole, "%.*s", (int)length, value);
        right = number_parse_int(whole, &num) && (!value[length] || number_parse_int(value + length + 1, &den));
    }
    if (!right || num < 1 || den < 1 || num > RATE_PART_MAX || den > RATE_PART_MAX)
        return options_wrong("--fps", value, why,
                             "give an integer or a fraction of integers up to 1000000, as 25 or 30000/1001",
                             "is no rate of frames");
    const int64_t divisor = common_divisor(num, den);
    request->fps_num = num / divisor;
    request->fps_den = den / divisor;
    return STATUS_OK;
}

static const command_option options[] = {
    {"output", 'o', "PATTERN",
     "frames as pictures, numbered from 0 by one %d or %05d in the name: .png, .jpg or .pfm; or one film, .y4m (- for "
     "standard output)",
     OPTION_FILLS(option_text, animate_request, output)},
    {"script", 0, "FILE", "what hands do with the slimes, for all of them",
     OPTION_FILLS(option_text, animate_request, script)},
    {"duration", 0, "S", "seconds; when not said 2 more than the script has, or 4 without one",
     OPTION_FILLS(take_seconds, animate_request, duration_s)},
    {"fps", 0, "N", "frames a second, as 25 (the default) or 30000/1001", .take = take_rate},
    {"start", 0, "S", "the first frame's time, in seconds after the motion's beginning; 0 when not said",
     OPTION_FILLS(take_seconds, animate_request, start_s)},
    OPTION_SET("'toy.stiffness=80'"),
    {"rows", 0, "FILE", "append a row a frame, once, to a .csv: times, counts, energies",
     OPTION_FILLS(option_text, animate_request, rows)},
    {"restart", 0, NULL, "remove the frames of the film that is there, and begin anew",
     OPTION_FILLS(option_flag, animate_request, restart)},
    {"json", 0, NULL, "print the account as one JSON object", OPTION_FILLS(option_flag, animate_request, json)},
    {0},
};

static status check_output(const animate_request *request, diagnostic *why)
{
    if (!request->output)
        return options_wrong("animate", NULL, why, "add -o frames/%05d.png for pictures, -o NAME.y4m for a film",
                             "nothing is asked for");
    const bool to_stdout = strcmp(request->output, "-") == 0;
    if (to_stdout && request->json)
        return options_wrong("--json", "", why, "name a file by -o", "standard output cannot hold film and account");
    if (to_stdout && isatty(STDOUT_FILENO))
        return options_wrong("-o", "-", why, "send it into a file or another program", "a terminal shows no films");
    if (request->restart && animate_is_stream(request))
        return options_wrong("--restart", "", why, "leave it out", "a film in one file always begins anew");
    return STATUS_OK;
}

static status check_rows(const animate_request *request, diagnostic *why)
{
    static const char *const endings[] = {".csv"};
    size_t which;
    if (!request->rows)
        return STATUS_OK;
    TRY(outputs_ending("--rows", request->rows, endings, 1, "end it in .csv", &which, why));
    return outputs_check_folder("--rows", request->rows, why);
}

/* A script is named from the working folder, but the parameter's is looked for in the scene's. */
static status find_script(animate_request *request, diagnostic *why)
{
    if (!request->script)
        return STATUS_OK;
    struct stat about;
    if (stat(request->script, &about) == 0 && !S_ISREG(about.st_mode))
        return options_wrong("--script", request->script, why, "name a regular file: a script is read more than once",
                             "is no regular file");
    request->script_path = realpath(request->script, NULL);
    if (request->script_path)
        return STATUS_OK;
    return options_wrong("--script", request->script, why, "check the path", "cannot open: %s", strerrordesc_np(errno));
}

static status check_request(void *asked, diagnostic *why)
{
    animate_request *request = asked;
    TRY(check_output(request, why));
    TRY(check_rows(request, why));
    return find_script(request, why);
}

static const scene_command animate_command = {
    .name = "animate",
    .form = {.options = options,
             .words = "SCENE",
             SCENE_WORD("animate"),
             .about =
                 "Render a film of the scene file SCENE, whose slimes move.\vFrame k shows the time START + k / FPS; "
                 "there are DURATION times FPS of them, rounded, at least one. Frames that are there already are not "
                 "rendered again: a film that was stopped goes on when it is asked for again. For example:\n"
                 "  cuvette animate experiments/scenes/slime.yaml -o frames/%05d.png\n"
                 "  cuvette animate experiments/scenes/slime.yaml -o - | ffmpeg -i - slime.mp4"},
    .check = check_request,
};

status animate_request_parse(int argc, char **argv, animate_request *out, diagnostic *why)
{
    *out = (animate_request){.input.from_beginning = true, .duration_s = -1, .fps_num = 25, .fps_den = 1};
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
    return strcmp(request->output, "-") == 0 || outputs_ends_with(request->output, ".y4m");
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
    return options_wrong("animate", NULL, why,
                         "give a --duration with at most 10000000 frames, that ends within 86400 s",
                         "the film is too long");
}
