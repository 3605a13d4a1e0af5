/* API: the self-contained page of the final image, as `cuvette render -o FILE.html` writes it. See web/README.md. */
#include "web/api/api.h"

#include "base/text_writer.h"
#include "report/page.h"

#include <stdlib.h>

static status write_page(call *c, const shared_image *p, const char *command, char **bytes, size_t *size)
{
    const report_page_content page = {.s = p->of,
                                      .level = c->l->settings.level,
                                      .rows = image_rows_of(p->linear),
                                      .bits = 8,
                                      .film_hash = p->film_hash,
                                      .command = command};
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
    char *command = NULL, *bytes = NULL, *file = api_document_file(c);
    size_t size = 0;
    bool complete;
    status code = file ? STATUS_OK : out_of_memory(&c->why);
    if (code == STATUS_OK && api_wait_for_final(c, &p) != STATUS_OK) {
        c->refused = 409;
        code = STATUS_INTERRUPTED;
    }
    THEN(code,
         command_line(c->l->files, *file ? file : NULL, p->of, c->l->settings.threads, &command, &complete, &c->why));
    THEN(code, write_page(c, p, command, &bytes, &size));
    shared_image_release(p);
    free(command);
    free(file);
    return code == STATUS_OK ? api_send(c, "text/html; charset=utf-8", bytes, size) : code;
}
