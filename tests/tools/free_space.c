/* A library for LD_PRELOAD: every file system has FREE_BYTES bytes left. */
#include <stdlib.h>
#include <sys/statvfs.h>

int statvfs(const char *path, struct statvfs *about)
{
    (void)path;
    const char *left = getenv("FREE_BYTES");
    *about = (struct statvfs){.f_frsize = 1, .f_bavail = left ? (fsblkcnt_t)atoll(left) : 0};
    return 0;
}
