/* `cuvette render`: renders a scene, writes image, maps and timeline, prints the account. */
#include "base/cancel.h"
#include "base/number.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "job/quantities.h"
#include "measure/statistics.h"
#include "render/frame/record.h"
#include "render/inspect/beams.h"
#include "report/json.h"
#include "report/page.h"
#include "report/report.h"
#include "scene/file/shared.h"
#include "scene/model/camera.h"
#include "scene/model/scene.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* --- the page of a rendered scene (report/page.h), with the command that made it --- */

static status command_of(const scene_input *input, const char *path, bool live, char **text, diagnostic *why)
{
    text_writer writer;
    TRY(text_writer_open(&writer, why));
    fputs("cuvette render ", writer.stream);
    shell_word_write(writer.stream, input->path);
    for (size_t i = 0; i < input->count; i++) {
        const scene_change *change = &input->changes[i];
        char *both = change->path ? text_format("%s=%s", change->path, change->text) : NULL;
        fputs(" --set ", writer.stream);
        shell_word_write(writer.stream, both ? both : change->text);
        free(both);
    }
    fputs(" -o ", writer.stream);
    shell_word_write(writer.stream, path);
    fputs(live ? " --live" : "", writer.stream);
    return text_writer_close(&writer, text, NULL, why);
}

static status write_page(const void *content, FILE *out, diagnostic *why)
{
    return page_write_html(content, out, why);
}

/* Writes the page completely or not at all. live: the laboratory's code (report/page.h); NULL: none. */
static status render_page_write(const scene_input *input, const job_account *f, isa level, const char *path, int bits,
                                const char *live, diagnostic *why)
{
    image *img = NULL;
    char *command_text = NULL;
    status code = film_image(f->result->img, &img, why);
    if (code == STATUS_OK)
        img->tone = camera_tone(f->of);
    THEN(code, command_of(input, path, live, &command_text, why));
    if (code == STATUS_OK) {
        const page_content page = {.s = f->of,
                                   .level = level,
                                   .rows = image_rows_of(img),
                                   .bits = bits,
                                   .film_hash = job_account_hash(f),
                                   .command = command_text,
                                   .live = live};
        code = outputs_write_text(path, write_page, &page, why);
    }
    free(command_text);
    image_destroy(img);
    return code;
}

/* --- the command --- */

typedef struct render_request {
    scene_input input;
    outputs files;
    bool json, beams, live;
    char *laboratory; /* the laboratory's code for the page; owned; NULL: none */
    int64_t repeat;   /* 0: not given */
} render_request;

static status parse_bits(const command_option *o, void *context, const char *value, diagnostic *why)
{
    render_request *request = context;
    int64_t bits = 8;
    (void)o;
    const status result = options_integer("--bits", value, 8, 16, &bits, why);
    if (result == STATUS_OK && bits != 8 && bits != 16)
        return options_wrong("--bits", NULL, why, "give 8 or 16", "unsupported bit depth %d", (int)bits);
    request->files.bits = (int)bits;
    return result;
}

static const command_option options[] = {
    {"output", 'o', "FILE", "write the image: .png, .jpg, .pfm or .exr (linear floats); .html: a page with the rays",
     OPTION_FILLS(option_text, render_request, files.img)},
    OPTION_SET("'render.depth=8' or 'lamp.position.x=2'"),
    OPTION_MEMORY,
    {"json", 0, NULL, "print one JSON object: hash, times, counts, parameters",
     OPTION_FILLS(option_flag, render_request, json)},
    {"beams", 0, NULL, "draw the scene's beams into the image of -o; the film and its hash stay the same",
     OPTION_FILLS(option_flag, render_request, beams)},
    {"live", 0, NULL, "put the laboratory into the page of -o: its scene can be turned and changed there",
     OPTION_FILLS(option_flag, render_request, live)},
    {"bits", 0, "N", "bits per channel of a PNG: 8 (the default) or 16", .store = parse_bits},
    {"rays", 0, "FILE", "write the ray count of each pixel: " IMAGE_MAP_ENDINGS,
     OPTION_FILLS(option_text, render_request, files.rays)},
    {"time", 0, "FILE", "write the render time of each pixel in ns: " IMAGE_MAP_ENDINGS,
     OPTION_FILLS(option_text, render_request, files.time)},
    {"cut", 0, "FILE", "write the fraction of each pixel's light that is cut: " IMAGE_MAP_ENDINGS,
     OPTION_FILLS(option_text, render_request, files.cut)},
    {"noise", 0, "FILE", "write the standard error of each pixel (path tracing): " IMAGE_MAP_ENDINGS,
     OPTION_FILLS(option_text, render_request, files.noise)},
    {"timeline", 0, "FILE", "write start, duration and thread of each tile: .json for chrome://tracing or Perfetto",
     OPTION_FILLS(option_text, render_request, files.timeline)},
    {"layers", 0, "PREFIX", "write the layers as PREFIX-LAYER.pfm; needs render.integrator=aov",
     OPTION_FILLS(option_text, render_request, files.layers)},
    {"stokes", 0, NULL, "add the Stokes vectors to the .exr of -o, by three more frames; needs render.polarisation=on",
     OPTION_FILLS(option_flag, render_request, files.stokes)},
    {"bands", 0, "N",
     "add the spectral radiance in N bands of wavelengths to the .exr of -o, by a frame for three bands; needs "
     "render.spectrum=spectral",
     OPTION_FILLS(option_integer, render_request, files.bands), .lowest = 1, .highest = OUTPUTS_BANDS_MAX},
    {"repeat", 0, "N", "render N times and report median, 95% interval and range of the times",
     OPTION_FILLS(option_integer, render_request, repeat), .lowest = 1, .highest = 1000000},
    {0},
};

/* Reads the laboratory's code before anything is rendered, so that a missing file costs no time. */
static status load_laboratory(render_request *request, diagnostic *why)
{
    if (!request->files.img || !outputs_is_page(request->files.img))
        return options_wrong("--live", NULL, why, "add -o FILE.html", "only a page can hold the laboratory");
    const status result = page_live_code(&request->laboratory, why);
    if (result == STATUS_BAD_INPUT && !why->file[0])
        diagnostic_locate(why, "--live", 0, 0);
    return result;
}

static status check_request(void *context, diagnostic *why)
{
    render_request *request = context;
    const outputs *files = &request->files;
    if (request->live)
        TRY(load_laboratory(request, why));
    if (request->beams && files->img && outputs_is_page(files->img))
        return options_wrong("--beams", NULL, why, "remove it", "a page shows the beams anyway");
    if (request->beams && (!files->img || image_format_is_float(image_format_of(files->img))))
        return options_wrong("--beams", NULL, why, "add -o FILE.png or -o FILE.jpg",
                             files->img ? "this file holds the film, which has no beams" : "no image is written");
    if (files->img || files->rays || files->time || files->cut || files->noise || files->timeline || files->layers ||
        request->json)
        return STATUS_OK;
    return options_wrong("render", NULL, why, "add -o FILE for the image or --json for the counts",
                         "no output is given");
}

static status check_scene(void *context, const scene *s, diagnostic *why)
{
    const render_request *request = context;
    if (request->live)
        TRY(shared_scene_check(s, why));
    TRY(more_frames_check(&request->files, s, why));
    return outputs_check(&request->files, s, why);
}

/* Prints the statistics of one process; the interval is not valid for other processes (cuvette-statistics(7)). */
static void print_time(const char *name, const double *values, size_t count)
{
    double copy[1000];
    char median[NUMBER_TEXT_MAX], low[NUMBER_TEXT_MAX], high[NUMBER_TEXT_MAX];
    double *sorted = count > sizeof copy / sizeof copy[0] ? malloc(count * sizeof *sorted) : copy;
    if (!sorted)
        return;
    memcpy(sorted, values, count * sizeof *sorted);
    const summary t = summarize(sorted, count);
    const bool has_interval = isfinite(t.median_low);
    const double half = 0.5 * (has_interval ? t.median_high - t.median_low : t.maximum - t.minimum);
    printf("%s: median %s s", name, number_format_within(t.median, half, median));
    if (has_interval)
        printf(", 95%% interval %s to %s s", number_format_within(t.median_low, half, low),
               number_format_within(t.median_high, half, high));
    printf(", range %s to %s s, n = %zu\n", number_format_within(t.minimum, half, low),
           number_format_within(t.maximum, half, high), count);
    if (sorted != copy)
        free(sorted);
}

/* Prints the fraction of the image's light that was cut, if it is large enough to be seen. */
static void print_cut(const job_account *f)
{
    const double least = 0.01, fraction = frame_quantity("cut_fraction")->read(f, -1).real[0];
    if (fraction >= least)
        printf(", %.3g %% of the light cut", 100.0 * fraction);
}

/* Prints the summary, one line; programs use --json. */
static void print_summary(const job_account *f, const outputs *files)
{
    const scene *s = f->of;
    const char *const written[] = {files->img, files->rays, files->time, files->cut, files->noise, files->timeline};
    uint64_t rays = ray_counters_total(&f->result->counters);
    const double wall_s = job_account_wall_s(f);
    char depth[DEPTH_TEXT_MAX];
    printf("%s%lldx%lld pixels, depth %s: %llu rays in %.3f s (%.1f million per second), film %016llx",
           f->complete ? "" : "a part of ", (long long)s->render.width, (long long)s->render.height,
           render_depth_text(&s->render, depth), (unsigned long long)rays, wall_s,
           wall_s > 0 ? (double)rays / wall_s / 1e6 : 0.0, (unsigned long long)job_account_hash(f));
    if (f->result->variance)
        printf(", rms noise %.4f", render_noise_rms(f->result));
    print_cut(f);
    const char *before = " -> ";
    for (size_t i = 0; i < sizeof written / sizeof written[0]; i++)
        if (written[i] && (i == 0 || !files->img || strcmp(written[i], files->img) != 0)) {
            printf("%s%s", before, written[i]);
            before = ", ";
        }
    if (files->layers)
        printf("%s%s-*.pfm", before, files->layers);
    putchar('\n');
    if (f->count > 1) {
        print_time("wall time", f->wall_s, f->count);
        print_time("CPU time", f->cpu_s, f->count);
    }
}

/* Writes the image again, with the beams over it. */
static status draw_beams(const render_request *request, const job_account *f, job *frame_job, diagnostic *why)
{
    scene *hiding = NULL;
    image *img = NULL;
    job_account distances = {.result = NULL};
    const render_options frame_options = {.layers = true};
    status result = beams_hiding_scene(f->of, &hiding, why);
    THEN(result, job_render(frame_job, hiding, &frame_options, &distances, why));
    THEN(result, film_image(f->result->img, &img, why));
    THEN(result, beams_draw(f->of, job_isa(frame_job), distances.result->layers->values[LAYER_DEPTH], img, why));
    THEN(result, record_drawing(img, f->of, request->files.img, request->files.bits == 16 ? 16 : 8, why));
    image_destroy(img);
    job_account_release(&distances);
    scene_destroy(hiding);
    return result;
}

static status write_files(const render_request *request, const job_account *f, job *frame_job, diagnostic *why)
{
    const outputs *files = &request->files;
    more_frames more;
    status written = more_frames_render(files, f->of, f->result->img, frame_job, &more, why);
    THEN(written, outputs_write(files, f->of, f->result, &more.channels, why));
    more_frames_release(&more);
    TRY(written);
    if (files->img && outputs_is_page(files->img))
        TRY(render_page_write(&request->input, f, job_isa(frame_job), files->img, files->bits == 16 ? 16 : 8,
                              request->laboratory, why));
    if (request->beams && f->count > 0)
        TRY(draw_beams(request, f, frame_job, why));
    return STATUS_OK;
}

/* Writes the results. After a Ctrl-C, before or while files are written, the files are still written (again), with less
 * compression and without page, beams and layers, which take long; the status is then STATUS_INTERRUPTED. */
static status write_results(const render_request *request, const job_account *f, job *frame_job, diagnostic *why)
{
    status first = cancel_check(why);
    THEN(first, write_files(request, f, frame_job, why));
    status code = first;
    cancel_token shield;
    cancel_shield(&shield);
    if (first == STATUS_INTERRUPTED) {
        outputs quick_files = request->files;
        quick_files.layers = NULL;
        code = outputs_write(&quick_files, f->of, f->result, NULL, why);
    }
    if (code == STATUS_OK && request->json)
        code = json_print(report_create(f, request->repeat > 0), why);
    else if (code == STATUS_OK)
        print_summary(f, &request->files);
    cancel_end(&shield);
    return code == STATUS_OK ? first : code;
}

static status report_interrupted(const render_request *request, const job_account *f, diagnostic *why)
{
    if (!f->result)
        return diagnose(why, STATUS_INTERRUPTED, "", "interrupted before the first pixel");
    bool partial = f->count == 0 && request->files.img;
    diagnose(why, STATUS_INTERRUPTED, "", "interrupted; %s",
             partial ? "the image holds the finished tiles" : "finished results are kept");
    diagnostic_locate(why, request->files.img, 0, 0);
    return STATUS_INTERRUPTED;
}

static void show_progress(void *context, double fraction)
{
    progress_draw(context, fraction);
}

/* An OpenEXR file has the layers, if there are any. */
static bool holds_layers(const outputs *files, const scene *s)
{
    return files->img && image_format_of(files->img) == IMAGE_EXR && integrator_traits_of(&s->render)->layers;
}

static status render_and_write(const render_request *request, const scene *s, job *frame_job, diagnostic *why)
{
    const outputs *files = &request->files;
    progress_line line;
    const render_options frame_options = {.pixel_rays = files->rays,
                                          .pixel_time = files->time,
                                          .pixel_cut = files->cut,
                                          .timeline = files->timeline,
                                          .layers = files->layers || holds_layers(files, s),
                                          .usage = request->json,
                                          .progress = show_progress,
                                          .context = &line};
    job_account measured;
    progress_start(&line, "rendering");
    status result =
        job_repeat(frame_job, s, request->repeat > 0 ? (size_t)request->repeat : 1, &frame_options, &measured, why);
    progress_erase(&line);
    if ((result == STATUS_OK || result == STATUS_INTERRUPTED) && measured.result) {
        status written = write_results(request, &measured, frame_job, why);
        result = written == STATUS_OK ? result : written;
    }
    if (result == STATUS_OK && !request->json) {
        scene_input_note_inert_frame(&request->input, frame_job, &measured);
        scene_input_note_frame(&measured);
    }
    if (result == STATUS_INTERRUPTED)
        result = report_interrupted(request, &measured, why);
    job_account_release(&measured);
    return result;
}

static status run(void *context, scene *s, isa level, diagnostic *why)
{
    const render_request *request = context;
    job *frame_job = NULL;
    status result = scene_input_job(true, &frame_job, why);
    if (result == STATUS_OK && !request->json) {
        result = scene_input_lint(s, level, why);
        if (request->beams || (request->files.img && outputs_is_page(request->files.img)))
            scene_input_note_beams(s);
        scene_input_note_inert(s, &request->input);
    }
    THEN(result, render_and_write(request, s, frame_job, why));
    job_destroy(frame_job);
    return result;
}

static const scene_command render_command = {
    .name = "render",
    .form = {.options = options,
             .synopsis = "SCENE",
             SCENE_WORD("render", "-o FILE for an output, "),
             .about = "Render SCENE, print its ray count and time, and write the image with -o.\vFor example:\n"
                      "  cuvette render experiments/scenes/rod.yaml -o rod.png --set render.depth=4\n"
                      "'cuvette params SCENE' lists the parameters that --set accepts."},
    .check = check_request,
    .check_scene = check_scene,
    .run = run,
};

status command_render(int argc, char **argv, diagnostic *why)
{
    render_request request = {.repeat = 0};
    const status result = scene_command_run(&render_command, argc, argv, &request, why);
    free(request.laboratory);
    return result;
}
