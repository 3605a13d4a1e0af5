/* API: the self-contained page of the final image, as `cuvette render -o FILE.html` writes it. See web/README.md. */
#include "web/api/api.h"

#include "base/text.h"
#include "report/page.h"

#include <stdlib.h>
#include <string.h>

/* ?live=0: without the laboratory; ?live=empty: with a place for it, which the caller fills; otherwise with the
 * laboratory if the program has it. */
static status take_laboratory(call *c, char **laboratory)
{
    const char *asked = http_query_value(c->request, "live");
    diagnostic missing = {.line = 0};
    *laboratory = NULL;
    if (asked && strcmp(asked, "0") == 0)
        return STATUS_OK;
    if (asked && strcmp(asked, "empty") == 0)
        return (*laboratory = strdup("")) ? STATUS_OK : out_of_memory(&c->why);
    const status code = page_live_code(laboratory, &missing);
    if (code == STATUS_FAILURE)
        c->why = missing;
    return code == STATUS_BAD_INPUT ? STATUS_OK : code;
}

static status write_page(call *c, const shared_image *p, const char *command, const char *laboratory, char **bytes,
                         size_t *size)
{
    const report_page_content page = {.s = p->of,
                                      .level = c->l->settings.level,
                                      .rows = image_rows_of(p->linear),
                                      .bits = 8,
                                      .film_hash = p->film_hash,
                                      .command = command,
                                      .live = laboratory};
    text_writer writer;
    TRY(semaphore_acquire(c->l->heavy, &c->why));
    status code = text_writer_open(&writer, &c->why);
    if (code == STATUS_OK)
        code = text_writer_end(&writer, report_page_write(&page, writer.stream, &c->why), bytes, size, &c->why);
    semaphore_release(c->l->heavy);
    return code;
}

status api_page(call *c)
{
    const shared_image *p = NULL;
    char *command = NULL, *bytes = NULL, *laboratory = NULL, *file = api_document_file(c);
    size_t size = 0;
    bool complete;
    status code = file ? STATUS_OK : out_of_memory(&c->why);
    if (code == STATUS_OK && api_wait_for_final(c, &p) != STATUS_OK) {
        c->refused = 409;
        code = STATUS_INTERRUPTED;
    }
    THEN(code,
         command_line(c->l->files, *file ? file : NULL, p->of, c->l->settings.threads, &command, &complete, &c->why));
    THEN(code, take_laboratory(c, &laboratory));
    THEN(code, write_page(c, p, command, laboratory, &bytes, &size));
    shared_image_release(p);
    free(laboratory);
    free(command);
    free(file);
    return code == STATUS_OK ? api_send(c, "text/html; charset=utf-8", bytes, size) : code;
}
