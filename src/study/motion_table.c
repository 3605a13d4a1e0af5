#include "study/motion_table.h"

#include "base/file.h"
#include "scene/motion/motion.h"
#include "scene/model/slime.h"
#include "softbody/trials.h"
#include "study/cell_table.h"
#include "study/grid.h"
#include "scene/model/scene.h"

status motion_table_check(const study *s, diagnostic *why)
{
    status code = STATUS_OK;
    for (size_t cell = 0; s->keep_motion && code == STATUS_OK && cell < study_cell_count(s); cell++) {
        scene *setting = NULL;
        code = study_cell_scene(s, cell, &setting, why);
        if (code == STATUS_OK && !scene_moves(setting)) {
            diagnostic_locate(why, s->path, 0, 0);
            code = diagnose(why, STATUS_BAD_INPUT, "give a mesh 'generate: slime'",
                            "motion cannot be kept of cell %zu: nothing moves in it", cell);
        }
        scene_destroy(setting);
    }
    return code;
}

static status put_slime(const study *s, size_t cell, const mesh_entry *m, isa level, FILE *out, diagnostic *why)
{
    const softbody_settings settings = slime_settings(m);
    softbody_trial_report report;
    const status code = softbody_trials(&settings, level, &report, why);
    for (int i = 0; code == STATUS_OK && i < SOFTBODY_TRIAL_COUNT; i++) {
        const softbody_trial *v = &report.value[i];
        cell_table_begin(s, cell, out);
        fprintf(out, "\t%s\t%s\t%s", m->name, v->name, v->unit[0] ? v->unit : "NA");
        cell_table_number(out, v->measured);
        cell_table_number(out, v->theory);
        cell_table_number(out, softbody_trial_error(v));
        fprintf(out, "\t%s\n", v->what);
    }
    return code;
}

status motion_table_write(const study *s, size_t cell, const scene *setting, isa level, const char *path,
                          diagnostic *why)
{
    file_writer file;
    status code = file_writer_open(&file, path, why);
    if (code != STATUS_OK)
        return code;
    cell_table_header(s, "slime\tname\tunit\tmeasured\ttheory\terror\twhat", file.stream);
    for (size_t i = 0; i < setting->mesh_count && code == STATUS_OK; i++)
        if (setting->meshes[i].source == MESH_SLIME)
            code = put_slime(s, cell, &setting->meshes[i], level, file.stream, why);
    if (code == STATUS_OK)
        return file_writer_commit(&file, why);
    file_writer_abandon(&file);
    return code;
}
