/* Texts and remedies of system errors. */
#include "base/system_error.h"

#include <errno.h>
#include <stdbool.h>
#include <string.h>

const char *system_remedy(int error)
{
    switch (error) {
    case ENOSPC:
    case EDQUOT: return "free some space or choose another disk";
    case EFBIG: return "raise the limit on file size (ulimit -f)";
    case EMFILE: return "raise the limit on open files (ulimit -n)";
    case ENFILE: return "close other programs";
    case EAGAIN: return "close other programs, or raise the limit on processes (ulimit -u)";
    case EINTR: return "run the command again";
    case EIO: return "check the disk (dmesg), or choose another";
    case EACCES:
    case EPERM:
    case EROFS: return "change the permissions or choose another folder";
    case ENOENT: return "check the path";
    default: return NULL;
    }
}

static bool is_the_machines(int error)
{
    return error == ENOSPC || error == EDQUOT || error == EFBIG || error == EMFILE || error == ENFILE || error == EIO ||
           error == EAGAIN;
}

/* The reason is a text of its own, because strerror is not thread-safe and depends on the locale. */
status system_error(diagnostic *why, status otherwise, const char *path, const char *doing, int error,
                    const char *advice)
{
    const char *reason = strerrordesc_np(error), *remedy = system_remedy(error);
    if (path)
        diagnostic_locate(why, path, 0, 0);
    if (error == ENOMEM)
        return out_of_memory(why);
    return diagnose(why, is_the_machines(error) ? STATUS_FAILURE : otherwise, remedy ? remedy : advice, "%s: %s", doing,
                    reason ? reason : "unknown error");
}
