/* The keys of cuvette-account(5) as roff, from the list of quantities. The build puts them into the page. */
#include "job/quantities.h"
#include <ctype.h>
#include <stdio.h>

/* Escapes characters that roff would interpret. */
static void print_roff(const char *text)
{
    for (const char *c = text; *c; c++)
        printf(*c == '-' ? "\\-" : *c == '\\' ? "\\e" : "%c", *c);
}

static void print_keys(const quantity *list, size_t count, const char *before)
{
    for (size_t i = 0; i < count; i++) {
        const quantity *q = &list[i];
        static const char *const merges[] = {"", "median of the frames", "over all frames", "last frame"};
        const char *merge = before[0] ? "" : merges[q->merge];
        if (!q->json)
            continue;
        printf(".TP\n.BR %s%s", before, q->json);
        if (q->unit[0] || merge[0])
            printf(" \" (%s%s%s)\"", q->unit, q->unit[0] && merge[0] ? "; " : "", merge);
        printf("\n%c", toupper((unsigned char)q->meaning[0]));
        print_roff(q->meaning + 1);
        puts(".");
    }
}

int main(void)
{
    print_keys(frame_quantities, frame_quantity_count, "");
    puts(".PP\nThe list\n.B threads\nhas an object for each worker, with keys of the last frame:");
    print_keys(worker_quantities, worker_quantity_count, "threads[].");
    return fflush(stdout) == 0 ? 0 : 1;
}
