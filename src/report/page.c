/* Writes a page: its style, the laboratory that it may contain, and the document. Texts of the scene are escaped. */
#include "report/page.h"
#include "base/file.h"
#include "base/installed.h"
#include "base/text.h"
#include "report/diagram.h"
#include "scene/file/shared.h"
#include "scene/file/write.h"
#include "scene/model/scene.h"
#include <errno.h>
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

/* A ray's numbers are visible while its line is under the pointer, focused, or the fragment of the address. */
#define PAGE_STYLE                                                                                            \
    ":root{color-scheme:light dark;--paper:#ffffff;--ink:#1c1c1c;--soft:#f1f1f1;--edge:#c4c4c4;"              \
    "--link:#0b57a4;--mark:#fff0b8}\n"                                                                        \
    "@media (prefers-color-scheme:dark){:root{--paper:#16181c;--ink:#e8e8e8;--soft:#23262c;--edge:#4a4e57;"   \
    "--link:#8ab8f0;--mark:#4d4213}}\n"                                                                       \
    "body{margin:0 auto;max-width:70rem;padding:1rem;background:var(--paper);color:var(--ink);"               \
    "font:1rem/1.45 system-ui,sans-serif}\n"                                                                  \
    "h1{font-size:1.4rem;margin:0 0 .75rem}h2{font-size:1.1rem;margin:1.5rem 0 .5rem}p{margin:.5rem 0}\n"     \
    "a{color:var(--link)}\n"                                                                                  \
    ".stage{position:relative;margin:0 auto;background:var(--soft)}\n"                                        \
    ".stage img{position:absolute;top:0;left:0;width:100%;height:auto}\n"                                     \
    ".stage svg{position:relative;display:block;width:100%;height:auto;fill:none;stroke-linecap:round}\n"     \
    "svg text{fill:var(--ink)}svg rect{fill:var(--soft)}\n"                                                   \
    ".numbers{visibility:hidden;pointer-events:none}svg a{outline:none}\n"                                    \
    "svg a:hover .numbers,svg a:focus .numbers,svg a:target .numbers{visibility:visible}\n"                   \
    "svg a:hover .halo,svg a:focus .halo,svg a:target .halo{stroke:#ffe14d;stroke-opacity:1}\n"               \
    ".halo{stroke:#000000;stroke-opacity:.55}.near{stroke:#000000;stroke-opacity:0}\n"                        \
    ".stage svg{isolation:isolate}.light{mix-blend-mode:plus-lighter}\n"                                      \
    ".camera{stroke:#ffffff}.reflect{stroke:#ff8f4d}.refract{stroke:#5cb8ff}\n"                               \
    ".shadow{stroke:#ffc93c;stroke-dasharray:5 3}.blocked{stroke:#b4b4b4;stroke-dasharray:5 3}\n"             \
    ".frame{overflow:auto;max-height:26rem;border:1px solid var(--edge)}\n"                                   \
    "table{border-collapse:collapse;font-size:.85rem;font-variant-numeric:tabular-nums;white-space:nowrap}\n" \
    "th,td{padding:.2rem .5rem;text-align:left;border-bottom:1px solid var(--edge)}\n"                        \
    "thead th{position:sticky;top:0;background:var(--soft)}tr:target{background:var(--mark)}\n"               \
    "pre{overflow:auto;max-height:26rem;margin:0;padding:.6rem;background:var(--soft);font-size:.85rem}\n"    \
    "#turn{font:inherit;padding:.5rem 1rem}#turned{width:100vw;height:100dvh;max-width:none;max-height:none;" \
    "box-sizing:border-box;margin:0;padding:0;border:0;background:var(--paper)}\n"                            \
    "#turned[open]{display:flex;flex-direction:column}#turned form{padding:.25rem}\n"                         \
    "#turned iframe{flex:1;width:100%;border:0}\n"

/* --- the laboratory ---
 *
 * Finds, packs and writes the laboratory of a page. A script decompresses it into a frame of the page, with the scene
 * that the page contains; the page's policy allows this, but no requests. */

enum { LIVE_MAX = 1 << 26 }; /* bytes */

static const char *live_file(void)
{
    const char *asked = getenv("CUVETTE_LIVE");
    return asked && *asked ? asked : PAGE_LIVE_FILE;
}

char *page_live_path(void)
{
    /* Relative to the program: a build has it in the same folder, an installation in share. */
    static const char *const places[] = {"", "/../share/cuvette", "/../../share/cuvette"};
    const char *asked = live_file();
    if (strcmp(asked, PAGE_LIVE_FILE) == 0)
        return installed_find(places, sizeof places / sizeof *places, PAGE_LIVE_FILE);
    return access(asked, F_OK) == 0 ? strdup(asked) : NULL;
}

static status pack(const char *text, size_t size, char **code, diagnostic *why)
{
    uLongf room = compressBound((uLong)size);
    unsigned char *packed = malloc(room);
    *code = NULL;
    if (packed && compress2(packed, &room, (const Bytef *)text, (uLong)size, Z_BEST_COMPRESSION) == Z_OK)
        *code = base64_encode(packed, room, false);
    free(packed);
    return *code ? STATUS_OK : out_of_memory(why);
}

status page_live_code(char **code, diagnostic *why)
{
    char *path = page_live_path(), *text = NULL;
    size_t size = 0;
    *code = NULL;
    if (!path && errno == ENOMEM)
        return out_of_memory(why);
    if (!path)
        return diagnose(why, STATUS_BAD_INPUT,
                        "build it with 'make setup-wasm setup-site site', or set CUVETTE_LIVE to its path",
                        "cannot find the laboratory in one file, %s", live_file());
    status result = file_read(path, LIVE_MAX, &text, &size, why);
    THEN(result, pack(text, size, code, why));
    free(text);
    free(path);
    return result;
}

/* The frame's document inherits the policy of the page. A dialog returns to the image on Esc. */
static const char script[] =
    "<script>\n"
    "(() => {\n"
    "  const at = (id) => document.getElementById(id);\n"
    "  const button = at('turn');\n"
    "  if (!at('cuvette-live').textContent || !globalThis.DecompressionStream) return;\n"
    "  const laboratory = async () => {\n"
    "    const packed = await fetch(`data:;base64,${at('cuvette-live').textContent}`);\n"
    "    const plain = packed.body.pipeThrough(new DecompressionStream('deflate'));\n"
    "    return (await new Response(plain).text()).replace('<head>', (head) => head + at('cuvette-scene').outerHTML);\n"
    "  };\n"
    "  const frame = at('turned').querySelector('iframe');\n"
    "  button.hidden = false;\n"
    "  button.onclick = async () => {\n"
    "    frame.srcdoc ||= await laboratory();\n"
    "    at('turned').showModal();\n"
    "  };\n"
    "})();\n"
    "</script>\n";

/* Writes the button, the code and the script. code "": the code is inserted later. */
static void write_live(const char *code, FILE *out)
{
    fprintf(out,
            "<p><button type=\"button\" id=\"turn\" hidden>Turn it yourself</button></p>\n"
            "<dialog id=\"turned\" aria-label=\"Laboratory\"><form method=\"dialog\"><button>Back to the image</button>"
            "</form><iframe title=\"Laboratory\"></iframe></dialog>\n"
            "<script type=\"text/plain\" id=\"cuvette-live\">%s</script>\n%s",
            code, script);
}

/* --- the document --- */

/* Nothing can be requested or run, whatever the texts contain. */
#define POLICY "default-src 'none'; img-src data:; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'"
/* Nothing can be requested; the laboratory is part of the page. */
#define LIVE_POLICY                                                                                                \
    "default-src 'none'; img-src data: blob:; media-src blob:; style-src 'unsafe-inline'; base-uri 'none'; "       \
    "script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:; connect-src data: blob:; form-action " \
    "'none'"

static const char *title_of(const scene *s)
{
    return s->title && s->title[0] ? s->title : "A scene of Cuvette";
}

static void write_heading(const page_content *page, const char *code, FILE *out)
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

/* The image also contains the scene, so that it can be saved from the page and opened as a scene. */
static status write_image(const page_content *page, const shared_texts *texts, FILE *out, diagnostic *why)
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

static void write_account(const page_content *page, const page_rays *rays, FILE *out)
{
    char depth[DEPTH_TEXT_MAX];
    fprintf(out, "<p>%d × %d pixels, depth %s, film %016" PRIx64 ", Cuvette %s.</p>\n", page->rows.width,
            page->rows.height, render_depth_text(&page->s->render, depth), page->film_hash, CUVETTE_VERSION);
    if (rays->beams)
        fprintf(out, "<h2>Rays of the beams</h2>\n<p>The %zu strongest of %zu segments.", rays->count, rays->traced);
    else
        fprintf(out, "<h2>Rays of the middle pixel</h2>\n<p>Pixel %d,%d at %.6g nm; the %zu strongest of %zu rays.",
                rays->x, rays->y, rays->lambda_nm, rays->count, rays->traced);
    fputs(" Angles are from the normal; R and T are for unpolarised light.</p>\n", out);
}

static status write_source(const page_content *page, const char *text, bool holds_scene, FILE *out, diagnostic *why)
{
    fputs("<h2>Command</h2>\n<pre tabindex=\"0\" id=\"command\">", out);
    svg_escape(out, page->command);
    fputs(holds_scene
              ? "</pre>\n<p>This file holds the scene: <code>cuvette render THIS-FILE -o image.png</code> renders it "
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

static status write_body(const page_content *page, const shared_texts *texts, const char *text, FILE *out,
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
            write_live(page->live, out);
        write_account(page, &rays, out);
        page_rays_write_table(&rays, out);
        code = write_source(page, text, texts->scene, out, why);
    }
    page_rays_release(&rays);
    return code;
}

status page_write_html(const page_content *page, FILE *out, diagnostic *why)
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
