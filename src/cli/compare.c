#include "cli/cli.h"
#include "report/json.h"
#include "report/report.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "image/compare.h"
#include <errno.h>
#include <stdio.h>

typedef struct compare_request {
    const char *paths[2], *map; /* map: NULL when not wanted */
    size_t count;
    bool json;
} compare_request;

enum { KEY_JSON = 0x100, KEY_DIFF };

static const struct argp_option options[] = {
    {"diff", KEY_DIFF, "FILE", 0, "write where they differ, the FLIP error in false colour: .png, .jpg or .pfm", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object", 0},
    {0},
};

static error_t take_argument(const char *argument, compare_request *request, diagnostic *why)
{
    if (request->count < 2) {
        request->paths[request->count++] = argument;
        return 0;
    }
    diagnose(why, STATUS_BAD_INPUT, "compare takes two pictures", "'%.128s' is one too many", argument);
    diagnostic_locate(why, "compare", 0, 0);
    return EINVAL;
}

static error_t take_option(int key, char *value, struct argp_state *state)
{
    options_input *input = state->input;
    compare_request *request = input->request;
    switch (key) {
    case KEY_DIFF: request->map = value; return 0;
    case KEY_JSON: request->json = true; return 0;
    case ARGP_KEY_ARG: return take_argument(value, request, input->why);
    default: return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp parser = {
    .options = options,
    .parser = take_option,
    .args_doc = "A B",
    .doc =
        "Say how far the pictures A and B lie apart, as a display shows them: mean squared error, peak signal-to-noise "
        "ratio, structural similarity, FLIP, the largest difference, the pixels that differ. PNG, JPEG, PFM and 24-bit "
        "BMP go "
        "together, of one size.\vFor example:\n"
        "  cuvette compare depth4.png depth8.png --diff where.png",
};

typedef struct pair {
    image *pictures[2];
    int bits[2];
    image_comparison found;
} pair;

static status check_request(const compare_request *request, diagnostic *why)
{
    if (request->count < 2) {
        diagnose(why, STATUS_BAD_INPUT, "give two PNG, JPEG, PFM or 24-bit BMP files", "%s",
                 request->count ? "there is nothing to compare the picture with" : "no pictures are named");
        diagnostic_locate(why, "compare", 0, 0);
        return STATUS_BAD_INPUT;
    }
    return request->map ? outputs_check_picture("--diff", request->map, request->paths, 2, why) : STATUS_OK;
}

static status measure(const compare_request *request, pair *p, diagnostic *why)
{
    status result = STATUS_OK;
    for (int i = 0; i < 2 && result == STATUS_OK; i++)
        result = image_read(request->paths[i], &p->pictures[i], &p->bits[i], why);
    if (result != STATUS_OK)
        return result;
    result = image_compare(p->pictures[0], p->pictures[1], &p->found, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, request->paths[0], 0, 0);
    return result;
}

static status write_map(const compare_request *request, const pair *p, diagnostic *why)
{
    image *map;
    status result = image_compare_map(p->pictures[0], p->pictures[1], &map, why);
    if (result == STATUS_OK)
        result = image_write(map, request->map, 8, why);
    image_destroy(map);
    return result;
}

static void print_text(const pair *p)
{
    const image_comparison *c = &p->found;
    printf("size        %d x %d pixels\n", p->pictures[0]->width, p->pictures[0]->height);
    printf("mse         %.6g\n", c->mse);
    if (c->mse > 0)
        printf("psnr        %.2f dB\n", c->psnr_db + 0.0); /* not -0 */
    else
        printf("psnr        identical\n");
    printf("ssim        %.6f\n", c->ssim);
    printf("flip        %.6f\n", c->flip);
    if (c->largest > 0)
        printf("largest     %.6g at %d,%d\n", c->largest, c->largest_x, c->largest_y);
    else
        printf("largest     0\n");
    printf("differing   %.4g%% of the pixels, at 8 bits\n", 100.0 * c->differing_share);
}

static status print_json(const compare_request *request, const pair *p, diagnostic *why)
{
    const image_comparison *c = &p->found;
    json_t *o = json_object();
    int bad = json_object_set_new(o, "schema", json_integer(1));
    bad |= json_object_set_new(o, "files",
                               json_pack("[o,o]", json_of_text(request->paths[0]), json_of_text(request->paths[1])));
    bad |= json_object_set_new(o, "bits", json_pack("[i,i]", p->bits[0], p->bits[1]));
    bad |= json_object_set_new(o, "width", json_integer(p->pictures[0]->width));
    bad |= json_object_set_new(o, "height", json_integer(p->pictures[0]->height));
    bad |= !report_comparison(o, c);
    status result = json_write(stdout, bad ? NULL : o, why);
    json_decref(o);
    return result;
}

status command_compare(int argc, char **argv, diagnostic *why)
{
    compare_request request = {0};
    pair p = {0};
    status result = options_parse(&parser, 0, argc, argv, &request, why);
    if (result == STATUS_OK)
        result = check_request(&request, why);
    if (result == STATUS_OK)
        result = measure(&request, &p, why);
    if (result == STATUS_OK && request.map)
        result = write_map(&request, &p, why);
    if (result == STATUS_OK && request.json)
        result = print_json(&request, &p, why);
    else if (result == STATUS_OK)
        print_text(&p);
    image_destroy(p.pictures[0]);
    image_destroy(p.pictures[1]);
    return result;
}
