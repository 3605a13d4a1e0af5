/* The parser of /proc/stat. */
#include "measure/proc_stat.h"

#include <stdlib.h>
#include <string.h>

/* The columns of a line "cpu ". Guest time, which follows, is already included in user and nice. */
enum { USER, NICE, SYSTEM, IDLE, IOWAIT, IRQ, SOFTIRQ, STEAL, COLUMNS };

static const char *next_line(const char *at)
{
    const char *end = strchr(at, '\n');
    return end ? end + 1 : at + strlen(at);
}

static int read_columns(const char *at, double ticks[COLUMNS])
{
    int count = 0;
    for (; count < COLUMNS; count++) {
        while (*at == ' ')
            at++;
        if (*at < '0' || *at > '9')
            break;
        char *end;
        ticks[count] = (double)strtoull(at, &end, 10);
        at = end;
    }
    return count;
}

bool proc_stat_parse(const char *text, double ticks_per_s, proc_stat *out)
{
    double ticks[COLUMNS] = {0};
    bool found = false;
    int units = 0;
    for (const char *line = text; *line != '\0'; line = next_line(line)) {
        if (strncmp(line, "cpu", 3) != 0)
            continue;
        if (line[3] == ' ')
            found = read_columns(line + 4, ticks) > IDLE;
        else if (line[3] >= '0' && line[3] <= '9')
            units++;
    }

    double busy = ticks[USER] + ticks[NICE] + ticks[SYSTEM] + ticks[IRQ] + ticks[SOFTIRQ] + ticks[STEAL];
    double idle = ticks[IDLE] + ticks[IOWAIT];
    if (!found || busy + idle == 0.0 || !(ticks_per_s > 0.0))
        return false;
    *out = (proc_stat){.busy_s = busy / ticks_per_s,
                       .idle_s = idle / ticks_per_s,
                       .steal_s = ticks[STEAL] / ticks_per_s,
                       .units = units};
    return true;
}
