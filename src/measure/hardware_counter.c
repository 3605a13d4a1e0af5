/* Hardware counters through perf_event_open(2). */
#include "measure/usage.h"

#include <linux/perf_event.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { EVENTS = 4 };

struct hardware_counter {
    int file[EVENTS]; /* from perf_event_open(2); -1 if the kernel refused */
};

static const uint64_t event_codes[EVENTS] = {
    PERF_COUNT_HW_CPU_CYCLES,
    PERF_COUNT_HW_INSTRUCTIONS,
    PERF_COUNT_HW_BRANCH_MISSES,
    PERF_COUNT_HW_CACHE_MISSES,
};

/* Events are opened one by one, not as a group: a group that does not fit the processor's registers counts nothing at
 * all, and inherit excludes reading of groups. */
static int open_event(uint64_t code)
{
    struct perf_event_attr attributes;
    memset(&attributes, 0, sizeof attributes);
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = code;
    attributes.inherit = 1;
    attributes.exclude_kernel = 1; /* all that a user may count with perf_event_paranoid = 2, the usual value */
    attributes.exclude_hv = 1;
    attributes.read_format = PERF_FORMAT_TOTAL_TIME_ENABLED | PERF_FORMAT_TOTAL_TIME_RUNNING;
    return (int)syscall(SYS_perf_event_open, &attributes, 0, -1, -1, PERF_FLAG_FD_CLOEXEC);
}

hardware_counter *hardware_counter_create(void)
{
    hardware_counter *counter = malloc(sizeof *counter);
    if (!counter)
        return NULL;
    for (int i = 0; i < EVENTS; i++)
        counter->file[i] = open_event(event_codes[i]);
    return counter;
}

/* The count, scaled by time enabled / time running if the kernel multiplexed the register. */
static int64_t read_event(int file)
{
    struct {
        uint64_t value, enabled_ns, running_ns;
    } got;
    if (file < 0 || read(file, &got, sizeof got) != (ssize_t)sizeof got || got.running_ns == 0)
        return -1;
    if (got.running_ns >= got.enabled_ns)
        return (int64_t)got.value;
    return (int64_t)((double)got.value * ((double)got.enabled_ns / (double)got.running_ns));
}

hardware_counts hardware_counter_read(const hardware_counter *counter)
{
    if (!counter)
        return (hardware_counts){-1, -1, -1, -1};
    return (hardware_counts){
        .cycles = read_event(counter->file[0]),
        .instructions = read_event(counter->file[1]),
        .branch_misses = read_event(counter->file[2]),
        .cache_misses = read_event(counter->file[3]),
    };
}

static int64_t since(int64_t before, int64_t now)
{
    return before < 0 || now < 0 ? -1 : now - before;
}

hardware_counts hardware_counts_since(const hardware_counter *counter, const hardware_counts *before)
{
    hardware_counts now = hardware_counter_read(counter);
    return (hardware_counts){
        .cycles = since(before->cycles, now.cycles),
        .instructions = since(before->instructions, now.instructions),
        .branch_misses = since(before->branch_misses, now.branch_misses),
        .cache_misses = since(before->cache_misses, now.cache_misses),
    };
}

void hardware_counter_destroy(hardware_counter *counter)
{
    if (!counter)
        return;
    for (int i = 0; i < EVENTS; i++)
        if (counter->file[i] >= 0)
            close(counter->file[i]);
    free(counter);
}
