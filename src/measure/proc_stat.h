/* The parser of /proc/stat, separate from reading the file so that it can be tested with text of any machine. Pure;
 * private to src/measure. proc(5), section /proc/stat. */
#pragma once

#include <stdbool.h>

typedef struct proc_stat {
    double busy_s;  /* user, nice, system, irq, softirq and steal, sum over all units, since boot */
    double idle_s;  /* idle and iowait */
    double steal_s; /* in which the hypervisor ran others; part of busy_s */
    int units;      /* lines cpu0, cpu1, ...: processing units online */
} proc_stat;

/* text is the content of the file; ticks_per_s is sysconf(_SC_CLK_TCK). False when it has no line "cpu " with at least
 * four counts, or when all counts are zero, as in sandboxes that hide the machine. */
bool proc_stat_parse(const char *text, double ticks_per_s, proc_stat *out);
