/* Makes the kept files of each cell once: images and maps, and the comparison with the reference. They use a separate
 * frame after the rows, so that measurements are not disturbed; its film must equal that of the rows. */
#include "scene/model/camera.h"
#include "scene/model/open.h"
#include "study/plan/grid.h"
#include "study/plan/identity.h"
#include "study/plan/keep.h"
#include "study/rows/compare_rows.h"
#include "study/rows/row_files.h"
#include "study/run/run_state.h"
#include <stdlib.h>

static bool lacks_comparison(const run *r, size_t cell)
{
    return r->s->reference.count && !r->compared[cell];
}

static bool lacks_anything(const run *r, size_t cell)
{
    return keep_missing(r->s, r->folder, cell) || lacks_comparison(r, cell);
}

bool run_complete(const run *r)
{
    for (size_t i = 0; i < r->cell_count; i++)
        if (!progress_index_cell_done(r->done, r->cells[i]) || lacks_anything(r, r->cells[i]))
            return false;
    return true;
}

status study_lacks_files(const study *s, const char *results, bool *lacks, diagnostic *why)
{
    const size_t cells = study_cell_count(s);
    run r = {.s = s,
             .options = &(study_options){.results = results},
             .folder = study_folder(s, results),
             .compared = calloc(cells, sizeof *r.compared)};
    status code = r.folder && r.compared ? run_find_compared(&r, why) : out_of_memory(why);
    *lacks = false;
    for (size_t cell = 0; code == STATUS_OK && !*lacks && cell < cells; cell++)
        *lacks = lacks_anything(&r, cell);
    free(r.compared);
    free(r.folder);
    return code;
}

static status render_reference(run *r, const scene *setting, reference *out, diagnostic *why)
{
    job_account frame;
    status code = run_render(r, setting, NULL, &frame, why);
    THEN(code, film_image(frame.result->img, &out->img, why));
    if (code == STATUS_OK)
        out->img->tone = camera_tone(setting);
    if (code == STATUS_OK) {
        out->film_hash = frame.film_hash;
        out->noise_rms = render_noise_rms(frame.result);
        code = reference_save(r->s, r->folder, out, setting, why);
    }
    job_account_release(&frame);
    return code;
}

/* Sets r->last_reference to the cell's reference: the current one, one from disk, or a new frame. */
static status provide_reference(run *r, size_t cell, diagnostic *why)
{
    scene *setting = NULL;
    uint64_t hash = 0;
    status code = reference_scene(r->s, cell, &setting, why);
    THEN(code, run_load(r, setting, why));
    THEN(code, reference_scene_hash(setting, &hash));
    if (code == STATUS_OK && (!r->last_reference.img || r->last_reference.scene_hash != hash)) {
        reference_release(&r->last_reference);
        code = reference_load(r->folder, scene_root(r->s->base), hash, &r->last_reference, why);
        if (code == STATUS_OK && !r->last_reference.img)
            code = render_reference(r, setting, &r->last_reference, why);
        if (code != STATUS_OK)
            reference_release(&r->last_reference);
    }
    scene_destroy(setting);
    return code;
}

static status compare_cell(run *r, size_t cell, const scene *setting, const render_result *frame, diagnostic *why)
{
    csv_buffer line = {0};
    compare_row row = {.s = r->s,
                       .cell = cell,
                       .setting = setting,
                       .cell_reference = &r->last_reference,
                       .run = r->id,
                       .process = r->process};
    TRY(compare_row_measure(&row, frame, why));
    compare_row_write(&line, &row);
    status code = run_append(&r->compares, &line, why);
    r->compared[cell] = code == STATUS_OK;
    return code;
}

static status keep_cell(run *r, size_t cell, diagnostic *why)
{
    scene *setting = NULL;
    job_account frame = {.result = NULL};
    const render_options wanted = keep_options(r->s);
    bool keeps = keep_missing(r->s, r->folder, cell), compares = lacks_comparison(r, cell);
    status code = compares ? provide_reference(r, cell, why) : STATUS_OK;
    THEN(code, study_cell_scene(r->s, cell, &setting, why));
    THEN(code, run_load(r, setting, why));
    THEN(code, run_render(r, setting, keeps ? &wanted : NULL, &frame, why));
    if (code == STATUS_OK && frame.film_hash != progress_index_film(r->done, cell, r->build, frame.film_hash))
        code = diagnose(why, STATUS_FAILURE,
                        "list marked rows with `cuvette study verify`; the film must depend only on the scene",
                        "the image of cell %zu has another film than the cell's rows", cell);
    if (code == STATUS_OK && keeps)
        code = keep_write(r->s, r->folder, &(kept_cell){cell, &frame}, why);
    if (code == STATUS_OK && compares)
        code = compare_cell(r, cell, setting, frame.result, why);
    job_account_release(&frame);
    scene_destroy(setting);
    return code;
}

status run_keep_all(run *r, diagnostic *why)
{
    size_t images = 0, img = 0;
    bool renumbered;
    for (size_t i = 0; i < r->cell_count; i++)
        images += lacks_anything(r, r->cells[i]);
    status code = images ? keep_renumber(r->s, r->folder, study_keeps_files(r->s), &renumbered, why) : STATUS_OK;
    for (size_t i = 0; code == STATUS_OK && i < r->cell_count; i++)
        if (lacks_anything(r, r->cells[i])) {
            progress_images(r->line, r->cells[i], ++img, images);
            code = keep_cell(r, r->cells[i], why);
        }
    return code;
}
