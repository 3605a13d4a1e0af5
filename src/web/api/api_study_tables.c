/* API: the tables of a study as files: the rows as on disk, the summary as `cuvette study summary` prints it. */
#include "base/file.h"
#include "base/text.h"
#include "web/api/api.h"
#include "web/api/study_json.h"
#include <stdlib.h>
#include <unistd.h>

enum { ROWS_MAX = 1 << 30 }; /* bytes */

static status no_rows(call *c)
{
    return api_refuse(c, 404, "the study has no rows yet", "measure it, or merge the rows of its shards, first");
}

status api_study_rows_csv(call *c)
{
    study *s;
    char *bytes = NULL;
    size_t size = 0;
    TRY(api_take_study(c, &s));
    char *path = text_format("%s/%s/rows.csv", c->l->settings.results, s->name);
    status code = path ? STATUS_OK : out_of_memory(&c->why);
    if (code == STATUS_OK && access(path, F_OK) != 0)
        code = no_rows(c);
    THEN(code, file_read_below(path, folder_real(c->l->files), ROWS_MAX, &bytes, &size, &c->why));
    free(path);
    study_destroy(s);
    return code == STATUS_OK ? api_send(c, "text/csv", bytes, size) : code;
}

status api_study_summary_tsv(call *c)
{
    study *s;
    char *text = NULL;
    size_t size = 0;
    TRY(api_take_study(c, &s));
    status code = study_summary_text(s, c->l->settings.results, &text, &size, &c->why);
    if (code == STATUS_OK && !text)
        code = no_rows(c);
    study_destroy(s);
    return code == STATUS_OK ? api_send(c, "text/tab-separated-values", text, size) : code;
}
