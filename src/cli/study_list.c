/* `cuvette study list`: the studies of a folder and the scenes below it. */
#include "base/installed.h"
#include "base/status.h"
#include "base/text.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/study.h"
#include "cli/terminal.h"
#include "scene/model/scene.h"
#include "study/plan/grid.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A kind of file in the list; print writes its line. */
typedef struct listed_kind {
    const char *ending;
    status (*print)(const char *path, diagnostic *why);
} listed_kind;

static status print_study(const char *path, diagnostic *why)
{
    study *s = NULL;
    document *fit = NULL;
    diagnostic unused;
    const bool is_fit = study_read_fit(path, &s, &fit, &unused) == STATUS_OK;
    document_destroy(fit);
    if (!is_fit)
        TRY(study_read(path, &s, why));
    if (is_fit)
        printf("%-40s         fit  %s\n", path, s->title ? s->title : "");
    else
        printf("%-40s %5zu cells  %s\n", path, study_cell_count(s), s->title ? s->title : "");
    study_destroy(s);
    return STATUS_OK;
}

static status print_scene(const char *path, diagnostic *why)
{
    scene *s = NULL;
    TRY(scene_read(path, &s, why));
    printf("%-40s       scene  %s\n", path, s->title ? s->title : "");
    scene_destroy(s);
    return STATUS_OK;
}

static int by_name(const struct dirent **a, const struct dirent **b)
{
    return strcmp((*a)->d_name, (*b)->d_name);
}

/* An unreadable file is an error that does not end the list: main prints the last one. */
static status print_all(const char *folder, const listed_kind *kind, struct dirent **entries, int count,
                        diagnostic *why)
{
    status result = STATUS_OK;
    for (int i = 0; i < count; i++) {
        const char *ending = strrchr(entries[i]->d_name, '.');
        if (entries[i]->d_name[0] == '.' || !ending || strcmp(ending, kind->ending) != 0)
            continue;
        char *path = text_format("%s/%s", folder, entries[i]->d_name);
        diagnostic error = {.line = 0};
        const status listed = path ? kind->print(path, &error) : out_of_memory(&error);
        free(path);
        if (listed == STATUS_OK)
            continue;
        if (result != STATUS_OK)
            terminal_error(why);
        result = listed;
        *why = error;
        if (listed == STATUS_FAILURE) /* a fault of the machine, not of this file */
            break;
    }
    return result;
}

static status list_folder(const char *folder, const listed_kind *kind, diagnostic *why)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, NULL, by_name);
    if (count < 0)
        return system_error(why, STATUS_BAD_INPUT, folder, "cannot list the folder", errno,
                            "give a folder with *.study files");
    const status result = print_all(folder, kind, entries, count, why);
    for (int i = 0; i < count; i++)
        free(entries[i]);
    free(entries);
    return result;
}

static bool is_folder(const char *path)
{
    DIR *d = opendir(path);
    if (d)
        closedir(d);
    return d;
}

static status list_below(const char *folder, const char *name, const listed_kind *kind, diagnostic *why)
{
    char *below = text_format("%s/%s", folder, name);
    if (!below)
        return out_of_memory(why);
    const status result = is_folder(below) ? list_folder(below, kind, why) : STATUS_OK;
    free(below);
    return result;
}

static status list_studies_and_scenes(const char *folder, diagnostic *why)
{
    static const listed_kind studies = {".study", print_study}, scenes = {".yaml", print_scene};
    TRY(list_folder(folder, &studies, why));
    TRY(list_below(folder, "full", &studies, why));
    return list_below(folder, "scenes", &scenes, why);
}

status study_list(int argc, char **argv, diagnostic *why)
{
    study_request request;
    status result = study_request_parse(STUDY_LIST, argc, argv, &request, why);
    if (result == STATUS_OK) {
        char *installed = is_folder("experiments") ? NULL : installed_folder("experiments");
        result = list_studies_and_scenes(request.file_count ? request.files[0]
                                         : installed        ? installed
                                                            : "experiments",
                                         why);
        free(installed);
    }
    study_request_release(&request);
    return result;
}
