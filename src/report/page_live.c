/* Finds, packs and writes the laboratory of a page. Its script decompresses it into a frame of the page's own, with the
 * scene that the page holds; the page's policy allows this, but no request. */
#include "report/page_live.h"

#include "base/text.h"
#include "base/file.h"
#include "base/installed.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

enum { LIVE_MAX = 1 << 26 }; /* bytes */

static const char *asked_path(void)
{
    const char *asked = getenv("CUVETTE_LIVE");
    return asked && *asked ? asked : PAGE_LIVE_FILE;
}

char *page_live_path(void)
{
    /* Next to a build; from bin or lib to where `make install` puts it. */
    static const char *const places[] = {"", "/../share/cuvette", "/../../share/cuvette"};
    const char *asked = asked_path();
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
                        "make it with: make setup-wasm setup-site site; or set CUVETTE_LIVE to it",
                        "there is no %s, the laboratory in one file", asked_path());
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

void page_live_write(const char *code, FILE *out)
{
    fprintf(out,
            "<p><button type=\"button\" id=\"turn\" hidden>Turn it yourself</button></p>\n"
            "<dialog id=\"turned\" aria-label=\"Laboratory\"><form method=\"dialog\"><button>Back to the image</button>"
            "</form><iframe title=\"Laboratory\"></iframe></dialog>\n"
            "<script type=\"text/plain\" id=\"cuvette-live\">%s</script>\n%s",
            code, script);
}
