/* Landlock: landlock(7), Documentation/userspace-api/landlock.rst of Linux. */
#include "base/os_confine.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/landlock.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

/* Of later versions than the headers of Debian 12. */
#define ACCESS_TRUNCATE (UINT64_C(1) << 14) /* version 3 */
#define NET_CONNECT_TCP (UINT64_C(1) << 1)  /* version 4 */
typedef struct ruleset {
    uint64_t files, network;
} ruleset;

#define ACCESS_READ ((uint64_t)(LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR))
#define ACCESS_RUN (ACCESS_READ | LANDLOCK_ACCESS_FS_EXECUTE)
#define ACCESS_WRITE                                                                                                \
    (ACCESS_READ | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_REMOVE_DIR | LANDLOCK_ACCESS_FS_REMOVE_FILE | \
     LANDLOCK_ACCESS_FS_MAKE_DIR | LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_MAKE_SYM |                      \
     LANDLOCK_ACCESS_FS_REFER | ACCESS_TRUNCATE)
/* Special files can be made nowhere. */
#define ACCESS_ALL                                                                                             \
    (ACCESS_WRITE | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_SOCK | \
     LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK)
/* Those that a file has which is not a folder. */
#define ACCESS_OF_FILE                                                                                      \
    ((uint64_t)(LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE | \
                ACCESS_TRUNCATE))

bool os_confine_is_off(void)
{
    const char *wanted = getenv("CUVETTE_SANDBOX"), *loaded = getenv("LD_PRELOAD");
    return (wanted && strcmp(wanted, "off") == 0) || (loaded && strstr(loaded, "/vgpreload_"));
}

/* The rights that this version of Landlock knows. */
static ruleset known_rights(long version)
{
    ruleset all = {ACCESS_ALL, version >= 4 ? NET_CONNECT_TCP : 0};
    if (version < 2)
        all.files &= ~(uint64_t)LANDLOCK_ACCESS_FS_REFER;
    if (version < 3)
        all.files &= ~ACCESS_TRUNCATE;
    return all;
}

/* Against a place that is not there, or that nobody may enter. */
static bool is_shortage(int error)
{
    return error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO;
}

/* False, and errno, if the place is there but cannot be named now. */
static bool allow(int rules, const confine_place *place, uint64_t known)
{
    struct stat about;
    const int fd = open(place->path, O_PATH | O_CLOEXEC);
    if (fd < 0)
        return !is_shortage(errno);
    uint64_t rights = (place->rights & CONFINE_READ ? ACCESS_READ : 0) |
                      (place->rights & CONFINE_RUN ? ACCESS_RUN : 0) |
                      (place->rights & CONFINE_WRITE ? ACCESS_WRITE : 0);
    if (fstat(fd, &about) == 0 && !S_ISDIR(about.st_mode))
        rights &= ACCESS_OF_FILE;
    const struct landlock_path_beneath_attr rule = {.allowed_access = rights & known, .parent_fd = fd};
    const bool done = syscall(SYS_landlock_add_rule, rules, LANDLOCK_RULE_PATH_BENEATH, &rule, 0) == 0;
    const int error = errno;
    close(fd);
    errno = error;
    return done || !is_shortage(error);
}

static bool fail(int error)
{
    errno = is_shortage(error) ? error : 0;
    return false;
}

bool os_confine_files(const confine_place *places, size_t count)
{
    const long version = syscall(SYS_landlock_create_ruleset, NULL, 0, LANDLOCK_CREATE_RULESET_VERSION);
    if (version < 1 || os_confine_is_off())
        return fail(0);
    const ruleset known = known_rights(version);
    const size_t size = known.network ? sizeof known : sizeof known.files;
    const int rules = (int)syscall(SYS_landlock_create_ruleset, &known, size, 0);
    if (rules < 0)
        return fail(errno);
    bool done = true;
    for (size_t i = 0; i < count && done; i++)
        done = allow(rules, &places[i], known.files);
    done = done && prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(SYS_landlock_restrict_self, rules, 0) == 0;
    const int error = errno;
    close(rules);
    return done || fail(error);
}
