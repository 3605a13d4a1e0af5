/* Writes a page with the command that made it. */
#include "cli/render_page.h"

#include "base/text.h"
#include "cli/outputs.h"
#include "report/page.h"
#include "scene/model/camera.h"
#include <stdlib.h>

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
    return report_page_write(content, out, why);
}

status render_page_write(const scene_input *input, const job_account *f, isa level, const char *path, int bits,
                         const char *live, diagnostic *why)
{
    image *img = NULL;
    char *command = NULL;
    status code = film_image(f->result->img, &img, why);
    if (code == STATUS_OK)
        img->tone = camera_tone(f->of);
    THEN(code, command_of(input, path, live, &command, why));
    if (code == STATUS_OK) {
        const report_page_content page = {.s = f->of,
                                          .level = level,
                                          .rows = image_rows_of(img),
                                          .bits = bits,
                                          .film_hash = job_account_hash(f),
                                          .command = command,
                                          .live = live};
        code = outputs_write_text(path, write_page, &page, why);
    }
    free(command);
    image_destroy(img);
    return code;
}
