/* Small files in /proc and /sys, whose size is not known in advance. Private to src/measure. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Reads at most size - 1 bytes of the file root/path into text and terminates them with 0; returns false, with errno
 * set, if the file does not exist or cannot be read. root may be "". */
bool proc_file_read(const char *root, const char *path, char *text, size_t size);

/* The decimal integer after "key:" at the start of a line, as in /proc/meminfo; -1 if there is none. */
int64_t proc_file_field(const char *text, const char *key);

/* The counts of /proc/stat; proc(5). */
typedef struct proc_stat {
    double busy_s;  /* user, nice, system, irq, softirq and steal, sum over all units, since boot */
    double idle_s;  /* idle and iowait */
    double steal_s; /* withheld by the hypervisor; part of busy_s */
    int units;      /* lines cpu0, cpu1, ...: processing units online */
} proc_stat;

/* Parses the text of /proc/stat. ticks_per_s is sysconf(_SC_CLK_TCK). False when it has no line "cpu " with at least
 * four counts, or when all counts are zero, as in sandboxes that hide the machine. */
bool proc_stat_parse(const char *text, double ticks_per_s, proc_stat *out);
