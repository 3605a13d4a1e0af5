/* What is made of each cell once: its pictures and maps, and how far its picture lies from the reference. A frame of
 * its own after the rows, so that looking disturbs nothing that is measured; its film must be that of the rows. */
#include "study/compare_rows.h"
#include "study/keep.h"
#include "study/row_files.h"
#include "study/run_state.h"
#include "scene/model/open.h"

status run_find_compared(run *r, diagnostic *why)
{
    row_files *files;
    if (!r->s->reference.count)
        return STATUS_OK;
    status code = row_files_read(r->s, r->options->results, COMPARE_ROWS, &files, why);
    for (size_t i = 0; code == STATUS_OK && i < files->row_count; i++)
        r->compared[files->rows[i].cell] = true;
    row_files_destroy(files);
    return code;
}

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
        if (!ledger_cell_done(r->done, r->cells[i]) || lacks_anything(r, r->cells[i]))
            return false;
    return true;
}

static status render(run *r, const scene *setting, render_options options, render_result **frame, diagnostic *why)
{
    if (run_should_stop(r))
        return run_interrupted(why);
    options.progress = run_frame_progress;
    options.context = r;
    status code = renderer_render(r->tracer, setting, &options, frame, why);
    return code == STATUS_INTERRUPTED ? run_interrupted(why) : code;
}

static status render_reference(run *r, const scene *setting, reference *out, diagnostic *why)
{
    render_result *frame = NULL;
    status code = render(r, setting, (render_options){0}, &frame, why);
    if (code == STATUS_OK)
        code = film_image(frame->picture, &out->picture, why);
    if (code == STATUS_OK) {
        out->film_hash = film_hash(frame->picture);
        out->noise_rms = render_noise_rms(frame);
        code = reference_save(r->s, r->folder, out, setting, why);
    }
    render_result_destroy(frame);
    return code;
}

/* Brings the cell's reference into r->held: the one that is there, or from disk, or a frame. */
static status hold_reference(run *r, size_t cell, diagnostic *why)
{
    scene *setting = NULL;
    uint64_t hash = 0;
    status code = reference_scene(r->s, cell, &setting, why);
    if (code == STATUS_OK)
        code = run_prepare_scene(r, setting, why);
    if (code == STATUS_OK)
        code = reference_scene_hash(setting, &hash);
    if (code == STATUS_OK && (!r->held.picture || r->held.scene_hash != hash)) {
        reference_release(&r->held);
        code = reference_load(r->folder, scene_root(r->s->base), hash, &r->held, why);
        if (code == STATUS_OK && !r->held.picture)
            code = render_reference(r, setting, &r->held, why);
        if (code != STATUS_OK)
            reference_release(&r->held);
    }
    scene_destroy(setting);
    return code;
}

static status compare_cell(run *r, size_t cell, const scene *setting, const render_result *frame, diagnostic *why)
{
    csv_line line = {0};
    compare_row row = {.of = r->s, .cell = cell, .setting = setting, .against = &r->held};
    status code = compare_row_measure(&row, frame, why);
    if (code != STATUS_OK)
        return code;
    compare_row_write(&line, &row);
    code = line.failed ? out_of_memory(why) : table_append(r->compares, line.text, line.size, why);
    csv_line_free(&line);
    r->compared[cell] = code == STATUS_OK;
    return code;
}

static status keep_cell(run *r, size_t cell, diagnostic *why)
{
    scene *setting = NULL;
    render_result *frame = NULL;
    bool keeps = keep_missing(r->s, r->folder, cell), compares = lacks_comparison(r, cell);
    status code = compares ? hold_reference(r, cell, why) : STATUS_OK;
    if (code == STATUS_OK)
        code = study_cell_scene(r->s, cell, &setting, why);
    if (code == STATUS_OK)
        code = run_prepare_scene(r, setting, why);
    if (code == STATUS_OK)
        code = render(r, setting, keeps ? keep_options(r->s) : (render_options){0}, &frame, why);
    uint64_t seen = code == STATUS_OK ? film_hash(frame->picture) : 0;
    if (code == STATUS_OK && seen != ledger_film(r->done, cell, seen))
        code = diagnose(why, STATUS_FAILURE, "look for marked rows; the image must depend on the scene alone",
                        "the picture of cell %zu is not the one that its rows saw", cell);
    if (code == STATUS_OK && keeps)
        code = keep_write(r->s, r->folder, &(kept_cell){cell, setting, frame, r->level}, why);
    if (code == STATUS_OK && compares)
        code = compare_cell(r, cell, setting, frame, why);
    render_result_destroy(frame);
    scene_destroy(setting);
    return code;
}

status run_keep_all(run *r, diagnostic *why)
{
    status code = STATUS_OK;
    size_t pictures = 0, picture = 0;
    for (size_t i = 0; i < r->cell_count; i++)
        pictures += lacks_anything(r, r->cells[i]);
    for (size_t i = 0; code == STATUS_OK && i < r->cell_count; i++)
        if (lacks_anything(r, r->cells[i])) {
            progress_pictures(r->line, r->cells[i], ++picture, pictures);
            code = keep_cell(r, r->cells[i], why);
        }
    return code;
}
