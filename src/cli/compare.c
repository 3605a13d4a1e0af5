/* `cuvette compare`: the difference of two images, as numbers and as a map. */
#include "image/compare.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/scene_input.h"
#include "cli/terminal.h"
#include "report/json.h"
#include "report/report.h"

#include <stdio.h>

typedef struct compare_request {
    const char *paths[2], *map; /* map: NULL for none */
    bool json;
} compare_request;

static const command_option options[] = {
    {"diff", 0, "FILE", "write the FLIP error map in false colour: " IMAGE_ENDINGS,
     OPTION_FILLS(option_text, compare_request, map)},
    {"json", 0, NULL, "print one JSON object", OPTION_FILLS(option_flag, compare_request, json)},
    OPTION_MEMORY,
    {0},
};

static const command_form form = {
    .options = options,
    .synopsis = "A B",
    .arguments_at = offsetof(compare_request, paths),
    .argument_limit = 2,
    .excess_remedy = "use exactly two images",
    .excess = "unexpected argument '%.128s'",
    .about =
        "Compare the images A and B as a display shows them: mean squared error, peak signal-to-noise ratio, "
        "structural similarity, FLIP, the largest difference and the fraction of differing pixels. Both images must "
        "have the same size; each can be a " IMAGE_FORMATS " file.\vFor example:\n"
        "  cuvette compare depth4.png depth8.png --diff where.png",
};

typedef struct pair {
    image *images[2];
    int bits[2];
    image_comparison found;
} pair;

static status check_request(const compare_request *request, diagnostic *why)
{
    if (!request->paths[1])
        return options_wrong("compare", NULL, why, "name two " IMAGE_FORMATS " files",
                             request->paths[0] ? "only one image is given" : "no images are given");
    return request->map ? outputs_check_image("--diff", request->map, request->paths, 2, why) : STATUS_OK;
}

static void note_file(const char *path, const image *img)
{
    char line[4096 + IMAGE_NOTE_MAX];
    if (!img->note[0])
        return;
    snprintf(line, sizeof line, "%s: %s", path, img->note);
    terminal_note(line);
}

static status measure(const compare_request *request, pair *p, diagnostic *why)
{
    for (int i = 0; i < 2; i++) {
        TRY(image_read(request->paths[i], &p->images[i], &p->bits[i], why));
        note_file(request->paths[i], p->images[i]);
    }
    status result = image_compare(p->images[0], p->images[1], &p->found, why);
    if (result == STATUS_BAD_INPUT)
        diagnostic_locate(why, request->paths[0], 0, 0);
    return result;
}

static status write_map(const compare_request *request, const pair *p, diagnostic *why)
{
    image *map;
    status result = image_compare_map(p->images[0], p->images[1], &map, why);
    THEN(result, image_write(map, request->map, 8, why));
    image_destroy(map);
    return result;
}

static void print_text(const pair *p)
{
    const image_comparison *c = &p->found;
    printf("size        %d x %d pixels\n", p->images[0]->width, p->images[0]->height);
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
    printf("differing   %.4g%% of the pixels, at 8 bits\n", 100.0 * c->differing_fraction);
}

static status print_json(const compare_request *request, const pair *p, diagnostic *why)
{
    const image_comparison *c = &p->found;
    json_t *o = json_object();
    int bad = json_object_set_new(o, "schema", json_integer(1));
    bad |= json_object_set_new(o, "files",
                               json_pack("[o,o]", json_of_text(request->paths[0]), json_of_text(request->paths[1])));
    bad |= json_object_set_new(o, "bits", json_pack("[i,i]", p->bits[0], p->bits[1]));
    bad |= json_object_set_new(o, "width", json_integer(p->images[0]->width));
    bad |= json_object_set_new(o, "height", json_integer(p->images[0]->height));
    bad |= !report_comparison(o, c);
    return json_print(json_if(o, bad == 0), why);
}

status command_compare(int argc, char **argv, diagnostic *why)
{
    compare_request request = {0};
    pair p = {0};
    status result = command_form_read(&form, argc, argv, &request, why);
    THEN(result, check_request(&request, why));
    THEN(result, measure(&request, &p, why));
    if (result == STATUS_OK && request.map)
        result = write_map(&request, &p, why);
    if (result == STATUS_OK && request.json)
        result = print_json(&request, &p, why);
    else if (result == STATUS_OK)
        print_text(&p);
    image_destroy(p.images[0]);
    image_destroy(p.images[1]);
    return result;
}
