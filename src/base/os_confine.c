/* Landlock: landlock(7), Documentation/userspace-api/landlock.rst of Linux. seccomp: seccomp(2),
 * Documentation/userspace-api/seccomp_filter.rst; a list of what is allowed, as a program of the classic Berkeley
 * Packet Filter. */
#include "base/os_process.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/landlock.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

bool os_confine_is_off(void)
{
    const char *wanted = getenv("CUVETTE_SANDBOX"), *loaded = getenv("LD_PRELOAD");
    return (wanted && strcmp(wanted, "off") == 0) || (loaded && strstr(loaded, "/vgpreload_"));
}

/* ---- files: Landlock ---- */

/* Rights of versions that are newer than the headers of Debian 12. */
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
/* All rights that the rules govern. No place allows making special files. */
#define ACCESS_ALL                                                                                             \
    (ACCESS_WRITE | LANDLOCK_ACCESS_FS_EXECUTE | LANDLOCK_ACCESS_FS_MAKE_CHAR | LANDLOCK_ACCESS_FS_MAKE_SOCK | \
     LANDLOCK_ACCESS_FS_MAKE_FIFO | LANDLOCK_ACCESS_FS_MAKE_BLOCK)
/* The rights that apply to a file that is not a folder. */
#define ACCESS_OF_FILE                                                                                      \
    ((uint64_t)(LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE | LANDLOCK_ACCESS_FS_EXECUTE | \
                ACCESS_TRUNCATE))

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

/* Whether the error is a shortage of resources, not a missing or forbidden path. */
static bool is_shortage(int error)
{
    return error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO;
}

/* False, with errno, if the place exists but cannot be opened now. */
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

/* ---- system calls: seccomp ---- */

#if defined __x86_64__
#define ARCHITECTURE AUDIT_ARCH_X86_64
#elif defined __aarch64__
#define ARCHITECTURE AUDIT_ARCH_AARCH64
#elif defined __riscv && __riscv_xlen == 64
#define ARCHITECTURE AUDIT_ARCH_RISCV64
#elif defined __s390x__
#define ARCHITECTURE AUDIT_ARCH_S390X
#endif

/* On s390x, clone has its flags in another argument, and mmap has its arguments in memory. */
#ifdef __s390x__
enum { CLONE_FLAGS_AT = 1, SEES_MMAP = 0 };
#else
enum { CLONE_FLAGS_AT = 0, SEES_MMAP = 1 };
#endif

#ifdef __has_feature
#define HAS_FEATURE(name) __has_feature(name)
#else
#define HAS_FEATURE(name) 0
#endif
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__ || HAS_FEATURE(address_sanitizer) || \
    HAS_FEATURE(thread_sanitizer)
enum { SANITIZED = 1 };
#else
enum { SANITIZED = 0 };
#endif

/* The calls for memory, locks, signals to the process itself, clocks and the end of a thread. */
static const long computing[] = {
    SYS_brk,           SYS_munmap,          SYS_mremap,       SYS_madvise,     SYS_futex,           SYS_sched_yield,
    SYS_rt_sigaction,  SYS_rt_sigprocmask,  SYS_rt_sigreturn, SYS_sigaltstack, SYS_gettid,          SYS_getpid,
    SYS_clock_gettime, SYS_clock_nanosleep, SYS_nanosleep,    SYS_getrandom,   SYS_set_robust_list, SYS_exit,
    SYS_exit_group,    SYS_restart_syscall, SYS_gettimeofday, SYS_getrusage,
#ifdef SYS_rseq
    SYS_rseq,
#endif
};

/* The calls that CONFINE_READING adds: for files, descriptors and the number of processing units. */
static const long reading[] = {
    SYS_read,       SYS_readv,     SYS_pread64, SYS_write,      SYS_writev,    SYS_close,
    SYS_fstat,      SYS_lseek,     SYS_statx,   SYS_newfstatat, SYS_fadvise64, SYS_getcwd,
    SYS_readlinkat, SYS_faccessat, SYS_sysinfo, SYS_prlimit64,  SYS_uname,     SYS_sched_getaffinity,
#ifdef SYS_faccessat2
    SYS_faccessat2,
#endif
#ifdef SYS_stat
    SYS_stat,       SYS_lstat,     SYS_access,  SYS_readlink,
#endif
#ifdef SYS_getrlimit
    SYS_getrlimit,
#endif
};

enum { CODE_MAX = 256 };
typedef struct program {
    struct sock_filter code[CODE_MAX];
    unsigned short length;
} program;

static void put(program *p, unsigned code, uint32_t value, unsigned yes, unsigned no)
{
    p->code[p->length++] = (struct sock_filter){(uint16_t)code, (uint8_t)yes, (uint8_t)no, value};
}

static void put_load(program *p, size_t offset)
{
    put(p, BPF_LD | BPF_W | BPF_ABS, (uint32_t)offset, 0, 0);
}

static void put_return(program *p, uint32_t action)
{
    put(p, BPF_RET | BPF_K, action, 0, 0);
}

static void put_allowed(program *p, const long *calls, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        put(p, BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)calls[i], 0, 1);
        put_return(p, SECCOMP_RET_ALLOW);
    }
}

/* The low word of an argument, where all flags are. */
static size_t argument(int number)
{
    const size_t low = __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__ ? 4 : 0;
    return offsetof(struct seccomp_data, args) + 8 * (size_t)number + low;
}

/* The call is allowed if its argument has none of these bits, or, with `needed`, all of them. */
static void put_flags(program *p, long call, int number, uint32_t bits, bool needed)
{
    put(p, BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)call, 0, 5);
    put_load(p, argument(number));
    put(p, BPF_ALU | BPF_AND | BPF_K, bits, 0, 0);
    put(p, BPF_JMP | BPF_JEQ | BPF_K, needed ? bits : 0, 0, 1);
    put_return(p, SECCOMP_RET_ALLOW);
    put_return(p, SECCOMP_RET_ERRNO | EPERM);
}

/* The call is allowed if its argument is this value. */
static void put_value(program *p, long call, int number, uint32_t value)
{
    put(p, BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)call, 0, 4);
    put_load(p, argument(number));
    put(p, BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1);
    put_return(p, SECCOMP_RET_ALLOW);
    put_return(p, SECCOMP_RET_ERRNO | EPERM);
}

#ifdef ARCHITECTURE
/* Another architecture's calls, and x32's, which have the numbers from 2^30, are refused. */
static void put_head(program *p)
{
    put_load(p, offsetof(struct seccomp_data, arch));
    put(p, BPF_JMP | BPF_JEQ | BPF_K, ARCHITECTURE, 1, 0);
    put_return(p, SECCOMP_RET_ERRNO | EPERM);
    put_load(p, offsetof(struct seccomp_data, nr));
    put(p, BPF_JMP | BPF_JGE | BPF_K, 0x40000000, 0, 1);
    put_return(p, SECCOMP_RET_ERRNO | EPERM);
}

/* Memory cannot become executable. */
static void put_memory(program *p)
{
    put_flags(p, SYS_mprotect, 2, PROT_EXEC, false);
    if (SEES_MMAP)
        put_flags(p, SYS_mmap, 2, PROT_EXEC, false);
    else
        put_allowed(p, (const long[]){SYS_mmap}, 1);
    put_value(p, SYS_tgkill, 0, (uint32_t)getpid()); /* abort() */
}

static void put_reading(program *p)
{
    const uint32_t writes = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
    put_allowed(p, reading, sizeof reading / sizeof *reading);
    put_flags(p, SYS_openat, 2, writes, false);
#ifdef SYS_open
    put_flags(p, SYS_open, 1, writes, false);
#endif
    put_value(p, SYS_fcntl, 1, F_GETFL);
    put_flags(p, SYS_clone, CLONE_FLAGS_AT, CLONE_THREAD, true);
#ifdef SYS_clone3
    /* The flags of clone3 are in memory, which a filter cannot read; after ENOSYS the C library uses clone. */
    put(p, BPF_JMP | BPF_JEQ | BPF_K, SYS_clone3, 0, 1);
    put_return(p, SECCOMP_RET_ERRNO | ENOSYS);
#endif
}
#endif

bool os_confine_calls(confine_calls what)
{
#ifdef ARCHITECTURE
    program p = {.length = 0};
    if (SANITIZED || os_confine_is_off())
        return false;
    put_head(&p);
    put_allowed(&p, computing, sizeof computing / sizeof *computing);
    put_memory(&p);
    if (what == CONFINE_READING)
        put_reading(&p);
    put_return(&p, SECCOMP_RET_ERRNO | EPERM);
    const struct sock_fprog all = {p.length, p.code};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &all) == 0;
#else
    (void)what;
    return false;
#endif
}
