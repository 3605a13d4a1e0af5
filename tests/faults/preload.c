/* A library for LD_PRELOAD: makes one call of the malloc family, or of pthread_create, fail in the program that
 * page.h names. Counts calls, and notes each distinct call stack with its first call; a stack is known by its return
 * addresses relative to their modules, so that it is the same in each run. It neither allocates nor calls a function
 * that does. */
#include "page.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <unwind.h>

/* glibc's own functions, so that none has to be looked up with dlsym, which allocates. */
void *__libc_malloc(size_t);
void *__libc_calloc(size_t, size_t);
void *__libc_realloc(void *, size_t);
void *__libc_memalign(size_t, size_t);
void __libc_free(void *);

static fault_page *page;
static bool armed;
static int (*next_create)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
static __thread bool inside __attribute__((tls_model("initial-exec")));

typedef struct stack {
    uint64_t hash;
    int depth, skip;
    bool keeps;
} stack;

static void keep_frame(int at, uint64_t offset, const struct dl_find_object *module)
{
    page->frames[at] = offset;
    page->frame_count = at + 1;
    page->modules[at][0] = '\0';
    if (module && module->dlfo_link_map->l_name)
        strncpy(page->modules[at], module->dlfo_link_map->l_name, MODULE_MAX - 1);
}

static _Unwind_Reason_Code add_frame(struct _Unwind_Context *context, void *to)
{
    stack *s = to;
    const uintptr_t address = _Unwind_GetIP(context);
    struct dl_find_object module;
    if (s->skip > 0) {
        s->skip--;
        return _URC_NO_REASON;
    }
    const bool known = address && _dl_find_object((void *)address, &module) == 0;
    const uint64_t offset = known ? address - (uintptr_t)module.dlfo_map_start : 0;
    if (s->keeps)
        keep_frame(s->depth, offset, known ? &module : NULL);
    if (!page->depth || s->depth < page->depth) {
        s->hash = (s->hash ^ offset) * UINT64_C(0x9e3779b97f4a7c15);
        s->hash ^= s->hash >> 29;
    }
    return ++s->depth < FRAMES_MAX && (s->keeps || !page->depth || s->depth < page->depth) ? _URC_NO_REASON
                                                                                           : _URC_END_OF_STACK;
}

/* Of the caller's caller. */
static __attribute__((noinline)) uint64_t stack_hash(bool keeps)
{
    stack s = {.hash = 1, .skip = 3, .keeps = keeps};
    inside = true;
    _Unwind_Backtrace(add_frame, &s);
    inside = false;
    return s.hash;
}

static atomic_flag noting = ATOMIC_FLAG_INIT;
static uint32_t slot[4 * SITES_MAX]; /* index + 1 of a site, by hash */

static void note(uint64_t hash, long at)
{
    while (atomic_flag_test_and_set(&noting))
        ;
    uint32_t i = (uint32_t)(hash % (4 * SITES_MAX));
    while (slot[i] && page->sites[slot[i] - 1].hash != hash)
        i = (i + 1) % (4 * SITES_MAX);
    if (!slot[i] && page->site_count < SITES_MAX) {
        page->sites[page->site_count] = (fault_site){hash, (uint32_t)at};
        slot[i] = (uint32_t)++page->site_count;
    }
    atomic_flag_clear(&noting);
}

static __attribute__((noinline)) bool fails(fault_class class)
{
    if (!armed || page->class != (int)class || inside)
        return false;
    const long at = atomic_fetch_add(&page->seen, 1) + 1;
    if (page->records)
        note(stack_hash(false), at);
    const bool after = page->stays && atomic_load(&page->fired);
    if (!after && (page->hash ? stack_hash(false) != page->hash : at != page->at))
        return false;
    if (atomic_fetch_add(&page->fired, 1) == 0)
        page->fired_hash = stack_hash(true);
    else if (!page->stays)
        return false;
    return true;
}

static void *counted(void *memory)
{
    if (armed && memory)
        atomic_fetch_add(&page->live, 1);
    return memory;
}

static void *none(void)
{
    errno = ENOMEM;
    return NULL;
}

void *malloc(size_t size)
{
    return fails(FAULT_MEMORY) ? none() : counted(__libc_malloc(size));
}

void *calloc(size_t count, size_t size)
{
    return fails(FAULT_MEMORY) ? none() : counted(__libc_calloc(count, size));
}

void *realloc(void *memory, size_t size)
{
    if (size == 0 && memory) {
        free(memory);
        return NULL;
    }
    if (fails(FAULT_MEMORY))
        return none();
    void *now = __libc_realloc(memory, size);
    return memory ? now : counted(now);
}

void *aligned_alloc(size_t alignment, size_t size)
{
    return fails(FAULT_MEMORY) ? none() : counted(__libc_memalign(alignment, size));
}

void *memalign(size_t, size_t);
void *memalign(size_t alignment, size_t size)
{
    return fails(FAULT_MEMORY) ? none() : counted(__libc_memalign(alignment, size));
}

int posix_memalign(void **to, size_t alignment, size_t size)
{
    void *memory = fails(FAULT_MEMORY) ? NULL : counted(__libc_memalign(alignment, size));
    if (memory)
        *to = memory;
    return memory ? 0 : ENOMEM;
}

void free(void *memory)
{
    if (armed && memory)
        atomic_fetch_sub(&page->live, 1);
    const int error = errno; /* as free itself promises since glibc 2.33 */
    __libc_free(memory);
    errno = error;
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*run)(void *), void *context)
{
    if (!next_create) /* a static constructor that starts a thread */
        *(void **)&next_create = dlsym(RTLD_NEXT, "pthread_create");
    return fails(FAULT_THREAD) ? EAGAIN : next_create(thread, attributes, run, context);
}

static void after_fork(void)
{
    armed = page->place == FAULT_IN_FORKED;
}

static bool is_the_program(void)
{
    int nobody = 0;
    return strcmp(program_invocation_short_name, page->program) == 0 &&
           atomic_compare_exchange_strong(&page->owner, &nobody, (int)getpid());
}

/* Preloaded libraries begin last, after the libraries that the program needs. */
__attribute__((constructor)) static void begin(void)
{
    const char *path = getenv("FAULTS_PAGE");
    const int file = path ? open(path, O_RDWR | O_CLOEXEC) : -1;
    void *bytes = file >= 0 ? mmap(NULL, sizeof *page, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0) : MAP_FAILED;
    if (file >= 0)
        close(file);
    if (bytes == MAP_FAILED)
        return;
    page = bytes;
    *(void **)&next_create = dlsym(RTLD_NEXT, "pthread_create");
    if (!is_the_program())
        return;
    stack_hash(false); /* what unwinding prepares at its first use */
    pthread_atfork(NULL, NULL, after_fork);
    armed = page->place == FAULT_IN_PROGRAM;
    syscall(SYS_prctl, FAULTS_START, 0, 0, 0, 0);
}

__attribute__((destructor)) static void end(void)
{
    if (!page || !armed || atomic_load(&page->owner) != (int)getpid())
        return;
    armed = false;
    page->live_at_end = atomic_load(&page->live);
    page->descriptors_at_end = 0;
    for (int fd = 3; fd < 256; fd++)
        page->descriptors_at_end += fcntl(fd, F_GETFD) != -1;
    page->ended = 1;
}
