/* Confines the laboratory: its threads, and the programs that they start, can read and write the chosen folder, the
 * folder of unsaved scenes and a temporary folder. They can read and run the program's files, the system's, and the
 * folders in PATH, but no other files, such as those of other projects or of the user's home. */
#include "base/installed.h"
#include "base/os_process.h"
#include "base/status.h"
#include "base/text.h"
#include "report/page.h"
#include "web/document/kept_scenes.h"
#include "web/session/session.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <unistd.h>

enum { PLACES_MAX = 128 };

typedef struct place_list {
    confine_place at[PLACES_MAX];
    char *owned[PLACES_MAX];
    size_t count;
    bool out_of_memory; /* a place is missing */
} place_list;

/* Adds the path, which the list owns from now on; NULL: out of memory. */
static void add(place_list *all, char *path, unsigned rights)
{
    all->out_of_memory |= !path;
    if (!path || !path[0] || all->count == PLACES_MAX) {
        free(path);
        return;
    }
    all->owned[all->count] = path;
    all->at[all->count++] = (confine_place){path, rights};
}

static void add_text(place_list *all, const char *path, unsigned rights)
{
    if (path)
        add(all, strdup(path), rights);
}

/* Adds a path that base/installed.h has found; NULL with ENOENT: it is not installed. */
static void add_found(place_list *all, char *path, unsigned rights)
{
    if (path || errno == ENOMEM)
        add(all, path, rights);
}

/* Adds the folders of a list such as PATH, except relative ones, which depend on the working folder. */
static void add_list(place_list *all, const char *list)
{
    for (const char *at = list; at && *at;) {
        const size_t length = strcspn(at, ":");
        if (at[0] == '/' && length > 1)
            add(all, text_format("%.*s", (int)length, at), CONFINE_RUN);
        at += length + (at[length] == ':');
    }
}

/* Loaders, libraries, fonts and gnuplot; what src/measure reads; the null device. */
static void add_system(place_list *all)
{
    static const char *const folders[] = {"/usr", "/lib", "/lib64", "/bin", "/sbin", "/opt", "/nix", "/gnu"};
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        add_text(all, folders[i], CONFINE_RUN);
    add_list(all, getenv("PATH"));
    add_list(all, getenv("LD_LIBRARY_PATH"));
    add_text(all, "/etc", CONFINE_READ);
    add_text(all, "/proc", CONFINE_READ);
    add_text(all, "/sys", CONFINE_READ);
    add_text(all, "/dev/urandom", CONFINE_READ);
    add_text(all, "/dev/null", CONFINE_WRITE);
}

/* The program, which studies start; the importer, which reads mesh files; and what is installed with them. */
static void add_program(place_list *all)
{
    static const char *const here[] = {"", "/../libexec/cuvette"};
    char program[PATH_MAX];
    if (os_program_path(program))
        add_text(all, program, CONFINE_RUN);
    for (size_t i = 0; i < sizeof here / sizeof *here; i++)
        add_found(all, installed_find(&here[i], 1, "cuvette-import"), CONFINE_RUN);
    add_text(all, getenv("CUVETTE_IMPORT"), CONFINE_RUN);
    add_found(all, installed_folder("experiments"), CONFINE_READ);
    add_found(all, page_live_path(), CONFINE_READ);
}

static const char *temporary_place(void)
{
    const char *place = getenv("TMPDIR");
    return place && place[0] ? place : "/tmp";
}

#define TEMPORARY "cuvette-tmp-"

/* Opens and locks the folder; -1 if it is in use or no folder. The lock ends with the process, even if the process is
 * killed. */
static int lock_folder(const char *path)
{
    const int fd = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (fd >= 0 && flock(fd, LOCK_EX | LOCK_NB) == 0)
        return fd;
    if (fd >= 0)
        close(fd);
    return -1;
}

static int remove_entry(const char *path, const struct stat *what, int kind, struct FTW *place)
{
    (void)what, (void)kind, (void)place;
    return remove(path);
}

static void remove_all(const char *path)
{
    enum { OPEN_MAX_FILES = 8 };
    nftw(path, remove_entry, OPEN_MAX_FILES, FTW_DEPTH | FTW_PHYS);
}

/* Removes the folders of laboratories that were killed. */
static void remove_abandoned(const char *place)
{
    DIR *entries = opendir(place);
    for (const struct dirent *e; entries && (e = readdir(entries));) {
        if (strncmp(e->d_name, TEMPORARY, strlen(TEMPORARY)) != 0)
            continue;
        char *path = text_format("%s/%s", place, e->d_name);
        const int fd = path ? lock_folder(path) : -1;
        if (fd >= 0) {
            remove_all(path);
            close(fd);
        }
        free(path);
    }
    if (entries)
        closedir(entries);
}

/* Creates the temporary folder. If it cannot be created or locked, there is none, and figures fail with an
 * error; a lack of memory or open files is an error at once. */
static status add_temporary(lab *l, place_list *all, diagnostic *why)
{
    remove_abandoned(temporary_place());
    char *path = text_format("%s/" TEMPORARY "XXXXXX", temporary_place());
    if (!path)
        return out_of_memory(why);
    l->temporary_lock = mkdtemp(path) ? lock_folder(path) : -1;
    if (l->temporary_lock >= 0) {
        l->temporary = path;
        add_text(all, path, CONFINE_WRITE);
        return STATUS_OK;
    }
    diagnostic reason = {.line = 0};
    const status code = system_error(&reason, STATUS_OK, path, "cannot create a temporary folder", errno, NULL);
    rmdir(path);
    free(path);
    if (code != STATUS_OK)
        *why = reason;
    return code;
}

status lab_confine(lab *l, diagnostic *why)
{
    const lab_settings *settings = &l->settings;
    place_list all = {.count = 0};
    if (os_confine_is_off())
        return STATUS_OK;
    add_system(&all);
    add_program(&all);
    status code = add_temporary(l, &all, why);
    add_text(&all, settings->folder, CONFINE_WRITE);
    diagnostic reason = {.what = ""};
    if (settings->rescue && settings->rescue[0] && kept_scenes_folder(settings->rescue, &reason) == STATUS_OK)
        add_text(&all, settings->rescue, CONFINE_WRITE);
    all.out_of_memory |= strcmp(reason.remedy, MEMORY_REMEDY) == 0;
    if (code == STATUS_OK && all.out_of_memory)
        code = out_of_memory(why);
    if (code == STATUS_OK && !os_confine_files(all.at, all.count) && errno)
        code = system_error(why, STATUS_FAILURE, settings->folder, "cannot confine the laboratory to its folder", errno,
                            NULL);
    for (size_t i = 0; i < all.count; i++)
        free(all.owned[i]);
    return code;
}

void lab_remove_temporary(lab *l)
{
    if (l->settings.confine && l->settings.rescue && l->settings.rescue[0])
        rmdir(l->settings.rescue);
    if (!l->temporary)
        return;
    remove_all(l->temporary);
    close(l->temporary_lock);
    free(l->temporary);
}

const char *lab_temporary_folder(const lab *l)
{
    return l->temporary ? l->temporary : temporary_place();
}
