/* Reading of /proc/stat, apart from the file itself so that it can be tested on text of any machine. Pure; inside
 * this room. proc(5), section /proc/stat. */
#pragma once

#include <stdbool.h>

typedef struct proc_stat {
    double busy_s; /* user, nice, system, irq, softirq and steal, all units together, since boot */
    double idle_s; /* idle and iowait */
    int units;     /* lines cpu0, cpu1, ...: processing units online */
} proc_stat;

/* text is the file's; ticks_per_s is sysconf(_SC_CLK_TCK). False when it has no line "cpu " with four counts or more,
 * or when all of them are zero, as sandboxes give that hide the machine. */
bool proc_stat_parse(const char *text, double ticks_per_s, proc_stat *out);
