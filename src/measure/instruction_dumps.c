/* The files of callgrind: PATH.1, PATH.2, ...; a line "totals: N" has the sum, as the manual of callgrind describes. */
#include "measure/instruction_dumps.h"
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char *path_of_dumps(void)
{
    const char *path = getenv(INSTRUCTION_DUMPS_VARIABLE);
    return path && path[0] ? path : NULL;
}

bool instruction_dumps_exist(void)
{
    return path_of_dumps() != NULL;
}

static int64_t read_total(const char *path)
{
    char line[512];
    int64_t total = -1;
    FILE *file = fopen(path, "re");
    while (file && fgets(line, sizeof line, file))
        if (sscanf(line, "totals: %" SCNd64, &total) == 1)
            break;
    if (file)
        fclose(file);
    return total;
}

int64_t instruction_dumps_next(instruction_dumps *dumps)
{
    const char *path = path_of_dumps();
    char name[1024];
    int64_t total = -1;
    while (path && snprintf(name, sizeof name, "%s.%ld", path, dumps->last + 1) < (int)sizeof name &&
           access(name, R_OK) == 0) {
        dumps->last++;
        total = read_total(name);
        unlink(name);
    }
    return total;
}
