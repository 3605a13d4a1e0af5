#include "study/quick.h"
#include "scene/model/open.h"
#include "scene/model/scene.h"
#include "study/identity.h"
#include "study/row_files.h"
#include <stdlib.h>

static int64_t part(int64_t pixels, int64_t by)
{
    return pixels / by > 0 ? pixels / by : 1;
}

void quick_frame(scene *setting)
{
    const int64_t width = setting->render.width, height = setting->render.height;
    int64_t by = 1;
    while (part(width, by) * part(height, by) > QUICK_PIXELS)
        by++;
    setting->render.width = part(width, by);
    setting->render.height = part(height, by);
}

status study_make_quick(study *s, diagnostic *why)
{
    s->quick = true;
    s->repetitions_min = s->repetitions_max = s->processes = 1;
    s->relative_width = 0;
    s->undisturbed = s->warmups = 0;
    free(s->identity);
    s->identity = NULL;
    return identities_find(s, &s->identity, why);
}

/* The number of runs of either form in a folder of a study. */
static status count_runs(const study *s, const char *folder, size_t *quick, size_t *others, diagnostic *why)
{
    run_list *all;
    *quick = *others = 0;
    TRY(runs_read(folder, scene_root(s->base), &all, why));
    for (size_t i = 0; i < all->count; i++)
        json_is_true(json_object_get(all->entry[i].facts, "quick")) ? ++*quick : ++*others;
    runs_destroy(all);
    return STATUS_OK;
}

status study_follow_runs(study *s, const char *results, diagnostic *why)
{
    size_t quick, others;
    char *folder = study_folder(s, results);
    status code = folder ? count_runs(s, folder, &quick, &others, why) : out_of_memory(why);
    free(folder);
    return code == STATUS_OK && quick > 0 && !s->quick ? study_make_quick(s, why) : code;
}

status quick_check_runs(const study *s, const char *folder, diagnostic *why)
{
    size_t quick, others;
    TRY(count_runs(s, folder, &quick, &others, why));
    if (s->quick && others > 0)
        return diagnose_at(why, folder, STATUS_BAD_INPUT, "give --results another folder",
                           "quick rows do not go to the rows of whole frames");
    if (!s->quick && quick > 0)
        return diagnose_at(why, folder, STATUS_BAD_INPUT, "give --results another folder, or add --quick",
                           "the rows there are of a quick run");
    return STATUS_OK;
}
