/* Writes a page: the parts of the document. Every text of the scene is escaped. */
#include "report/page.h"

#include "base/text.h"
#include "report/page_live.h"
#include "report/page_rays.h"
#include "report/page_style.h"
#include "report/svg.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"
#include "scene/model/params.h"
#include "scene/model/scene.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

/* Nothing may be requested and nothing runs, whatever a text contained. */
#define POLICY "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
/* Nothing may be requested; the laboratory of the page runs, from the page alone. */
#define LIVE_POLICY                                                                                                \
    "default-src 'none'; img-src data: blob:; style-src 'unsafe-inline'; base-uri 'none'; "                        \
    "script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src data: blob:; form-action " \
    "'none'"

static const char *title_of(const scene *s)
{
    return s->title && s->title[0] ? s->title : "A scene of Cuvette";
}

static void write_heading(const report_page_content *page, const char *code, FILE *out)
{
    fprintf(out,
            "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
            "<meta http-equiv=\"Content-Security-Policy\" content=\"%s\">\n"
            "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>",
            page->live && code ? LIVE_POLICY : POLICY);
    svg_escape(out, title_of(page->s));
    fputs("</title>\n<style>\n" PAGE_STYLE "</style>\n", out);
    if (code)
        fprintf(out, "%s%s%s\n", SHARED_PAGE_BEGIN, code, SHARED_PAGE_END);
    fputs("</head>\n<body>\n<main>\n<h1>", out);
    svg_escape(out, title_of(page->s));
    fputs("</h1>\n", out);
}

/* The image carries the scene too, so that it can be saved from the page and opened. */
static status write_image(const report_page_content *page, const shared_texts *texts, FILE *out, diagnostic *why)
{
    image_rows rows = page->rows;
    unsigned char *bytes = NULL;
    size_t size = 0;
    rows.texts = texts->item;
    rows.text_count = texts->count;
    TRY(image_encode_rows(&rows, IMAGE_PNG, page->bits, false, &bytes, &size, why));
    char *code = base64_encode(bytes, size, false);
    free(bytes);
    if (!code)
        return out_of_memory(why);
    fprintf(out, "<img width=\"%d\" height=\"%d\" alt=\"Rendered image\" src=\"data:image/png;base64,%s\">\n",
            rows.width, rows.height, code);
    free(code);
    return STATUS_OK;
}

static void write_account(const report_page_content *page, const page_rays *rays, FILE *out)
{
    char *depth = NULL;
    (void)scene_get(page->s, "render.depth", &depth, NULL);
    fprintf(out, "<p>%d × %d pixels, depth %s, film %016" PRIx64 ", Cuvette %s.</p>\n", page->rows.width,
            page->rows.height, depth ? depth : "", page->film_hash, CUVETTE_VERSION);
    free(depth);
    if (rays->beams)
        fprintf(out, "<h2>Rays of the beams</h2>\n<p>The %zu strongest of %zu segments.", rays->count, rays->traced);
    else
        fprintf(out, "<h2>Rays of the middle pixel</h2>\n<p>Pixel %d,%d at %.6g nm; the %zu strongest of %zu rays.",
                rays->x, rays->y, rays->lambda_nm, rays->count, rays->traced);
    fputs(" Angles are from the normal; R and T are for unpolarised light.</p>\n", out);
}

static status write_source(const report_page_content *page, const char *text, bool whole, FILE *out, diagnostic *why)
{
    fputs("<h2>Command</h2>\n<pre tabindex=\"0\" id=\"command\">", out);
    svg_escape(out, page->command);
    fputs(whole ? "</pre>\n<p>This file holds the scene: <code>cuvette render THIS-FILE -o image.png</code> renders it "
                  "again, and <code>cuvette lab THIS-FILE</code> opens it.</p>\n"
                : "</pre>\n<p>The scene reads other files, so this file does not hold all of it.</p>\n",
          out);
    fputs("<h2>Scene</h2>\n<pre tabindex=\"0\" id=\"scene\">", out);
    for (const char *line = text; *line;) { /* svg_escape would replace the ends of lines */
        const char *end = strchrnul(line, '\n');
        char *copy = strndup(line, (size_t)(end - line));
        if (!copy)
            return out_of_memory(why);
        svg_escape(out, copy);
        free(copy);
        fputc('\n', out);
        line = *end ? end + 1 : end;
    }
    fputs("</pre>\n</main>\n</body>\n</html>\n", out);
    return STATUS_OK;
}

static status write_body(const report_page_content *page, const shared_texts *texts, const char *text, FILE *out,
                         diagnostic *why)
{
    page_rays rays = {.ray = NULL};
    status code = page_rays_collect(&rays, page->s, page->level, page->rows.width, page->rows.height, why);
    if (code == STATUS_OK) {
        fprintf(out, "<div class=\"stage\" style=\"max-width:min(%dpx,calc(75vh*%d/%d))\">\n", page->rows.width,
                page->rows.width, page->rows.height);
        code = write_image(page, texts, out, why);
    }
    if (code == STATUS_OK) {
        page_rays_write_drawing(&rays, page->rows.width, page->rows.height, out);
        fputs("</div>\n", out);
        if (page->live && texts->scene)
            page_live_write(page->live, out);
        write_account(page, &rays, out);
        page_rays_write_table(&rays, out);
        code = write_source(page, text, texts->scene, out, why);
    }
    page_rays_release(&rays);
    return code;
}

status report_page_write(const report_page_content *page, FILE *out, diagnostic *why)
{
    shared_texts texts;
    char *text = NULL, *code = NULL;
    TRY(shared_texts_make(page->s, &texts, why));
    status result =
        texts.scene ? shared_scene_code(texts.scene, &code, why) : scene_write_text(page->s, NULL, false, &text, why);
    if (result == STATUS_OK) {
        write_heading(page, code, out);
        result = write_body(page, &texts, texts.scene ? texts.scene : text, out, why);
    }
    free(texts.scene);
    free(text);
    free(code);
    return result;
}
